"""Lines within a table that begin another one: names in another order, or other units, as where a logger was set up
anew and its file went on. What stands behind them must not be taken for the columns above."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from thermodata.reader.text.cells.cell import Cell, is_number, is_stamp
from thermodata.reader.text.cells.lines.delimiter import fields
from thermodata.reader.text.cells.values.quotes import clean
from thermodata.reader.text.names.header_rows import texts_of
from thermodata.reader.text.names.units_row import as_units, of_units
from thermodata.reader.text.page.header.header_again import repeats_of
from thermodata.reader.text.page.layout import Layout
from thermodata.reader.text.tables.table import Table
from thermodata.schema.units.spelling import spelled

_SHOWN = 120  # letters of a line


def another_header(table: Table, lines: Iterable[tuple[int, str]], repeated: int) -> tuple[int, str] | None:
    """(number, what to tell) of the first line that begins another table. lines: those that are no rows of it;
    repeated: the number of the last line before them that repeats the header."""
    for number, text in lines:
        if table.repeats_header(text):
            repeated = number
            continue
        cells = [clean(c) for c in fields(text, table.delimiter, table.quoted)]
        if reason := begins_another(table.layout, cells, text, number == repeated + 1):
            return number, reason
    return None


def last_repeated(table: Table, lines: Sequence[tuple[int, str]]) -> int:
    """The number of the last line that repeats the header, -1 where none does."""
    return next((number for number, text in reversed(lines) if table.repeats_header(text)), -1)


def another_in_sheet(
    layout: Layout, head: Sequence[Sequence[Cell]], rows: Sequence[Sequence[Cell]]
) -> tuple[int, str] | None:
    """The same of the rows of a sheet, counted from 0. head: the rows above them."""
    repeats = repeated_in_sheet(head, rows)
    for number, row in enumerate(rows):
        if number not in repeats and all(isinstance(c, str) or c is None for c in row):
            cells = texts_of(row)
            shown = "; ".join(filter(None, cells))
            if reason := begins_another(layout, cells, shown, number - 1 in repeats):
                return number, reason
    return None


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
