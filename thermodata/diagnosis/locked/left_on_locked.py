"""What is known already of the locked tests of a model: their error, from when the claims that it came from were
confirmed. Nothing is opened for it.

What is claimed or likely opens the lock, and what a model with it leaves there is kept of claims alone. It says
nothing of which effect is missing; but where it is large, something is. Of other data, other tests or another fit it
says nothing at all.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from thermodata.diagnosis.claims.rules_together import HALVES
from thermodata.diagnosis.verdict.judged import Judgement
from thermodata.modelling.terms.rms import rms_about_means
from thermodata.modelling.versions.with_claims import is_fit_with_claims
from thermodata.schema.words.sentences import in_percent

if TYPE_CHECKING:
    from thermodata.modelling.run import Loaded
    from thermodata.modelling.terms.fitted_response import FittedResponse
    from thermodata.schema.answers.candidate import Candidate
    from thermodata.store import Store
    from thermodata.view.grid.dataset import TestData
from thermodata.schema.units.unit import difference_unit


def left_on_locked(store: Store, model: Loaded) -> dict[str, float]:
    """Response -> error on the locked tests [its unit], with the claims of the last version that was given any; empty
    where none was, where there was nothing to confirm them on, or where they were confirmed in another fit."""
    found = _claimed_before(store, model)
    return {} if found is None or (known := found[1].locked_rmse_um_after) is None else {found[0]: known}


def shape_left_on_locked(store: Store, model: Loaded) -> dict[str, float]:
    """The same with a free offset a test, as left-out tests have it, of those in which the claims act."""
    found = _claimed_before(store, model)
    return {} if found is None or (known := found[1].locked_shape_um_after) is None else {found[0]: known}


def _claimed_before(store: Store, model: Loaded) -> tuple[str, Candidate] | None:
    """(response, first claim) of the last version that was given any, where the model is the fit with them."""
    from thermodata.store.catalogue.models.findings import load_diagnosis
    from thermodata.store.catalogue.models.fits import model_chain

    for earlier in reversed(model_chain(store, model.identity)[:-1]):
        found = load_diagnosis(store, earlier.model)
        claims = [c for c in found.candidates if c.claimed] if found is not None else []
        if found is None or not claims:
            continue
        same = is_fit_with_claims(model.fitted.spec, model.data, earlier.spec, found)
        return (found.response, claims[0]) if same else None
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
    return rms_about_means([p for p in parts if len(p)] or [np.zeros(1)])
