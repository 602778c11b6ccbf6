"""The error on left-out tests of the user's own model with all that a verdict names: before and after are then of
models that somebody has, whatever else a candidate was judged beside."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from threadpoolctl import threadpool_limits

from thermodata.diagnosis.candidates.of_library import CandidateEffect
from thermodata.diagnosis.question.known import known, likeliest
from thermodata.diagnosis.tell.listed import beside_the_model, lets_an_error_fall, rmse
from thermodata.diagnosis.tell.why import judged_beside
from thermodata.diagnosis.verdict.investigate import Investigation, weighed
from thermodata.diagnosis.verdict.judge import Judged, Judgement
from thermodata.errors import ThermodataError
from thermodata.modelling.terms.fitted_response import FittedResponse
from thermodata.view.dataset import Dataset, TestData

# the model with candidates, fitted to all open tests
Refit = Callable[[Sequence[CandidateEffect]], FittedResponse]


def named(investigation: Investigation, judgement: Judgement) -> list[Judged]:
    """The claims; where nothing is claimed, the refinements that let an error fall."""
    offered = [j for j in judgement.refinements if lets_an_error_fall(j.scored, investigation)]
    return list(judgement.claims) or offered


def left_with_named(
    investigation: Investigation, judgement: Judgement, refit: Refit, data: Dataset, tests: Sequence[TestData]
) -> float | None:
    """RMS error of tests that are left out in turn, each alike, as the next version's own answer will tell it; None
    where the verdict names nothing, or the version can't predict all of the open tests."""
    found = named(investigation, judgement)
    # beside the model as it has its effects errors are others, and the candidate tells them itself
    if not found or any(j.scored.as_modelled for j in found):
        return None
    if len(found) == 1:
        told, of_model = beside_the_model(found[0].scored, investigation)
        if of_model or not judged_beside(found[0].scored, found[0], investigation, judgement):
            return rmse(told.sse_after, told)
    try:
        fitted = refit([j.scored.candidate for j in found])
    except ThermodataError:  # no open test has all of their channels
        return None
    if not all(fitted.can_predict(test) for test in tests):
        return None
    with threadpool_limits(1):
        problem, _ = weighed(fitted, data, tests)
        left = known(problem, likeliest(problem)).left_out
    return left if np.isfinite(left) else None
