"""What a signal is: its quantity, by unit where there is one, else by name, else by values. Never made up."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from thermodata.draft.signals import units
from thermodata.draft.signals.numerals import numeral_question
from thermodata.draft.signals.quantity.by_name import by_name
from thermodata.draft.signals.quantity.by_unit import by_unit
from thermodata.draft.signals.quantity.guessed import NO_READING, NOTHING, OF_NONE, Guess
from thermodata.draft.signals.values import Values
from thermodata.draft.words.listed import holds_word
from thermodata.draft.words.vocabulary import DIFFERENCE, foreign_in, places_in, quantities_in
from thermodata.reader.times.time_units import found_epoch
from thermodata.schema.units.unit import normal_unit

_WEAK = ("a time stamp", "a number")  # words that stand beside others: 'Temp block 3'


def quantity_of(own: str, text: str, unit: str | None, dtype: str, values: Values | None) -> Guess:
    """What a signal measures. own: its name; text: the name with what stands over it; unit: None where the file says
    none; values: a sample of them, where there is one."""
    bare = unit is None or normal_unit(unit) == "dimensionless"
    if dtype == "str" and values is not None and values.read:
        return _of_numerals(quantity_of(own, text, unit, "float64", values), values)
    if dtype == "str":
        return _of_words(own, unit, bare, values)
    if not bare:
        own, text = units.without_volts(own), units.without_volts(text)
    named = quantities_in(own) or quantities_in(text)
    foreign = foreign_in(own)
    if dtype == "bool":
        return Guess("state", sure=True, basis=("type",))
    if bare and values is not None and _since_a_date(values):
        return Guess(None, unit, why_not=f"a count of seconds since 1970: {OF_NONE}")
    if bare and values is not None and values.counts_rows and not named:
        return Guess(None, unit, why_not=f"{NO_READING}: it counts the rows")
    if bare and not foreign and _on_off(own, named, values):
        return Guess(
            "state",
            basis=("name", "values") if values is not None else ("name",),
            sure=values is not None and values.switch and "state" in named,
        )
    if foreign and not _stronger(named, own, unit):
        return Guess(None, unit, why_not=f"{foreign}: {OF_NONE}")
    if holds_word(DIFFERENCE, own) and "temperature" in named:
        named = ("temperature_difference", *(q for q in named if q != "temperature"))
    if not bare:
        assert unit is not None
        return by_unit(own, named, unit, values)
    return by_name(own, named, values, dtype)


def _of_numerals(found: Guess, values: Values) -> Guess:
    """Of a signal whose texts are numbers, by what these would be. A program's version, or a lot, is written so too."""
    if found.quantity is not None:
        return replace(found, sure=False)
    if not (found.why_not or "").startswith(NOTHING):
        return found
    why = f"{NOTHING} numbers kept as text ({values.span()}); quantity: label if they measure nothing"
    return replace(found, why_not=why)


def _of_words(own: str, unit: str | None, bare: bool, values: Values | None) -> Guess:
    """Of a signal whose values are texts. bare: it has no unit."""
    if bare and values is not None and values.numerals:
        if values.units is not None:
            return Guess(
                None, unit, why_not=f"{numeral_question(values.units)}, or quantity: label if they measure nothing"
            )
        why = f"numbers kept as text ({values.span()}), which have no value: write them as numbers into the file"
        return Guess(None, unit, why_not=f"{why}, or quantity: label if they measure nothing")
    if bare and values is not None and values.text and not foreign_in(own):
        return Guess("state", basis=("name", "values") if places_in(own) else ("values",))  # ON and OFF
    if bare:
        return Guess("label", sure=True, basis=("text",))
    # numbers in a spelling that is none would be kept as words, and be missed in every view of values
    return Guess(None, unit, why_not=f"text, though {unit} is a unit of numbers: thermodata preview shows it")


def _since_a_date(values: Values) -> bool:
    """Whether numbers are Unix time, in whatever unit of it, by their size."""
    return (found_epoch(np.array([values.low, values.high], np.float64)) or "").startswith("unix")


def _on_off(own: str, named: tuple[str, ...], values: Values | None) -> bool:
    """A switch by its values (0 and 1), or by a name that says so ('bDoor', 'coolant on') with values that allow it."""
    if values is not None and values.switch:
        return True
    fits = values is None or (values.whole and values.low >= 0 and values.high <= 1)
    return fits and ("state" in named or (own.startswith("b ") and not named and bool(places_in(own))))


def _stronger(named: tuple[str, ...], own: str, unit: str | None) -> bool:
    """Whether the unit proves a quantity that the name has too, beside a word of something else ('Temp block 3')."""
    if unit is None:
        return False
    possible = units.quantities_of(unit)
    weak = (foreign_in(own) or "").startswith(_WEAK)
    if weak and tuple(possible) == ("displacement",):  # of an instrument that is called IDS
        return True
    return possible[:1] in (("temperature",), ("rotational_speed",)) or (weak and any(q in possible for q in named))
