"""Structs that are one signal: their values, and the fields that say its time, rate, name and unit."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from thermodata.reader.text.preamble.scale_words import states_scale
from thermodata_reader_table.mat.tree import Cells, Node, Numbers, Struct, Text

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


def one_text(node: Node | None) -> str | None:
    """The text of a char array, or of a cell with one."""
    if isinstance(node, Cells) and len(node.items) == 1:
        node = node.items[0]
    return node.lines[0] if isinstance(node, Text) and len(node.lines) == 1 else None


def one_number(node: Node | None) -> float | None:
    """The value of an array of one number, or of a cell with one; None for anything else."""
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
    said: Mapping[str, str] = field(default_factory=dict)  # fields that state a scale: {'gain': '0.1'}


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
        {k: said for k, v in fields.items() if states_scale(k) and (said := _text_or_number(v)) is not None},
    )


def _text_or_number(node: Node) -> str | None:
    number = one_number(node)
    return one_text(node) if number is None else f"{number:.12g}"
