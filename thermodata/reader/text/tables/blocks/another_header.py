"""Lines within a table that begin another one: names in another order, or other units, as where a logger was set up
anew and its file went on. What stands behind them must not be taken for the columns above."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from thermodata.reader.text.cells.cell import Cell, is_number, is_stamp
from thermodata.reader.text.cells.lines.delimiter import fields
from thermodata.reader.text.cells.values.quotes import clean
from thermodata.reader.text.names.header_rows import texts_of
from thermodata.reader.text.names.units_row import as_units, of_units
from thermodata.reader.text.page.header.header_again import repeats_of
from thermodata.reader.text.page.layout import Layout
from thermodata.reader.text.tables.blocks.read_on import Under, under_header, under_names
from thermodata.reader.text.tables.table import Table
from thermodata.schema.units.spelling import spelled

_SHOWN = 120  # letters of a line


@dataclass(frozen=True, slots=True)
class Begun:
    """A line that begins another table. told: what is to be said of it, '' for nothing; under: how the cells of its
    rows lie, None where they are not read."""

    line: int
    told: str
    under: Under | None = None


def another_header(table: Table, lines: Iterable[tuple[int, str]], repeated: int, under: Under) -> Begun | None:
    """The first line that begins another table. lines: (number, text) of those that are no rows of it; repeated: the
    number of the last line before them that repeats the header; under: how cells lie before them."""
    for number, text in lines:
        cells = cells_of(table, text)
        again = under_header(table, cells) if names_again(table.layout, cells) else None
        if again is not None and again != under:
            return Begun(number, _more(again), again)
        below, moved = number == repeated + 1, under.in_order(cells)
        # a row of units that repeats the first header's says others where the names have moved
        others = below and under.moved and other_units(table.layout, moved)
        if again is not None or (not others and repeats_header(table, text, under)):
            repeated = number
            continue
        if reason := begins_another(table.layout, moved, text, below):
            return Begun(number, reason)
    return None


def last_repeated(table: Table, lines: Sequence[tuple[int, str]], under: Under) -> int:
    """The number of the last line that repeats the header, -1 where none does."""
    return next((number for number, text in reversed(lines) if repeats_header(table, text, under)), -1)


def repeats_header(table: Table, text: str, under: Under) -> bool:
    """Whether a line repeats one above the data, or the header that its rows lie under. A row of units below that has
    moved with the names."""
    if table.repeats_header(text):
        return True
    if not under.moved:
        return False
    cells = cells_of(table, text)
    if names_again(table.layout, cells) and under_header(table, cells) == under:
        return True
    return table.repeats_header(table.delimiter.join(under.in_order(cells)))


def cells_of(table: Table, text: str) -> list[str]:
    """The cells of a line, without blanks and quotes around them."""
    return [clean(c) for c in fields(text, table.delimiter, table.quoted)]


def _more(under: Under) -> str:
    """What is told of columns that the table's own header does not name."""
    if not under.more:
        return ""
    names = ", ".join(f"'{name}'" for name in under.more)
    return f"columns begin here that the first header does not name, they are not read: {names}; split the file there"


def another_in_sheet(
    layout: Layout, head: Sequence[Sequence[Cell]], rows: Sequence[Sequence[Cell]], named: frozenset[int]
) -> tuple[int, str] | None:
    """The same of the rows of a sheet, counted from 0. head: the rows above them; named: those that name the columns
    anew."""
    repeats = repeated_in_sheet(head, rows) | named
    for number, row in enumerate(rows):
        if number not in repeats and all(isinstance(c, str) or c is None for c in row):
            cells = texts_of(row)
            shown = "; ".join(filter(None, cells))
            if reason := begins_another(layout, cells, shown, number - 1 in repeats):
                return number, reason
    return None


def in_one_order(
    layout: Layout, head: Sequence[Sequence[Cell]], rows: Sequence[Sequence[Cell]]
) -> tuple[Sequence[Sequence[Cell]], frozenset[int]]:
    """(the rows of a sheet, each cell under its own column though a header names them in another order from there on;
    such headers, counted from 0). head: the rows above them."""
    if len(layout.groups) > 1 or layout.fit is not None or any(layout.worded):
        return rows, frozenset()
    repeats = repeated_in_sheet(head, rows)
    under: Under | None = None
    made, named = list(rows), set[int]()
    for number, row in enumerate(rows):
        if number in repeats:
            under = None
            continue
        texts = texts_of(row) if all(isinstance(c, str) or c is None for c in row) else []
        found = under_names(layout, [True] * len(layout.names), texts) if names_again(layout, texts) else None
        if found is not None and not found.more:
            under = found if found.moved else None
            named.add(number)
        elif under is not None:
            made[number] = [row[p] if 0 <= p < len(row) else None for p in under.at]
    return (made, frozenset(named)) if named else (rows, frozenset())


def repeated_in_sheet(head: Sequence[Sequence[Cell]], rows: Sequence[Sequence[Cell]]) -> frozenset[int]:
    """The rows of a sheet that repeat one above the data, counted from 0."""
    repeats = repeats_of(head)
    return frozenset(n for n, row in enumerate(rows) if repeats(row))


def begins_another(layout: Layout, cells: Sequence[str], shown: str, below: bool) -> str:
    """Why a row begins another table; '' where it does not. below: it stands directly below a row that repeats the
    header, else what looks like units is a mark, or a channel's word."""
    if layout.fit is not None:
        cells = [str(c) for c in layout.fit.over(cells)]
    if names_again(layout, cells):
        return f"another header begins here, nothing after it is read: '{shown[:_SHOWN]}'; split the file there"
    other = other_units(layout, cells) if below else ""
    return f"other units begin here, nothing after it is read: {other}; split the file there" if other else ""


def names_again(layout: Layout, cells: Sequence[str]) -> bool:
    """Whether a line names the time as the header does."""
    said = [(cells[i], layout.names[i], i) for i in layout.groups[0].time if i < len(cells)]
    named = len(said) == len(layout.groups[0].time) and any(cell for cell, _, _ in said)  # an empty cell names nothing
    return named and all((cell or f"column {i + 1}") == name for cell, name, i in said)


def other_units(layout: Layout, cells: Sequence[str]) -> str:
    """'dZ' in µm, in mm before: the columns of which a row of units says another one; '' where it is none, or says the
    same."""
    if any(cells[len(layout.names) :]) or not any(cells) or any(is_number(c) or is_stamp(c) for c in cells):
        return ""
    cells = [*cells, *[""] * (len(layout.names) - len(cells))]  # a line that is cut off
    if not of_units(cells, layout.time):
        return ""
    said = enumerate(zip(as_units(cells), layout.units, strict=False))
    changed = [
        (i, unit, was)
        for i, (unit, was) in said
        if unit and unit.strip("-–") and i not in layout.dated and _one_spelling(unit) != _one_spelling(was or "")
    ]
    return ", ".join(f"'{layout.names[i]}' in {unit}, in {was or 'no unit'} before" for i, unit, was in changed)


def _one_spelling(unit: str) -> str:
    """A unit in one spelling: 'degC' of '°C'."""
    return spelled(unit) or unit
