"""Diagnosis with a store: load the model and its tests, answer, keep the answer, count the looks at locked tests."""

from __future__ import annotations

from typing import TYPE_CHECKING

from thermodata.diagnosis.answer import answer
from thermodata.effect import effects
from thermodata.modelling.run import load
from thermodata.schema.result import Diagnosis
from thermodata.store.base.counting import watched

if TYPE_CHECKING:
    from thermodata.store import Store
    from thermodata.store.base.counting import Tell


def diagnose(store: Store, ref: str, tell: Tell | None = None) -> Diagnosis:
    """Which effect is missing in a model of the store (an id, a unique prefix or a name).

    tell: is told how many candidates are done, of how many; each against all its surrogates."""
    from thermodata.store.catalogue.models import count_locked_look, save_diagnosis

    model = load(store, ref)
    with watched(tell):
        outcome = answer(model.fitted, model.data, effects(), model.identity)
    if outcome.locked:
        claimed = next((c.id for c in outcome.diagnosis.candidates if c.claimed), "a claim that did not hold")
        count_locked_look(store, model.identity, [t.key for t in outcome.locked], f"confirming {claimed}")
    save_diagnosis(store, model.identity, outcome.diagnosis)
    return outcome.diagnosis
