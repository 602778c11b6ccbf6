"""What a model has, by what it does: its effects, those inside of other models, and what plain functions stand for.

A lag or a transfer function of the spindle bearing's temperature acts as the effect `spindle_bearing` does, whatever it
is called in the model file. So it has the family and the cause of that effect, and its refinements.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from thermodata.effect.binding import bindings, family_of
from thermodata.modelling.inputs.drivers import names_of
from thermodata.modelling.model_file.nested import ModelOutput
from thermodata.modelling.model_file.transfer.as_effect import GivenFunction
from thermodata.modelling.terms.fitted_response import FittedResponse, FittedTerm
from thermodata.plugin import Effect
from thermodata.schema.units.quantity import SECONDS_PER_UNIT
from thermodata.view.grid.dataset import ChannelInfo

GENERIC = "generic"
CONTROL = "control"  # its static compensation is a difference of any two temperatures
TIME_UNITS = tuple(SECONDS_PER_UNIT)
ALL_MODES = 99  # of a function that is printed: nobody asks for a further one


@dataclass(frozen=True, slots=True)
class Present:
    """An effect of the model. family: with the axis that its channels sit on. modes: how many time constants it has.
    whole: whether it acts in all phases of a test."""

    effect: str
    channels: frozenset[str]
    family: str = ""
    modes: int = 1
    whole: bool = True


def present(fitted: FittedResponse) -> list[Present]:
    """Of each effect of a fitted response, and of the models inside of it."""
    return [_present(term) for term in _terms_of_every_model(fitted)]


def modes(effect: Effect) -> int:
    """How many time constants an effect has."""
    return ALL_MODES if isinstance(effect, GivenFunction) else sum(p.unit in TIME_UNITS for p in effect.params)


def stands_for(one: Present, library: Mapping[str, Effect], channels: Mapping[str, ChannelInfo]) -> list[Present]:
    """The effects of the library that a plain function acts as: those that some of its channels fit."""
    if not is_plain(one.effect, library):
        return []
    own = {n: channels[n] for n in sorted(one.channels) if n in channels}
    found = []
    for effect in library.values():
        if effect.family in (GENERIC, CONTROL) or not effect.needs:
            continue
        for binding in bindings(effect, own):
            family, read = family_of(effect, binding, own), frozenset(binding.values())
            found.append(Present(effect.name, read, family, one.modes, one.whole))
    return found


def is_plain(effect: str, library: Mapping[str, Effect]) -> bool:
    """Whether a name says nothing of the physics: a lag, a gain, a transfer function."""
    return library.get(effect) is None or library[effect].family == GENERIC


def _terms_of_every_model(fitted: FittedResponse) -> Iterator[FittedTerm]:
    for term in fitted.terms:
        if isinstance(term.effect, ModelOutput):
            yield from _terms_of_every_model(term.effect.response)
        else:
            yield term


def _present(term: FittedTerm) -> Present:
    read = frozenset(n for text in term.binding.values() for n in names_of(text))
    return Present(term.effect.name, read, term.family, modes(term.effect), term.bound.spec.phases is None)
