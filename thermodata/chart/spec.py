"""What a chart shows, as plain values; `as_json` of a Chart or a HeatMap is all that the script in a page needs.

Colours are names of palette.css (`colour.py`), never codes: a page has a light and a dark look, and print has its own.
Units are written as they are shown ('um' becomes 'µm' in the page). Arrays hold NaN where nothing was measured, and
are drawn with a gap there.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np

from thermodata.chart.pack import exactly, packed
from thermodata.plugin import Array, Float1D

Scale = Literal["linear", "log"]
Style = Literal["line", "points", "steps", "area"]
SpanKind = Literal["weak", "phase", "gap", "mask"]
_VERSION = 1


@dataclass(frozen=True, slots=True)
class Axis:
    """What runs along x. range: what is shown at first (of all values where None). time: x is seconds since 1970 UTC,
    and ticks are dates. Hours of which there is less than one are read as minutes."""

    label: str
    unit: str
    range: tuple[float, float] | None = None
    scale: Scale = "linear"
    time: bool = False


@dataclass(frozen=True, slots=True)
class Band:
    """Where a series lies with some certainty. low, high: shape (n,) as the series; label: '95 %'."""

    low: Float1D
    high: Float1D
    label: str


_LABEL, _ROOM = 13, 16  # [px] of a label at a line's end, and above and below all of them


@dataclass(frozen=True, slots=True)
class Series:
    """One curve of a panel. y: shape (n,). x: shape (n,), the chart's own where None. label: at the line's end, its
    name where None, '' for none. note: said beside the name in the readout."""

    name: str
    unit: str
    y: Float1D
    colour: str
    x: Float1D | None = None
    style: Style = "line"
    dash: str = "solid"
    width: float = 1.6
    label: str | None = None
    note: str = ""
    band: Band | None = None


@dataclass(frozen=True, slots=True)
class Marks:
    """Samples that stand out, each with its reason: shape (n,) each. Beyond the panel's range one is drawn at its edge
    as a triangle."""

    name: str
    unit: str
    x: Float1D
    y: Float1D
    colours: Sequence[str]
    reasons: Sequence[str]


@dataclass(frozen=True, slots=True)
class Limit:
    """A level line across a panel, and the words for it."""

    y: float
    label: str
    colour: str = "muted"


@dataclass(frozen=True, slots=True)
class Row:
    """A lane of stretches, such as the flags of one channel: (from, to, colour, reason) on the chart's x."""

    name: str
    runs: Sequence[tuple[float, float, str, str]]


@dataclass(frozen=True, slots=True)
class Panel:
    """Curves that share a y axis. range: fixed; else what is in sight fills the height. zero: y = 0 is drawn. height:
    at least; a panel is high enough for the labels at the ends of its lines."""

    title: str
    unit: str
    series: Sequence[Series] = ()
    height: int = 170  # [px]
    scale: Scale = "linear"
    range: tuple[float, float] | None = None
    marks: Sequence[Marks] = ()
    limits: Sequence[Limit] = ()
    zero: bool = False

    def __post_init__(self) -> None:
        labels = sum(series.label != "" for series in self.series)
        object.__setattr__(self, "height", max(self.height, _LABEL * labels + _ROOM))


@dataclass(frozen=True, slots=True)
class Strip:
    """A panel as low as a line of text, without a y axis: an operating state."""

    series: Series
    title: str
    height: int = 24  # [px]


@dataclass(frozen=True, slots=True)
class Span:
    """A shaded stretch of x. rank: 1 is the first to look at, 0 has none. panels: by number, all where None."""

    start: float
    stop: float
    kind: SpanKind
    label: str = ""
    reason: str = ""
    rank: int = 0
    panels: tuple[int, ...] | None = None


@dataclass(frozen=True, slots=True)
class Chart:
    """Panels over one x. x: shape (n,) of all series that have none of their own. about: what it shows, in a sentence,
    for those who don't see it. rows: lanes below the panels."""

    about: str
    axis: Axis
    x: Float1D
    panels: Sequence[Panel | Strip]
    spans: Sequence[Span] = ()
    rows: Sequence[Row] = ()
    rows_title: str = ""
    group: str = ""  # charts of one group share cursor and zoom
    tools: bool = True

    def as_json(self, coarse: bool = False) -> dict[str, Any]:
        """The chart for `ThermoChart`; coarse: two bytes a value, 1/65534 of its span (a saved page's size)."""
        return {
            "kind": "chart",
            "version": _VERSION,
            "about": self.about,
            "axis": _axis(self.axis),
            "x": exactly(self.x),
            "panels": [_panel(p, coarse) for p in self.panels],
            "spans": [_span(s) for s in self.spans],
            "rows": [
                {"name": r.name, "runs": [[_round(a), _round(b), c, w] for a, b, c, w in r.runs]} for r in self.rows
            ],
            "rows_title": self.rows_title,
            "group": self.group,
            "tools": self.tools,
        }


@dataclass(frozen=True, slots=True)
class HeatMap:
    """Strips of colour, one a row. values: shape (rows, columns), NaN where nothing was measured. lengths: up to where
    a row goes [columns]: NaN before that is hatched as missing, behind it stands nothing. limit: the colours reach from
    -limit to +limit, and arrows say where values go beyond. targets: the id of the chart that a click on a row opens
    there, '' for none."""

    about: str
    axis: Axis
    unit: str
    rows: Sequence[str]
    values: Array
    lengths: Sequence[int]
    start: float
    step: float
    limit: float
    note: str = ""
    targets: Sequence[str] = field(default=())

    def as_json(self, coarse: bool = False) -> dict[str, Any]:
        """The heat map for `ThermoChart`."""
        return {
            "kind": "heatmap",
            "version": _VERSION,
            "about": self.about,
            "axis": _axis(self.axis),
            "unit": self.unit,
            "rows": list(self.rows),
            "columns": int(self.values.shape[1]),
            "values": packed(np.asarray(self.values, dtype=np.float64), coarse),
            "lengths": [int(n) for n in self.lengths],
            "start": self.start,
            "step": self.step,
            "limit": self.limit,
            "note": self.note,
            "targets": list(self.targets),
        }


def _axis(axis: Axis) -> dict[str, Any]:
    return {
        "label": axis.label,
        "unit": axis.unit,
        "range": list(axis.range) if axis.range else None,
        "scale": axis.scale,
        "time": axis.time,
    }


def _panel(panel: Panel | Strip, coarse: bool) -> dict[str, Any]:
    if isinstance(panel, Strip):
        return {
            "strip": True,
            "title": panel.title,
            "unit": panel.series.unit,
            "height": panel.height,
            "scale": "linear",
            "range": None,
            "zero": False,
            "series": [_series(panel.series, coarse)],
            "marks": [],
            "limits": [],
        }
    # sixteen bits of a span are too few for small values on a logarithmic axis
    fine = coarse and panel.scale == "linear"
    return {
        "strip": False,
        "title": panel.title,
        "unit": panel.unit,
        "height": panel.height,
        "scale": panel.scale,
        "range": list(panel.range) if panel.range else None,
        "zero": panel.zero,
        "series": [_series(s, fine) for s in panel.series],
        "marks": [_marks(m) for m in panel.marks],
        "limits": [{"y": line.y, "label": line.label, "colour": line.colour} for line in panel.limits],
    }


def _series(series: Series, coarse: bool) -> dict[str, Any]:
    band = series.band
    return {
        "name": series.name,
        "unit": series.unit,
        "colour": series.colour,
        "style": series.style,
        "dash": series.dash,
        "width": series.width,
        "label": series.name if series.label is None else series.label,
        "note": series.note,
        "x": None if series.x is None else exactly(series.x),
        "y": packed(series.y, coarse),
        "band": None
        if band is None
        else {"low": packed(band.low, coarse), "high": packed(band.high, coarse), "label": band.label},
    }


def _marks(marks: Marks) -> dict[str, Any]:
    """Reasons and colours repeat: each is written once."""
    colours, reasons = list(dict.fromkeys(marks.colours)), list(dict.fromkeys(marks.reasons))
    return {
        "name": marks.name,
        "unit": marks.unit,
        "x": [_round(v) for v in marks.x],
        "y": [_round(v) for v in marks.y],
        "colours": colours,
        "colour": [colours.index(c) for c in marks.colours],
        "reasons": reasons,
        "reason": [reasons.index(r) for r in marks.reasons],
    }


def _span(span: Span) -> dict[str, Any]:
    return {
        "from": span.start,
        "to": span.stop,
        "kind": span.kind,
        "label": span.label,
        "reason": span.reason,
        "rank": span.rank,
        "panels": None if span.panels is None else list(span.panels),
    }


def _round(value: float) -> float:
    return float(f"{value:.6g}")
