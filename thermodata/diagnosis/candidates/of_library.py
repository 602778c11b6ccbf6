"""The candidates: every effect of the library, bound to every set of channels that fits what it needs."""

from __future__ import annotations

from collections.abc import Container, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

from thermodata.diagnosis.candidates.candidate_effect import CandidateEffect
from thermodata.diagnosis.candidates.feedback import is_kept_from_the_tool, kept_parts
from thermodata.diagnosis.candidates.kin import Kin, ModelOf, furthest, kin_of, refines, told_by
from thermodata.diagnosis.candidates.seen import NOTHING, Seen
from thermodata.diagnosis.candidates.unread import (
    MachinePart,
    is_holder,
    is_lesser,
    is_motion,
    part_of,
    parts_of,
    unread,
)
from thermodata.diagnosis.candidates.warm_at_rest import is_at_table, turns
from thermodata.diagnosis.question.present import (
    CONTROL,
    GENERIC,
    Present,
    is_plain,
    modes,
    stands_for,
)
from thermodata.effect.binding import bindings, family_of
from thermodata.effect.places import holds
from thermodata.plugin import Effect
from thermodata.schema.units.quantity import NOT_DRIVERS
from thermodata.schema.words.places import is_around, is_beside, is_casting, is_scale, makes_heat
from thermodata.view.grid.dataset import ChannelInfo

STATIC = "static"
ARTEFACT = "artefact"  # a family: what the logs have, and no machine does
# parts of a body that make heat
HEATED_PARTS = ("bearing", "motor")
# a plain lag of a channel that a named effect explains as well says less: a twentieth of its prior probability
UNNAMED = -3.0


def candidates(
    library: Mapping[str, Effect],
    channels: Mapping[str, ChannelInfo],
    present: Iterable[Present],
    response: str,
    seen: Seen = NOTHING,
) -> list[CandidateEffect]:
    """What could be missing. present: what the model has. Every channel is asked as a plain lag too, whatever named
    effects it drives: a name must earn its place. Artefacts are looked for within tests, not here."""
    own = tuple(present)
    plain = tuple(p for p in own if is_plain(p.effect, library))
    # a plain function is no other effect than what it stands for
    acting = (*own, *(other for p in plain for other in stands_for(p, library, channels)))
    usable = that_may_drive(channels, response)
    placed = any(c.at is not None for c in usable.values() if c.quantity == "temperature")
    known = {part for p in acting if p.effect in library for part in parts_of(library[p.effect], p.channels, channels)}
    # a temperature that is modelled reads its own part
    if response in channels and channels[response].quantity == "temperature":
        known |= {part for part in [part_of(channels[response].at)] if part}
    known |= kept_parts(library.values(), usable.values(), seen.feedback)
    model = ModelOf(own, acting, frozenset(p.family for p in acting) - {GENERIC})
    beside = _Beside(library, usable, model, plain, frozenset(known), placed, seen)
    # a static gain is a lag whose time constant is zero, and the grid of a lag begins there
    asked = [e for e in library.values() if not (e.family == ARTEFACT or not e.needs or e.name == STATIC)]
    found = [beside.candidate(e, binding) for e in asked for binding in bindings(e, usable)]
    return _told_by_names([one for one in found if one is not None])


def that_may_drive(channels: Mapping[str, ChannelInfo], response: str) -> dict[str, ChannelInfo]:
    """The channels that may drive an effect of a response. A sensor that failed goes with anything that happened when
    it did; one that failed in a test or two of many drives nothing there (`CandidateEffect.in_test`)."""
    return {
        n: c
        for n, c in channels.items()
        if n != response and c.quantity not in NOT_DRIVERS and c.faulty is None and not c.is_mask
    }


@dataclass(frozen=True, slots=True)
class _Beside:
    """What each effect is held against. usable: channels that may drive one. model: what is there already; plain: the
    functions without a name in it; known: the parts that it has. placed: whether any temperature has a place."""

    library: Mapping[str, Effect]
    usable: Mapping[str, ChannelInfo]
    model: ModelOf
    plain: tuple[Present, ...]
    known: frozenset[MachinePart]
    placed: bool
    seen: Seen

    def candidate(self, effect: Effect, binding: Mapping[str, str]) -> CandidateEffect | None:
        """An effect by some channels; None where it is not asked: the model has it, it refines nothing, it would have
        to rub where nothing does, or it does not reach the tool."""
        usable, placed = self.usable, self.placed
        names, family = frozenset(binding.values()), family_of(effect, binding, usable)
        if self._is_there(effect, names) or self._refines_nothing(effect, binding, family):
            return None
        if is_kept_from_the_tool(effect, [usable[n] for n in names], self.seen.feedback):
            return None
        nameless, bodies = family in (GENERIC, CONTROL), [n for n in names if _is_body(n, usable, self.seen.at_rest)]
        if not nameless and len(bodies) == len(names):
            return None
        # where an axis stands tells no part of it from another
        other = unread(effect, [n for role, n in binding.items() if role != told_by(effect)], usable, self.known)
        return CandidateEffect(
            effect,
            binding,
            family,
            placeless=family == GENERIC and not placed,
            passive=placed and nameless and (bool(bodies) or any(_is_warmed_from_elsewhere(usable[n]) for n in names)),
            kin=kin_of(effect, family, names, self.model, self.library, usable),
            unread=other,
            around=len(names) == 1 and all(_is_around(usable[n]) for n in names),
            of_motion=all(is_motion(usable[n].quantity) for n in names),
            of_holder=all(is_holder(usable[n]) for n in names),
            of_source=all(_is_source(usable[n]) for n in names),
            lesser=is_lesser(effect, names, usable, other),
        )

    def _is_there(self, effect: Effect, names: frozenset[str]) -> bool:
        """Whether the model has it, or a plain function of the same channels that can do as much."""
        same = any(p.effect == effect.name and p.channels == names for p in self.model.own)
        return same or any(p.channels == names and p.modes >= modes(effect) for p in self.plain)

    def _refines_nothing(self, effect: Effect, binding: Mapping[str, str], family: str) -> bool:
        """Whether it is a refinement of what the model does not have, and its own moves do not tell it either."""
        if not refines(effect):
            return False
        # beside what it refines, by another channel, it is no cause either
        alone = binding.get(told_by(effect) or "") in self.seen.telling and not self.model.has_any(
            refines(effect), family
        )
        return not (alone or self.model.has_one_of(refines(effect), frozenset(binding.values())))


def _told_by_names(found: Sequence[CandidateEffect]) -> list[CandidateEffect]:
    """The same, each plain function with what the effects with a name on its channels say of it."""
    kins: dict[tuple[str, ...], list[Kin]] = {}
    unmodelled: dict[tuple[str, ...], tuple[str, ...]] = {}
    for c in found:
        if c.family in (GENERIC, CONTROL):
            continue
        kins.setdefault(c.channels, []).append(c.kin)
        if c.kin is None:
            unmodelled[c.channels] = (*unmodelled.get(c.channels, ()), c.id)
    return [
        replace(
            c,
            log_prior=UNNAMED,
            kin=c.kin or furthest(kins.get(c.channels, ())),
            unmodelled=unmodelled.get(c.channels, ()),
        )
        if _says_little(c, kins)
        else c
        for c in found
    ]


def _is_warmed_from_elsewhere(channel: ChannelInfo) -> bool:
    """Whether it is warm for what is warm elsewhere, for all that is known of its place."""
    follows = channel.at is None or is_casting(channel.at) or is_beside(channel.at) or is_scale(channel.at)
    return channel.quantity == "temperature" and follows


def _is_body(name: str, channels: Mapping[str, ChannelInfo], at_rest: Container[str]) -> bool:
    """Whether it reads the temperature of a body, as a table's, of which a part that makes heat has a sensor of its
    own, or a table that nothing turns, or turns in vain: what such a body does beyond that comes from elsewhere, as
    from the coolant that washes it."""
    own = channels[name]
    if own.quantity != "temperature" or own.at is None:
        return False
    if is_at_table(own) and (name in at_rest or not any(turns(c) for c in channels.values())):
        return True
    heated = (f"{own.at}.{part}" for part in HEATED_PARTS)
    return any(c.quantity == "temperature" and holds(h, c.at) for h in heated for c in channels.values() if c.at)


def _is_source(channel: ChannelInfo) -> bool:
    return channel.quantity == "temperature" and makes_heat(channel.at)


def _is_around(channel: ChannelInfo) -> bool:
    return channel.quantity == "temperature" and is_around(channel.at)


def _says_little(candidate: CandidateEffect, named: Container[tuple[str, ...]]) -> bool:
    """Whether its name says no more than which channels it reads."""
    return candidate.family == CONTROL or (candidate.family == GENERIC and candidate.channels in named)
