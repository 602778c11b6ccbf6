"""Which columns of a table hold its time, by their values and names, or as they are declared."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence, Set
from dataclasses import dataclass
from itertools import islice, pairwise

from thermodata.errors import FormatError, UsageError, nearest
from thermodata.reader.text.cells.cell import Cell, is_clocked, is_dated, is_number, is_stamp, mostly, number_of
from thermodata.reader.text.cells.first_rows import FirstRows
from thermodata.reader.text.cells.time_forms.clock_pattern import BLANK, HALF, says_the_hour
from thermodata.reader.text.cells.time_forms.time_pattern import part_of_a_second
from thermodata.reader.text.clocks.odd_clocks import are_pointed_clocks, looks_like_dates
from thermodata.reader.text.clocks.transposed import ADVICE, is_transposed
from thermodata.reader.text.clocks.zoned_beside import zoned_beside
from thermodata.reader.text.names.called_column import by_name
from thermodata.reader.text.names.header import split_unit
from thermodata.reader.text.names.of_text import OF_TEXT
from thermodata.reader.text.names.time_header import is_time_header, since_midnight
from thermodata.reader.text.times.one_cell.spans import are_spans
from thermodata.reader.text.times.several_cells.clock_numbers import columns_of_clock
from thermodata.reader.text.times.several_cells.date_parts import find_parts
from thermodata.reader.text.times.several_cells.time_cells import with_parts
from thermodata.reader.times.time_units import SECONDS

_HINT = "declare table: {time: {column: 1, unit: s}}, or time: {period: 60 s} for rows that nothing dates"
_FRACTION = re.compile(rf":\d\d:\d\d[.,:;]\d+{BLANK}*({HALF})?$")


def column(wanted: int | str, names: Sequence[str], where: str) -> int:
    """The place of a declared column (1-based, or by its name), from 0."""
    if isinstance(wanted, int):
        if not 1 <= wanted <= len(names):
            raise FormatError(
                f"no column {wanted}",
                where=where,
                expected=f"1 to {len(names)}",
                got=str(wanted),
                hint="columns count from 1; or give the name in the header",
            )
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


def find_time(seen: FirstRows, likely: tuple[int, ...] = ()) -> tuple[int, ...]:
    """A date, a date and a time of day, a time of day, numbers under a word for time, or a first column in a unit of
    time, in this order; then spans of time, and dates of which many are damaged. likely: columns that are taken to be
    called a time. FormatError where there is none."""
    columns = _looked_at(seen, likely)
    for way in (_by_dates, _by_clocks, _by_numbers, _by_first_unit, _by_spans, _by_damaged_dates):
        if found := way(columns):
            return found
    raise FormatError(
        "no time column found",
        where=seen.where,
        got=", ".join(seen.names[:12]),
        expected="a column of dates, or one called time or with s, min or h as its unit",
        hint=ADVICE if is_transposed(seen) else _HINT,
    )


@dataclass(frozen=True, slots=True)
class _Columns:
    """What the columns of a table look like. places: those that may be a time; filled: the cells of each that hold
    something; words: those that are called a time; dates: those of dates that go on; standing: those of dates that do
    not tell its rows apart; clocks: of times of day; pointed: of those with a point between hours and minutes, beside
    dates; numbers: of those that are called a time."""

    seen: FirstRows
    places: Sequence[int]
    filled: Sequence[Sequence[Cell]]
    words: Sequence[int]
    dates: Sequence[int]
    standing: Set[int]
    clocks: Sequence[int]
    pointed: Sequence[int]
    numbers: Sequence[int]


def _looked_at(seen: FirstRows, likely: tuple[int, ...]) -> _Columns:
    places = list(range(len(seen.names)))
    filled = [[r[i] for r in seen.rows if r[i] not in ("", None)] for i in places]
    # a moment in a comment is none of a row's
    places = [i for i in places if not (OF_TEXT.search(seen.names[i]) and 2 * len(filled[i]) < len(seen.rows))]
    words = [i for i in places if i in likely or is_time_header(seen.names[i])]
    dates = [i for i in places if _are(filled[i], is_dated, 0.8)]
    dates = [i for i in dates if not looks_like_dates(filled[i])] or dates  # beside a date they are times of day
    pointed = [i for i in words if dates and are_pointed_clocks(i, seen)]
    clocks = [i for i in places if _are(filled[i], is_clocked, 0.8)]
    of_day = [i for i in words if since_midnight(seen.names[i]) is not None and _are(filled[i], is_number, 0.6)]
    standing = _unchanging_dates(
        {i: [c for c in filled[i] if is_dated(c)] for i in dates},
        [*([c for c in filled[i] if is_clocked(c)] for i in clocks), *(filled[i] for i in of_day)],
    )
    numbers = [i for i in words if i not in pointed and _are(filled[i], is_number, 0.6)]
    counting = any(_numbers_go_on(filled[i]) for i in numbers)
    if counting and not clocks and not of_day:
        standing |= {i for i in dates if _days_of_many_rows(filled[i])}
    if len(standing) == len(dates) and not (counting or _parts_go_on(seen)):
        standing = set()
    dates = [i for i in dates if i not in standing]
    return _Columns(seen, places, filled, words, dates, standing, clocks, pointed, numbers)


def _are(cells: Sequence[Cell], test: Callable[[Cell], bool], least: float) -> bool:
    """Whether there are cells, and at least a share of them pass a test."""
    return bool(cells) and mostly(cells, test, least, len(cells))


def _by_dates(of: _Columns) -> tuple[int, ...]:
    """A date, with a time of day or parts of one beside it where it has none."""
    if not of.dates:
        return ()
    seen, filled, clocks = of.seen, of.filled, of.clocks
    of_hours = [i for i in of.dates if tell_the_hour(filled[i])]
    first = zoned_beside(next((i for i in of.dates if i in of.words), of.dates[0]), of_hours, seen)
    sample = filled[first][0]
    has_clock = says_the_hour(sample) if isinstance(sample, str) else not clocks or tell_the_hour(filled[first])
    found: tuple[int, ...] = (first,) if has_clock or not clocks else (first, clocks[0])
    if not clocks and not of.pointed and not tell_the_hour(filled[first]):
        found = (first, *columns_of_clock(first, seen))
    whole = with_parts(found, seen)
    if whole != found:
        return whole
    return (*found, *_parts_of_a_second(found[-1] + 1, seen, seen.column(found[-1])))


def _by_clocks(of: _Columns) -> tuple[int, ...]:
    return with_parts((of.clocks[0],), of.seen) if of.clocks else ()


def _by_numbers(of: _Columns) -> tuple[int, ...]:
    """Numbers under a word for time; a "t" may be many things beside a column that is called time."""
    if not of.numbers:
        return ()
    return (min(of.numbers, key=lambda i: split_unit(of.seen.names[i])[0].strip(" .:") == "t"),)


def _by_first_unit(of: _Columns) -> tuple[int, ...]:
    in_time = (of.seen.units[0] or "").strip().lower() in SECONDS
    return (0,) if in_time and _are(of.filled[0], is_number, 0.6) else ()


def _by_spans(of: _Columns) -> tuple[int, ...]:
    names = of.seen.names
    called = (i for i in range(len(names)) if is_time_header(names[i]) or not _has_own_name(names[i]))
    return tuple(islice((i for i in called if _are_rising(of.filled[i])), 1))


def _by_damaged_dates(of: _Columns) -> tuple[int, ...]:
    return tuple(islice((i for i in of.places if i not in of.standing and _are(of.filled[i], is_dated, 0.3)), 1))


def _has_own_name(header: str) -> bool:
    """Whether a column has a name of its own."""
    return re.fullmatch(r"column \d+|Unnamed: \d+|index", header) is None


def _are_rising(cells: Sequence[Cell]) -> bool:
    """Whether cells are spans of time (10 sec, 0 days 00:00:10) that differ."""
    texts = [c for c in cells if isinstance(c, str)]
    return len(texts) == len(cells) > 1 and len(set(texts)) > 1 and are_spans(texts)


def tell_the_hour(cells: Sequence[Cell]) -> bool:
    """Whether dates hold a time of day; those of a workbook, one that is not midnight in all of them."""
    return any(
        says_the_hour(c) if isinstance(c, str) else bool(hasattr(c, "hour") and (c.hour or c.minute or c.second))
        for c in cells
    )


def _unchanging_dates(dates: Mapping[int, Sequence[Cell]], clocks: Sequence[Sequence[Cell]]) -> set[int]:
    """Columns of dates that are one and the same in all rows: of when something was calibrated, not of when rows were
    measured. A day stands beside a time of day that goes on."""
    running = any(len(set(cells)) > 1 for cells in clocks)
    return {i for i, cells in dates.items() if len(set(cells)) == 1 and not (running and not tell_the_hour(cells))}


def _days_of_many_rows(cells: Sequence[Cell]) -> bool:
    """Whether dates without a time of day repeat: they can't tell the rows of a day apart."""
    return len(set(cells)) < len(cells) and not tell_the_hour(cells)


def _numbers_go_on(cells: Sequence[Cell]) -> bool:
    """Whether numbers grow from row to row, as seconds from a start do."""
    values = [v for c in cells if (v := number_of(c)) is not None]
    return len(values) > 1 and all(a < b for a, b in pairwise(values))


def _parts_go_on(seen: FirstRows) -> bool:
    """Whether a date in columns of its own differs from row to row."""
    parts = find_parts(seen)
    return parts is not None and len({tuple(r[i] for i in parts[0]) for r in seen.rows}) > 1


def _parts_of_a_second(column: int, seen: FirstRows, times: Sequence[Cell]) -> tuple[int, ...]:
    """The column of text behind a date and time of whole seconds that holds their parts, where there is one."""
    form = part_of_a_second(seen.names[column]) if column < len(seen.names) else None
    if form is None or form.pattern is None:
        return ()
    pairs = [(t, r[column]) for t, r in zip(times, seen.rows, strict=True) if is_stamp(t)]  # a repeated header is none
    whole = all(isinstance(t, str) and not _FRACTION.search(t.strip()) for t, _ in pairs)
    good = all(isinstance(c, str) and form.pattern.fullmatch(c) for _, c in pairs)
    return (column,) if pairs and whole and good else ()
