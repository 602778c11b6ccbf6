"""A signal whose name says another unit than its file: 'dZ [mm]' above a row of units with 'µm'."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from thermodata.draft.signals.quantity.guessed import Guess, range_text
from thermodata.draft.signals.values import Values
from thermodata.plugin import Signal
from thermodata.reader.text.names.unit_in_name import other_unit


def with_both_units(said: Guess, signals: Iterable[tuple[Signal, Values | None]]) -> Guess:
    """With the question which of both is right, and none of them written. signals: as its files have it, each with its
    values there."""
    if said.quantity in (None, "label", "state"):
        return said
    difference = said.quantity == "temperature_difference"
    for signal, values in signals:
        own = None if signal.scaling is not None else other_unit(signal.name, signal.unit, difference)
        if own is not None:
            by = signal.unit
            asked = (
                f'unit: "{by}" as the file says beside the name, or, as the name has it, unit: "{own}", '
                f'instead_of: "{by}"? ({range_text(values)})'
            )
            return replace(said, unit=None, instead_of=None, sure=False, questions=(*said.questions, asked))
    return said
