"""Open tests whose error is the level of what is on at their first sample, and may have run before."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from thermodata.modelling.terms.fitted_response import FittedResponse
from thermodata.modelling.trust.checks.started_on import started_on
from thermodata.schema.answers.diagnosis import StartedOn
from thermodata.view.grid.dataset import TestData


def started_with(response: FittedResponse, tests: Sequence[TestData]) -> list[StartedOn]:
    """In the tests' order."""
    usable = [t for t in tests if response.can_predict(t)]
    counted = [int(response.mask(t).sum()) for t in usable]
    whole = sum(float(np.sum(response.residual(t)[response.mask(t)] ** 2)) for t in usable)
    return [
        StartedOn(
            campaign=test.campaign,
            test=test.test,
            on=found.on,
            channels=dict(found.channels),
            rmse_um=found.rmse,
            left_um=found.left,
            of_squares=n * (found.rmse**2 - found.left**2) / whole,
        )
        for test, n in zip(usable, counted, strict=True)
        if (found := started_on(response, test)) is not None
    ]
