"""A candidate's evidence as a chart: in each test the residual, and what the candidate would take of it."""

from __future__ import annotations

import numpy as np

from thermodata.chart.colour import EFFECTS
from thermodata.chart.parts import Axis, Panel, Series
from thermodata.chart.spec import Chart
from thermodata.plugin import Float1D, Int1D
from thermodata.report.verdict.refined import named
from thermodata.report.words.pieces import names_of_pieces
from thermodata.schema.answers.candidate import Candidate, CandidateCourse

PAUSE = 3.0  # steps as on either side of it: no sample counts for so long, and no line is drawn over it


def course_chart(c: Candidate, unit: str) -> Chart:
    """A panel a test, or part of one. unit: of the response."""
    length = max((run.t_s[-1] / 3600 for run in c.courses if run.t_s), default=1.0)
    return Chart(
        f"What the model leaves over in each test, and what {c.id} would take of it",
        Axis("time", "h", range=(0.0, length)),
        np.empty(0),
        [
            Panel(name, unit, _curves(run, c, unit), height=110, zero=True)
            for name, run in zip(names_of_pieces(c.courses), c.courses, strict=True)
        ],
    )


def _curves(run: CandidateCourse, c: Candidate, unit: str) -> list[Series]:
    t_s = np.asarray(run.t_s)
    after = pauses(t_s)
    middle = (t_s[after - 1] + t_s[after]) / 2 if len(after) else t_s[:0]
    hours = np.insert(t_s, after, middle) / 3600
    return [
        Series(name, unit, np.insert(np.asarray(values, dtype=np.float64), after, np.nan), colour, x=hours, label=label)
        for name, label, values, colour in (
            ("residual", "residual", run.residual_um, "residual"),
            (named(c), c.effect, run.contribution_um, EFFECTS[0]),
        )
    ]


def pauses(t_s: Float1D) -> Int1D:
    """First samples behind a pause, as indices of t_s, shape (n,): a step far longer than those before and after it. A
    stretch that was sampled seldom has no pause within itself."""
    steps = np.diff(t_s)
    if len(steps) < 2:
        return np.empty(0, dtype=np.int64)
    beside = np.maximum(np.concatenate([[0.0], steps[:-1]]), np.concatenate([steps[1:], [0.0]]))
    return np.flatnonzero((steps > PAUSE * beside) & (steps > PAUSE * np.median(steps))) + 1
