"""The names of a table without a header, where each stands before its value in every row: `T_front,21.3,T_air,20.5`. A
row that lacks a value may lack its name, too."""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np

from thermodata.plugin import Bool1D
from thermodata.reader.signals.interleaved import STATES
from thermodata.reader.text.cells.cell import Cell, is_empty, is_number, is_stamp, mostly
from thermodata.reader.text.cells.values.quotes import clean
from thermodata.schema.units.unit import is_unit

_FEWEST_ROWS, _FEWEST_PAIRS, _LONGEST = 10, 2, 60
_MAY_NAME = re.compile(r"[^\W\d_].*[^\W_]\S*")  # letters first, two characters at least


def names_before_values(heads: Sequence[str], rows: Sequence[Sequence[Cell]]) -> dict[int, str]:
    """Column -> its name by the one word that stands before its numbers; {} where a header names any column, where not
    each number has such a word, or where words are units or states. rows: the first ones."""
    width = len(heads)
    whole = [r for r in rows if len(r) >= width and any(not is_empty(c) for c in r)]
    if len(whole) < _FEWEST_ROWS or any(head not in ("", f"column {i + 1}") for i, head in enumerate(heads)):
        return {}
    found = {i + 1: word for i in range(width - 1) if (word := _word_before(whole, i)) is not None}
    numbers = {i for i in range(1, width) if _all_are(whole, i)}
    names = list(found.values())
    return found if len(set(names)) == len(names) >= _FEWEST_PAIRS and numbers <= found.keys() else {}


def behind_another(words: Sequence[Cell], word: str) -> Bool1D:
    """Which values have another word before them than the one that their column is called by: they are of something
    else. words: those of some rows, shape (n,); where none stands, the value is the column's."""
    said = {w: not is_empty(w) and clean(str(w)) != clean(word) for w in set(words)}
    return np.fromiter((said[w] for w in words), bool, len(words))


def other_word(word: str, other: Cell) -> str:
    """What a loss says of such a value."""
    return f"expected a value behind '{word}', got one behind '{clean(str(other))[:60]}'"


def _word_before(rows: Sequence[Sequence[Cell]], place: int) -> str | None:
    """The word in a column whose neighbour holds numbers, where it is one and the same, and lacks beside no number."""
    words = {str(r[place]).strip() for r in rows if not is_empty(r[place])}
    word = next(iter(words), "")
    if len(words) != 1 or not _may_name(word) or not _all_are(rows, place + 1):
        return None
    return word if all(is_empty(r[place + 1]) for r in rows if is_empty(r[place])) else None


def _all_are(rows: Sequence[Sequence[Cell]], place: int) -> bool:
    cells = [r[place] for r in rows if not is_empty(r[place])]
    return bool(cells) and mostly(cells, lambda c: is_number(c) and not isinstance(c, bool), 0.95, len(cells))


def _may_name(word: str) -> bool:
    if len(word) > _LONGEST or _MAY_NAME.fullmatch(word) is None or is_stamp(word):
        return False
    return word.casefold() not in STATES and not is_unit(word)
