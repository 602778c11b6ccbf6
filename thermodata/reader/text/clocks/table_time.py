"""The time of a table: which columns hold it, in what unit or how it is written. Declared, or found."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from thermodata.errors import FormatError, QuestionError
from thermodata.reader.text.cells.cell import Cell, is_clocked, is_dated, is_number
from thermodata.reader.text.cells.first_rows import FirstRows
from thermodata.reader.text.clocks.odd_clocks import clock_question, day_question
from thermodata.reader.text.clocks.start_and_end import interval_note
from thermodata.reader.text.clocks.time_columns import column, find_time, tell_the_hour
from thermodata.reader.text.clocks.time_questions import (
    ZONED_ROWS,
    joined_question,
    no_time,
    of_day_question,
    time_question,
    weeks_question,
    without_word,
    worded_time,
    zone_question,
)
from thermodata.reader.text.clocks.unit_of_numbers import unit_of_numbers
from thermodata.reader.text.clocks.zoned_beside import beside_note
from thermodata.reader.text.names.time_header import is_time_header, since_midnight
from thermodata.reader.text.times.one_cell.clock_words import said_clock
from thermodata.reader.text.times.several_cells.date_parts import find_parts
from thermodata.reader.text.times.several_cells.time_cells import part_question, with_parts, zone_notes
from thermodata.reader.times.open_questions import UNKNOWN


@dataclass(frozen=True, slots=True)
class TableTime:
    """columns: that hold the time together, from 0; unit: of numbers, with their epoch where they have one (`s`,
    `unix_ms`), None for dates and times of day; form: how these are written, None where their cells tell; notes: what
    a user is told of it."""

    columns: tuple[int, ...]
    unit: str | None = None
    form: str | None = None
    notes: tuple[str, ...] = ()


def time_of(said: Mapping[str, Any], seen: FirstRows, likely: tuple[int, ...] = ()) -> TableTime:
    """The time of a table, or of a group of its columns. said: what is declared of it (`column`, `unit`, `format`);
    likely: columns that are called times in other words.

    QuestionError where its cells leave open what they say; FormatError where no column is a time; UsageError for a
    declared column that is not there."""
    wanted, unit, form = said.get("column"), said.get("unit"), said.get("format")
    told = form is not None or unit is not None  # then nothing is asked of how it is written
    if wanted is not None:
        columns = tuple(
            column(w, seen.names, seen.where) for w in (wanted if isinstance(wanted, list | tuple) else [wanted])
        )
        if not told and (parts := _declared_parts(columns, seen)) is not None:
            return parts
    else:
        if not told and (parts := _found_parts(seen, likely)) is not None:
            return parts
        columns = _time_columns(form, seen, likely)
        if not told and not likely:
            _ask_what_is_open(columns, seen)
    notes = zone_notes(columns, seen)
    if wanted is None:
        notes += [*beside_note(columns[0], seen), *interval_note(columns, seen)]
    cells = seen.column(columns[0])
    numeric = sum(map(is_number, cells)) * 2 > len(cells)
    if not told and len(columns) == 1:
        name = seen.names[columns[0]]
        form = said_clock(name, seen.units[columns[0]], cells) or (since_midnight(name) if numeric else None)
    if form is not None or (not numeric and unit is None):
        return TableTime(columns, None, form, tuple(notes))
    known, more = unit_of_numbers(columns[0], seen, unit)
    return TableTime(columns, known, None, (*notes, *more))


def _declared_parts(columns: tuple[int, ...], seen: FirstRows) -> TableTime | None:
    """Declared columns all of which are parts of a date, in their order. QuestionError: the zone is open."""
    if (asked := zone_question(seen, columns)) is not None:
        raise asked
    parts = find_parts(seen.of(columns))
    if parts is None or len(parts[0]) != len(columns):
        return None
    return TableTime(tuple(columns[i] for i in parts[0]), None, parts[1])


def _found_parts(seen: FirstRows, likely: tuple[int, ...]) -> TableTime | None:
    """A date in parts, where no other column tells the whole time. QuestionError: the zone of another one is open."""

    def found(there: FirstRows) -> tuple[int, ...]:
        try:
            return find_time(there, likely)
        except FormatError:
            return ()

    columns = found(seen)
    bare = [[without_word(c) for c in r] for r in (*seen.rows[:ZONED_ROWS], *seen.rows[-ZONED_ROWS:])]
    # dates that only a word behind them keeps from being the time
    would = tuple(
        i for i in found(seen.with_rows(bare)) if is_time_header(seen.names[i]) and any(is_dated(r[i]) for r in bare)
    )
    parts = find_parts(seen)
    if parts is not None and not any(
        _tells_all(c, parts[0], rows) for c, rows in ((columns, seen.rows), (would, bare))
    ):
        every = with_parts(parts[0], seen)
        shown = ", ".join(f"'{seen.names[i]}'" for i in every)
        notes = (f"the time stands in {len(every)} columns: {shown}", *zone_notes(every, seen))
        return TableTime(every, None, parts[1], notes)
    asked = zone_question(seen, {*columns, *would} or range(len(seen.names)))
    if asked is not None:
        raise asked
    return None


def _tells_all(columns: tuple[int, ...], parts: tuple[int, ...], data: Sequence[Sequence[Cell]]) -> bool:
    """Whether time columns, none of which is a part of a date, hold more than a day or a time of day: dates with a time
    of day, or numbers."""
    if not columns or not parts or set(columns) & set(parts):
        return False
    cells = [r[columns[0]] for r in data if r[columns[0]] not in ("", None)]
    if not any(map(is_dated, cells)):
        return not any(map(is_clocked, cells))
    return len(columns) > 1 or tell_the_hour(cells)


def _time_columns(form: str | None, seen: FirstRows, likely: tuple[int, ...]) -> tuple[int, ...]:
    """The columns of `find_time`, or times in words whose `form` is declared. QuestionError, FormatError: there is
    none."""
    try:
        return find_time(seen, likely)
    except FormatError:
        # of one of several times the columns count from its own first
        worded = None if likely else worded_time(seen)
        if worded is not None and form not in (None, UNKNOWN):
            return (worded[0],)
        question = time_question(seen) if likely else no_time(seen)
        if question is None:
            raise
        raise question from None


def _ask_what_is_open(columns: tuple[int, ...], seen: FirstRows) -> None:
    """QuestionError where the cells of a time that was found leave open what they say."""
    asked = (
        weeks_question(columns, seen)
        or joined_question(columns, seen)
        or clock_question(columns, seen)
        or day_question(columns, seen)
        or part_question(columns, seen)
        or _fraction_beside(columns, seen)
    )
    if asked is not None:
        raise asked


def _fraction_beside(columns: tuple[int, ...], seen: FirstRows) -> QuestionError | None:
    """What to ask where a day alone was found, and a column that is called a time holds parts of a day, or
    clocks in one number."""
    if len(columns) != 1 or not any(is_dated(r[columns[0]]) and not tell_the_hour([r[columns[0]]]) for r in seen.rows):
        return None
    times = [i for i, name in enumerate(seen.names) if i not in columns and is_time_header(name)]
    return next((q for i in times if (q := of_day_question(i, seen)) is not None), None)
