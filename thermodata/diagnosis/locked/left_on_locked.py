"""What is known already of the locked tests of a model: their error, from when the claims that it came from were
confirmed. Nothing is opened for it.

What is claimed or likely opens the lock, and what a model with it leaves there is kept of claims alone. It says
nothing of which effect is missing; but where it is large, something is.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from thermodata.diagnosis.claims.rules import HALVES
from thermodata.diagnosis.question.known import rms
from thermodata.diagnosis.verdict.judge import Judgement
from thermodata.errors import UsageError
from thermodata.modelling.versions.candidate import with_candidate
from thermodata.schema.counted import in_percent

if TYPE_CHECKING:
    from thermodata.modelling.run import Loaded
    from thermodata.modelling.terms.fitted_response import FittedResponse
    from thermodata.schema.candidate import Candidate
    from thermodata.schema.model import EffectSpec, Model
    from thermodata.store import Store
    from thermodata.view.dataset import TestData
from thermodata.schema.quantity import difference_unit


def left_on_locked(store: Store, model: Loaded) -> dict[str, float]:
    """Response -> error on the locked tests [its unit], with the claims of the last version that was given any; empty
    where none was, where there was nothing to confirm them on, or where the model has not all of them."""
    found = _claimed_before(store, model)
    return {} if found is None or (known := found[1].locked_rmse_um_after) is None else {found[0]: known}


def shape_left_on_locked(store: Store, model: Loaded) -> dict[str, float]:
    """The same with a free offset a test, as left-out tests have it, of those in which the claims act."""
    found = _claimed_before(store, model)
    return {} if found is None or (known := found[1].locked_shape_um_after) is None else {found[0]: known}


def _claimed_before(store: Store, model: Loaded) -> tuple[str, Candidate] | None:
    """(response, first claim) of the last version that was given any, where the model has all of them."""
    from thermodata.store.catalogue.models import load_diagnosis, model_chain

    for earlier in reversed(model_chain(store, model.identity)[:-1]):
        found = load_diagnosis(store, earlier.model)
        claims = [c for c in found.candidates if c.claimed] if found is not None else []
        if found is None or not claims:
            continue
        return (found.response, claims[0]) if _has(model, earlier.spec, claims) else None
    return None


def contradicted(
    judgement: Judgement, left: float | None, response: FittedResponse, locked: Sequence[TestData]
) -> Judgement:
    """The judgement, but for one that finds nothing missing where less than half of what the locked tests do is
    foretold. left: their error, None where it is not known."""
    if judgement.verdict not in ("none", "refine") or left is None:
        return judgement
    spread = _spread(response, locked)
    if left <= HALVES * spread:
        return judgement
    unit = difference_unit(response.unit)
    reason = (
        f"the locked tests, opened when its last effect was claimed, were left with {left:.2g} {unit} of "
        f"{spread:.2g} {unit} (limit {in_percent(HALVES)}), though the open ones show nothing more"
    )
    return Judgement("unknown", (), judgement.refinements, judgement.judged, reason)


def _spread(response: FittedResponse, tests: Sequence[TestData]) -> float:
    """RMS of the response about its mean in each test."""
    parts = [response.measured(t)[response.mask(t)] for t in tests]
    return rms([p - p.mean() for p in parts if len(p)] or [np.zeros(1)])


def _has(model: Loaded, spec: Model, claims: list[Candidate]) -> bool:
    try:
        for claim in claims:
            spec = with_candidate(spec, claim.id, model.data.channels)
    except UsageError:  # of effects or channels that are gone since
        return False
    own = [_bare(e) for e in model.fitted.spec.effects]
    return all(_bare(e) in own for e in spec.effects)


def _bare(effect: EffectSpec) -> EffectSpec:
    """Ids differ by the order in which effects were added."""
    return effect.model_copy(update={"id": None})
