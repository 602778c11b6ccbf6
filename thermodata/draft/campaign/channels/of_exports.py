"""What an export of our own says of its channels, which leaves nothing to guess of them."""

from __future__ import annotations

from dataclasses import replace

from thermodata.draft.signals.quantity.guessed import Guess
from thermodata.plugin import Signal
from thermodata.schema.agreed.exported import own_says


def as_exported(said: Guess, signal: Signal) -> Guess:
    """A guess as the file says it, where it says the quantity; its place and axis are those that were declared."""
    quantity, at, axis = (own_says(signal.name, key, signal.properties) for key in ("quantity", "at", "axis"))
    if quantity is None:
        return said if at is None else placed_as_told(said, at)
    unit = said.unit if said.quantity == quantity and said.instead_of is None else signal.unit
    return replace(
        said,
        quantity=quantity,
        unit=unit,
        at=at,
        axis=axis,
        sure=True,
        basis=("what the export says",),
        questions=(),
        why_not=None,
        instead_of=None,
    )


def placed_as_told(said: Guess, at: str) -> Guess:
    """A guess with the place that a list beside the logs says, which answers what was asked of it."""
    return replace(said, at=at, questions=tuple(q for q in said.questions if not q.startswith("at:")))
