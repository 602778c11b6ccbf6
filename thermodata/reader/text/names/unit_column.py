"""A column that holds the unit of the one column of numbers beside it: `Date/Time,Unit,Value` of an iButton."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from thermodata.plugin import Block, Bool1D, Loss
from thermodata.reader.header_words import UNIT_WORDS
from thermodata.reader.interleaved import bare_header, words_of
from thermodata.reader.text.cells.quotes import clean
from thermodata.reader.unit_words import holds_units, may_be_a_machine
from thermodata.schema.quantity import is_unit, normal_unit


@dataclass(frozen=True, slots=True)
class UnitColumn:
    """column: that says it; of: the name of what it is of; unit: in all rows that were looked at."""

    column: str
    of: str
    unit: str


def unit_column(kinds: Mapping[str, str | None], cells: Mapping[str, Sequence[str]]) -> UnitColumn | None:
    """None where no column is called a unit, its cells are none or several, or it may be of several columns. kinds: of
    the columns beside the time whose headers say no unit; cells: their sampled cells."""
    called = [n for n, kind in kinds.items() if kind == "str" and holds_units(n, map(clean, cells[n]))]
    numbers = [n for n, kind in kinds.items() if kind not in (None, "str", "bool")]
    if len(called) != 1 or len(numbers) != 1:
        return None
    found = dict.fromkeys(word for cell in cells[called[0]] if (word := clean(cell)))
    unit = next(iter(found)) if len({normal_unit(word) for word in found}) == 1 else None
    if unit is None or not is_unit(unit) or may_be_a_machine(unit):
        return None
    return UnitColumn(called[0], numbers[0], unit)


def machine_note(kinds: Mapping[str, str | None], cells: Mapping[str, Sequence[str]]) -> str | None:
    """A note on a column called a unit that holds one letter, which is not taken."""
    if sum(kind not in (None, "str", "bool") for kind in kinds.values()) != 1:
        return None
    for name, kind in kinds.items():
        found = {word for cell in cells[name] if (word := clean(cell))} if bare_header(name) in UNIT_WORDS else set()
        if kind == "str" and len(found) == 1 and may_be_a_machine(word := next(iter(found))) and is_unit(word):
            return f"'{name}' says '{word}', which may be a machine as well as a unit: if it is one, declare it as unit"
    return None


def in_one_unit(items: Iterator[Block | Loss], said: UnitColumn, where: str) -> Iterator[Block | Loss]:
    """The blocks without the rows that say another unit, which are a loss."""
    others: dict[str, int] = {}
    for item in items:
        if isinstance(item, Loss) or said.column not in item.values:
            yield item
            continue
        words = np.array(words_of(said.column, item.values[said.column]), object)
        same = [word for word in set(words.tolist()) if not word or normal_unit(word) == normal_unit(said.unit)]
        other: Bool1D = ~np.isin(words.astype(str), same)
        if not other.any():
            yield item
            continue
        for word in words[other].tolist():
            others[word] = others.get(word, 0) + 1
        rows = np.flatnonzero(~other)
        if rows.size:
            flags = {k: v[rows] for k, v in (item.flags or {}).items()}
            values = {k: v[rows] for k, v in item.values.items()}
            yield Block(item.stream, item.t_ns[rows], values, flags or None, None if item.at is None else item.at[rows])
    for word, count in others.items():
        reason = f"{count} rows in another unit than '{said.unit}', as '{said.column}' says: {word[:20]}"
        yield Loss(where, reason=reason)
