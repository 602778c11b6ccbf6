"""`confirm`: what the locked tests say of an effect that the user chose; every look is counted."""

from __future__ import annotations

from typing import TYPE_CHECKING

from thermodata.diagnosis.candidates.candidate_effect import CandidateEffect
from thermodata.diagnosis.candidates.failing import without_failing
from thermodata.diagnosis.clocks.ends_of_logs import ends_of_logs
from thermodata.diagnosis.locked.confirm import Fits, confirm
from thermodata.diagnosis.locked.confirmation import Confirmation
from thermodata.diagnosis.locked.copies import copies
from thermodata.diagnosis.locked.held import as_held, despite, held
from thermodata.diagnosis.locked.seen import claimed, not_seen, of_response, shown_again
from thermodata.diagnosis.locked.turned_locked import turned_locked
from thermodata.diagnosis.made_from import answer_key
from thermodata.diagnosis.question.present import present
from thermodata.diagnosis.question.responses import response_index
from thermodata.diagnosis.sound import sound, told
from thermodata.diagnosis.weigh.by_phase import named_apart
from thermodata.diagnosis.weigh.gain_by import named
from thermodata.effect import effect as find_effect
from thermodata.effect import effects
from thermodata.errors import UsageError
from thermodata.modelling.add import chosen_id
from thermodata.modelling.run import Loaded, load
from thermodata.modelling.terms.fitted_response import FittedResponse
from thermodata.modelling.versions.candidate import candidate_spec, changed, gain_by_of, note_of_response, phases_of
from thermodata.schema.answers.confirmed import Confirmed, TestConfirmed

if TYPE_CHECKING:
    from collections.abc import Sequence

    from thermodata.store import Store
    from thermodata.view.grid.dataset import Dataset, TestData


def confirm_choice(store: Store, ref: str, candidate: str | int, response: str | None = None) -> tuple[Confirmed, bool]:
    """(what the locked tests say of an effect that the user chose, whether that was known already).

    candidate: a rank of the stored diagnosis, an id, or any 'effect:channels'. response: by default that of the stored
    diagnosis. Opening the lock is counted, but for an answer that the store holds, for what a diagnosis of the same
    data opened it for, and for errors that were shown before. UsageError: no such candidate, a rank of another
    response's diagnosis, or no locked test that both models can predict.
    """
    from thermodata.store.catalogue.models.findings import keep_answer, kept_answer, load_diagnosis
    from thermodata.store.catalogue.models.looks import count_locked_look, locked_looks

    model = load(store, ref, anew=True)
    tests = model.fitted.tests(model.data)
    asked = load_diagnosis(store, model.identity) if response is None else None
    index = response_index(model.fitted, tests, asked.response if asked is not None else response)
    of = model.fitted.responses[index]
    chosen = _candidate_named(model, of, chosen_id(store, model.identity, candidate, response))
    name, key = chosen.id, answer_key(model)
    whose = of_response(model, of.name)
    question = f"confirm {name}{whose}"
    kept = kept_answer(store, model.identity, question, key)
    if kept is not None:
        return _as_of_now(store, model, as_held(Confirmed.model_validate_json(kept))), True
    usable = [t for t in tests if of.can_predict(t)]
    ends = ends_of_logs(store, model)
    asked_of, _ = without_failing(effects(), lambda some: sound(model.fitted, index, model.data, usable, some, ends))
    locked = _locked_tests(model, of, asked_of.data, tests)
    base = asked_of.fitted if usable else None
    confirmation = confirm(model.fitted.spec, index, asked_of.data, [chosen], asked_of.tests, locked, base, of)
    before = kept_answer(store, model.identity, question)
    told_then = [] if before is None else Confirmed.model_validate_json(before).tests
    new = not_seen(store, model, of, name, locked, shown_again(told_then, _each_test(confirmation)))
    count_locked_look(store, model.identity, new, f"confirming {name}{whose}, by choice")
    put_right = asked_of.put_right
    if confirmation.where_it_acts is not None and not confirmation.where_it_acts.holds:
        fits = Fits(model.fitted.spec, index, asked_of.data, asked_of.tests, locked, asked_of.fitted)
        if wrong := turned_locked(fits.of([chosen]), locked, 0.0):
            upright = [t for t in locked if t.key not in wrong]
            put_right = put_right.model_copy(update={"left_out": [*put_right.left_out, *sorted(wrong)]})
            confirmation = confirm(model.fitted.spec, index, asked_of.data, [chosen], asked_of.tests, upright, base, of)
    shape = confirmation.where_it_acts
    found = Confirmed(
        model=model.identity,
        response=of.name,
        candidate=name,
        holds=None,
        locked_rmse_um_fitted=confirmation.stands,
        locked_rmse_um_before=confirmation.before,
        locked_rmse_um_after=confirmation.after,
        locked_shape_um_before=None if shape is None else shape.before,
        locked_shape_um_after=None if shape is None else shape.after,
        parameters=confirmation.parameters[name],
        tests=_each_test(confirmation),
        most_um=confirmation.most,
        looks=max(locked_looks(store, t.campaign, t.test) for t in locked),
        probability=claimed(store, model.identity, of.name).get(name),
        put_right=told(put_right),
        note=note_of_response(chosen.channels, model.data.channels),
    )
    result = despite(held(found, None if shape is None else shape.holds))
    keep_answer(store, model.identity, question, key, result.model_dump_json())
    return result, False


def _as_of_now(store: Store, model: Loaded, known: Confirmed) -> Confirmed:
    """An answer that the store holds, with what may be known otherwise since."""
    from thermodata.store.catalogue.models.looks import locked_looks

    now = {
        "probability": claimed(store, model.identity, known.response).get(known.candidate),
        "looks": max([known.looks, *(locked_looks(store, t.campaign, t.test) for t in known.tests)]),
    }
    return despite(known.model_copy(update=now))


def _locked_tests(model: Loaded, response: FittedResponse, data: Dataset, open_: Sequence[TestData]) -> list[TestData]:
    """The locked tests that can confirm. UsageError where there is none. data: with the logs put right."""
    closed = model.fitted.tests(data, "locked")
    again = {one.key for one, _ in copies(closed, open_, response.name)}
    locked = [t for t in closed if response.can_predict(t) and t.key not in again]
    if not locked:
        there = [f"{t.test}: {response.why_not(t) or 'a copy of an open test'}" for t in closed]
        raise UsageError(
            "no locked test to confirm on",
            expected="a test with role: locked, in which the model's channels were logged, and no copy of an open one",
            got="; ".join(there) or "none: every test of the model is open",
            hint="thermodata quality tells what was flagged in them" if there else _lock_one(model),
        )
    return locked


def _each_test(confirmation: Confirmation) -> list[TestConfirmed]:
    samples = {s.key: s.rows for s in confirmation.shapes}
    return [
        TestConfirmed(
            campaign=key[0],
            test=key[1],
            rmse_um_before=before,
            rmse_um_after=after,
            acts=key in confirmation.acts,
            n=samples[key],
            does_um=confirmation.does.get(key),
            rmse_um_fitted=confirmation.stands_each.get(key),
        )
        for key, before, after in confirmation.each
    ]


def _lock_one(model: Loaded) -> str:
    """How a test becomes one that can confirm: one that was fitted or looked at says nothing new."""
    campaign = " and ".join(f"'{name}'" for name in model.fitted.spec.campaign_ids)
    return (
        f"record one more test, or take one that no model was fitted to, and write role: locked at it in the file of "
        f"{campaign}; then thermodata ingest that file, thermodata fit {model.identity}, and confirm with the id that "
        "it prints"
    )


def _refuse_again(model: Loaded, response: FittedResponse, effect: str, channels: set[str]) -> None:
    """UsageError for what the response has already: a second copy says nothing of the first."""
    own = next((p for p in present(response) if p.effect == effect and p.channels == channels), None)
    if own is not None:
        raise UsageError(
            f"the model has {effect} ({', '.join(sorted(channels))}) already",
            where=f"model '{model.fitted.spec.name}' {model.identity[:8]}",
            expected="an effect that it lacks",
            got=effect,
            hint="ask it of the model before that was added: thermodata history MODEL names its versions",
        )


def _candidate_named(model: Loaded, response: FittedResponse, name: str) -> CandidateEffect:
    changed(model.fitted.spec, name)  # refuses what `add` would refuse
    if (by := gain_by_of(name)) is not None:
        return named(response, *by, model.data.tests)
    if (apart := phases_of(name)) is not None:
        return named_apart(response, *apart)
    spec = candidate_spec(name, model.data.channels)
    _refuse_again(model, response, spec.effect, {str(c) for c in spec.drivers.values()})
    return CandidateEffect(find_effect(spec.effect), {r: str(c) for r, c in spec.drivers.items()}, family="")
