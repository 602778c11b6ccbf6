"""What a version itself leaves on the locked tests that were opened for all that it adds: no look more."""

from __future__ import annotations

from typing import TYPE_CHECKING

from thermodata.modelling.terms.rms import rms

if TYPE_CHECKING:
    from thermodata.modelling.terms.fitted import FittedModel
    from thermodata.schema.answers.candidate import Candidate
    from thermodata.schema.answers.diagnosis import Diagnosis
    from thermodata.view.grid.dataset import Dataset


def errors_on_locked(fitted: FittedModel, data: Dataset, found: Diagnosis, claim: Candidate) -> dict[str, float | None]:
    """`locked_rmse_um_*` of a result: before and as fitted of the parent, as its diagnosis has them; after of this very
    version, whose second lags were not in that question [unit of the response]; all None where it can't be scored on
    the same tests. found: with what was claimed on them. claim: one of it."""
    after = _left_where_asked(fitted, data, found)
    told = (None, None) if after is None else (claim.locked_rmse_um_before, claim.locked_rmse_um_fitted)
    return {"locked_rmse_um_before": told[0], "locked_rmse_um_after": after, "locked_rmse_um_fitted": told[1]}


def _left_where_asked(fitted: FittedModel, data: Dataset, found: Diagnosis) -> float | None:
    """RMS over all samples that count of the locked tests that were asked; None where one of them can't be foretold."""
    unasked = {(t.campaign, t.test) for t in found.locked_unasked}
    unasked |= set(found.put_right.left_out) if found.put_right is not None else set()
    tests = [t for t in fitted.tests(data, "locked") if t.key not in unasked]
    response = next((r for r in fitted.responses if r.name == found.response), None)
    if response is None or not all(response.can_predict(t) for t in tests):
        return None
    left = [response.residual(t)[response.mask(t)] for t in tests]
    return rms(left) if any(map(len, left)) else None
