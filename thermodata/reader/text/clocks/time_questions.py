"""What to ask where a table does not say its times: the unit, the format, the zone, or the time from row to row."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence

import numpy as np

from thermodata.errors import QuestionError
from thermodata.plugin import Array
from thermodata.reader.text.cells.cell import Cell, is_clocked, is_number, is_stamp, mostly, number_of
from thermodata.reader.text.cells.first_rows import FirstRows
from thermodata.reader.text.cells.time_forms.joined_clock import format_of_joined
from thermodata.reader.text.cells.time_forms.zone_words import ANY_ZONE, HOURS, SEVERAL, word_behind
from thermodata.reader.text.clocks.counts_of_days import count_question, excel_or_question, may_be_excel
from thermodata.reader.text.clocks.counts_of_seconds import far_question
from thermodata.reader.text.clocks.format_question import format_question
from thermodata.reader.text.names.time_header import is_time_header
from thermodata.reader.text.times.one_cell.odd_stamps import fitting_formats, guess_format
from thermodata.reader.text.times.several_cells.clock_numbers import (
    DAYS_OF_YEAR,
    days_beside,
    fraction_question,
    year_and_day,
)
from thermodata.reader.text.times.several_cells.date_parts import declared_parts
from thermodata.reader.text.times.several_cells.gps_weeks import find_weeks
from thermodata.reader.times.open_questions import UNKNOWN, unit_question
from thermodata.reader.times.time_units import EPOCHS, SECONDS, found_epoch
from thermodata.reader.times.time_words import unit_named

_ROLL = 2.0**32  # a counter of 32 bits begins anew there: an Arduino's millis() after 49.7 days
COUNTERS = {"millis": "ms", "micros": "us"}  # by the names that an Arduino has for them
_FEWEST_ROWS = 10  # of a table whose period is asked for: less is a list of anything
ZONED_ROWS = 40  # of its beginning and its end, for the zone may be another one then


def no_time(seen: FirstRows) -> QuestionError | None:
    """What to ask of a table in which `find_time` finds none: how the times are written in a column that is called so,
    else the time from row to row. None where it is no table of numbers."""
    if (weeks := weeks_question((), seen)) is not None:
        return weeks
    worded = worded_time(seen)
    if worded is None and (days := year_and_day(seen)) is not None:
        return format_question(days[0], seen, days[1], " ".join(str(seen.rows[0][i]) for i in days[0]))
    if worded is None:
        return time_question(seen)
    place, words = worded
    return format_question((place,), seen, guess_format(words), words[0], either=fitting_formats(words))


def weeks_question(columns: tuple[int, ...], seen: FirstRows) -> QuestionError | None:
    """What to ask of a week of GPS and the seconds in it, which may have been found for the time (`columns`) or not;
    None where there are none, or another time is there."""
    found = find_weeks(seen.names, seen.rows)
    if found is None or not set(columns) <= set(found[0]):
        return None
    places, form = found
    row = next(r for r in seen.rows if all(is_number(r[i]) for i in places))
    got = " ".join(str(row[i]).strip() for i in places)
    return question_of_weeks([i + 1 for i in places], [seen.names[i] for i in places], got, form, seen.where)


def question_of_weeks(
    columns: Sequence[int | str], names: Sequence[str], got: str, form: str, where: str
) -> QuestionError:
    """Whether two columns are a week of GPS and the time in it. columns: as they are declared; names: of both; got:
    what a row has there; form: by which they read."""
    (reading, *_) = declared_parts(form, 2)
    assert reading.reads is not None
    at = str(np.datetime64(reading.reads(got) // 10**9, "s")).replace("T", " ")
    said = {"time": {"column": list(columns), "format": form}}
    return QuestionError(
        "times in weeks of GPS",
        where=where,
        expected="a date and a time of day, or how they are counted",
        got=got,
        hint=f"declare table: {{time: {{column: [{', '.join(map(str, columns))}], format: '{form}'}}}}",
        times=list(names),
        ask=f"format of the times: are '{names[0]}' and '{names[1]}' a week of GPS and the time in it "
        f"({form})? '{got}' is {at} UTC then",
        declare=said,
        meanwhile=said,
    )


def worded_time(seen: FirstRows) -> tuple[int, list[str]] | None:
    """(place, cells) of a column that is called a time and holds text that is none as it stands, in a table of numbers;
    else of the one column of texts that are stamps of one format, whatever it is called. None where there is none."""
    if not any(sum(is_number(r[i]) for r in seen.rows) > 0.6 * len(seen.rows) for i in range(len(seen.names))):
        return None
    stamped: list[tuple[int, list[str]]] = []
    for i, name in enumerate(seen.names):
        cells = [r[i] for r in seen.rows if r[i] not in ("", None)]
        words = [c.strip() for c in cells if isinstance(c, str) and not is_number(c) and re.search(r"\d", c)]
        if not cells or len(words) <= 0.8 * len(cells):
            continue
        if is_time_header(name):
            return i, words
        if _are_stamps(words):
            stamped.append((i, words))
    return stamped[0] if len(stamped) == 1 else None


def _are_stamps(words: Sequence[str]) -> bool:
    """Whether texts are dates with a time of day, in one format, that differ from row to row."""
    if len(words) < _FEWEST_ROWS or 2 * len(set(words)) < len(words):
        return False
    form = guess_format(words)
    return form is not None and re.search("%[yY]", form) is not None and re.search("%[HI]", form) is not None


def time_question(seen: FirstRows) -> QuestionError | None:
    """What to ask of a table of numbers without a time; None where it is no such table."""
    width = len(seen.names)
    numbers = [i for i in range(width) if sum(is_number(r[i]) for r in seen.rows) > 0.6 * len(seen.rows)]
    if len(seen.rows) < _FEWEST_ROWS or len(numbers) * 2 < width:
        return None
    place, rising = likely_time(seen.rows)
    if rising is not None and (counted := count_question(seen.names[place], rising, seen.where, place + 1)) is not None:
        return counted
    if rising is not None and all(name == f"column {i + 1}" for i, name in enumerate(seen.names)):
        return unit_question(seen.names[place], rising, seen.where, place + 1)
    rolls = rising is not None and float(rising.max()) > max(number_of(r[place]) or 0.0 for r in seen.rows)
    epoch = None if rising is None or rolls else found_epoch(rising) or ("excel" if may_be_excel(rising) else None)
    low = seen.names[place].strip().lower().removesuffix("()")
    low = "d" if low in DAYS_OF_YEAR else low
    named = low if low in SECONDS else unit_named(seen.names[place])
    unit = epoch or COUNTERS.get(low) or named or ("ms" if rolls else UNKNOWN)
    also = ", which begins anew behind 2^32" if rolls else ""
    column = f"{{column: {1 if rising is None else place + 1}, unit: {UNKNOWN if rising is None else unit}}}"
    which = " and, for unknown, s, min or h" if unit == UNKNOWN else ""
    then = f"time: {column}{which}" + (", and clock: {resets: allow} beside table" if rolls else "")
    other = f"; or is '{seen.names[place]}' the time{also}? then {then}" if rising is not None else ""
    return QuestionError(
        "no time column found",
        where=seen.where,
        expected="a column of dates, or one called time or with s, min or h as its unit",
        got=", ".join(seen.names[:12]),
        hint=f"declare the time from row to row: table: {{time: {{period: 60 s}}}}; or a column: {column}",
        ask=f"period: the time from row to row, e.g. 10 s or 1 min? no column holds a time{other}",
        declare={"time": {"period": UNKNOWN}},
        meanwhile={"time": {"period": 1.0}},
        begins_s=None if rising is None or unit not in SECONDS else float(rising[0]) * SECONDS[unit],
    )


def likely_time(data: Sequence[Sequence[Cell]]) -> tuple[int, Array | None]:
    """(place, numbers) of the column that may be the time: the first one where its numbers rise in even steps, but for
    another that does where the first only numbers the rows."""
    first = _rising(data, 0)
    if first is None or first[0] not in (0, 1) or not (np.diff(first) == 1).all():
        return 0, first
    for place in range(1, len(data[0])):
        values = _rising(data, place)
        if values is not None and not (np.diff(values) == 1).all():
            return place, values
    return 0, first


def _rising(data: Sequence[Sequence[Cell]], place: int) -> Array | None:
    """The numbers of a column where they rise from row to row in even steps, as a time does or a count; those of 32
    bits go on beyond them where they begin anew."""
    values = np.array([v for r in data if (v := number_of(r[place])) is not None], np.float64)
    values += _ROLL * np.concatenate([[0], np.cumsum(np.diff(values) < -_ROLL / 2)])[: values.size]
    steps = np.diff(values)
    even = values.size >= max(2, 0.9 * len(data)) and bool((steps > 0).all())
    return values if even and float(np.mean(np.abs(steps - np.median(steps)) <= 0.1 * np.median(steps))) > 0.9 else None


def size_of_clock(name: str, cells: Sequence[Cell], where: str) -> str:
    """The unit of a time that names none, where its size leaves one sense only: a count from a date.
    QuestionError where it does not."""
    values = np.array([v for c in cells if (v := number_of(c)) is not None], np.float64)
    epoch = found_epoch(values) if values.size else None
    if epoch is not None:
        return epoch
    if (counted := count_question(name, values, where)) is not None:
        raise counted
    if may_be_excel(values):
        return excel_or_question(name, values, where, "s")
    if (far := far_question(name, values, "s", where)) is not None:
        raise far
    raise unit_question(name, values, where)


def epoch_in(name: str, unit: str, cells: Sequence[Cell], where: str) -> str | None:
    """The count from a date that times in a unit are by their size; None where they may count from a start.
    QuestionError for days that may do either."""
    values = np.array([v for c in cells if (v := number_of(c)) is not None], np.float64)
    epoch = found_epoch(values) if values.size else None
    seconds = SECONDS.get(unit.strip().strip("[]()").lower())
    if seconds == SECONDS["d"] and may_be_excel(values):
        return excel_or_question(name, values, where, "d")
    return epoch if epoch and epoch.startswith("unix") and EPOCHS[epoch].seconds == seconds else None


def joined_question(columns: tuple[int, ...], seen: FirstRows) -> QuestionError | None:
    """What to ask where dates are written as one number: 20260302080000 in the column that was found, or 20260302 in
    one that is called a date, beside times of day. None where none are."""
    if len(columns) != 1:
        return None
    (place,) = columns

    def stamps(i: int) -> tuple[str | None, str]:
        cells = [str(r[i]).strip() for r in seen.rows if r[i] not in ("", None)]
        joined = bool(cells) and all(c.isdecimal() and len(c) in (8, 12, 14) for c in cells)
        return (guess_format(cells), cells[0]) if joined else (None, "")

    form, first = stamps(place)
    if form is not None and "%H" in form:
        return format_question((place,), seen, form, first)
    if form is not None and (of_day := _joined_clock(place, seen)) is not None:
        return format_question((place, of_day[0]), seen, f"{form} {of_day[1]}", first)
    if not mostly(seen.column(place), is_clocked, 0.8, len(seen.rows)):
        return None
    for i in (i for i, name in enumerate(seen.names) if i != place and is_time_header(name)):
        form, first = stamps(i)
        if form is not None and "%H" not in form:
            return format_question((i, place), seen, form, first)
    return None


def _joined_clock(day: int, seen: FirstRows) -> tuple[int, str] | None:
    """(place, format) of a column that is called a time and holds times of day in one number: 070000."""
    for i in (i for i, name in enumerate(seen.names) if i != day and is_time_header(name)):
        letters = format_of_joined([str(r[i]).strip() for r in seen.rows if r[i] not in ("", None)])
        if letters is not None:
            return i, letters
    return None


def of_day_question(place: int, seen: FirstRows) -> QuestionError | None:
    """What to ask of numbers that are called a time beside days: parts of a day, or clocks such as 800 for 8:00. None
    where they are neither."""
    if (fraction := fraction_question(place, seen)) is not None:
        return fraction
    cells = [str(r[place]).strip() for r in seen.rows if r[place] not in ("", None)]
    letters = format_of_joined(cells)
    for day in days_beside(place, seen) if letters is not None else ():
        days = [str(r[day]).strip() for r in seen.rows if r[day] not in ("", None)]
        form = guess_format(days)
        spelled = None if form is None else f"{form} {letters}"
        return format_question((day, place), seen, spelled, f"{days[0]} {cells[0]}")
    return None


def zone_question(seen: FirstRows, columns: Iterable[int]) -> QuestionError | None:
    """What to ask of times behind which a word stands that is no zone, or several: 2026-03-02 08:00:00 CST. None where
    none stands there. columns: that may hold the time."""
    for i in sorted(columns):
        cells = [
            r[i].strip() for r in (*seen.rows[:ZONED_ROWS], *seen.rows[-ZONED_ROWS:]) if isinstance(r[i], str) and r[i]
        ]
        if not cells or ":" not in cells[0]:
            continue
        words = {c: w for c in cells if (w := word_behind(c)) is not None}
        bare = {c: c.removesuffix(")").removesuffix(w).rstrip(" (") for c, w in words.items()}
        if len(words) <= 0.3 * len(set(cells)) or not mostly(bare.values(), is_stamp, 0.8, len(bare)):
            continue
        cell, word = next(iter(words.items()))
        spelled = guess_format(list(bare.values())) if len(set(words.values())) == 1 else None
        form = spelled + cell[len(bare[cell]) :] if spelled else UNKNOWN
        zones = SEVERAL.get(word, ())
        shown = " or ".join(zones) if zones else ANY_ZONE
        said = {"time": {"column": i + 1, "format": form}}
        return QuestionError(
            f"times in a zone that has several meanings: '{word}'" if len(zones) > 1 else f"an unknown zone '{word}'",
            where=f"{seen.where} column '{seen.names[i]}'",
            expected=f"an offset such as +01:00, or one of {', '.join(HOURS)}",
            got=cell,
            hint=f"declare what it is in the source: timezone: {shown}; and table: {{time: {{column: {i + 1}, "
            f"format: '{form if spelled else '%Y-%m-%d %H:%M:%S ' + word}'}}}}",
            times=[seen.names[i]],
            ask=f"zone of the times: what is '{word}'? write timezone: {shown} into this source",
            declare=said,
            meanwhile=said if spelled else {"time": {"period": 1.0}},
        )
    return None


def without_word(cell: Cell) -> Cell:
    """A cell without the word for a zone behind its time."""
    word = word_behind(cell) if isinstance(cell, str) and ":" in cell else None
    return cell if word is None else cell.strip().removesuffix(")").removesuffix(word).rstrip(" (")
