"""Models of a store compared: their scores, each with another, and carried over to other tests and machines."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from thermodata.errors import UsageError
from thermodata.modelling.compare import elsewhere
from thermodata.modelling.compare.beside import ModelOnTest, models_on_tests
from thermodata.modelling.compare.differences import TestDifference, differences
from thermodata.modelling.compare.one_version import refuse_stale
from thermodata.modelling.compare.portability import Portability, portability
from thermodata.modelling.inputs.roles import find_tests, in_full
from thermodata.modelling.model_file.not_installed import as_stored, not_installed
from thermodata.modelling.run import Loaded, load
from thermodata.modelling.versions.result import make_result
from thermodata.schema.answers.result import FitResult
from thermodata.view.grid.dataset import Dataset

if TYPE_CHECKING:
    from thermodata.store import Store


def compare(store: Store, refs: Sequence[str]) -> list[FitResult]:
    """Each model's parameters, scores and checks; as its fit stored them where its data changed since, and where an
    effect of it is not installed, which a note says. Tests that are new to a model are scored too."""
    from thermodata.store.catalogue.models.fits import find_model

    results = []
    for ref in refs:
        stored = find_model(store, ref)
        if lacking := not_installed(stored.spec):
            note = as_stored(lacking, stored.name)
            results.append(stored.result.model_copy(update={"notes": [*stored.result.notes, note]}))
            continue
        if stored.stale:
            results.append(stored.result)
            continue
        model = load(store, ref, uncertainty=True)
        found = make_result(model.fitted, model.data, model.identity, parent=model.parent)
        results.append(found.model_copy(update={"parameters": stored.result.parameters}) if model.kept else found)
    return results


def differences_of(store: Store, refs: Sequence[str]) -> list[TestDifference]:
    """Each model's error less that of the first, test by test; none for one model, and none where the data of one
    changed since its fit."""
    from thermodata.store.catalogue.models.fits import find_model

    if len(refs) < 2 or any(find_model(store, ref).stale for ref in refs):
        return []
    loaded = [load(store, ref) for ref in refs]
    return differences([(m.identity, m.fitted, m.data) for m in loaded])


def compare_against(store: Store, refs: Sequence[str], reference: str, tests: Sequence[str] = ()) -> list[ModelOnTest]:
    """The models beside each other on every open test (or on those named), each against the reference. UsageError
    where one of them was fitted to another version of the data: their differences would be those of the data."""
    from thermodata.store.catalogue.models.fits import find_model

    found = {stored.model: stored for stored in (find_model(store, ref) for ref in (*refs, reference))}
    against = find_model(store, reference).model
    refuse_stale(store, found.values(), against)
    loaded = [load(store, identity) for identity in found]
    return models_on_tests([(m.identity, m.fitted, m.data) for m in loaded], against, tests)


def transfer(store: Store, ref: str, tests: Sequence[str] = (), campaigns: Sequence[str] = ()) -> list[Portability]:
    """How far the model carries over to each test and machine of its campaigns, which are kept as findings of the
    model; or to the tests or campaigns named, of the whole store. UsageError for a named test that is unknown, locked,
    or has nothing to carry over to."""
    from thermodata.store.catalogue.models.findings import save_findings

    model = load(store, ref)
    data, more = model.data, list[Portability]()
    others = elsewhere.asked_for(store, model.fitted.spec.campaign_ids, tests, campaigns)
    if others:
        there = elsewhere.data_of(store, others, data.step_s)
        more = elsewhere.portability_of(model.fitted, there)
        data = replace(data, tests=(*data.tests, *there.tests))
    within = [t for t in data.tests if not campaigns or t.campaign in campaigns]
    wanted = find_tests(tests, replace(data, tests=tuple(within)), "--test")
    rows = portability(model.fitted, model.data)
    told = {(r.campaign, r.test) for r in (*rows, *more)}
    _refuse_closed([key for key in wanted if key not in told], model, data)
    save_findings(store, model.identity, "portability", [(r.campaign, r.test, r.to_json()) for r in rows])
    here = [r for r in (*rows, *more) if not campaigns or r.campaign in campaigns]
    return [r for r in here if not tests or (r.campaign, r.test) in wanted]


def _refuse_closed(without: Sequence[tuple[str, str]], model: Loaded, data: Dataset) -> None:
    """UsageError for tests that were asked for and have no row."""
    if not without:
        return
    names = ", ".join(in_full(without))
    closed = {t.key for t in data.tests if t.campaign not in model.fitted.spec.campaign_ids and t.role == "locked"}
    if any(model.fitted.roles.role(key) == "locked" or key in closed for key in without):
        raise UsageError(
            f"locked: {names}; opened only to confirm an effect, and every look is counted",
            where="--test",
            expected="tests that are not locked in the model",
            got=names,
            hint=f"thermodata confirm {model.identity} EFFECT opens the locked tests for an effect of your choice",
        )
    raise UsageError(
        f"nothing to carry over to in {names}",
        where="--test",
        expected=f"a valid sample of {', '.join(r.name for r in model.fitted.responses)}, where the model predicts",
        got="none",
    )
