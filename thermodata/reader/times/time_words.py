"""Units of time in the words of the languages of labs: 'minuty', 'v minutách', 'Stunden', '分钟'."""

from __future__ import annotations

import re

_WORDS = {
    "s": "sec secs sek second seconds sekunden sekundy sekund sekundách sekundach secondi segundos secondes sekunder "
    "seconden másodperc sekuntia saniye секунды секунд сек 秒 초 秒钟",
    "min": "min mins minute minutes minuten minuty minut minuta minutách minutach minuti minuto minutos minuter "
    "minutter perc minuuttia dakika dak минуты минут мин 分 分钟 分鐘 분",
    "h": "hr hrs std hour hours stunden hod hodiny hodin hodina hodinách ore horas heures godziny godzin godzinach "
    "timmar timer uren tuntia saat часы часов час 小时 小時 시간",
    "d": "tage tagen dny dní dnů dni giorni días dias jours dagen dagar päivää дни дней",
}
UNIT_OF_WORD = {word: unit for unit, words in _WORDS.items() for word in words.split()}
_SIGNS = ("s", "h", "ms", "us")  # at the end of a name alone: uptime_s
_LETTERS = re.compile(r"[^\W\d_]+")
_JOINED = tuple(w for w in UNIT_OF_WORD if ord(w[0]) > 0x2FFF)  # of languages that write no blanks: 経過分


def unit_named(name: str) -> str | None:
    """The unit of time that a word in a name is; None where none is one, or where two differ."""
    words = _LETTERS.findall(name.lower())
    found = {unit for word in words if (unit := _unit_of(word)) is not None}
    if len(words) > 1 and words[-1] in _SIGNS:
        found.add(words[-1])
    return found.pop() if len(found) == 1 else None


def _unit_of(word: str) -> str | None:
    at_end = next((UNIT_OF_WORD[w] for w in _JOINED if word.endswith(w)), None)
    return UNIT_OF_WORD.get(word, at_end)
