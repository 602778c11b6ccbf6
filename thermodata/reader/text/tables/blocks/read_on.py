"""A header within a table that names its columns in another order, or more of them: where a logger was set up anew and
went on in its file. Each column is looked for by its name, and rows are read on as if nothing had moved."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from thermodata.reader.text.names.header import split_unit
from thermodata.reader.text.page.layout import Layout
from thermodata.reader.text.rows.grid import Grid, Rows
from thermodata.reader.text.tables.table import Table
from thermodata.schema.units.spelling import spelled

_GONE = -1


@dataclass(frozen=True, slots=True)
class Under:
    """How cells lie under a header. at: the place of each column of the table, -1 of one that holds nothing and is not
    named again; width: how many cells a row has; more: the names that no column of the table has."""

    at: tuple[int, ...]
    width: int
    more: tuple[str, ...] = ()

    @property
    def moved(self) -> bool:
        return self.at != tuple(range(self.width))

    def grid(self, grid: Grid) -> Grid:
        """How rows lie here. grid: under the table's own header."""
        if not self.moved:
            return grid
        kinds: list[str | None] = [None] * self.width
        for kind, place in zip(grid.kinds, self.at, strict=True):
            if place != _GONE:
                kinds[place] = kind
        return replace(grid, kinds=tuple(kinds))

    def columns_of(self, rows: Rows) -> Rows:
        """The same rows, by the columns of the table."""
        if not self.moved:
            return rows
        columns = {i: rows.columns[p] for i, p in enumerate(self.at) if p in rows.columns}
        return replace(
            rows, columns=columns, times={i: rows.times[p] for i, p in enumerate(self.at) if p in rows.times}
        )

    def in_order(self, cells: Sequence[str]) -> list[str]:
        """The cells of a line as the table has its columns; '' for those that the line lacks. Of a table whose columns
        didn't move, the cells as they are."""
        if not self.moved:
            return list(cells)
        return [cells[p] if 0 <= p < len(cells) else "" for p in self.at]


def own_header(table: Table) -> Under:
    """How cells lie under the header of the table itself."""
    return Under(tuple(range(len(table.layout.names))), len(table.layout.names))


def under_header(table: Table, cells: Sequence[str]) -> Under | None:
    """How cells lie below a line that names the time where the table has it, and all its columns in the same units;
    None below another one: where it lacks a column, has a name twice, or where names don't stand over their columns."""
    layout = table.layout
    if len(table.groups) > 1 or layout.fit is not None or table.columns is not None or layout.worded:
        return None
    under = under_names(layout, [kind is not None for kind in table.kinds], cells)
    if under is not None and under.more and table.begin is not None:
        return None  # whether its rows count from another start shows by rows of the same width only
    return under


def under_names(layout: Layout, filled: Sequence[bool], cells: Sequence[str]) -> Under | None:
    """The same of the layout of a text or a sheet. filled: whether a column holds anything, of each."""
    cells = [*cells]
    while cells and not cells[-1]:
        cells.pop()
    told = [_name_and_unit(cell) for cell in cells]
    free = [k for k in range(len(cells)) if k not in layout.time]
    if len({told[k][0] for k in free} - {""}) < len(free):
        return None
    at = list[int]()
    for i, (name, unit, holds) in enumerate(zip(layout.names, layout.units, filled, strict=True)):
        if i in layout.time:
            at.append(i)
            continue
        own, of_name = _name_and_unit(name)
        units = ("", of_name if unit is None else spelled(unit) or unit)  # it may stand in a line below
        place = next((k for k in free if told[k][0] == own and told[k][1] in units), _GONE)
        if place == _GONE and holds:
            return None
        at.append(place)
    more = tuple(cells[k] for k in free if k not in at)
    return Under(tuple(at), max(len(cells), *(i + 1 for i in layout.time)), more)


def _name_and_unit(cell: str) -> tuple[str, str]:
    """(name, unit in one spelling), '' for none."""
    name, unit = split_unit(cell)
    return name, (spelled(unit) or unit) if unit else ""
