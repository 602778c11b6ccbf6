"""The last question to a claim: does it hold on the locked tests, which took no part in the choice?"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from thermodata.diagnosis.candidates import CandidateEffect
from thermodata.modelling.fit import fit_model
from thermodata.modelling.fitted import FittedResponse
from thermodata.schema.model import EffectSpec, Model
from thermodata.schema.result import Parameter
from thermodata.view.dataset import Dataset, TestData

# the locked error must fall at least by this share, or the claim is withdrawn
MUST_FALL = 0.02


@dataclass(frozen=True, slots=True)
class Confirmation:
    """Errors on the locked tests, None where there are none; parameters of the added effect."""

    before: float | None
    after: float | None
    parameters: dict[str, Parameter]

    @property
    def holds(self) -> bool:
        return self.before is None or self.after is None or self.after < (1 - MUST_FALL) * self.before


def extended(spec: Model, candidate: CandidateEffect) -> Model:
    """The model with the candidate as one more effect."""
    added = EffectSpec(effect=candidate.effect.name, drivers=dict(candidate.binding))
    return spec.model_copy(update={"effects": [*spec.effects, added]})


def on_all_open(spec: Model, tests: Sequence[TestData], locked: Sequence[TestData]) -> Model:
    """The model calibrated on every test that took part in the choice; the locked ones stay locked."""
    def names(some: Sequence[TestData]) -> list[str]:
        return [f"{t.campaign}/{t.test}" for t in some]

    return spec.model_copy(update={"calibrate_on": names(tests), "verify_on": [], "locked": names(locked)})


def confirm(spec: Model, index: int, data: Dataset, candidate: CandidateEffect, tests: Sequence[TestData],
            locked: Sequence[TestData]) -> Confirmation:
    """Fit without and with the candidate on all open tests, and score both on the locked ones.

    index: of the response among the model's responses.
    """
    spec = on_all_open(spec, tests, locked)
    base, more = fit_model(spec, data, uncertainty=False), fit_model(extended(spec, candidate), data)
    ours, theirs = base.responses[index], more.responses[index]
    usable = [t for t in locked if ours.can_predict(t) and theirs.can_predict(t)]
    known = set(base.parameters())
    found = {name: p for name, p in more.parameters().items() if name not in known}
    return Confirmation(rmse(ours, usable), rmse(theirs, usable), found)


def rmse(fitted: FittedResponse, tests: Sequence[TestData]) -> float | None:
    """Free-run error over all samples that count, in the response's unit; None where there are none."""
    parts = [fitted.residual(t)[fitted.mask(t)] for t in tests]
    whole = np.concatenate(parts) if parts else np.empty(0)
    return float(np.sqrt(np.mean(whole**2))) if len(whole) else None
