"""A candidate's evidence as a chart: in each test the residual, and what the candidate would take of it."""

from __future__ import annotations

import numpy as np

from thermodata.chart.colour import EFFECTS
from thermodata.chart.spec import Axis, Chart, Panel, Series
from thermodata.schema.candidate import Candidate


def course_chart(c: Candidate, unit: str) -> Chart:
    """A panel a test. unit: of the response."""
    length = max((run.t_s[-1] / 3600 for run in c.courses if run.t_s), default=1.0)
    return Chart(
        f"What the model leaves over in each test, and what {c.id} would take of it",
        Axis("time", "h", range=(0.0, length)),
        np.empty(0),
        [
            Panel(
                run.test,
                unit,
                [
                    Series("residual", unit, np.asarray(run.residual_um), "residual", x=np.asarray(run.t_s) / 3600),
                    Series(c.effect, unit, np.asarray(run.contribution_um), EFFECTS[0], x=np.asarray(run.t_s) / 3600),
                ],
                height=110,
                zero=True,
            )
            for run in c.courses
        ],
    )
