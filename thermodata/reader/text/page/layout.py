"""How a table lies on its page: preamble, header rows, units, time columns. Declared, or found in its first rows."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from thermodata.errors import FormatError, QuestionError
from thermodata.reader.signals.by_place import BY_PLACE
from thermodata.reader.text.cells.cell import Cell, is_dated
from thermodata.reader.text.cells.first_rows import FirstRows
from thermodata.reader.text.names.before_values import names_before_values
from thermodata.reader.text.names.declared_names import declared_names, unused_note
from thermodata.reader.text.names.described import descriptions
from thermodata.reader.text.names.header import split_unit, unique
from thermodata.reader.text.names.header_rows import are_numbers, names_and_units, texts_of
from thermodata.reader.text.page.first_data import first_data, width_of
from thermodata.reader.text.page.header.head import Head
from thermodata.reader.text.page.header.header_again import repeats_of
from thermodata.reader.text.page.header.labelled_head import labelled_head
from thermodata.reader.text.page.header.line_up import Fit, line_up, units_by_keyword
from thermodata.reader.text.page.header.lines_between import lines_between
from thermodata.reader.text.page.header.misfit import refuse_misfit
from thermodata.reader.text.page.header.units_misfit import refuse_units_misfit
from thermodata.reader.text.page.timed.find_groups import find_groups
from thermodata.reader.text.page.timed.from_epoch import answer_of, from_epoch, stated_epoch
from thermodata.reader.text.page.timed.from_start import with_start
from thermodata.reader.text.page.timed.group import Group
from thermodata.reader.text.preamble.head_interval import against_interval, with_interval

_ROWS_BELOW = 200  # of data, by which columns are told
_OFTEN = 0.05  # of the rows, that have a number of cells of their own: no damage
_DATE = 8  # letters of a date by which it is known: "2026-03-", "02.03.20"


@dataclass(frozen=True)
class Layout:
    """first: rows before the data (preamble, header, units). names: header of each column as in the file, without
    blanks around it. groups: one, or several where columns have times of their own. over: the head that stands over
    several names, '' where there is none; described: what the file says of each column elsewhere, '' for nothing; fit:
    how the cells of the header were put over the columns, None where they stood there; worded: the word before the
    values of each column that is called by it, '' for none."""

    first: int
    names: tuple[str, ...]
    units: tuple[str | None, ...]
    groups: tuple[Group, ...]
    notes: tuple[str, ...] = ()
    over: tuple[str, ...] = ()
    described: tuple[str, ...] = ()
    fit: Fit | None = None
    worded: tuple[str, ...] = ()

    def said_of(self, column: int) -> dict[str, str]:
        """The properties of a signal: the head of the group that it stands in, what the file says of it, and its place
        where it is called by words in the rows."""
        said = {
            "group": self.over[column] if self.over else "",
            "description": self.described[column] if self.described else "",
            BY_PLACE: f"column {column + 1}" if self.worded and self.worded[column] else "",
        }
        return {key: text for key, text in said.items() if text}

    @property
    def time(self) -> tuple[int, ...]:
        """The time columns of all groups."""
        return tuple(i for g in self.groups for i in g.time)

    @property
    def dated(self) -> tuple[int, ...]:
        """Columns of dates and times that are read as text."""
        return tuple(i for g in self.groups if g.dated for i in g.time)

    @property
    def of_dates(self) -> bool:
        """Whether the times of some group are dates, or count from one."""
        return any(g.epoch is not None or (g.dated and not g.counted) for g in self.groups)

    def stream_of(self, column: int) -> str:
        return next(g.stream for g in self.groups if column in g.columns)


@dataclass(frozen=True, slots=True)
class _Header:
    """What the rows above the data say of each column, as in `Layout`. worded: column -> the word before its values;
    unused: the note on declared names that are not taken."""

    names: list[str]
    units: list[str | None]
    over: list[str]
    described: list[str]
    worded: dict[int, str]
    unused: str | None


def find_layout(
    rows: Sequence[Sequence[Cell]], declared: Mapping[str, Any] | None, where: str, between: str | None = None
) -> Layout:
    """The layout of a table from its first rows (some hundred suffice). declared: the campaign file's `table`; between:
    what parts the cells of a text, as messages show it, where a header of another number of cells is refused.

    FormatError where no data, or no time column, can be found; QuestionError where the times leave open what they say.
    """
    said = {k: v for k, v in (declared or {}).items() if v is not None}
    skip = int(said.get("skip_rows", 0))
    width = width_of(rows[skip:])
    first = _first_row(rows, said, skip, width, where)
    called = units_by_keyword(rows[skip:first], width)
    row_of_units = int(said["units_row"]) - 1 - skip if "units_row" in said else called
    below = rows[first : first + _ROWS_BELOW]
    above, fit = line_up(rows[skip:first], below, width, row_of_units, between == "blanks")
    lines = [texts_of(r) for r in above]
    above, settings = labelled_head(above, below, width)
    head = Head(above, below, width, row_of_units, skip, between, where)
    lacking = None if between is None else _refuse_misfits(head, said)
    header = _header(head, said)
    repeats = repeats_of(rows[skip:first])
    data = _whole_rows([r for r in below if not repeats(r)], width)
    if not data:
        raise FormatError(
            "a table without data rows",
            where=where,
            expected=f"data after row {first}",
            hint="ask the logger for the export again; a log with nothing in it can be left out of the campaign",
        )
    lost = list[str]()
    if "header_rows" not in said:
        lost = lines_between(head, header.names, header.units)
    seen = FirstRows(header.names, header.units, data, where)
    groups, notes = _beside_other_kinds(*_times(said.get("time"), seen, lines), below, width)
    time = groups[0].time[:1] if not said.get("time") and len(groups) == 1 else ()
    against = [against_interval(header.names[i], seen.column(i), groups[0].seconds, lines) for i in time]
    worded = ", ".join(header.worded.values())
    by_words = f"columns are called by the words before their values: {worded}" if worded else None
    noted = (*notes, *lost, by_words, fit.note if fit else None, lacking, header.unused, settings, *against)
    return Layout(
        first,
        tuple(header.names),
        tuple(header.units),
        tuple(groups),
        tuple(note for note in noted if note),
        tuple(header.over),
        tuple(header.described),
        fit,
        tuple(header.worded.get(i, "") for i in range(width)) if header.worded else (),
    )


def _first_row(rows: Sequence[Sequence[Cell]], said: Mapping[str, Any], skip: int, width: int, where: str) -> int:
    """The place of the first row of data, declared or found; FormatError where there is none."""
    header = said.get("header_rows")
    if header is not None:
        return max(skip + int(header), int(said.get("units_row", 0)))
    body = [r[:width] for r in rows[skip:]]
    first = first_data(body, width, where)
    date = next((str(c)[:_DATE] for c in body[first] if is_dated(c)), None)
    while first and _is_torn(body[first - 1], width, date):
        first -= 1
    return first + skip


def _header(head: Head, said: Mapping[str, Any]) -> _Header:
    """Declared names have the last word."""
    above, below, width = head.above, head.below, head.width
    heads, units, over = names_and_units([r[:width] for r in above], width, head.row_of_units)
    worded = names_before_values(heads, below) if "names" not in said and not any(units) else {}
    heads = [worded.get(i, name) for i, name in enumerate(heads)]
    units = [split_unit(worded[i])[1] if i in worded else unit for i, unit in enumerate(units)]
    unused = None
    if "names" in said and list(said["names"]) != heads:
        unused = unused_note(heads, below, head.ends, said, head.where)
        if unused is None:
            heads = declared_names(said["names"], width, head.where)
            units = [split_unit(name)[1] for name in heads]
    described, listed = descriptions([texts_of(r) for r in above], heads)
    units = [unit or other for unit, other in zip(units, listed, strict=True)]
    return _Header(unique(heads), units, over, described, worded, unused)


def _times(declared: Any, seen: FirstRows, lines: Sequence[Sequence[str]]) -> tuple[list[Group], list[str]]:
    """(the groups of columns with one time, notes): by the columns, and by what lines above them say that times count
    from. declared: `table: {time: ...}`; lines: the cells above the data. QuestionError where both leave it open."""
    stated = stated_epoch(declared, lines)
    try:
        groups, notes = find_groups(declared or {}, seen)
        if stated is not None:
            groups, notes = from_epoch(stated, groups, notes, seen)
        return groups, notes
    except QuestionError as question:
        answer = None if stated is None else answer_of(stated, seen)
        if stated is None or answer is None:
            raise with_start(with_interval(question, lines), seen, lines) from None
    groups, notes = find_groups(answer, seen)
    return groups, [*notes, stated.note(answer["unit"])]


def _refuse_misfits(head: Head, said: Mapping[str, Any]) -> str | None:
    """A note on names that are lacking; refuses a header, or units, that can't be those of the rows."""
    lacking = None
    if "header_rows" not in said:
        times = said.get("time") or {}
        told = not isinstance(times, Mapping) or times.get("column") is not None
        lacking = refuse_misfit(head, told=told)
    if "names" not in said:
        refuse_units_misfit(head)
    return lacking


def _beside_other_kinds(
    groups: list[Group], notes: list[str], rows: Sequence[Sequence[Cell]], width: int
) -> tuple[list[Group], list[str]]:
    """The same, where rows of another kind stand among those whose number tells their time."""
    if not groups[0].counted or not (others := _other_kinds(rows, width)):
        return groups, notes
    note = (
        f"rows of {' or '.join(map(str, sorted(others)))} cells stand among those of {width}: they are of another "
        "kind, not read, and take no time"
    )
    return [replace(g, others=others) for g in groups], [*notes, note]


def _other_kinds(rows: Sequence[Sequence[Cell]], width: int) -> frozenset[int]:
    """The numbers of cells of rows that are of no damage: that come again and again with cells of their own."""
    full = [r for r in rows if any(c not in ("", None) for c in r)]
    widths = Counter(len(r) for r in full if len(r) > 1)
    return frozenset(n for n, many in widths.items() if n != width and many > max(1, _OFTEN * len(full)))


def _whole_rows(rows: Sequence[Sequence[Cell]], width: int) -> list[list[Cell]]:
    """The rows that say what columns hold: as wide as the table, or as many others (where a group has ended); a row of
    a width of its own is damaged, and says nothing. Short ones are filled with empty cells."""
    full = [r for r in rows if any(c not in ("", None) for c in r)]
    widths = Counter(len(r) for r in full)
    usual = {n for n, many in widths.items() if n == width or many > max(1, _OFTEN * len(full))}
    return [[*r[:width], *[""] * (width - len(r))] for r in full if len(r) in usual or len(full) < 3]


def _is_torn(row: Sequence[Cell], width: int, date: str | None) -> bool:
    """Whether a row above the first good one is data all the same: with a date and something beside it, with a cell
    that begins with the date of the first good row, or of numbers only but for its destroyed time. Its loss is told;
    taken for a header, it would be gone without a word."""
    filled = [c for c in row if c not in ("", None)]
    if len(filled) < 2:
        return False
    if any(is_dated(c) for c in filled[:2]) or (date is not None and any(str(c)[:_DATE] == date for c in filled)):
        return True
    return len(row) == width and len(filled) > 2 and are_numbers(filled) and any("." in str(c) for c in filled)
