"""What a candidate can't be told from, in the words of a verdict."""

from __future__ import annotations

from typing import TYPE_CHECKING

from thermodata.schema.words.sentences import listed

if TYPE_CHECKING:
    from thermodata.schema.answers.candidate import Candidate

_UNNAMED = ("lag", "control_compensation")  # which say no more than the channels that they read
_CHANGES = ("gain_by", "phases")  # of an effect that the model has: no effect of its own
_MOST = 2


def by_name(one: Candidate) -> str:
    """', which may be coolant': the first effect with a name that a lag of the same channels can't be told from."""
    twins = (twin.partition(":") for twin in one.equivalent) if one.effect in _UNNAMED else ()
    names = [effect for effect, _, read in twins if effect not in _UNNAMED and set(read.split(",")) == set(one.drivers)]
    return f", which may be {names[0]}" if names else ""


def not_told_from(one: Candidate) -> str:
    """'not told from feed_motor (T_mot_X)': of the effects that have a name and read other channels, each once."""
    found: dict[str, str] = {}
    for twin in one.equivalent:
        effect, _, channels = twin.partition(":")
        if effect not in (*_UNNAMED, one.effect) and not set(channels.split(",")) <= set(one.drivers):
            found.setdefault(effect, as_named(twin))
    return f"not told from {listed(list(found.values())[:_MOST])}" if found else ""


def named_twins(one: Candidate) -> str:
    """', which may be coolant, not told from feed_screw (T_nut)', of a lag that refines the model: it may stand for
    physics that the model has nothing of; '' of what has a name, and where it can't be told from none."""
    if one.effect not in _UNNAMED:
        return ""
    own = [twin for twin in one.equivalent if twin.partition(":")[0] not in _CHANGES]
    of_effects = one.model_copy(update={"equivalent": own})
    apart = "" if one.gain_by or one.phases else not_told_from(of_effects)
    return by_name(of_effects) + (f", {apart}" if apart else "")


def as_named(candidate: str) -> str:
    """'feed_screw:T_nut_Z' -> 'feed_screw (T_nut_Z)'."""
    effect, _, channels = candidate.partition(":")
    return f"{effect} ({channels.replace(',', ', ')})" if channels else effect
