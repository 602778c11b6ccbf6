"""What a chart is made of, as plain values: its axis, panels of curves and marks, strips, rows and spans.

Colours are names of palette.css (`colour.py`), never codes: a page has a light and a dark look, and print has its own.
Units are written as they are shown ('um' becomes 'µm' in the page). Arrays hold NaN where nothing was measured, and
are drawn with a gap there.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from thermodata.plugin import Float1D

Scale = Literal["linear", "log"]
Style = Literal["line", "points", "steps", "area"]
SpanKind = Literal["weak", "phase", "gap", "mask"]


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
