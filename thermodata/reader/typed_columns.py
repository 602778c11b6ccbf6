"""What columns of typed tables (workbooks, Parquet) say of each other, by the rules of text: which stand over the empty
cells behind them, which tell the quality of others, and which the unit."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from thermodata.plugin import Array, Bool1D, Int1D
from thermodata.reader.signals.header_words import UNIT_SHORT, UNIT_WORDS
from thermodata.reader.signals.interleaved import bare_header, words_of
from thermodata.reader.signals.row_units import UnitColumn
from thermodata.reader.text.cells.values.status import declared_zero
from thermodata.reader.text.names.called_column import by_name
from thermodata.reader.text.names.unit_column import unit_column, unit_column_note
from thermodata.reader.text.rows.changed_cells import KEY, Standing, declared_standing, find_standing
from thermodata.reader.text.rows.qualities import Qualities, find_qualities
from thermodata.reader.text.rows.quality_columns import may_be_quality
from thermodata.reader.times.zone import NAT

_MOST_ROWS, _LEAST_ROWS, _MOST_CELLS = 20_000, 2000, 400_000  # that are looked at: of a wide table fewer rows
_NO_NUMBER = "NaN"  # a cell that says it, where others say nothing


@dataclass(frozen=True, slots=True)
class Related:
    """stands: columns whose values stand over the empty cells behind them; qualities: what columns say of others;
    notes: on all."""

    stands: frozenset[str] = frozenset()
    qualities: Qualities = field(default_factory=Qualities)
    notes: tuple[str, ...] = ()


def rows_looked_at(columns: int) -> int:
    """The first rows of so many columns, which tell what these say of each other."""
    return min(_MOST_ROWS, max(_LEAST_ROWS, _MOST_CELLS // max(1, columns)))


class Relating:
    """The values and flags of a table's columns, block by block, with what stands and what is called bad."""

    def __init__(self, related: Related) -> None:
        self.related = related
        self._standing = {name: Standing() for name in related.stands}

    def over(
        self, values: Mapping[str, Array], flags: Mapping[str, Array], empty: Mapping[str, Bool1D]
    ) -> tuple[dict[str, Array], dict[str, Array]]:
        """(values, flags) of all rows of a block, each shape (n,). empty: cells that hold nothing, of the columns that
        have any."""
        values, flags = dict(values), dict(flags)
        for name, standing in self._standing.items():
            if name in values:
                written = ~empty[name] if name in empty else np.ones(values[name].size, bool)
                values[name], flag = standing.over(values[name], flags.get(name), written)
                if flag is not None:
                    flags[name] = flag
        return values, self.related.qualities.flagged(flags, values)


@dataclass(frozen=True, slots=True)
class Columns:
    """Columns on one time, or their first rows. values: shape (n,) each; empty: cells that hold nothing, of the columns
    that have any; t_ns: times of rows [ns], NAT where there is none; measured: names of columns with a unit."""

    values: Mapping[str, Array]
    empty: Mapping[str, Bool1D]
    t_ns: Int1D
    measured: Collection[str] = ()

    def cells(self, name: str, values: Array) -> list[str]:
        """What the first cells of a column hold, as text. values: of these."""
        return _cells(values, self.empty.get(name))


def related(
    said: Mapping[str, Any] | None,
    columns: Columns,
    where: str,
    *,
    told_by_cells: bool = True,
    beyond: Collection[str] = (),
) -> Related:
    """By the first rows of columns. told_by_cells: False where only what is declared stands; beyond: names of other
    streams of the file, which may be declared as well. UsageError: `declared_standing`; QuestionError:
    `declared_zero`."""
    said = said or {}
    rows = rows_looked_at(len(columns.values))
    head = {name: v[:rows] for name, v in columns.values.items()}
    # of a column that is called no quality its name is all that counts
    called = {name: columns.cells(name, v) if may_be_quality(name) else [] for name, v in head.items()}

    def zero_of(zero: bool | None, name: str) -> bool:
        return declared_zero(said, zero, name, where)

    qualities = find_qualities(called, zero_of, columns.measured)
    note = None
    told = _declared_columns(said.get(KEY), list(columns.values), beyond, where)
    own = {name for name, _ in (*qualities.of_values.values(), *qualities.of_rows.values())}
    if told is None:
        seen = columns.t_ns[columns.t_ns != NAT]
        told = frozenset()
        head = {name: v for name, v in head.items() if name not in own}
        backwards = seen.size > 1 and seen[-1] < seen[0]
        if told_by_cells and not backwards and any(_has_gaps(v, columns.empty.get(name)) for name, v in head.items()):
            told, note = find_standing({name: columns.cells(name, v) for name, v in head.items()})
    told |= {own for value, (own, _) in qualities.of_values.items() if value in told}
    return Related(told, qualities, tuple(n for n in (note, *qualities.notes(called)) if n))


def unit_in_rows(values: Mapping[str, Array], units: Mapping[str, str | None]) -> tuple[UnitColumn | None, str | None]:
    """(what says the unit of which column, a note). values: the first rows of each column, shape (n,); units: of those
    whose header or metadata say one."""
    bare = {name: v for name, v in values.items() if units.get(name) is None}
    kinds: dict[str, str | None] = {
        name: "str" if v.dtype.kind == "O" else "bool" if v.dtype.kind == "b" else "float64" for name, v in bare.items()
    }
    called = [n for n, kind in kinds.items() if kind == "str" and bare_header(n) in {*UNIT_WORDS, *UNIT_SHORT}]
    if not called:
        return None, None
    cells: dict[str, list[str]] = {n: words_of(n, bare[n]) if n in called else [] for n in kinds}
    found = unit_column(kinds, cells)
    return found, found.note() if found is not None else unit_column_note(kinds, cells)


def _declared_columns(said: object, names: Sequence[str], beyond: Collection[str], where: str) -> frozenset[str] | None:
    """Those of some columns that are declared, by their own names behind that of a sheet too."""
    if not isinstance(said, list | tuple):
        return declared_standing(said, names, where)

    def called(one: str, among: Collection[str]) -> list[str]:
        if one in among:
            return [one]
        told = {one, f"column {one}"} if one.isdecimal() else {one}
        own = {name: name.rpartition("/")[2] for name in among}
        return [name for name, last in own.items() if last in told or by_name(one, [last]) is not None]

    unknown = [one for one in map(str, said) if not called(one, [*names, *beyond])]
    declared_standing(unknown, names, where)
    return frozenset(name for one in map(str, said) for name in called(one, names))


def _has_gaps(values: Array, empty: Bool1D | None) -> bool:
    """Whether some of its cells hold nothing, and not all."""
    if values.dtype.kind == "O":
        holds = {v is not None and bool(str(v).strip()) for v in values.tolist()}
        return len(holds) == 2
    return empty is not None and bool(empty[: values.size].any()) and not empty[: values.size].all()


def _cells(values: Array, empty: Bool1D | None) -> list[str]:
    """What cells hold, as text has it: nothing where they are empty."""
    if values.dtype.kind == "O":
        return ["" if v is None else str(v) for v in values.tolist()]
    none = np.zeros(values.size, bool) if empty is None else empty[: values.size]
    return ["" if e else _NO_NUMBER if v != v else str(v) for v, e in zip(values.tolist(), none.tolist(), strict=True)]
