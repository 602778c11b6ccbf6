"""The estimated missing heat of each test as a small chart: what is left over and what the source gives, over it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from thermodata.chart import Axis, Chart, Panel, Series
from thermodata.report.words.pieces import names_of_pieces
from thermodata.schema.answers.missing_heat import HeatCourse


def heat_charts(courses: Sequence[HeatCourse], unit: str, one_way: bool) -> list[Chart]:
    """One chart a test, all on the same scales for comparison. one_way: the source is never negative."""
    reach, source = _reach(courses), _source_range(courses, one_way)
    return [_chart(c, name, reach, source, unit) for c, name in zip(courses, names_of_pieces(courses), strict=True)]


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


def _chart(course: HeatCourse, name: str, reach: tuple[float, float], source: tuple[float, float], unit: str) -> Chart:
    step_h, from_h = course.step_s / 3600, course.from_s / 3600
    residual = np.array([np.nan if x is None else x for x in course.residual_um], dtype=np.float64)
    n = len(residual)
    return Chart(
        f"Test {name}: what the model leaves over, what the estimated source gives, and the source",
        Axis("time", "h", range=(from_h, from_h + step_h * n)),
        np.asarray(from_h + step_h * (np.arange(n) + 0.5)),  # a step's value stands in its middle
        [
            Panel(
                "from its mean",
                unit,
                [
                    Series("left over", unit, residual, "residual", width=1.4, label=""),
                    Series("estimated", unit, np.array(course.contribution_um), "model", width=2.0, label=""),
                ],
                height=100,
                range=reach,
                zero=True,
            ),
            Panel(
                "source",
                unit,
                [Series("source", unit, np.array(course.source_um), "source", style="area", width=1.0, label="")],
                height=60,
                range=source,
            ),
        ],
        tools=False,
    )
