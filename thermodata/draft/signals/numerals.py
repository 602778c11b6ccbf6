"""Texts that are numbers: measured ones in digits of any script, with or without a unit behind them."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from thermodata.calibration.channel import number_in
from thermodata.plugin import Float1D
from thermodata.reader.signals.unit_words import is_surely_unit

_NUMERAL = re.compile(r"(?P<number>[-+]?\d*[.,]?\d+([eE][-+]?\d+)?)(?:\s?(?P<unit>[^\d\s.,+-]\S{0,11}))?")
_MAY_BE_THOUSANDS = re.compile(r",\d{3}$")
_LONGEST = 64  # letters of one
_FEW, _MOSTLY = 8, 0.9  # texts that differ
# dashboards write 7.5 K for 7500, beside 800
_THOUSANDS = ("k", "K", "M", "G", "Mil", "Bil")


@dataclass(frozen=True, slots=True)
class Numerals:
    """numbers: as they stand before their units, shape (n,), NaN of words. units: one text with a unit and a bare one,
    '' where there is none; None where none has a unit. read: ingest takes these numbers as they stand."""

    numbers: Float1D
    units: tuple[str, str] | None
    read: bool


def bare_word(cell: object) -> str:
    """A cell of words without blanks around it; '' where it is empty."""
    return "" if cell is None or cell != cell else str(cell).strip()


def numerals_of(cells: Sequence[object]) -> Numerals | None:
    """None where words, or none but whole numbers, as those of programs and lots, stand there."""
    spelled = {word: unicodedata.normalize("NFKC", bare_word(word)).replace("−", "-") for word in dict.fromkeys(cells)}
    said = {word: s for word, s in spelled.items() if s}
    found = {word: m for word, s in said.items() if len(s) <= _LONGEST and (m := _NUMERAL.fullmatch(s)) and _may_be(m)}
    numbers = {word: m["number"].replace(",", ".") for word, m in found.items()}
    if len(numbers) <= _FEW or len(numbers) < _MOSTLY * len(said) or not any("." in n for n in numbers.values()):
        return None
    with_unit = next((said[w] for w, m in found.items() if m["unit"]), "")
    bare = next((said[w] for w, m in found.items() if not m["unit"]), "")
    units = (with_unit, bare) if with_unit else None
    plain = not with_unit and not any(_MAY_BE_THOUSANDS.search(said[word]) for word in numbers)
    read = plain and all(number_in(bare_word(word)) == float(number) for word, number in numbers.items())
    return Numerals(np.array([float(numbers.get(word, "nan")) for word in cells]), units, read)


def numeral_question(units: tuple[str, str]) -> str:
    """What to ask of numbers that stay words for what stands behind them. units: as of `Numerals`."""
    match = _NUMERAL.fullmatch(unicodedata.normalize("NFKC", units[0]).replace("−", "-"))
    unit = match["unit"] if match is not None else ""
    beside = f"'{units[0]}' beside '{units[1]}'" if units[1] else f"'{units[0]}'"
    which = f"is {unit} a unit, or thousands of one" if unit in _THOUSANDS else f"is {unit} the unit of all"
    if not units[1] and unit not in _THOUSANDS:
        which = f"in {unit}"
    return f"{beside} is kept as text, which has no value: {which}? write bare numbers of one unit into the file"


def _may_be(match: re.Match[str]) -> bool:
    unit = match["unit"]
    return not unit or unit in _THOUSANDS or is_surely_unit(unit)
