"""Diagnosis with a store: load the model and its tests, answer, keep the answer, count the looks at locked tests.

The same question to the same data comes from the store: nothing is computed, and no lock is opened again.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from thermodata.diagnosis.answer import answer
from thermodata.diagnosis.candidates.by_name import only_by_name
from thermodata.diagnosis.clocks.ends_of_logs import ends_of_logs
from thermodata.diagnosis.locked.left_on_locked import left_on_locked, shape_left_on_locked
from thermodata.diagnosis.locked.seen import of_response, told_again
from thermodata.diagnosis.made_from import answer_key
from thermodata.diagnosis.question.present import present
from thermodata.diagnosis.tell.of_version.as_stored import by_its_own_parameters
from thermodata.diagnosis.tell.of_version.undetermined import undetermined
from thermodata.effect import effects
from thermodata.effect.registry import all_effects
from thermodata.modelling.run import Loaded, load
from thermodata.modelling.seen.doubtful_clocks import doubtful_clocks
from thermodata.modelling.versions.made_without import still_without
from thermodata.schema.answers.diagnosis import Diagnosis
from thermodata.store.base.counting import watched

if TYPE_CHECKING:
    from collections.abc import Mapping

    from thermodata.schema.answers.result import Parameter
    from thermodata.store import Store
    from thermodata.store.base.counting import Tell


@dataclass(frozen=True, slots=True)
class Question:
    """Which effect a model of the store misses. response: of which of its responses, None for that of which most is
    left. left: the error on locked tests that an earlier claim left, by response."""

    store: Store
    model: Loaded
    response: str | None
    left: dict[str, float]

    @property
    def _name(self) -> str:
        return "diagnose" if self.response is None else f"diagnose {self.response}"

    def kept(self) -> Diagnosis | None:
        """The answer that the store holds; None where model, data, effects or rules have changed since. What was asked
        for last is the model's diagnosis, whose ranks `add` takes."""
        from thermodata.store.catalogue.models.findings import kept_answer, load_diagnosis, save_diagnosis

        text = kept_answer(self.store, self.model.identity, self._name, answer_key(self.model, self.left))
        found = None if text is None else Diagnosis.model_validate_json(text)
        latest = load_diagnosis(self.store, self.model.identity) if found is not None else None
        if found is not None and latest is not None and latest.response != found.response:
            save_diagnosis(self.store, self.model.identity, found)
        return found

    def answered(self, tell: Tell | None = None) -> Diagnosis:
        """The answer made anew, and kept; looks at locked tests are counted. tell: is told how many candidates are
        done, of how many."""
        from thermodata.store.catalogue.models.findings import keep_answer, kept_answer, save_diagnosis
        from thermodata.store.catalogue.models.fits import find_model, model_chain
        from thermodata.store.catalogue.models.looks import count_locked_look

        store, model = self.store, self.model
        with watched(tell):
            ends = ends_of_logs(store, model)
            outcome = answer(
                model.fitted,
                model.data,
                effects(),
                model.identity,
                left_on_locked=self.left,
                ends=ends,
                name=self.response,
            )
        shape = shape_left_on_locked(store, model).get(outcome.diagnosis.response)
        open_tests = [t.test for t in model.fitted.tests(model.data)]
        without = still_without([one.result.notes for one in model_chain(store, model.identity)], open_tests)
        asked_on = {"locked_shape_um": shape, "data_version": model.data.data_version, "made_without": without}
        found = _with_doubtful(_with_unasked(outcome.diagnosis.model_copy(update=asked_on), model), model)
        stored = find_model(store, model.identity)
        found = _with_undetermined(found, model, stored.result.parameters)
        if stored.data_version != model.data.data_version and not stored.stale:
            found = by_its_own_parameters(found, load(store, model.identity))
        before = kept_answer(store, model.identity, self._name)
        same = told_again(None if before is None else Diagnosis.model_validate_json(before), found)
        for look in outcome.looks:
            reason = f"confirming {', '.join(look.asked)}{of_response(model, found.response)}"
            count_locked_look(store, model.identity, [t.key for t in look.tests], reason, once={*look.asked} <= same)
        save_diagnosis(store, model.identity, found)
        if not found.not_asked:  # a plugin that was mended is asked, though nothing else has changed
            key = answer_key(model, self.left)
            keep_answer(store, model.identity, self._name, key, found.model_dump_json())
        return found


def question(store: Store, ref: str, response: str | None = None) -> Question:
    """Of a model (an id, a unique prefix or a name), fitted to its data as they are now."""
    model = load(store, ref, anew=True)
    return Question(store, model, response, left_on_locked(store, model))


def diagnose(store: Store, ref: str, tell: Tell | None = None, response: str | None = None) -> Diagnosis:
    """Which effect is missing in a model of the store: the answer that it holds to this question, or made anew."""
    asked = question(store, ref, response)
    return asked.kept() or asked.answered(tell)


def _with_doubtful(found: Diagnosis, model: Loaded) -> Diagnosis:
    """With the clocks that what is named hangs on, where nobody could align them and the answer moved none."""
    drivers = {name for c in found.candidates if c.claimed or c.refinement for name in c.drivers}
    moved = {c.source for c in found.put_right.clocks} if found.put_right is not None else set()
    doubtful = doubtful_clocks(model.fitted, model.data, drivers)
    return found.model_copy(update={"doubtful_clocks": [d.sentence for d in doubtful if d.source not in moved]})


def _with_unasked(found: Diagnosis, model: Loaded) -> Diagnosis:
    """Where something is left that may not be named: with what the user may ask for."""
    if found.unknown is None:
        return found
    asked, tests = effects(), model.fitted.tests(model.data)
    others = [one for name, one in all_effects().items() if name not in asked]
    of = next(r for r in model.fitted.responses if r.name == found.response)
    names = only_by_name(others, model.data.channels, tests, of.name, present(of))
    return found.model_copy(update={"unknown": found.unknown.model_copy(update={"by_name": names})})


def _with_undetermined(found: Diagnosis, model: Loaded, known: Mapping[str, Parameter]) -> Diagnosis:
    """With the effects of the model whose gain its fit does not determine. known: parameters of the fit. What is
    missing may be what blurs them: where it is named, nobody asks what the model leaves without them."""
    of = next(r for r in model.fitted.responses if r.name == found.response)
    weighed = found.verdict != "effect"
    return found.model_copy(update={"undetermined": undetermined(model.fitted, of, model.data, known, weighed)})
