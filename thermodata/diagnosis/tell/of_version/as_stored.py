"""Where a model fails by the parameters that it has, as every other command says: the question itself is asked of a fit
to all tests, also those that came since."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from thermodata.diagnosis.question.weak import weak_spots
from thermodata.diagnosis.tell.of_version.started_on import started_with
from thermodata.modelling.run import Loaded
from thermodata.modelling.terms.fitted_response import FittedResponse
from thermodata.schema.answers.diagnosis import Diagnosis
from thermodata.view.grid.dataset import TestData


def as_fitted(response: FittedResponse, tests: Sequence[TestData]) -> float | None:
    """RMS residual over what counts of all open tests."""
    parts = [response.residual(t)[response.mask(t)] for t in tests if response.can_predict(t)]
    whole = np.concatenate([*parts, np.empty(0)])
    return float(np.sqrt(np.mean(whole**2))) if len(whole) else None


def by_its_own_parameters(found: Diagnosis, stored: Loaded) -> Diagnosis:
    """The answer with weak spots, error and levels at the start of the model as the store holds it, on its tests as
    they are now."""
    response = next(r for r in stored.fitted.responses if r.name == found.response)
    tests = [t for t in stored.fitted.tests(stored.data) if response.can_predict(t)]
    noise = math.nan if found.noise_um is None else found.noise_um
    spots = weak_spots([(t, response.residual(t), response.mask(t)) for t in tests], noise)
    error, levels = as_fitted(response, tests), started_with(response, tests)
    return found.model_copy(update={"weak_spots": spots, "fitted_rmse_um": error, "started_on": levels})
