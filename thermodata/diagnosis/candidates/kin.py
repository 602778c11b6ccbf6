"""How near a candidate is to what the model has already: kin refines what is there more often than it is missing."""

from __future__ import annotations

from collections.abc import Container, Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

from thermodata.diagnosis.question.present import GENERIC, Present
from thermodata.effect.places import holds
from thermodata.plugin import Effect
from thermodata.view.grid.dataset import ChannelInfo

# "same": another mode of an effect that the model has, or another reading of its channels. "heat": another effect of
# the same cause, by other channels, as the coolant's switch beside its temperature. "part": one of several
# temperatures that an effect of the model reads together, as the air beside its gradient. "near": an effect of a family
# that the model has, at its place. "related": one elsewhere. "itself": an effect of the model with other gains
# (`gain_by`)
Kin = Literal["same", "heat", "part", "near", "related", "itself"] | None
NEAREST_FIRST: tuple[Kin, ...] = ("itself", "same", "heat", "part", "near", "related", None)


@dataclass(frozen=True, slots=True)
class ModelOf:
    """own: its effects. acting: these, and what they stand for. families: of all of these."""

    own: tuple[Present, ...]
    acting: tuple[Present, ...]
    families: frozenset[str]

    @property
    def read(self) -> frozenset[str]:
        """The channels that the model reads."""
        return frozenset[str]().union(*(p.channels for p in self.own))

    def has_any(self, effects: Container[str], family: str) -> bool:
        """Whether one of the effects acts at all, in a family, by whatever channels."""
        return any(p.effect in effects and p.family == family for p in self.acting)

    def has_one_of(self, effects: Container[str], names: frozenset[str]) -> bool:
        """Whether one of the effects acts in all phases, by one of the channels."""
        return any(p.effect in effects and p.whole and p.channels & names for p in self.acting)


def kin_of(
    effect: Effect,
    family: str,
    names: frozenset[str],
    model: ModelOf,
    library: Mapping[str, Effect],
    channels: Mapping[str, ChannelInfo],
) -> Kin:
    """Of an effect by some channels. family: with the axis that these sit on. names: of the channels. channels: of the
    data, what each of them is."""
    near = names <= model.read or _sits_where_read(names, model.read, channels)
    if refines(effect) and (told_by(effect) is None or model.has_any(refines(effect), family)):
        return "same"
    # a temperature is the state of one body; a speed makes heat, and force
    warm = all(channels[n].quantity == "temperature" for n in names)
    if family == GENERIC and near:
        if warm and _one_of_several(names, [p.channels for p in model.own]):
            return "part"
        # a door that somebody opens is no mode of the air behind it
        switched = all(channels[n].quantity == "state" for n in names)
        return "near" if switched and not names <= model.read else "same"
    acting = [(library[p.effect], p) for p in model.acting if p.effect in library]
    of_it = [p for own, p in acting if hasattr(effect, "cause") and heat_of(own, p.family) == heat_of(effect, family)]
    if of_it:
        other = all(p.effect != effect.name and not names & p.channels for p in of_it)
        return "heat" if other else "same"
    if family not in model.families:
        return None
    if any(heat_of(own, p.family) == heat_of(effect, family) for own, p in acting):
        return "same"
    if names <= model.read and warm:
        return "part" if _one_of_several(names, [p.channels for p in model.own if p.family == family]) else "same"
    return "near" if near else "related"


def furthest(names: Sequence[Kin]) -> Kin:
    """Of a lag of channels that have names: it may be any of them, so it is as far from the model as the furthest."""
    return max(names, key=NEAREST_FIRST.index, default=None)


def _one_of_several(names: frozenset[str], read: Sequence[frozenset[str]]) -> bool:
    """Whether an effect of the model reads it together with others, and none reads it alone."""
    return names not in read and any(names < some for some in read)


def _sits_where_read(names: frozenset[str], read: frozenset[str], channels: Mapping[str, ChannelInfo]) -> bool:
    """Whether a channel sits where the model reads one already: at its place, around it, or within it."""
    mine, theirs = ({p for n in some if n in channels and (p := channels[n].at)} for some in (names, read))
    return any(holds(a, b) or holds(b, a) for a in mine for b in theirs)


def cause(effect: Effect) -> str:
    """The heat or motion that an effect stands for: bearing friction, whether by temperature or by speed."""
    found: str = getattr(effect, "cause", effect.name)
    return found


def heat_of(effect: Effect, family: str) -> tuple[str, str]:
    """The heat that an effect stands for, and the axis where each has its own."""
    return cause(effect), family if "{" in effect.family else ""


def refines(effect: Effect) -> tuple[str, ...]:
    """Effects that this one is a refinement of: it is asked for only where the model has one of them, or `told_by`
    says."""
    found: tuple[str, ...] = getattr(effect, "refines", ())
    return found


def told_by(effect: Effect) -> str | None:
    """The role whose moves tell it from what it refines; None where it isn't asked for alone."""
    found: str | None = getattr(effect, "told_by", None)
    return found
