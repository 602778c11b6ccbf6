"""How well a model does: free run only, by test and phase.

FIT = (1 - ||y - y_sim|| / ||y - mean(y)||) * 100, not clipped: below 0 the mean would have been the better model.
([mares2021] prints y + y_sim in the denominator; it is the mean.)
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from thermodata.modelling.inputs.phases import phases
from thermodata.modelling.terms.fitted import FittedModel
from thermodata.modelling.terms.fitted_response import FittedResponse
from thermodata.modelling.terms.rms import rms
from thermodata.plugin import Float1D
from thermodata.schema.answers.result import Score
from thermodata.view.grid.dataset import Dataset, TestData

ALL = "all"
FEWEST = 2  # samples that a test needs for an error: the first gives its offset
IN_SAMPLE = "verification (in-sample)"


def scores(fitted: FittedModel, data: Dataset, model_id: str) -> list[Score]:
    """A row a test, response and phase, 'all' first. Tests that can't be predicted are left out, and so are
    locked ones: to look at these is counted (`diagnosis.locked`)."""
    rows: list[Score] = []
    for test in fitted.tests(data):
        role = role_of(fitted, test)
        for response in fitted.responses:
            if response.can_predict(test):
                rows += score_test(response, test, model_id, role)
    return rows


def role_of(fitted: FittedModel, test: TestData) -> str:
    """The test's role in this model; verification tests that were fitted too say so, and so do those that hold samples
    of a fitted one."""
    role = fitted.roles.role(test.key)
    fitted_too = any(test.key in r.fitted_on for r in fitted.responses) or test.key in fitted.overlaps
    return IN_SAMPLE if role == "verification" and fitted_too else role


def score_test(response: FittedResponse, test: TestData, model_id: str, role: str) -> Iterator[Score]:
    """Errors of the free run over the whole test and over each of its phases, in the response's unit."""
    measured, residual, mask = response.measured(test), response.residual(test), response.mask(test)
    whole = {ALL: np.ones(len(mask), bool)}
    for phase, inside in (whole | phases(test, response.bound.channel_of(test))).items():
        counted = mask & inside
        if phase != ALL and not counted.any():
            continue
        numbers = figures(measured[counted], residual[counted])
        yield Score(
            model=model_id,
            campaign=test.campaign,
            test=test.test,
            role=role,
            response=response.name,
            phase=phase,
            n=int(counted.sum()),
            **numbers,
        )


def figures(measured: Float1D, residual: Float1D) -> dict[str, float | None]:
    """fit [%], rmse, peak to peak (max - min) of both, largest absolute residual; None where nothing is scored: the one
    sample that its offset is taken from says nothing of the model."""
    if len(measured) < FEWEST:
        return dict.fromkeys(("fit", "rmse_um", "ptp_um", "ptp_residual_um", "max_um"))
    return {
        "fit": fit_percent(measured, residual),
        "rmse_um": rms([residual]),
        "ptp_um": float(np.ptp(measured)),
        "ptp_residual_um": float(np.ptp(residual)),
        "max_um": float(np.max(np.abs(residual))),
    }


def fit_percent(measured: Float1D, residual: Float1D) -> float | None:
    """None where the measured value never moves."""
    spread = float(np.linalg.norm(measured - measured.mean()))
    return None if spread == 0 else (1.0 - float(np.linalg.norm(residual)) / spread) * 100.0


def peak_sum(values: Float1D) -> float:
    """|max| + |min|, the peak to peak of [straka2021] and [horejs2022]."""
    return abs(float(values.max())) + abs(float(values.min())) if len(values) else 0.0
