"""What the head of a file says of units, beside the question of a unit that no header says."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import replace

from thermodata.draft.signals.guess import called, guess, told_of
from thermodata.draft.signals.quantity.guessed import NOTHING, Guess
from thermodata.draft.signals.values import Values
from thermodata.draft.words.naming import parts_of
from thermodata.plugin import Signal
from thermodata.reader.text import split_unit
from thermodata.reader.text.preamble.units_said import HEAD, OTHERS, unit_of, units_in
from thermodata.schema.units.conversion import converts
from thermodata.schema.units.quantity import CANONICAL_UNIT
from thermodata.schema.units.unit import normal_unit
from thermodata.schema.words.sentences import with_count

_FILES, _HEADS = 2, 4  # that are shown
_LONGEST = 80  # letters of a text
_LENGTHS_AND_HEAT = ("temperature", "temperature_difference", "displacement", "position")


def with_head(
    said: Guess, signal: Signal, note: str | None, heads: Mapping[str, Sequence[str]], values: Values | None = None
) -> tuple[Guess, str | None]:
    """The guess with the head's words in its question of the unit, or with such a question where the head says another
    unit than was taken, or those of several files differ; and the note of a channel in volts with them. heads: what
    they say, '' for nothing -> the files; values: of a sample."""
    said = _by_head(said, signal, heads, values)
    line = next(filter(None, heads))
    told = f"the head of the file says '{line}'"
    possible = {frozenset(u for u in units_in(text) if _fits(u, said.quantity)) for text in heads}
    if len(possible - {frozenset()}) > 1:
        shown = ", ".join(f"'{text}' ({with_count(files, _FILES)})" for text, files in list(heads.items())[:_HEADS])
        name = parts_of(split_unit(signal.name)[0])[-1]
        told = (
            f"the heads of the files differ: {shown}: a test in another unit says so: channels: {{{name}: {{unit: ?}}}}"
        )
        if signal.unit is None and said.quantity and not any(q.startswith("unit") for q in said.questions):
            return replace(said, sure=False, questions=(*said.questions, f"unit: {said.unit}? {told}")), note
    asked = [q for q in said.questions if q.startswith("unit")]
    if asked:
        questions = tuple(f"{q}, {told}" if q == asked[0] else q for q in said.questions)
        return replace(said, questions=questions), note
    if signal.unit is None and said.quantity in _LENGTHS_AND_HEAT and OTHERS.search(line):
        return replace(said, sure=False, questions=(*said.questions, f"unit: {said.unit}? {told}")), note
    own = unit_of(line, signal.name)
    if _is_another(own, said):
        return replace(said, sure=False, questions=(*said.questions, f"unit: {said.unit}, or {own}? {told}")), note
    if normal_unit(signal.unit or "") not in ("V", "mV"):  # which a scale of the logger makes another unit of
        return said, note
    return said, "; ".join(filter(None, (note, told)))


def _by_head(said: Guess, signal: Signal, heads: Mapping[str, Sequence[str]], values: Values | None) -> Guess:
    """The guess by the one unit that all heads say, asked, where a signal's name and values say no quantity: 'Z' under
    'Units: microinch'."""
    units = {unit for text in heads for unit in units_in(text)} if "" not in heads else set()
    if said.quantity is not None or signal.unit or not (said.why_not or "").startswith(NOTHING) or len(units) != 1:
        return said
    unit = units.pop()
    found = guess(called(signal), unit, signal.dtype, values, told_of(signal))
    if found.quantity is None:
        return said
    return replace(found, sure=False, questions=(f"unit: {unit}?", *found.questions))


def with_text(said: Guess, signal: Signal) -> Guess:
    """The same of a text beside the signals of a file that says units of them: a MAT file's `info`, "n in 1/s"."""
    if signal.unit is not None or said.quantity in (None, "state", "label"):
        return said
    name = re.sub(r"\[\d+\]$", "", parts_of(signal.name)[-1])  # an array is told of as a whole
    for key, text in signal.properties.items():
        own = unit_of(text, name) if key != HEAD and " in " in text else None
        if own is None or not _fits(own, said.quantity):
            continue
        told = f"the file's {key} says '{text[:_LONGEST]}'"
        asked = next((q for q in said.questions if q.startswith("unit")), None)
        if asked is not None:
            return replace(said, questions=tuple(f"{q}, {told}" if q == asked else q for q in said.questions))
        if _is_another(own, said):
            return replace(said, sure=False, questions=(*said.questions, f"unit: {said.unit}, or {own}? {told}"))
    return said


def _is_another(unit: str | None, said: Guess) -> bool:
    """Whether a unit is one of the quantity, and not that which was taken."""
    if unit is None or said.unit is None or not _fits(unit, said.quantity):
        return False
    return normal_unit(unit) != normal_unit(said.unit)


def _fits(unit: str, quantity: str | None) -> bool:
    return quantity in CANONICAL_UNIT and converts(unit, CANONICAL_UNIT[quantity])
