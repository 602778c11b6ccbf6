"""The last question to a claim: does it hold on the locked tests, which took no part in the choice?"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from thermodata.diagnosis.candidates import CandidateEffect
from thermodata.modelling.fit import fit_model
from thermodata.modelling.fitted import FittedModel
from thermodata.modelling.fitted_response import FittedResponse
from thermodata.schema.model import EffectSpec, Model
from thermodata.schema.result import Parameter
from thermodata.view.dataset import Dataset, TestData

# the locked error must fall at least by this share, or the claim is withdrawn
MUST_FALL = 0.02


@dataclass(frozen=True, slots=True)
class Confirmation:
    """Errors on the locked tests, None where there are none; parameters of the added effect.

    before, after: as scored, from the mean of the first samples on. shape_before, shape_after: with a free offset a
    test, which is what decides: one unlucky zero must not hide that the shape fits.
    """

    before: float | None
    after: float | None
    shape_before: float | None
    shape_after: float | None
    parameters: dict[str, Parameter]

    @property
    def holds(self) -> bool:
        before, after = self.shape_before, self.shape_after
        return before is None or after is None or after < (1 - MUST_FALL) * before


def extended(spec: Model, candidate: CandidateEffect) -> Model:
    """The model with the candidate as one more effect."""
    added = EffectSpec(effect=candidate.effect.name, drivers=dict(candidate.binding))
    return spec.model_copy(update={"effects": [*spec.effects, added]})


def on_all_open(spec: Model, tests: Sequence[TestData], locked: Sequence[TestData]) -> Model:
    """The model calibrated on every test that took part in the choice; the locked ones stay locked."""

    def names(some: Sequence[TestData]) -> list[str]:
        return [f"{t.campaign}/{t.test}" for t in some]

    return spec.model_copy(update={"calibrate_on": names(tests), "verify_on": [], "locked": names(locked)})


def confirm(
    spec: Model,
    index: int,
    data: Dataset,
    candidate: CandidateEffect,
    tests: Sequence[TestData],
    locked: Sequence[TestData],
    second: CandidateEffect | None = None,
    base: FittedModel | None = None,
) -> Confirmation:
    """Fit without and with the candidate on all open tests, and score both on the locked ones.

    index: of the response among the model's responses. second: an effect that is missing beside the candidate; then
    both together decide, for one alone may be fitted to what the other does. base: the fit without, where it is made.
    """
    spec = on_all_open(spec, tests, locked)
    base = fit_model(spec, data, uncertainty=False) if base is None else base
    more = fit_model(extended(spec, candidate), data)
    ours, theirs = base.responses[index], more.responses[index]
    usable = [t for t in locked if ours.can_predict(t) and theirs.can_predict(t)]
    known = set(base.parameters())
    added = {name: p for name, p in more.parameters().items() if name not in known}
    deciding = theirs
    if second is not None:
        both = fit_model(extended(extended(spec, candidate), second), data, uncertainty=False)
        deciding = both.responses[index]
    return Confirmation(
        rmse(ours, usable),
        rmse(theirs, usable),
        rmse(ours, usable, free=True),
        rmse(deciding, usable, free=True),
        added,
    )


def rmse_of_each(
    spec: Model,
    index: int,
    data: Dataset,
    candidate: CandidateEffect,
    tests: Sequence[TestData],
    locked: Sequence[TestData],
) -> list[tuple[tuple[str, str], float, float]]:
    """((campaign, test), error without, error with the candidate) of each locked test that both can predict; models
    fitted to all open tests, errors as scored."""
    spec = on_all_open(spec, tests, locked)
    ours, theirs = (
        fit_model(some, data, uncertainty=False).responses[index] for some in (spec, extended(spec, candidate))
    )
    rows = []
    for test in locked:
        if ours.can_predict(test) and theirs.can_predict(test):
            before, after = rmse(ours, [test]), rmse(theirs, [test])
            if before is not None and after is not None:
                rows.append((test.key, before, after))
    return rows


def rmse(fitted: FittedResponse, tests: Sequence[TestData], *, free: bool = False) -> float | None:
    """Free-run error over all samples that count, in the response's unit; None where there are none.

    free: with the best offset for each test, instead of the one from its first samples.
    """
    parts = [fitted.residual(t)[fitted.mask(t)] for t in tests]
    parts = [p - p.mean() if free and len(p) else p for p in parts]
    whole = np.concatenate(parts) if parts else np.empty(0)
    return float(np.sqrt(np.mean(whole**2))) if len(whole) else None
