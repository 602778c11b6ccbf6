"""Times of day in numbers: `Hour` and `Minute` beside a date, a fraction of its day as sheets keep it, and days of the
year (Campbell's `Year, DOY, HHMM`, also without a header). Read cell by cell, each different text once."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from datetime import date
from functools import partial
from itertools import pairwise

from thermodata.errors import QuestionError
from thermodata.reader.text.cells.cell import Cell, is_dated, is_empty, is_number, mostly, number_of
from thermodata.reader.text.cells.first_rows import FirstRows
from thermodata.reader.text.cells.time_forms.clock_pattern import says_the_hour
from thermodata.reader.text.cells.time_forms.joined_clock import read_joined
from thermodata.reader.text.cells.time_forms.time_pattern import DAY_NS, TimeFormat
from thermodata.reader.text.names.header import split_unit
from thermodata.reader.text.names.time_header import since_midnight
from thermodata.reader.times.zone import NAT

_UNITS = {"H": DAY_NS // 24, "M": DAY_NS // 1440, "S": DAY_NS // 86400, "": DAY_NS}
_SINCE_MIDNIGHT, _MOST_DAYS = "since midnight", 1000
_OF_MIDNIGHT = {"s": 10**9, "ms": 10**6, "min": 60 * 10**9, "h": 3600 * 10**9}
_NUMBER = re.compile(r"\s*(?P<H>[\d.,eE+ ]+)\s*")
_MOST = {"H": 24.0, "M": 60.0, "S": 61.0, "": 1.0}
_WORDS = {
    letter: words.split()
    for letter, words in {
        "H": "hour hours stunde stunden std hodina heure ora hora hh hr h",
        "M": "minute minutes minuten minuta min mm mi mn",
        "S": "second seconds sekunde sekunden sekunda vteřina seconde secondo segundo sec sek ss",
    }.items()
}


def clock_of_numbers(name: str, cells: Sequence[Cell]) -> TimeFormat | None:
    """How numbers beside a date tell its time of day: hours, minutes or seconds by their name, or else a fraction of
    the day; None where they are none of these."""
    full = [c for c in cells if not is_empty(c)]
    if not full or not mostly(full, is_number, 0.9, len(full)):
        return None
    if (of_day := since_midnight_format(since_midnight(name))) is not None:
        return of_day
    word = split_unit(name)[0].strip(" #.:_").casefold()
    letter = next((k for k, words in _WORDS.items() if word in words), "")
    values = [v for c in full if (v := number_of(c)) is not None]
    if not all(0 <= v < _MOST[letter] for v in values):
        return None
    text = {"H": "hours", "M": "minutes", "S": "seconds", "": "a fraction of the day"}[letter]
    return TimeFormat("time", None, text, zoned=False, reads=partial(_clock_ns, _UNITS[letter], _MOST[letter]))


def since_midnight_format(declared: str | None) -> TimeFormat | None:
    """How numbers read that are declared as 's since midnight', or in ms, min or h: as times of day. None of others."""
    unit, _, what = (declared or "").partition(" ")
    if what != _SINCE_MIDNIGHT or unit not in _OF_MIDNIGHT:
        return None
    # which is of a time of day, whatever reads it
    return TimeFormat("time", _NUMBER, f"{unit} since midnight", reads=partial(_since_midnight, _OF_MIDNIGHT[unit]))


def _since_midnight(unit_ns: int, cell: str) -> int:
    value = number_of(cell) if is_number(cell) else None
    return NAT if value is None or not 0 <= value * unit_ns < _MOST_DAYS * DAY_NS else round(value * unit_ns)


def columns_of_clock(day: int, seen: FirstRows) -> tuple[int, ...]:
    """The columns behind a date that are called hour, minute and second and hold such numbers."""
    of_day = next((i for i, name in enumerate(seen.names) if i != day and since_midnight(name) is not None), None)
    if of_day is not None and clock_of_numbers(seen.names[of_day], seen.column(of_day)) is not None:
        return (of_day,)
    found: tuple[int, ...] = ()
    for letter, place in zip("HMS", range(day + 1, len(seen.names)), strict=False):
        word = split_unit(seen.names[place])[0].strip(" #.:_").casefold()
        if word not in _WORDS[letter] or clock_of_numbers(seen.names[place], seen.column(place)) is None:
            break
        found = (*found, place)
    return found


def fraction_question(place: int, seen: FirstRows) -> QuestionError | None:
    """What to ask of numbers below 1 that are called a time, beside days; None where they are none."""
    full = [v for r in seen.rows if (v := number_of(r[place])) is not None]
    if not full or not all(0 <= v < 1 for v in full) or len(set(full)) < 2:
        return None
    name = seen.names[place]
    for day in days_beside(place, seen):
        said = {"time": {"column": [day + 1, place + 1]}}
        return QuestionError(
            "numbers below 1 beside a date",
            where=f"{seen.where} column '{name}'",
            expected="a unit of time, or a fraction of the day",
            got=f"{full[0]:g}, {full[1]:g} ...",
            hint=f"declare table: {{time: {{column: [{day + 1}, {place + 1}]}}}} where they are a fraction of the day "
            f"in '{seen.names[day]}', else table: {{time: {{column: {place + 1}, unit: h}}}}",
            times=[seen.names[day], name],
            ask=f"column: is '{name}' a fraction of the day in '{seen.names[day]}'? else {{column: {place + 1}, "
            "unit: h}",
            declare=said,
            meanwhile=said,
        )
    return None


def days_beside(place: int, seen: FirstRows) -> Iterator[int]:
    """The other columns that hold dates without a time of day."""
    for day in (i for i in range(len(seen.names)) if i != place):
        cells = [r[day] for r in seen.rows if not is_empty(r[day])]
        if cells and mostly(cells, is_dated, 0.9, len(cells)) and not says_the_hour(str(cells[0])):
            yield day


def _clock_ns(unit_ns: int, most: float, cell: str) -> int:
    value = number_of(cell) if is_number(cell) else None
    if value is None or not 0 <= value < most:
        return NAT
    # a fraction of a day is kept to microseconds
    return round(value * unit_ns / 1000) * 1000 if unit_ns == DAY_NS else round(value * unit_ns)


def days_of_years(pieces: Sequence[str]) -> Callable[[str], int] | None:
    """What reads '2026 195 800' in the pieces '%Y', '%j', '%H%M' of a format; None where they are others."""
    if tuple(pieces[:2]) != ("%Y", "%j") or not all(p in _CLOCKS for p in pieces[2:]):
        return None
    return partial(_of_year, tuple(pieces))


def year_and_day(seen: FirstRows) -> tuple[tuple[int, ...], str] | None:
    """(columns, format) of a year, its day and a time of day that are called so: `Year, DOY, HHMM`; None where there
    are none. Without a header they are known by their values: a year, a day and a clock that goes on, side by side."""
    if all(name == f"column {i + 1}" for i, name in enumerate(seen.names)):
        return _by_values(seen)
    words = [split_unit(n)[0].strip(" #.:_").casefold() for n in seen.names]
    year = next((i for i, w in enumerate(words) if w in ("year", "jahr", "rok", "année", "año", "yyyy")), None)
    day = next((i for i, w in enumerate(words) if w in DAYS_OF_YEAR), None)
    if year is None or day is None:
        return None
    for form in (("hhmm", "%H%M"), ("hhmmss", "%H%M%S"), ("hour", "%H"), ("time", "%H%M")):
        clock = next((i for i, w in enumerate(words) if w == form[0]), None)
        if clock is None:
            continue
        reads = partial(_of_year, ("%Y", "%j", form[1]))
        if all(reads(f"{r[year]} {r[day]} {r[clock]}") != NAT for r in seen.rows):
            second = next((i for i, w in enumerate(words) if w in _WORDS["S"] and form[1] == "%H%M"), None)
            if second is not None and all(_is_second(r[second]) for r in seen.rows):
                return (year, day, clock, second), "%Y %j %H%M %S"
            return (year, day, clock), f"%Y %j {form[1]}"
    return None


def _is_second(cell: Cell) -> bool:
    return _CLOCKS["%S"](str(cell)) != NAT


def _by_values(seen: FirstRows) -> tuple[tuple[int, ...], str] | None:
    """The same by values; with seconds behind the clock where it alone does not go on, and rows of several kinds may
    have one time."""
    for form, least in (("%Y %j %H%M", 1.0), ("%Y %j %H%M %S", 0.5)):
        pieces = form.split()
        reads = partial(_of_year, tuple(pieces))
        for year in range(len(seen.names) - len(pieces)):
            times = [reads(" ".join(str(c) for c in r[year : year + len(pieces)])) for r in seen.rows]
            apart = len(set(zip(_kinds(seen, year), times, strict=True)))
            rises = all(a <= b for a, b in pairwise(times)) and apart >= least * len(times)
            if len(times) > 2 and min(times) > _SINCE_1990 and rises and len({r[year] for r in seen.rows}) <= 2:
                return tuple(range(year, year + len(pieces))), form
    return None


def _kinds(seen: FirstRows, year: int) -> list[Cell]:
    """What says of each row of which kind it is: a number of few before the year, as of Campbell's arrays."""
    kinds = [r[year - 1] if year else "" for r in seen.rows]
    return kinds if _MANY_OF_A_KIND * len(set(kinds)) <= len(kinds) else [""] * len(kinds)


_MANY_OF_A_KIND = 3  # rows, in the mean
_SINCE_1990 = 20 * 365 * DAY_NS  # a year of any log
DAYS_OF_YEAR = ("doy", "day of year", "dayofyear", "day_of_year", "julian day", "julianday", "julian", "jday", "yday")
_CLOCKS = {
    "%H%M": partial(read_joined, 4),
    "%H%M%S": partial(read_joined, 6),
    "%H": partial(_clock_ns, _UNITS["H"], _MOST["H"]),
    "%M": partial(_clock_ns, _UNITS["M"], _MOST["M"]),
    "%S": partial(_clock_ns, _UNITS["S"], _MOST["S"]),
}


def _of_year(pieces: tuple[str, ...], text: str) -> int:
    cells = text.split()
    if len(cells) != len(pieces) or not all(map(is_number, cells)):
        return NAT
    year, day = number_of(cells[0]) or 0.0, number_of(cells[1]) or 0.0
    if not (1900 <= year <= 2200 and 1 <= day < 367 and not year % 1 and not day % 1):
        return NAT
    total = (date(int(year), 1, 1).toordinal() - date(1970, 1, 1).toordinal() + int(day) - 1) * DAY_NS
    for piece, cell in zip(pieces[2:], cells[2:], strict=True):
        part = _CLOCKS[piece](cell)
        if part == NAT:
            return NAT
        total += part
    return total
