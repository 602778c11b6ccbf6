"""What a person said of a signal in the campaign file before: it counts more than all that a draft could guess."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from thermodata.draft.signals.quantity.guessed import Guess
from thermodata.plugin import Signal

SAID = ("quantity", "unit", "instead_of", "axis", "at")  # keys of a channel that say what its signal is
NAME = "name"  # what somebody calls its channel
_KEY, _BASIS = "said_before_", "as in the campaign file before"


def told(signal: Signal, said: Mapping[str, str]) -> Signal:
    """The signal with what somebody said of it. said: key of `SAID`, or `NAME`, -> its value."""
    return replace(signal, properties={**signal.properties, **{_KEY + key: value for key, value in said.items()}})


def name_told(signal: Signal) -> str | None:
    """What somebody called the channel of a signal."""
    return signal.properties.get(_KEY + NAME)


def as_told(found: Guess, signal: Signal) -> Guess:
    """A guess with what somebody said of the signal in its place; what is asked beside it stays asked."""
    said = {key: signal.properties[_KEY + key] for key in SAID if _KEY + key in signal.properties}
    if not said:
        return found
    if "quantity" not in said and found.quantity is None:
        return found
    made = replace(
        found,
        quantity=said.get("quantity", found.quantity),
        unit=said.get("unit", found.unit),
        instead_of=said.get("instead_of", None if "unit" in said else found.instead_of),
        axis=said.get("axis", found.axis),
        at=said.get("at", found.at),
        why_not=None,
        sure=not found.questions,
        basis=(_BASIS,),
    )
    if made.quantity == found.quantity:
        return made
    # what was guessed and asked of it was of what it was taken for
    asked = () if "at" in said else ("at: where on the machine?",)
    return replace(made, at=said.get("at"), axis=said.get("axis"), sure=not asked, questions=asked)
