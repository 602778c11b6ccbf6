"""Whether a column of words holds units: by its header, or by a short one ("E", "Einh.") together with its words."""

from __future__ import annotations

from collections.abc import Iterable

from thermodata.reader.signals.header_words import UNIT_SHORT, UNIT_WORDS
from thermodata.reader.signals.interleaved import bare_header
from thermodata.schema.units.unit import is_unit

_DEGREES = ("C", "F", "K")
# units that are words of a state, a place or a statistic as well, and marks of nothing
_OTHERWISE = frozenset({"in", "at", "min", "-", "n.a.", "na"})


def may_be_a_machine(word: str) -> bool:
    """Whether a word under "Unit" may be the letter or number of a machine as well: the A of ampere. A thermometer's C,
    F and K are taken for what they say."""
    return len(word) == 1 and word.isalnum() and word not in _DEGREES


def holds_units(header: str, words: Iterable[str]) -> bool:
    """Whether a column says the units of values beside it. A short header says it only where each of its words can be
    nothing else: under "E" may stand errors, and under "U" machines. words: its cells, '' where there is nothing."""
    bare = bare_header(header)
    if bare in UNIT_WORDS:
        return True
    if bare not in UNIT_SHORT:
        return False
    told = {word for word in words if word}
    return bool(told) and all(len(w) > 1 or not w.isalnum() for w in told) and all(map(is_surely_unit, told))


def is_surely_unit(word: str) -> bool:
    """Whether a word is a unit known here, and no word of a state, a place or a statistic as well."""
    return word.casefold() not in _OTHERWISE and is_unit(word)
