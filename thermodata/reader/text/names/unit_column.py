"""A column that holds the unit of the one column of numbers beside it: `Date/Time,Unit,Value` of an iButton."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence

import numpy as np

from thermodata.plugin import Block, Loss
from thermodata.reader.signals.header_words import UNIT_WORDS, VALUE_WORDS
from thermodata.reader.signals.interleaved import bare_header, words_of
from thermodata.reader.signals.row_units import UnitColumn, converts_here, in_unit
from thermodata.reader.signals.unit_words import holds_units, may_be_a_machine
from thermodata.reader.text.cells.values.quotes import clean
from thermodata.schema.flag import Flag
from thermodata.schema.units.unit import is_unit, normal_unit

_SHOWN = 4
_NOT_MEASURED = np.uint16(Flag.NOT_MEASURING)


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


def paired_units(kinds: Mapping[str, str | None], cells: Mapping[str, Sequence[str]]) -> tuple[UnitColumn, ...]:
    """Columns of units each of which says by its name of which column of numbers it is: `Ch1_Unit` of `Ch1_Value`. None
    of one whose cells are no units, or of several kinds. kinds, cells: as of `unit_column`."""
    numbers = {_stem(n, VALUE_WORDS): n for n, kind in kinds.items() if kind not in (None, "str", "bool")}
    found: list[UnitColumn] = []
    for name, kind in kinds.items():
        stem = _stem(name, UNIT_WORDS)
        if kind != "str" or not stem or bare_header(name) == stem or stem not in numbers:
            continue
        units = _units_in(cells[name])
        first, *others = units or ("",)
        if is_unit(first) and first and all(converts_here(other, first) for other in others):
            found.append(UnitColumn(name, numbers[stem], first, tuple(others)))
    return tuple(found)


def _stem(name: str, words: Collection[str]) -> str:
    """A header without the word at its end, bare: 'ch1' of 'Ch1_Unit'."""
    bare = bare_header(name)
    ends = [w for w in words if bare.endswith(w) and len(w) > 1]
    return bare.removesuffix(max(ends, key=len)) if ends else bare


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
        words = words_of(said.column, item.values[said.column])
        values, lost, foreign = in_unit(words, item.values[said.of], said.unit)
        for word, count in foreign.items():
            others[word] = others.get(word, 0) + count
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
        yield Loss(where, reason=lost_for_unit(said, word, count))


def lost_for_unit(said: UnitColumn, word: str, count: int) -> str:
    """What is said of rows in a unit that does not convert."""
    return f"{count} rows in another unit than '{said.unit}', as '{said.column}' says: {word[:20]}"
