"""What a page draws: a chart or a map of heat; `as_json` of one is all that the script in a page needs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from thermodata.chart.pack import exactly, packed
from thermodata.chart.parts import Axis, Panel, Row, Span, Strip
from thermodata.chart.parts_as_json import axis_as_json, panel_as_json, row_as_json, span_as_json
from thermodata.plugin import Array, Float1D

_VERSION = 1


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
            "axis": axis_as_json(self.axis),
            "x": exactly(self.x),
            "panels": [panel_as_json(p, coarse) for p in self.panels],
            "spans": [span_as_json(s) for s in self.spans],
            "rows": [row_as_json(r) for r in self.rows],
            "rows_title": self.rows_title,
            "group": self.group,
            "tools": self.tools,
        }


@dataclass(frozen=True, slots=True)
class HeatMap:
    """Strips of colour, one a row. values: shape (rows, columns), NaN where nothing was measured. lengths: up to where
    a row goes [columns]: NaN before that is hatched as missing, behind it stands nothing. limit: the colours reach from
    -limit to +limit, and arrows say where values go beyond. targets: the id of the chart that a click on a row opens
    there, '' for none. figures: what stands behind each row, under figures_title."""

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
    figures: Sequence[str] = ()
    figures_title: str = ""

    def as_json(self, coarse: bool = False) -> dict[str, Any]:
        """The heat map for `ThermoChart`."""
        return {
            "kind": "heatmap",
            "version": _VERSION,
            "about": self.about,
            "axis": axis_as_json(self.axis),
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
            "figures": list(self.figures),
            "figures_title": self.figures_title,
        }
