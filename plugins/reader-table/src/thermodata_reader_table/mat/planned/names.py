"""What names in a MAT file say: which variable is a time, which holds names, units or the rate, what is a signal."""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Mapping

from thermodata.reader.times.since import count_in
from thermodata.reader.times.time_units import EPOCHS, SECONDS

_TIME = {
    "time",
    "zeit",
    "čas",
    "cas",
    "temps",
    "tiempo",
    "tempo",
    "datum",
    "date",
    "datetime",
    "timestamp",
    "times",
    "timestamps",
    "datenum",
    "时间",
    "時間",
    "tid",
    "uhrzeit",
    "zeitstempel",
    "tvec",
    "timevec",
    "timevector",
    "tiempos",
    "abscissa",
    "seconds",
    "elapsed",
    "posixtime",
    "clock",
    "日時",
    "時刻",
    "日期",
}
_NAMES = {
    "names",
    "name",
    "labels",
    "label",
    "header",
    "headers",
    "colheaders",
    "channels",
    "channelnames",
    "signals",
    "signalnames",
    "columns",
    "columnnames",
    "varnames",
    "variablenames",
    "colnames",
    "kanal",
    "kanäle",
    "namen",
    "nazvy",
    "názvy",
    "legend",
    "titles",
    "channelname",
    "signalname",
    "textdata",
    "variables",
}
_UNITS = {
    "units",
    "unit",
    "einheiten",
    "einheit",
    "jednotky",
    "jednotka",
    "unitnames",
    "channelunits",
    "yunits",
    "variableunits",
}
_UNIT_OF = re.compile(r"(?P<a>.+?)(?:_[Uu]nits?|Units?)|[Uu]nits?_(?P<b>.+)|unit(?P<c>[A-Z].*)")
_LIST_OF = re.compile(
    r"(?P<a>.+?)(?:_(?i:names?|labels?|headers?|legend)|Names?|Labels?|Headers?|names|labels|header)"
    r"|(?i:names?|labels?)_(?P<b>.+)"
)
_GENERAL = {
    *"xy",
    "channel",
    "channels",
    "data",
    "signal",
    "signals",
    "variable",
    "variables",
    "value",
    "values",
    "col",
    "column",
    "columns",
    "var",
    "sensor",
    "sensors",
    "kanal",
    "kanäle",
}
_STEP = {
    "dt",
    "ts",
    "samplingtime",
    "sampletime",
    "samplingperiod",
    "sampleperiod",
    "interval",
    "sampleinterval",
    "samplinginterval",
    "timestep",
    "deltat",
    "increment",
    "abtastzeit",
}
_RATE = {
    "fs",
    "samplerate",
    "samplingrate",
    "samplefrequency",
    "samplingfrequency",
    "rate",
    "frate",
    "abtastrate",
    "abtastfrequenz",
    "fsample",
}


def tokens(name: str) -> list[str]:
    """Words of a name, with case: 'time_T1' -> time, T1; 'timeAxis' -> time, Axis."""
    return re.findall(r"[A-ZÀ-Ž]?[^\W\dA-ZÀ-Ž_]+|[A-ZÀ-Ž]+|\d+", re.sub(r"[_\W]+", " ", name))


def names_time(name: str) -> bool:
    """Whether a name is that of a time: a word for it, or a small t ('T' is a temperature)."""
    if name == "t":
        return True
    return any(w.lower() in _TIME for w in tokens(name))


def may_be_time(name: str) -> bool:
    """Whether a name with a small t for a part could be a time, if its values rise: 't_oil' may be a temperature."""
    parts = tokens(name)
    return len(parts) > 1 and parts[0] == "t"


def without_time(name: str) -> str:
    """What is left of a time's name: the signal that it belongs to ('Data1_time_T1' -> 'data1t1')."""
    return "".join(w for w in tokens(name) if w.lower() not in _TIME and w != "t").lower()


def squeezed(name: str) -> str:
    """A name without what separates its words, in small letters."""
    return "".join(tokens(name)).lower()


def names_names(name: str) -> bool:
    """Whether a variable holds the names of others."""
    return squeezed(name) in _NAMES or any(squeezed(name).endswith(w) for w in ("names", "labels", "header"))


def names_units(name: str) -> bool:
    """Whether a variable holds the units of others."""
    return squeezed(name) in _UNITS or squeezed(name).endswith("units")


def unit_of(name: str, known: Collection[str] = (), unit: str | None = None) -> str | None:
    """The variable whose unit one holds that is called after it: T1_unit, unit_T1, T1Unit; None for another one.
    known: the variables beside it: of two that differ by case alone each has its own; unit: what it holds."""
    match = _UNIT_OF.fullmatch(name)
    if match is None:
        return None
    other = match["a"] or match["b"] or match["c"]
    if other in known:
        return str(other)
    return None if names_time_unit(name, unit) or squeezed(other) in _GENERAL else str(other)


def unit_among(said: Mapping[str, str], known: Callable[[str], bool] = bool) -> str | None:
    """The unit that attributes of an array say, where no letter of it is lost. known: whether a text is one;
    a time may say more: 's since 2000'."""
    texts = (text.strip() for key, text in said.items() if squeezed(key) in _UNITS)
    return next((text for text in texts if text and "\ufffd" not in text and known(text)), None)


def listed_of(name: str, known: Collection[str]) -> str:
    """The variable whose columns a list of names or units is of, by its own name: 'T_names' of T; '' where it is called
    after none (names, channelUnits). known: the variables beside it; 'tempNames' is of Temp, 'T_names' never of t."""
    match = _LIST_OF.fullmatch(name) or _UNIT_OF.fullmatch(name)
    other = next((part for part in match.groups() if part), "") if match is not None else ""
    if other in known or len(other) < 2:
        return other
    alike = [k for k in known if k.lower() == other.lower() and k != name]
    return alike[0] if len(alike) == 1 else "" if squeezed(other) in _GENERAL else other


def names_time_unit(name: str, unit: str | None) -> bool:
    """Whether a variable holds the unit of the time; T_unit, with a large T, only where that is a unit of time, for it
    may be that of a temperature. unit: what it holds."""
    if squeezed(name) in ("timeunit", "timeunits", "unittime", "xunit"):
        return True
    return squeezed(name) == "tunit" and (not name.startswith("T") or (unit or "").strip().lower() in SECONDS)


def names_step(name: str) -> bool:
    """Whether a variable holds the time between two samples, in s."""
    return squeezed(name) in _STEP and name != "TS"


def names_rate(name: str) -> bool:
    """Whether a variable holds the samples a second."""
    return squeezed(name) in _RATE


def unit_in_name(name: str) -> str | None:
    """The unit at the end of a time's name: 'time_s', 'tMin', 'time [h]'; or a count: 'seconds_since_1904'."""
    if (counted := count_in(name)) is not None:
        return counted
    parts = tokens(name)
    last = parts[-1].lower() if len(parts) > 1 else ""
    return (
        last
        if last in SECONDS and last != "d"
        else "datenum"
        if "datenum" in [p.lower() for p in parts]
        else (
            "unix"
            if {"posix", "posixtime", "unix", "epoch"} & {p.lower() for p in parts}
            else last
            if last in EPOCHS
            else None
        )
    )
