"""A candidate of a diagnosis as a line of a model file: 'feed_screw:T_nut_Z' -> effect and drivers.

Two kinds change a line that is there: 'gain_by:spindle_bearing,conditions.tool' gives it a gain for each tool, and
'phases:spindle_bearing,heating,cooling' writes it once for each phase.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from thermodata.effect import effect as find_effect
from thermodata.effect import effects
from thermodata.effect.binding import Described, bindings, unnamed
from thermodata.effect.places import readable_place
from thermodata.errors import UsageError, unknown_channel, unknown_name
from thermodata.modelling.model_file.resolve import term_ids
from thermodata.schema.files.model import EffectSpec, Model
from thermodata.schema.units.quantity import PROBED

GAIN_BY = "gain_by:"
PHASES = "phases:"
_CHOSEN_NOW = {"in_sample": True, "in_sample_on": None}  # all open tests take part in the choice


def gain_by_id(term: str, by: str) -> str:
    """The id of a candidate that gives a term of the model a gain for each value of a condition."""
    return f"{GAIN_BY}{term},{by}"


def gain_by_of(candidate: str) -> tuple[str, str] | None:
    """(term, condition) of such an id; None for all others."""
    term, _, by = candidate.removeprefix(GAIN_BY).partition(",")
    return (term.strip(), by.strip()) if candidate.startswith(GAIN_BY) else None


def phases_id(term: str, phases: Sequence[str]) -> str:
    """The id of a candidate that writes an effect of the model once for each phase."""
    return f"{PHASES}{','.join([term, *phases])}"


def phases_of(candidate: str) -> tuple[str, tuple[str, ...]] | None:
    """(term, phases) of such an id; None for all others."""
    term, *phases = (word.strip() for word in candidate.removeprefix(PHASES).split(","))
    return (term, tuple(filter(None, phases))) if candidate.startswith(PHASES) else None


def phase_ids(term: str, phases: Sequence[str]) -> tuple[str, ...]:
    """The ids of what an effect becomes: 'spindle_bearing_heating', 'spindle_bearing_cooling'."""
    return tuple(f"{term}_{phase}" for phase in phases)


def changed(spec: Model, candidate: str) -> Model | None:
    """The model with one of its effects changed as an id says; None where the id names an effect more. UsageError as
    `with_gain_by` and `with_phases` have it."""
    by, apart = gain_by_of(candidate), phases_of(candidate)
    return with_gain_by(spec, *by) if by is not None else with_phases(spec, *apart) if apart is not None else None


def with_candidate(spec: Model, candidate: str, channels: Mapping[str, Described]) -> Model:
    """The model with what an id names. UsageError as `candidate_spec` and `changed` have it."""
    other = changed(spec, candidate)
    return with_effect(spec, candidate_spec(candidate, channels)) if other is None else other


def candidate_spec(candidate: str, channels: Mapping[str, Described]) -> EffectSpec:
    """Channels stand in the order of the effect's roles. UsageError where effect or channels are unknown or unfit."""
    name, _, rest = candidate.partition(":")
    effect = find_effect(name)
    given = [c.strip() for c in rest.split(",") if c.strip()]
    for channel in given:
        if channel not in channels:
            raise unknown_channel(channel, list(channels), where=f"candidate '{candidate}'")
    choices = bindings(effect, channels)
    fitting = [c for c in choices if list(c.values()) == given] if given else unnamed(effect, channels)
    if len(fitting) == 1:
        return EffectSpec(effect=name, drivers=dict(fitting[0]))
    if len(given) == len(effect.needs):  # a channel without a place, named on purpose
        return EffectSpec(effect=name, drivers={n.role: c for n, c in zip(effect.needs, given, strict=True)})
    if not choices:
        raise UsageError(
            f"candidate '{candidate}': no channel fits what '{name}' needs",
            expected="; ".join(
                f"{n.role}: {n.quantity} at {' or '.join(map(readable_place, n.places)) or 'any place'}"
                for n in effect.needs
            ),
            got="no such channel with data",
            hint="a channel of that quantity and place in the campaign file (thermodata channels lists those there are)"
            f", or name one: {name}:CHANNEL",
        )
    raise UsageError(
        f"candidate '{candidate}' fits {len(fitting) or 'no'} sets of channels",
        expected=", ".join(f"{name}:{','.join(c.values())}" for c in choices),
        hint="one of these",
    )


def note_of_response(drivers: Sequence[str], channels: Mapping[str, Described]) -> str | None:
    """Why what displacements or tilts drive is no cause; None where none does. diagnose never asks it."""
    found = [n for n in drivers if n in channels and channels[n].quantity in PROBED]
    if not found:
        return None
    are = "is itself a displacement or tilt" if len(found) == 1 else "are themselves displacements or tilts"
    return (
        f"{' and '.join(found)} {are}: a response is no cause, and falls with this one because the same heat moves "
        "both; diagnose never asks it"
    )


def with_effect(spec: Model, effect: EffectSpec) -> Model:
    """A new model: the same, and one effect more, with bounds as wide as it may reach. Verification tests take part in
    the choice, so they are fitted too and their scores say so."""
    return spec.model_copy(update={"effects": [*spec.effects, _reaching(effect)], **_CHOSEN_NOW})


def _reaching(effect: EffectSpec) -> EffectSpec:
    """A sensor within the very body leaves less to lag than the bounds of the effect know."""
    if effect.effect not in effects():
        return effect
    reach = {p.name: p.reach for p in find_effect(effect.effect).params if p.reach is not None}
    held = {*effect.fixed, *effect.bounds}
    bounds = {name: r for name, r in reach.items() if name not in held}
    return effect.model_copy(update={"bounds": {**effect.bounds, **bounds}}) if bounds else effect


def with_gain_by(spec: Model, term: str, by: str) -> Model:
    """A new model: the same, and one effect of it with a gain for each value of `by`, within each of those that it has
    one for already. UsageError where the model has no such effect, or the effect has a gain for each value of `by`."""
    old, where = _line(spec, term), f"model '{spec.name}', effect '{term}'"
    if not by:
        raise UsageError(
            "no condition to part the gain by",
            where=where,
            expected="conditions.NAME, machine or campaign",
            hint=f"name it: {gain_by_id(term, 'conditions.NAME')}",
        )
    if by.removeprefix("conditions.") in old.gains_by:
        raise UsageError(
            "the effect has a gain for each of them already",
            where=where,
            got=f"gain_by: {old.gain_by}",
            hint="add another candidate; 'thermodata show MODEL' shows what the model has",
        )
    more = [*old.gains_by, by] if old.gains_by else by
    effects = [e if e is not old else e.model_copy(update={"gain_by": more}) for e in spec.effects]
    return spec.model_copy(update={"effects": effects, **_CHOSEN_NOW})


def with_phases(spec: Model, term: str, phases: Sequence[str]) -> Model:
    """A new model: the same, and one effect of it once for each phase, with parameters of its own in each. UsageError
    where the model has no such effect, or it acts in some phases only already."""
    old, where = _line(spec, term), f"model '{spec.name}', effect '{term}'"
    if len(set(phases)) < 2:
        raise UsageError(
            "an effect is parted into two phases or more",
            where=where,
            expected=phases_id(term, ("heating", "cooling")),
            got=phases_id(term, phases),
            hint="name the phases as 'thermodata diagnose MODEL' does",
        )
    if old.phases is not None:
        raise UsageError(
            "the effect acts in some phases only already",
            where=where,
            got=f"phases: {old.phases}",
            hint="change 'phases' of the effect in the model file, and fit it again",
        )
    parted = [
        old.model_copy(update={"id": name, "phases": [phase]})
        for name, phase in zip(phase_ids(term, phases), phases, strict=True)
    ]
    effects = [one for e in spec.effects for one in (parted if e is old else [e])]
    return spec.model_copy(update={"effects": effects, **_CHOSEN_NOW})


def _line(spec: Model, term: str) -> EffectSpec:
    """The effect with an id; UsageError where the model has none."""
    ids = term_ids(spec.effects)
    if term not in ids:
        raise unknown_name("effect", term, ids, where=f"model '{spec.name}'")
    return spec.effects[ids.index(term)]
