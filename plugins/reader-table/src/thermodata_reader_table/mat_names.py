"""What names in a MAT file say: which variable is a time, which holds names, units or the rate, what is a signal."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass

from thermodata.reader.time_units import EPOCHS, SECONDS
from thermodata_reader_table.mat_tree import Cells, Node, Numbers, Struct, Text

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

_DATA = ("data", "values", "value", "y", "samples", "ydata", "y_values/values", "signal", "y_data")
_ABSCISSA = ("time", "t", "x", "times", "timestamp", "timestamps", "xdata", "zeit", "x_values/values", "x_data")
_DELTA = (
    "dt",
    "dx",
    "delta",
    "delta_x",
    "increment",
    "interval",
    "x_values/increment",
    "sampleinterval",
    "ts",
    "sampletime",
    "wf_increment",
    "xdelta",
)
_PER_SECOND = ("fs", "rate", "samplerate", "sample_rate", "samplingrate", "sampling_rate", "frequency")
_ZERO = ("x0", "t0", "start", "xstart", "start_value", "x_values/start_value", "wf_start_offset")
_TITLE = ("name", "label", "signalname", "title", "channel", "channelname", "function_record/name", "signal_name")
_UNIT = ("unit", "units", "yunit", "y_unit", "einheit", "jednotka", "unit_string", "y_values/quantity/label")
_TIME_UNIT = ("xunit", "x_unit", "timeunit", "time_unit", "x_values/quantity/label")


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
    return "".join(tokens(name)).lower()


def names_names(name: str) -> bool:
    return squeezed(name) in _NAMES or any(squeezed(name).endswith(w) for w in ("names", "labels", "header"))


def names_units(name: str) -> bool:
    return squeezed(name) in _UNITS or squeezed(name).endswith("units")


def names_time_unit(name: str) -> bool:
    return squeezed(name) in ("timeunit", "timeunits", "unittime", "tunit", "xunit")


def names_step(name: str) -> bool:
    return squeezed(name) in _STEP and name != "TS"


def names_rate(name: str) -> bool:
    return squeezed(name) in _RATE


def unit_in_name(name: str) -> str | None:
    """The unit at the end of a time's name: 'time_s', 'tMin', 'time [h]'."""
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


def one_text(node: Node | None) -> str | None:
    """The text of a char array, or of a cell with one."""
    if isinstance(node, Cells) and len(node.items) == 1:
        node = node.items[0]
    return node.lines[0] if isinstance(node, Text) and len(node.lines) == 1 else None


def one_number(node: Node | None) -> float | None:
    if isinstance(node, Cells) and len(node.items) == 1:
        node = node.items[0]
    return float(node.line(0, 0)[0]) if isinstance(node, Numbers) and node.size == 1 else None


def texts(node: Node) -> list[str] | None:
    """The lines of a char array or of a cell of texts; None where it holds anything else."""
    if isinstance(node, Text):
        return list(node.lines)
    if not isinstance(node, Cells) or not node.items:
        return None
    found = [one_text(item) if not (isinstance(item, Text) and not item.lines) else "" for item in node.items]
    return None if any(f is None for f in found) else [f or "" for f in found]


@dataclass(frozen=True, slots=True)
class Record:
    """A struct that is one signal: its values, and what it says of itself."""

    data: Numbers
    time: Node | None
    step_s: float | None
    zero: float
    title: str | None
    unit: str | None
    time_unit: str | None
    odd: tuple[str, ...] = ()  # fields for a name or a unit that hold no text


def _get(fields: Mapping[str, Node], paths: tuple[str, ...]) -> tuple[str, Node] | None:
    low = {k.lower(): (k, v) for k, v in fields.items()}
    for path in paths:
        first, _, rest = path.partition("/")
        found = low.get(first)
        while found is not None and rest:
            first, _, rest = rest.partition("/")
            node = found[1]
            inner = {k.lower(): v for k, v in node.fields.items()} if isinstance(node, Struct) else {}
            found = (found[0], inner[first]) if first in inner else None
        if found is not None:
            return found
    return None


def as_record(struct: Struct) -> Record | None:
    """The signal that a struct is: one array of values, with a time, a rate, a name or a unit of its own, and no
    other long array; None for any other struct."""
    fields = struct.fields
    data = _get(fields, _DATA)
    if data is None or not isinstance(data[1], Numbers) or data[1].size < 2:
        return None
    time, delta, rate = _get(fields, _ABSCISSA), _get(fields, _DELTA), _get(fields, _PER_SECOND)
    title, unit = _get(fields, _TITLE), _get(fields, _UNIT)
    if time is not None and isinstance(time[1], Numbers) and time[1].size < 2:
        time = None
    step = one_number(delta[1]) if delta else None
    if step is None and rate is not None and (hertz := one_number(rate[1])):
        step = 1.0 / hertz
    if time is None and step is None and title is None and unit is None:
        return None
    used = {data[0], time[0] if time else ""}
    if any(isinstance(v, Numbers) and v.size > 2 and k not in used for k, v in fields.items()):
        return None
    zero, x_unit = _get(fields, _ZERO), _get(fields, _TIME_UNIT)
    return Record(
        data[1],
        time[1] if time else None,
        step,
        (one_number(zero[1]) if zero else None) or 0.0,
        one_text(title[1]) if title else None,
        one_text(unit[1]) if unit else None,
        one_text(x_unit[1]) if x_unit else None,
        tuple(f[0] for f in (title, unit, x_unit) if f and isinstance(f[1], Numbers) and f[1].size),
    )
