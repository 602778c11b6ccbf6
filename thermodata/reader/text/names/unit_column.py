"""A column that holds the unit of the one column of numbers beside it: `Date/Time,Unit,Value` of an iButton."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from thermodata.plugin import Block, Loss
from thermodata.reader.header_words import UNIT_WORDS
from thermodata.reader.interleaved import bare_header, words_of
from thermodata.reader.text.cells.quotes import clean
from thermodata.reader.unit_words import holds_units, may_be_a_machine
from thermodata.schema.flag import Flag
from thermodata.schema.quantity import converts, is_unit, linear_conversion, normal_unit

UNIT_OF = "unit_of"  # property of a signal: the one whose unit it says
_SHOWN = 4
_NOT_MEASURED = np.uint16(Flag.NOT_MEASURING)


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


def unit_column(kinds: Mapping[str, str | None], cells: Mapping[str, Sequence[str]]) -> UnitColumn | None:
    """None where no column is called a unit, its cells are none, or of several kinds, or it may be of several columns.
    kinds: of the columns beside the time whose headers say no unit; cells: their sampled cells."""
    called = [n for n, kind in kinds.items() if kind == "str" and holds_units(n, map(clean, cells[n]))]
    numbers = [n for n, kind in kinds.items() if kind not in (None, "str", "bool")]
    if len(called) != 1 or len(numbers) != 1:
        return None
    found = _units_in(cells[called[0]])
    first = next(iter(found), None)
    if first is None or not is_unit(first) or (len(found) == 1 and may_be_a_machine(first)):
        return None
    others = tuple(found)[1:]
    if not all(converts_here(other, first) for other in others):
        return None
    return UnitColumn(called[0], numbers[0], first, others)


def unit_column_note(kinds: Mapping[str, str | None], cells: Mapping[str, Sequence[str]]) -> str | None:
    """A note on a column called a unit that is not taken: it holds one letter, or units that differ, and may be of
    several columns or is of several kinds of values. kinds: of the columns whose headers say no unit."""
    numbers = [n for n, kind in kinds.items() if kind not in (None, "str", "bool")]
    for name, kind in kinds.items():
        if kind != "str" or bare_header(name) not in UNIT_WORDS or not numbers:
            continue
        found = _units_in(cells[name])
        if not all(map(is_unit, found)):
            continue
        letters = all(map(may_be_a_machine, found))
        if len(found) == 1 and letters and len(numbers) == 1:
            word = next(iter(found))
            return f"'{name}' says '{word}', which may be a machine as well as a unit: if it is one, declare it as unit"
        if len(found) > 1 and not letters:
            words, shown = ", ".join(list(found)[:_SHOWN]), "', '".join(numbers[:_SHOWN])
            return (
                f"'{name}' says several units ({words}), which are not converted: it may be of each of '{shown}', or "
                "they are of several kinds. Rows in different units count alike: export one unit a column"
            )
    return None


def _units_in(cells: Sequence[str]) -> dict[str, str]:
    """The words of sampled cells, one of each unit -> it as it is spelled here."""
    found: dict[str, str] = {}
    for word in dict.fromkeys(map(clean, cells)):
        if word and (spelled := normal_unit(word)) not in found.values():
            found[word] = spelled
    return found


def converts_here(word: str, unit: str) -> bool:
    """Whether values in the one are converted to the other: letters alone may be machines."""
    return (len(word) > 1 or len(unit) > 1) and is_unit(word) and converts(word, unit)


def in_one_unit(
    items: Iterator[Block | Loss], said: UnitColumn, where: str, *, whole: bool = False
) -> Iterator[Block | Loss]:
    """The blocks in one unit; rows in one that does not convert to it are left out, and a loss. whole: no row is left
    out, for it holds other values: this one counts as not measured."""
    others: dict[str, int] = {}
    for item in items:
        if isinstance(item, Loss) or said.column not in item.values:
            yield item
            continue
        words = np.array(words_of(said.column, item.values[said.column]), object).astype(str)
        values, lost = item.values[said.of], np.zeros(words.size, bool)
        for word in np.unique(words).tolist():
            if not word or normal_unit(word) == normal_unit(said.unit):
                continue
            rows = words == word
            if values.dtype.kind == "f" and converts_here(word, said.unit):
                factor, offset = linear_conversion(word, said.unit)
                values = np.where(rows, values * factor + offset, values)
                continue
            others[word] = others.get(word, 0) + int(rows.sum())
            lost |= rows
        kept = np.arange(lost.size) if whole else np.flatnonzero(~lost)
        every = dict(item.flags or {})
        if whole and lost.any():
            every[said.of] = every.get(said.of, np.zeros(lost.size, np.uint16)) | (lost * _NOT_MEASURED)
        if kept.size:
            flags = {k: v[kept] for k, v in every.items()}
            of_rows = {k: v[kept] for k, v in {**item.values, said.of: values}.items()}
            yield Block(
                item.stream, item.t_ns[kept], of_rows, flags or None, None if item.at is None else item.at[kept]
            )
    for word, count in others.items():
        reason = f"{count} rows in another unit than '{said.unit}', as '{said.column}' says: {word[:20]}"
        yield Loss(where, reason=reason)
