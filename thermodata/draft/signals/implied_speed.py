"""A speed in rpm because nothing says another unit: where what it is called, or who sent it, has radians or degrees by
the second as often, that is asked, and it is never sure."""

from __future__ import annotations

from dataclasses import replace

from thermodata.draft.signals.quantity.guessed import Guess
from thermodata.draft.words.naming import words
from thermodata.plugin import Signal

_VELOCITY = frozenset({"vel", "velocity", "velocities", "omega", "angular"})
_SCHEMA = "schema"  # of a message: what robots send has rad/s
_TURNS_BY_MINUTE = ("RotaryVelocity", "SpindleSpeed")  # MTConnect's types of data items, whose unit is a standard
_ASKED = "unit: rpm, rad/s or deg/s? nothing says it"


def is_implied(found: Guess) -> bool:
    """Whether a speed has its unit by its values alone."""
    return found.quantity == "rotational_speed" and "values" in found.basis and "unit" not in found.basis


def with_speed_asked(found: Guess, signal: Signal, name: str) -> Guess:
    """With a question for the unit of an angular velocity, or of a message's speed, that only its values imply. name:
    with all that its file says of it."""
    said = signal.properties
    if not is_implied(found) or found.unit is None or said.get("type", "").startswith(_TURNS_BY_MINUTE):
        return found
    if _SCHEMA not in said and _VELOCITY.isdisjoint(words(name).split()):
        return found
    return replace(found, sure=False, questions=(*found.questions, _ASKED))
