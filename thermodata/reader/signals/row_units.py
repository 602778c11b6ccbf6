"""Units that rows say of a column of numbers beside them, and the numbers in one of these."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from thermodata.plugin import Array, Bool1D
from thermodata.schema.units.conversion import converts, linear_conversion
from thermodata.schema.units.unit import is_unit, normal_unit

UNIT_OF = "unit_of"  # property of a signal: the one whose unit it says


@dataclass(frozen=True, slots=True)
class UnitColumn:
    """column: that says it; of: the name of what it is of; unit: of the first row; others: that other rows have, as a
    logger that chose its range, which are converted."""

    column: str
    of: str
    unit: str
    others: tuple[str, ...] = ()

    def note(self) -> str | None:
        """What is told of rows in several units."""
        if not self.others:
            return None
        shown = ", ".join(f"'{unit}'" for unit in self.others)
        return f"'{self.column}' says the unit of '{self.of}' row by row: {shown} is converted to '{self.unit}'"


def converts_here(word: str, unit: str) -> bool:
    """Whether values in the one are converted to the other: letters alone may be machines."""
    return (len(word) > 1 or len(unit) > 1) and is_unit(word) and converts(word, unit)


def in_unit(words: Sequence[str], values: Array, unit: str) -> tuple[Array, Bool1D, dict[str, int]]:
    """Values of rows in one unit, where their words say another one; of numbers with fractions, for whole ones keep no
    others. words, values: shape (n,). Also: which rows are in a unit that does not convert, shape (n,), and how many of
    each."""
    said = np.array(words, object).astype(str)
    lost = np.zeros(said.size, bool)
    foreign: dict[str, int] = {}
    for word in np.unique(said).tolist():
        if not word or normal_unit(word) == normal_unit(unit):
            continue
        rows = said == word
        if values.dtype.kind == "f" and converts_here(word, unit):
            factor, offset = linear_conversion(word, unit)
            values = np.where(rows, values * factor + offset, values)
            continue
        foreign[word] = int(rows.sum())
        lost |= rows
    return values, lost, foreign
