"""Lines above a table that say when something was: what their labels are made of, in the languages of loggers.

A label says one of these: rows began then; something was recorded then; a logger was switched on then, which may be
before the rows begin; a date or a time and no more; or a file was made then, which may be weeks later. A label with any
other word, such as "Calibration date", says nothing of the rows. Where such a one names a start and leaves open of
what, it is asked.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from enum import IntEnum

from thermodata.reader.text.cells.time_forms.calendar_words import WEEKDAYS


class TimeLabel(IntEnum):
    """What a label says of its time, the surest last."""

    MADE = 1  # the file was: exported, printed, created
    NAMED = 2  # something began, and nobody knows what: 'Start Messung WZM3'
    BARE = 3  # a date, a time
    BOOTED = 4  # the logger was switched on: weeks before, or for another run
    RECORDED = 5
    BEGAN = 6


_BEGAN = (
    "start starts started starting begin begins began beginning t0 trigger triggered startzeit startdatum "
    "startzeitpunkt beginn messbeginn messstart testbeginn versuchsbeginn aufnahmebeginn aufzeichnungsbeginn "
    "aufnahmestart aufzeichnungsstart triggerzeit triggerzeitpunkt inizio avvio début debut départ depart "
    "démarrage demarrage déclenchement declenchement inicio comienzo arranque disparo início partida začátek "
    "zacatek počátek pocatek zahájení zahajeni spuštění spusteni początek poczatek rozpoczęcie rozpoczecie "
    "kezdet indítás starttijd starttidspunkt starttid gestartet begonnen startuhrzeit avviato iniziato iniciado "
    "commencé démarré commence demarre spuštěno zahájeno rozpoczęto "
    "開始 開始時刻 開始時間 開始日時 测量开始 开始 开始时间 开始日期 "
    "起始时间 開始日期 触发时间 시작 시작시간"
)
_RECORDED = (
    "measurement measurements measured measuring recording recorded record acquisition acquired test log logging "
    "logged session run scan messung messdatum messzeitpunkt aufnahme aufnahmedatum aufnahmezeitpunkt aufzeichnung "
    "aufzeichnungsdatum messungen versuch versuchsdatum prüfung prüfdatum testdatum misura misure misurazione "
    "misurazioni acquisizione registrazione prova mesure enregistrement essai medición medicion medida adquisición "
    "adquisicion registro "
    "ensayo medição aquisição měření mereni záznam zaznam záznamu zkouška měřeno pomiar pomiaru rejestracja "
    "rejestracji mérés meting "
    "測定 測定日時 測定日 計測日時 记录时间 测量时间 测试时间 采集时间 試験日"
)
_BOOTED = "boot booted bootup boottime bootzeit hochgefahren eingeschaltet einschaltzeit neustart"
_BARE = (
    "date time datetime timestamp day datum zeit uhrzeit zeitpunkt zeitstempel data ora orario heure horodatage "
    "fecha hora čas cas dátum idő godzina czas tijd dato tid klockslag 日時 日付 時刻 日期 时间 時間 日期时间 "
    "날짜 시간 일시"
)
_MADE = (
    "created creation exported export printed print report saved written generated modified file save "
    "erstellt erstellungsdatum exportiert exportdatum gedruckt druckdatum druck bericht gespeichert "
    "speicherdatum creato creazione esportato stampa stampato rapporto salvato créé cree création exporté "
    "exporte imprimé imprime rapport enregistré creado creación creacion exportado impreso informe guardado "
    "vytvořeno vytvoreno exportováno tisk vytištěno uloženo utworzono wydruk raport zapisano 作成日 作成日時 "
    "保存日時 印刷日 创建时间 导出时间 打印日期"
)
_FILLING = (
    "of the at on in and for first sample samples value values reading data point und der des die das am um von "
    "vom ersten di del della dell dei delle e il la le les de du d l et y en el los local lokal absolute abs "
    "absolut z ze do series channel storage ortszeit lokalzeit locale lokale lokaler místní mistni lokalny lokal is "
    "was ist war wurde été ete est"
)
_WORDS = {
    **dict.fromkeys(WEEKDAYS.split(), None),
    **dict.fromkeys(_FILLING.split(), None),
    **dict.fromkeys(_MADE.split(), TimeLabel.MADE),
    **dict.fromkeys(_BOOTED.split(), TimeLabel.BOOTED),
    **dict.fromkeys(_RECORDED.split(), TimeLabel.RECORDED),
    **dict.fromkeys(_BARE.split(), TimeLabel.BARE),
    **dict.fromkeys(_BEGAN.split(), TimeLabel.BEGAN),
}
# of what ended, or of what is done to a sensor or a machine at another time
_OTHER = re.compile(
    r"(?i)(?:end\w*|stop\w*|fin|fine|konec|koniec|last|letzte\w*|next|previous|cal|[ck]alib\w*|kal|étalon\w*|taratura|"
    r"verif\w*|service|wartung|maintenance|warranty|licen[cs]e|lizenz|production|job|shift|schicht)"
)
_CAMEL = re.compile(r"(?<=[a-zß-ÿ])(?=[A-Z])")
_ZONES = re.compile(r"\bIST\b")  # of India, Israel and Ireland, and no German word
_LONGEST = 60  # letters of a label


def said_by(label: str) -> TimeLabel | None:
    """What a label says of the time behind it; None where it is none of a time, or of another: "End", "Calibrated"."""
    if not 0 < len(label) <= _LONGEST:
        return None
    words = re.findall(r"t_?0\b|[^\W_]+", _CAMEL.sub(" ", label).casefold().replace("t_0", "t0"))
    if not words:
        return None
    if any(w not in _WORDS for w in words) or _ZONES.search(label):
        return TimeLabel.NAMED if _names_a_start(words) else None
    known = [s for w in words if (s := _WORDS[w]) is not None]
    if not known:
        return None
    # a file that was made says nothing of its rows, whatever else stands there: "Report date", "Print time"; nor does
    # a logger that was switched on: "Last test boot"
    return TimeLabel.MADE if TimeLabel.MADE in known else TimeLabel.BOOTED if TimeLabel.BOOTED in known else max(known)


def is_of_another_time(text: str) -> bool:
    """Whether a text speaks of what ended, of what was done to a sensor or a machine, or of when a file was made."""
    words = re.findall(r"[^\W\d_]+", text.casefold())
    return any(_OTHER.fullmatch(w) or _WORDS.get(w) is TimeLabel.MADE for w in words)


def _names_a_start(words: Sequence[str]) -> bool:
    """Whether a label with words that nobody knows names a start: of what, is open."""
    began = any(_WORDS.get(w) is TimeLabel.BEGAN for w in words)
    return began and not any(_OTHER.fullmatch(w) or w.isdecimal() for w in words)
