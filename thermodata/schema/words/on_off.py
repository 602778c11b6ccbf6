"""What labs and controls write for on and off in a column of a switch."""

from __future__ import annotations

import unicodedata
from functools import lru_cache

SHOWN = "ON and OFF, EIN and AUS, MARCHE and ARRET, ACCESO and SPENTO, ENCENDIDO and APAGADO, ZAP and VYP, 入 and 切"
"""Some pairs of such words, for a message."""

_ON = (
    *("1", "true", "on", "yes", "ein", "an", "ja", "eingeschaltet", "wahr", "aan", "ingeschakeld"),
    *("ano", "zap", "zapnuto", "zapnut", "zapnuta", "marche", "en marche", "oui", "vrai", "allumé", "enclenché"),
    *("acceso", "accesa", "marcia", "in marcia", "inserito", "inserita", "si", "vero"),
    *("encendido", "encendida", "marcha", "en marcha", "conectado", "conectada", "verdadero"),
    *("ligado", "ligada", "sim", "verdadeiro", "wł", "włączony", "włączona", "włączone", "załączony", "tak"),
    *("вкл", "включено", "включен", "да", "på", "till", "evet", "be", "bekapcsolva", "igen"),
    *("入", "運転", "オン", "开", "開", "启动", "运行", "켜짐", "운전"),
)
_OFF = (
    *("0", "false", "off", "no", "aus", "nein", "ausgeschaltet", "falsch", "uit", "nee", "uitgeschakeld"),
    *("ne", "vyp", "vypnuto", "vypnut", "vypnuta", "arrêt", "à l'arrêt", "non", "faux", "éteint", "déclenché"),
    *("spento", "spenta", "arresto", "in arresto", "disinserito", "disinserita", "falso"),
    *("apagado", "apagada", "paro", "parada", "parado", "desconectado", "desconectada"),
    *("desligado", "desligada", "não", "wył", "wyłączony", "wyłączona", "wyłączone", "nie"),
    *("выкл", "выключено", "выключен", "нет", "av", "från", "hayır", "ki", "kikapcsolva", "nem"),
    *("切", "停止", "オフ", "关", "關", "꺼짐", "정지"),
)


@lru_cache(maxsize=10_000)
def on_or_off(word: str) -> float | None:
    """1 of a word for on, 0 of one for off, in capitals or not, with its accents or without; None of any other."""
    return _NUMBER_OF.get(_bare(word))


def _bare(word: str) -> str:
    apart = unicodedata.normalize("NFKD", word.strip().casefold())
    return "".join(c for c in apart if not unicodedata.combining(c)).rstrip(".").replace("ł", "l").replace("ı", "i")


_NUMBER_OF = {_bare(w): number for number, words in ((1.0, _ON), (0.0, _OFF)) for w in words}
