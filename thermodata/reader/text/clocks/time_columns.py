"""Which columns of a table are its time, and in what unit: declared, or by their values and names."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import Any

from thermodata.errors import FormatError, QuestionError, ThermodataError, UsageError, nearest
from thermodata.reader.text.cells.cell import Cell, is_clocked, is_dated, is_number, is_stamp, mostly, number_of
from thermodata.reader.text.cells.clock_pattern import BLANK, HALF, says_the_hour
from thermodata.reader.text.cells.time_pattern import part_of_a_second
from thermodata.reader.text.clocks.odd_clocks import clock_question
from thermodata.reader.text.clocks.start_and_end import interval_note
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
from thermodata.reader.text.clocks.zoned_beside import beside_note, zoned_beside
from thermodata.reader.text.names.called_column import by_name
from thermodata.reader.text.names.header import split_unit
from thermodata.reader.text.names.time_header import is_time_header, since_midnight
from thermodata.reader.text.times.clock_numbers import columns_of_clock
from thermodata.reader.text.times.clock_words import said_clock
from thermodata.reader.text.times.date_parts import find_parts
from thermodata.reader.text.times.spans import are_spans
from thermodata.reader.text.times.time_cells import part_question, with_parts, zone_notes
from thermodata.reader.times.open_questions import UNKNOWN
from thermodata.reader.times.time_units import SECONDS

_FRACTION = re.compile(rf":\d\d:\d\d[.,:]\d+{BLANK}*({HALF})?$")


def column(wanted: int | str, names: Sequence[str], where: str) -> int:
    """The place of a declared column (1-based, or by its name), from 0."""
    if isinstance(wanted, int):
        if not 1 <= wanted <= len(names):
            raise FormatError(f"no column {wanted}", where=where, expected=f"1 to {len(names)}", got=str(wanted))
        return wanted - 1
    if (found := by_name(wanted, names)) is not None:
        return found
    close = nearest(wanted, names)
    raise UsageError(
        f"no time column '{wanted}'",
        where=where,
        expected=", ".join(names[:30]),
        got=wanted,
        hint=f"did you mean '{close}'?" if close else None,
    )


def time_of(
    said: Mapping[str, Any],
    names: list[str],
    units: list[str | None],
    data: list[list[Cell]],
    where: str,
    likely: tuple[int, ...] = (),
) -> tuple[tuple[int, ...], str | None, str | None, list[str]]:
    """(time columns, unit or None for dates, format, notes). likely: columns that are called times in other words."""
    wanted, unit, form = said.get("column"), said.get("unit"), said.get("format")
    told = form is not None or unit is not None
    if wanted is not None:
        columns = tuple(column(w, names, where) for w in (wanted if isinstance(wanted, list | tuple) else [wanted]))
        if not told and (asked := zone_question(names, data, where, columns)) is not None:
            raise asked
        parts = find_parts([names[i] for i in columns], [[r[i] for i in columns] for r in data])
        if not told and parts is not None and len(parts[0]) == len(columns):
            return tuple(columns[i] for i in parts[0]), None, parts[1], []
    else:
        if not told:
            parts, asked = _parts_or_question(names, units, data, where, likely)
            if asked is not None:
                raise asked
            if parts is not None:
                every = with_parts(parts[0], names, data)
                shown = ", ".join(f"'{names[i]}'" for i in every)
                noted = [f"the time stands in {len(every)} columns: {shown}", *zone_notes(every, names, data)]
                return every, None, parts[1], noted
        try:
            columns = find_time(names, units, data, where, likely)
        except FormatError:
            # of one of several times the columns count from its own first
            worded = None if likely else worded_time(names, data)
            if worded is None or form in (None, UNKNOWN):
                question = time_question(names, data, where) if likely else no_time(names, data, where)
                if question is None:
                    raise
                raise question from None
            columns = (worded[0],)
        open_part: ThermodataError | None = None
        if not told and not likely:
            open_part = (
                weeks_question(columns, names, data, where)
                or joined_question(columns, names, data, where)
                or clock_question(columns, names, data, where)
                or part_question(columns, names, data, where)
                or _fraction_beside(columns, names, data, where)
            )
        if open_part is not None:
            raise open_part
    cells = [row[columns[0]] for row in data]
    numeric = sum(map(is_number, cells)) * 2 > len(cells)
    notes = zone_notes(columns, names, data)
    if wanted is None:
        notes += [*beside_note(columns[0], names, data), *interval_note(columns, names, data)]
    name = names[columns[0]]
    if form is None and unit is None and len(columns) == 1:
        form = said_clock(name, units[columns[0]], cells) or (since_midnight(name) if numeric else None)
    if form is not None or (not numeric and unit is None):
        return columns, None, form, notes
    known, more = unit_of_numbers(columns[0], names, units, data, unit, where)
    return columns, known, None, [*notes, *more]


def find_time(
    names: list[str], units: list[str | None], data: list[list[Cell]], where: str, likely: tuple[int, ...] = ()
) -> tuple[int, ...]:
    """A date, a date and a time of day, a time of day, numbers under a word for time, or a first column in a unit of
    time, in this order. FormatError where there is none."""
    width = len(names)

    filled = [[r[i] for r in data if r[i] not in ("", None)] for i in range(width)]

    def share(column: int, test: Any, least: float) -> bool:
        return bool(filled[column]) and mostly(filled[column], test, least, len(filled[column]))

    words = [i for i in range(width) if i in likely or is_time_header(names[i])]
    dates = [i for i in range(width) if share(i, is_dated, 0.8)]
    clocks = [i for i in range(width) if share(i, is_clocked, 0.8)]
    of_day = [i for i in words if since_midnight(names[i]) is not None and share(i, is_number, 0.6)]
    standing = _standing(
        {i: [c for c in filled[i] if is_dated(c)] for i in dates},
        [*([c for c in filled[i] if is_clocked(c)] for i in clocks), *(filled[i] for i in of_day)],
    )
    numbers = [i for i in words if share(i, is_number, 0.6)]
    counting = any(_numbers_go_on(filled[i]) for i in numbers)
    if counting and not clocks and not of_day:
        standing |= {i for i in dates if _days_of_many_rows(filled[i])}
    if len(standing) == len(dates) and not (counting or _parts_go_on(names, data)):
        standing = set()
    dates = [i for i in dates if i not in standing]
    if dates:
        of_hours = [i for i in dates if _tell_the_hour(filled[i])]
        first = zoned_beside(next((i for i in dates if i in words), dates[0]), of_hours, names, data)
        sample = filled[first][0]
        has_clock = says_the_hour(sample) if isinstance(sample, str) else not clocks or _tell_the_hour(filled[first])
        found: tuple[int, ...] = (first,) if has_clock or not clocks else (first, clocks[0])
        if not clocks and not _tell_the_hour(filled[first]):
            found = (first, *columns_of_clock(first, names, data))
        whole = with_parts(found, names, data)
        if whole != found:
            return whole
        return (*found, *_parts_of_a_second(found[-1] + 1, names, [r[found[-1]] for r in data], data))
    if clocks:
        return with_parts((clocks[0],), names, data)
    if numbers:
        # a "t" may be many things beside a column that is called time
        return (min(numbers, key=lambda i: split_unit(names[i])[0].strip(" .:") == "t"),)
    if (units[0] or "").strip().lower() in SECONDS and share(0, is_number, 0.6):
        return (0,)
    spans = [i for i in range(width) if (is_time_header(names[i]) or not _named(names[i])) and _are_rising(filled[i])]
    if spans:
        return (spans[0],)
    damaged = [i for i in range(width) if i not in standing and share(i, is_dated, 0.3)]
    if damaged:
        return (damaged[0],)
    raise FormatError(
        "no time column found",
        where=where,
        got=", ".join(names[:12]),
        expected="a column of dates, or one called time or with s, min or h as its unit",
        hint="declare table: {time: {column: 1, unit: s}}, or time: {period: 60 s} for rows that nothing dates",
    )


def _fraction_beside(
    columns: tuple[int, ...], names: list[str], data: list[list[Cell]], where: str
) -> QuestionError | None:
    """What to ask where a day alone was found, and a column that is called a time holds parts of a day, or
    clocks in one number."""
    if len(columns) != 1 or not any(is_dated(r[columns[0]]) and not _tell_the_hour([r[columns[0]]]) for r in data):
        return None
    times = [i for i, name in enumerate(names) if i not in columns and is_time_header(name)]
    return next((q for i in times if (q := of_day_question(i, names, data, where)) is not None), None)


def _named(header: str) -> bool:
    """Whether a column has a name of its own."""
    return re.fullmatch(r"column \d+|Unnamed: \d+|index", header) is None


def _are_rising(cells: Sequence[Cell]) -> bool:
    """Whether cells are spans of time (10 sec, 0 days 00:00:10) that differ."""
    texts = [c for c in cells if isinstance(c, str)]
    return len(texts) == len(cells) > 1 and len(set(texts)) > 1 and are_spans(texts)


def _tell_the_hour(cells: Sequence[Cell]) -> bool:
    """Whether dates hold a time of day; those of a workbook, one that is not midnight in all of them."""
    return any(
        says_the_hour(c) if isinstance(c, str) else bool(hasattr(c, "hour") and (c.hour or c.minute or c.second))
        for c in cells
    )


def _standing(dates: Mapping[int, Sequence[Cell]], clocks: Sequence[Sequence[Cell]]) -> set[int]:
    """Columns of dates that are one and the same in all rows: of when something was calibrated, not of when rows were
    measured. A day stands beside a time of day that goes on."""
    running = any(len(set(cells)) > 1 for cells in clocks)
    return {i for i, cells in dates.items() if len(set(cells)) == 1 and not (running and not _tell_the_hour(cells))}


def _days_of_many_rows(cells: Sequence[Cell]) -> bool:
    """Whether dates without a time of day repeat: they can't tell the rows of a day apart."""
    return len(set(cells)) < len(cells) and not _tell_the_hour(cells)


def _numbers_go_on(cells: Sequence[Cell]) -> bool:
    """Whether numbers grow from row to row, as seconds from a start do."""
    values = [v for c in cells if (v := number_of(c)) is not None]
    return len(values) > 1 and all(a < b for a, b in pairwise(values))


def _parts_go_on(names: list[str], data: list[list[Cell]]) -> bool:
    """Whether a date in columns of its own differs from row to row."""
    parts = find_parts(names, data)
    return parts is not None and len({tuple(r[i] for i in parts[0]) for r in data}) > 1


def _parts_or_question(
    names: list[str], units: list[str | None], data: list[list[Cell]], where: str, likely: tuple[int, ...]
) -> tuple[tuple[tuple[int, ...], str] | None, QuestionError | None]:
    """(columns and format of a date in parts where no other column tells the whole time, the question of its zone)."""

    def found(rows: list[list[Cell]]) -> tuple[int, ...]:
        try:
            return find_time(names, units, rows, where, likely)
        except FormatError:
            return ()

    columns = found(data)
    bare = [[without_word(c) for c in r] for r in (*data[:ZONED_ROWS], *data[-ZONED_ROWS:])]
    # dates that only a word behind them keeps from being the time
    would = tuple(i for i in found(bare) if is_time_header(names[i]) and any(is_dated(r[i]) for r in bare))
    parts = find_parts(names, data)
    if parts is not None and not any(_tells_all(c, parts[0], rows) for c, rows in ((columns, data), (would, bare))):
        return parts, None
    return None, zone_question(names, data, where, {*columns, *would} or range(len(names)))


def _tells_all(columns: tuple[int, ...], parts: tuple[int, ...], data: list[list[Cell]]) -> bool:
    """Whether time columns, none of which is a part of a date, hold more than a day or a time of day: dates with a time
    of day, or numbers."""
    if not columns or not parts or set(columns) & set(parts):
        return False
    cells = [r[columns[0]] for r in data if r[columns[0]] not in ("", None)]
    if not any(map(is_dated, cells)):
        return not any(map(is_clocked, cells))
    return len(columns) > 1 or _tell_the_hour(cells)


def _parts_of_a_second(column: int, names: list[str], times: Sequence[Cell], data: list[list[Cell]]) -> tuple[int, ...]:
    """The column of text behind a date and time of whole seconds that holds their parts, where there is one."""
    form = part_of_a_second(names[column]) if column < len(names) else None
    if form is None or form.pattern is None:
        return ()
    pairs = [(t, r[column]) for t, r in zip(times, data, strict=True) if is_stamp(t)]  # a repeated header is none
    whole = all(isinstance(t, str) and not _FRACTION.search(t.strip()) for t, _ in pairs)
    good = all(isinstance(c, str) and form.pattern.fullmatch(c) for _, c in pairs)
    return (column,) if pairs and whole and good else ()
