"""What the head of a file says of units, beside the question of a unit that no header says."""

from __future__ import annotations

from dataclasses import replace

from thermodata.draft.signals.quantity import Guess
from thermodata.plugin import Signal
from thermodata.reader.text.preamble.units_said import HEAD, OTHERS
from thermodata.schema.quantity import normal_unit

_LENGTHS_AND_HEAT = ("temperature", "temperature_difference", "displacement", "position")


def with_head(said: Guess, signal: Signal, note: str | None) -> tuple[Guess, str | None]:
    """The guess with the head's words in its question of the unit, or with such a question where the head says another
    unit than was taken; and the note of a channel in volts with them."""
    line = signal.properties[HEAD]
    told = f"the head of the file says '{line}'"
    asked = [q for q in said.questions if q.startswith("unit")]
    if asked:
        questions = tuple(f"{q}, {told}" if q == asked[0] else q for q in said.questions)
        return replace(said, questions=questions), note
    if signal.unit is None and said.quantity in _LENGTHS_AND_HEAT and OTHERS.search(line):
        return replace(said, sure=False, questions=(*said.questions, f"unit: {said.unit}? {told}")), note
    if normal_unit(signal.unit or "") not in ("V", "mV"):  # which a scale of the logger makes another unit of
        return said, note
    return said, "; ".join(filter(None, (note, told)))
