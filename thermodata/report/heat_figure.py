"""The estimated missing heat of each test as a small figure: what is left over and what the source gives, over it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from thermodata.report import colour
from thermodata.report.decimate import packed
from thermodata.report.figures import Figure, base_layout
from thermodata.schema.result import HeatCourse

HEIGHT = 190  # [px]
_SPLIT, _GAP = 0.36, 0.07  # share of the height that the source has, and the space above it


def heat_figures(courses: Sequence[HeatCourse], unit: str, one_way: bool) -> list[Figure]:
    """One figure a test, all on the same scales for comparison. one_way: the source is never negative."""
    return [_figure(c, _reach(courses), _source_range(courses, one_way), unit) for c in courses]


def _reach(courses: Sequence[HeatCourse]) -> tuple[float, float]:
    seen = [x for c in courses for x in (*c.residual_um, *c.contribution_um) if x is not None]
    low, high = min(seen, default=-1.0), max(seen, default=1.0)
    room = 0.06 * (high - low or 1.0)
    return low - room, high + room


def _source_range(courses: Sequence[HeatCourse], one_way: bool) -> tuple[float, float]:
    everything = [x for c in courses for x in c.source_um] or [1.0]
    # a single spike must not flatten all other tests
    high = min(max(everything), 2 * float(np.quantile(everything, 0.99))) or max(everything) or 1.0
    low = 0.0 if one_way else max(min(everything), 2 * min(float(np.quantile(everything, 0.01)), 0.0))
    return 1.08 * min(low, 0.0), 1.08 * high


def _figure(course: HeatCourse, reach: tuple[float, float], source: tuple[float, float], unit: str) -> Figure:
    step_h, from_h = course.step_s / 3600, course.from_s / 3600
    residual = np.array([np.nan if x is None else x for x in course.residual_um], dtype=np.float64)
    layout = base_layout(HEIGHT)
    axis = {"gridcolor": colour.GRID, "zeroline": False, "tickfont": {"size": 10, "color": colour.MUTED}}
    layout.update(
        showlegend=False,
        hovermode="x",
        hoversubplots="axis",
        margin={"l": 40, "r": 6, "t": 6, "b": 24, "pad": 0},
        yaxis={
            **axis,
            "domain": [_SPLIT + _GAP, 1],
            "range": list(reach),
            "nticks": 4,
            "zeroline": True,
            "zerolinecolor": "#cbd5e1",
        },
        yaxis2={**axis, "domain": [0, _SPLIT], "range": list(source), "nticks": 3, "anchor": "x"},
        xaxis={
            **axis,
            "anchor": "y2",
            "range": [from_h, from_h + step_h * len(residual)],
            "ticksuffix": " h",
            "showticksuffix": "last",
            "nticks": 6,
            "showline": True,
            "linecolor": "#cbd5e1",
        },
    )
    middle = {"type": "scatter", "mode": "lines", "x0": from_h + step_h / 2, "dx": step_h}
    return {
        "data": [
            {
                **middle,
                "y": packed(residual),
                "name": "residual",
                "line": {"color": colour.RESIDUAL, "width": 1.4},
                "hovertemplate": f"residual %{{y:.3~g}} {unit}<extra></extra>",
            },
            {
                **middle,
                "y": packed(np.array(course.contribution_um)),
                "name": "estimated",
                "line": {"color": colour.MODEL, "width": 2.2},
                "opacity": 0.75,
                "hovertemplate": f"estimated %{{y:.3~g}} {unit}<extra></extra>",
            },
            {
                **middle,
                "y": packed(np.array(course.source_um)),
                "yaxis": "y2",
                "name": "source",
                "fill": "tozeroy",
                "fillcolor": colour.faint(colour.WEAK, 0.45),
                "line": {"color": colour.WEAK, "width": 1, "shape": "hvh"},
                "hovertemplate": f"source %{{y:.3~g}} {unit}<extra></extra>",
            },
        ],
        "layout": layout,
    }
