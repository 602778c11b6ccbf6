"""The model's own effects with a function for heating and another for cooling ([horejs2010]).

A turning spindle moves the air that cools it, so that one function for both leaves an error that no channel explains.
What is asked is what stands in the effect's place once it is parted: heating keeps the one function (whose gains and
time constants move anyway, among what is known), elsewhere that is taken back, and cooling has a function of its own.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import cast

import numpy as np

from thermodata.diagnosis.candidates.candidate_effect import InTest
from thermodata.diagnosis.candidates.of_library import UNNAMED
from thermodata.diagnosis.question.known_effects import is_warm
from thermodata.diagnosis.question.present import TIME_UNITS
from thermodata.diagnosis.weigh.changed import TIMES, ChangedEffect, EffectOfModel, is_free
from thermodata.diagnosis.weigh.figures import short
from thermodata.diagnosis.weigh.scored import Scored
from thermodata.effect.places import holds
from thermodata.errors import UsageError, unknown_name
from thermodata.modelling.inputs.drivers import names_of
from thermodata.modelling.terms.acting import acting, moved_while
from thermodata.modelling.terms.fitted_response import FittedResponse, FittedTerm
from thermodata.modelling.versions.candidate import phase_ids, phases_id, with_phases
from thermodata.plugin import Effect, Gain, Param
from thermodata.schema.files.model import Model
from thermodata.view.grid.dataset import TestData

HEATING, COOLING = "heating", "cooling"
AIR = ("hall", "floor")  # what is there whether the machine works or not has no phases
LEAST_TESTS = 2  # with cooling: no other foretells what is in one only
TAKEN_BACK = "taken_back"


@dataclass(frozen=True, slots=True)
class ApartInCooling(EffectOfModel):
    """A fitted effect as what it would lose outside of heating, and what it would do in cooling."""

    @property
    def meaning(self) -> str:
        return f"{self.fitted.effect.meaning}, with a function of its own in cooling"

    @property
    def params(self) -> tuple[Param, ...]:
        """Of the function in cooling."""
        held = self.fitted.bound.spec.fixed
        return tuple(p for p in self.fitted.effect.params if p.upper > p.lower and p.name not in held)

    @property
    def gains(self) -> tuple[Gain, ...]:
        """The share that is taken back (-1: all of it), then those of the function in cooling."""
        back = Gain(TAKEN_BACK, "1", TIMES, "any", "of the one function, outside of heating")
        return (back, *self.fitted.effect.gains)


@dataclass(frozen=True, slots=True, kw_only=True)
class HeatingAndCoolingApart(ChangedEffect):
    """An effect of the model as two: one that acts in heating, and one in cooling."""

    @property
    def id(self) -> str:
        return phases_id(self.term.id, self.phases)

    @property
    def becomes(self) -> tuple[str, ...]:
        return phase_ids(self.term.id, self.phases)

    @property
    def phases(self) -> tuple[str, ...]:
        return HEATING, COOLING

    @property
    def protocol(self) -> str:
        return "a stop while warm, and a long cooling"

    def in_test(self, test: TestData) -> InTest:
        """Zero where nothing tells when the machine works."""
        bound, heating, cooling = self.term.bound, acting(test, [HEATING]), acting(test, [COOLING])
        if heating is None or cooling is None or not bound.covers(test) or not bound.has(test):
            return lambda p: np.zeros((len(test.t_s), len(self.effect.gains)))
        back = moved_while(self.term.contribution(test)[:, None], ~heating)
        return lambda p: np.hstack([back, moved_while(bound.columns(test, {**self.term.params, **p}), cooling)])

    def added_to(self, spec: Model) -> Model:
        return with_phases(spec, self.term.id, self.phases)

    def in_words(self, scored: Scored) -> str:
        """'spindle_bearing acts by another function in cooling than in heating (tau about 100 instead of 40 min)'."""
        found = scored.columns.points[scored.weighed.best[0]]
        said = [
            f"{p.name} about {short(found[p.name])} instead of {short(self.term.params[p.name])} {p.unit}"
            for p in self.effect.params
            if p.unit in TIME_UNITS
        ]
        times = f" ({', '.join(said)})" if said else ""
        return f"{self.term.id} acts by another function in cooling than in heating{times}"


def heating_and_cooling_apart(
    fitted: FittedResponse, tests: Sequence[TestData], every: Sequence[TestData]
) -> list[HeatingAndCoolingApart]:
    """Each effect that reads nothing but temperatures which the machine's work may raise, and acts alike in all phases.
    tests: those that are weighed. every: all of the data, in which a model with it must be able to tell the phases."""
    return [
        _candidate(term)
        for term in fitted.terms
        if is_free(term)
        and term.bound.spec.gain_by is None
        and term.bound.spec.phases is None
        and term.bound.spec.calibrate_on is None
        and all(_warms_with_work(term, t) and acting(t, [COOLING]) is not None for t in every if term.bound.covers(t))
        and sum(_cools(t) for t in tests if term.bound.covers(t)) >= LEAST_TESTS
    ]


def named_apart(fitted: FittedResponse, term: str, phases: Sequence[str]) -> HeatingAndCoolingApart:
    """The one that a user names, whatever its tests say. UsageError: no such effect, or other phases."""
    terms, where = {t.id: t for t in fitted.terms}, f"candidate '{phases_id(term, phases)}'"
    if term not in terms:
        raise unknown_name("effect", term, list(terms), where=where)
    if tuple(phases) != (HEATING, COOLING):
        raise UsageError(
            "only heating and cooling are asked apart",
            where=where,
            expected=f"{HEATING},{COOLING}",
            got=",".join(phases),
            hint=f"name them: {phases_id(term, (HEATING, COOLING))}; other phases stand in the model file",
        )
    return _candidate(terms[term])


def _candidate(term: FittedTerm) -> HeatingAndCoolingApart:
    effect = cast(Effect, ApartInCooling(term))
    return HeatingAndCoolingApart(effect, term.binding, term.family, log_prior=UNNAMED, kin="itself", term=term)


def _warms_with_work(term: FittedTerm, test: TestData) -> bool:
    """Whether all that it reads are temperatures, and none is that of the hall's air or floor."""
    names = [n for text in term.bound.binding_of(test).values() for n in names_of(text)]
    places = [test.channels[n].at for n in names if n in test.channels]
    air = any(holds(one, place) for one in AIR for place in places)
    return bool(names) and not air and all(is_warm(test, n) for n in names)


def _cools(test: TestData) -> bool:
    cooling = acting(test, [COOLING])
    return cooling is not None and bool(cooling.any())
