"""A version that verification tests helped to choose, fitted to data that have more of them: these are new to it."""

from __future__ import annotations

from collections.abc import Collection
from typing import TYPE_CHECKING

from thermodata.modelling.inputs.roles import fitted_keys, resolve_roles
from thermodata.schema.files.model import Model
from thermodata.schema.words.sentences import listed
from thermodata.view.grid.dataset import Dataset

if TYPE_CHECKING:
    from thermodata.schema.answers.diagnosis import Diagnosis
    from thermodata.store.catalogue.models.fits import StoredModel


def as_chosen(stored: StoredModel, data: Dataset) -> Model:
    """A model of the store for a fit to the data as they are now: verification tests that came after the choice of its
    effects are checked on and not fitted."""
    spec = stored.spec
    if not spec.in_sample or stored.data_version == data.data_version:
        return spec
    then = {f"{s.campaign}/{s.test}": s.role for s in stored.result.scores}
    took_part = [name for name, role in then.items() if role != "verification"]
    if spec.in_sample_on is None and {*map("/".join, fitted_keys(spec, resolve_roles(spec, data)))} == {*took_part}:
        return spec
    # those that are gone may come back
    return spec.model_copy(update={"in_sample_on": list(dict.fromkeys([*(spec.in_sample_on or ()), *took_part]))})


def unasked(
    stored: StoredModel, diagnosis: Diagnosis | None, data: Dataset, scored: Collection[tuple[str, str]]
) -> list[str]:
    """A note that names the verification tests that came after a diagnosis of a model, and are fitted with what is
    chosen by it; none where it was asked of all of them."""
    if diagnosis is None or diagnosis.data_version == data.data_version:
        return []
    asked = {(one.campaign, one.test) for c in diagnosis.candidates for one in c.left_out}
    known = {*asked, *((s.campaign, s.test) for s in stored.result.scores)}
    new = ["/".join(key) for key in resolve_roles(stored.spec, data).verify if key in scored and key not in known]
    if not asked or not new:
        return []
    it, verify = ("they are", "verify") if len(new) > 1 else ("it is", "verifies")
    return [
        f"{listed(new)} came after the diagnosis that this is chosen by; {it} fitted all the same (in-sample), and "
        f"{verify} nothing of the choice: thermodata diagnose {stored.model} asks again, of all that there is now"
    ]


def came_since(spec: Model, data: Dataset) -> list[str]:
    """A note that names the verification tests that took no part in the choice; none where all did."""
    roles = resolve_roles(spec, data)
    fitted = fitted_keys(spec, roles)
    new = ["/".join(key) for key in roles.verify if key not in fitted] if spec.in_sample else []
    if not new:
        return []
    stay = "they stay verification tests" if len(new) > 1 else "it stays a verification test"
    return [f"{listed(new)} took no part in the choice of the effects: not fitted, {stay}"]
