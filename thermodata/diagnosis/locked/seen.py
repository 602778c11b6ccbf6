"""What of the locked tests was shown before: asked again, it is no look, whatever else changed meanwhile."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from math import isclose
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from thermodata.modelling.inputs.roles import Key
    from thermodata.modelling.run import Loaded
    from thermodata.modelling.terms.fitted_response import FittedResponse
    from thermodata.schema.answers.candidate import Candidate
    from thermodata.schema.answers.confirmed import TestConfirmed
    from thermodata.schema.answers.diagnosis import Diagnosis
    from thermodata.store import Store
    from thermodata.view.grid.dataset import TestData

ALIKE = 1e-6  # of an error: no output prints so many digits


def shown_again(before: Sequence[TestConfirmed], now: Sequence[TestConfirmed]) -> set[Key]:
    """The tests whose errors are those of the answer before, to what is printed of them."""
    known = {(t.campaign, t.test): t for t in before}
    return {
        key
        for key, t in (((t.campaign, t.test), t) for t in now)
        if (was := known.get(key)) is not None
        and t.n == was.n
        and _figures_agree(t.rmse_um_before, was.rmse_um_before)
        and _figures_agree(t.rmse_um_after, was.rmse_um_after)
    }


def told_again(before: Diagnosis | None, now: Diagnosis) -> set[str]:
    """The candidates of which a diagnosis tells the same of the locked tests as the one before did."""
    if before is None or before.response != now.response:
        return set()
    known = {c.id: _locked_figures(c) for c in before.candidates}
    return {
        c.id
        for c in now.candidates
        if (was := known.get(c.id)) is not None
        and any(value is not None for value in was)
        and all(_figures_agree(value, then) for value, then in zip(_locked_figures(c), was, strict=True))
    }


def not_seen(
    store: Store, model: Loaded, response: FittedResponse, name: str, locked: Sequence[TestData], shown: Collection[Key]
) -> list[Key]:
    """Those that a confirmation looks at anew: what a diagnosis opened for the same, on the same data, is no look, nor
    are errors that were shown."""
    from thermodata.store.catalogue.models.findings import load_diagnosis
    from thermodata.store.catalogue.models.fits import find_model
    from thermodata.store.catalogue.models.looks import looked_for

    claims, diagnosis = [*claimed(store, model.identity, response.name)], load_diagnosis(store, model.identity)
    now, seen = model.data.data_version, set(shown)
    told_now = diagnosis is not None and diagnosis.data_version == now and name in claims
    if told_now or find_model(store, model.identity).data_version == now:
        alone = claims == [name]  # the answer told its errors
        seen |= looked_for(store, model.identity, name, of_response(model, response.name), with_others=alone)
    return [t.key for t in locked if t.key not in seen]


def claimed(store: Store, model: str, response: str) -> dict[str, float | None]:
    """What the stored diagnosis claims for this response, with its probability."""
    from thermodata.store.catalogue.models.findings import load_diagnosis

    found = load_diagnosis(store, model)
    asked = found.candidates if found is not None and found.response == response else []
    return {c.id: c.probability for c in asked if c.claimed}


def of_response(model: Loaded, response: str) -> str:
    """Behind what the lock is opened for: of a model with several responses with whose errors it shows."""
    return "" if len(model.fitted.responses) == 1 else f" of {response}"


def _locked_figures(c: Candidate) -> tuple[float | None, ...]:
    return (
        c.locked_rmse_um_before,
        c.locked_rmse_um_after,
        c.locked_shape_um_before,
        c.locked_shape_um_after,
        c.locked_tests_asked,
    )


def _figures_agree(one: float | None, other: float | None) -> bool:
    if one is None or other is None:
        return one is other
    return isclose(one, other, rel_tol=ALIKE)
