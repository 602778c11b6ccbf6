"""Which column of a table is its time, and in what unit: declared, or by its values and its name."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from thermodata.errors import FormatError, QuestionError, UsageError, nearest
from thermodata.plugin import Array
from thermodata.reader.open_questions import UNKNOWN, unit_question
from thermodata.reader.text.cell import TIME_WORD, Cell, is_clocked, is_dated, is_number, is_stamp, mostly, number_of
from thermodata.reader.text.date_parts import find_parts
from thermodata.reader.text.header import split_unit
from thermodata.reader.text.odd_stamps import guess_format
from thermodata.reader.text.timestamp import MILLISECONDS
from thermodata.reader.text.zone_words import HOURS, SEVERAL, word_behind
from thermodata.reader.time_units import EPOCHS, SECONDS, check_unit, found_epoch

_FEWEST_ROWS = 10  # of a table whose period is asked for: less is a list of anything
_ZONED_ROWS = 40  # of its beginning and its end, for the zone may be another one then
_UNIT_BEHIND = re.compile(
    r"^(?P<word>[^\W\d_]+(?: [^\W\d_]+)??)(?P<between>\s+in\s+|\s*[/,:]\s*|[ _.]+)(?P<unit>[^\W\d_]{1,8})\.?$"
)
_FRACTION = re.compile(r":\d\d:\d\d[.,:]\d+\s*([AaPp]\.?[Mm]\.?)?$")


def unit_of_time(header: str, unit: str | None = None) -> str | None:
    """The unit of time that a header names, in brackets or behind the word for time: "Zeit in h", "t / min", "time_ms".
    unit: what was split from it, or stands in a row of its own. None where it names none."""
    name, own = split_unit(header)
    for text in (unit, own):
        if text is not None:
            low = text.strip().strip("[]()").lower()
            return low if low in SECONDS or low in EPOCHS else None
    match = _UNIT_BEHIND.match(name.strip())
    if match is None or not TIME_WORD.match(match["word"]):
        return None
    low = match["unit"].lower()
    return low if low in SECONDS else None


def is_time_header(header: str, unit: str | None = None) -> bool:
    """Whether a header says that its column is the time: by its word, or by a unit of time behind that."""
    name = split_unit(header)[0].strip()
    if unit is not None and unit_of_time(header, unit) is None:
        return False
    return TIME_WORD.match(name) is not None or (split_unit(header)[1] is None and unit_of_time(header) is not None)


def column(wanted: int | str, names: Sequence[str], where: str) -> int:
    """The place of a declared column (1-based, or by its name), from 0."""
    if isinstance(wanted, int):
        if not 1 <= wanted <= len(names):
            raise FormatError(f"no column {wanted}", where=where, expected=f"1 to {len(names)}", got=str(wanted))
        return wanted - 1
    for fold in (str, str.casefold):
        hits = [i for i, n in enumerate(names) if fold(wanted) in (fold(n), fold(split_unit(n)[0]))]
        if len(hits) == 1:
            return hits[0]
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
                shown = ", ".join(f"'{names[i]}'" for i in parts[0])
                return parts[0], None, parts[1], [f"the time stands in {len(parts[0])} columns: {shown}"]
        try:
            columns = find_time(names, units, data, where, likely)
        except FormatError:
            # of one of several times the columns count from its own first
            worded = None if likely else _worded_time(names, data)
            if worded is None or form in (None, UNKNOWN):
                question = _time_question(names, data, where) if likely else no_time(names, data, where)
                if question is None:
                    raise
                raise question from None
            columns = (worded[0],)
        asked = _joined_question(columns, names, data, where) if not told and not likely else None
        if asked is not None:
            raise asked
    cells = [row[columns[0]] for row in data]
    numeric = sum(map(is_number, cells)) * 2 > len(cells)
    notes: list[str] = []
    if form is not None or (not numeric and unit is None):
        return columns, None, form, notes
    name = names[columns[0]]
    text = unit or units[columns[0]] or unit_of_time(name)
    if text is None:
        text = _size_of_clock(name, cells, where)
        notes.append(
            f"time column '{name}' has no unit: by its size it is {text}; declare table: {{time: {{unit: ...}}}} "
            "if that is wrong"
        )
    return columns, check_unit(str(text), where), None, notes


def _size_of_clock(name: str, cells: Sequence[Cell], where: str) -> str:
    """The unit of a time that names none, where its size leaves one sense only: a count from a date.
    QuestionError where it does not."""
    values = np.array([v for c in cells if (v := number_of(c)) is not None], np.float64)
    epoch = found_epoch(values) if values.size else None
    if epoch is not None:
        return epoch
    days = values.size > 1 and bool(((values > 36_526) & (values < 73_051)).all()) and float(np.ptp(values)) < 400
    if days and bool((np.abs(np.diff(values)) < 0.2).all()) and bool((values != np.floor(values)).any()):
        if re.search(r"(?i)dat", name):
            return "excel"
        raise QuestionError(
            "times that may be Excel's days or seconds",
            where=where,
            got=f"{name}: {values[0]:.12g} ...",
            expected="a unit",
            hint="declare table: {time: {unit: excel}} or {time: {unit: s}}",
            ask=f"unit of the time: excel (days since 1900) or s? '{name}' begins with {values[0]:.12g}",
            declare={"time": {"unit": UNKNOWN}},
            meanwhile={"time": {"unit": "excel"}},
        )
    raise unit_question(name, values, where)


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
    standing = _standing(
        {i: [c for c in filled[i] if is_dated(c)] for i in dates},
        [[c for c in filled[i] if is_clocked(c)] for i in clocks],
    )
    if standing and len(standing) == len(dates) and not _parts_go_on(names, data):
        standing = set()
    dates = [i for i in dates if i not in standing]
    if dates:
        first = next((i for i in dates if i in words), dates[0])
        sample = filled[first][0]
        has_clock = ":" in sample if isinstance(sample, str) else not clocks or _tell_the_hour(filled[first])
        found = (first,) if has_clock or not clocks else (first, clocks[0])
        return (*found, *_milliseconds(found[-1] + 1, names, [r[found[-1]] for r in data], data))
    if clocks:
        return (clocks[0],)
    numbers = [i for i in words if share(i, is_number, 0.6)]
    if numbers:
        # a "t" may be many things beside a column that is called time
        return (min(numbers, key=lambda i: split_unit(names[i])[0].strip(" .:") == "t"),)
    if (units[0] or "").strip().lower() in SECONDS and share(0, is_number, 0.6):
        return (0,)
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


def _tell_the_hour(cells: Sequence[Cell]) -> bool:
    """Whether dates hold a time of day; those of a workbook, one that is not midnight in all of them."""
    return any(
        ":" in c if isinstance(c, str) else bool(hasattr(c, "hour") and (c.hour or c.minute or c.second)) for c in cells
    )


def _standing(dates: Mapping[int, Sequence[Cell]], clocks: Sequence[Sequence[Cell]]) -> set[int]:
    """Columns of dates that are one and the same in all rows: of when something was calibrated, not of when rows were
    measured. A day stands beside a time of day that goes on."""
    running = any(len(set(cells)) > 1 for cells in clocks)
    return {i for i, cells in dates.items() if len(set(cells)) == 1 and not (running and not _tell_the_hour(cells))}


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
    bare = [[_without_word(c) for c in r] for r in (*data[:_ZONED_ROWS], *data[-_ZONED_ROWS:])]
    # dates that only a word behind them keeps from being the time
    would = tuple(i for i in found(bare) if is_time_header(names[i]) and any(is_dated(r[i]) for r in bare))
    parts = find_parts(names, data)
    if parts is not None and not any(_tells_all(c, parts[0], rows) for c, rows in ((columns, data), (would, bare))):
        return parts, None
    return None, zone_question(names, data, where, {*columns, *would} or range(len(names)))


def _without_word(cell: Cell) -> Cell:
    word = word_behind(cell) if isinstance(cell, str) and ":" in cell else None
    return cell if word is None else cell.strip().removesuffix(")").removesuffix(word).rstrip(" (")


def _tells_all(columns: tuple[int, ...], parts: tuple[int, ...], data: list[list[Cell]]) -> bool:
    """Whether time columns, none of which is a part of a date, hold more than a day or a time of day: dates with a time
    of day, or numbers."""
    if not columns or not parts or set(columns) & set(parts):
        return False
    cells = [r[columns[0]] for r in data if r[columns[0]] not in ("", None)]
    if not any(map(is_dated, cells)):
        return not any(map(is_clocked, cells))
    return len(columns) > 1 or _tell_the_hour(cells)


def _worded_time(names: list[str], data: list[list[Cell]]) -> tuple[int, list[str]] | None:
    """(place, cells) of a column that is called a time and holds text that is none as it stands, in a table of numbers;
    None where there is no such column."""
    if not any(sum(is_number(r[i]) for r in data) > 0.6 * len(data) for i in range(len(names))):
        return None
    for i, name in enumerate(names):
        cells = [r[i] for r in data if r[i] not in ("", None)]
        words = [c.strip() for c in cells if isinstance(c, str) and not is_number(c) and re.search(r"\d", c)]
        if is_time_header(name) and cells and len(words) > 0.8 * len(cells):
            return i, words
    return None


def no_time(names: list[str], data: list[list[Cell]], where: str) -> QuestionError | None:
    """What to ask of a table in which `find_time` finds none: how the times are written in a column that is called so,
    else the time from row to row. None where it is no table of numbers."""
    worded = _worded_time(names, data)
    if worded is None:
        return _time_question(names, data, where)
    place, words = worded
    return _format_question((place,), guess_format(words), words[0], where)


def _joined_question(
    columns: tuple[int, ...], names: list[str], data: list[list[Cell]], where: str
) -> QuestionError | None:
    """What to ask where dates are written as one number: 20260302080000 in the column that was found, or 20260302 in
    one that is called a date, beside times of day. None where none are."""
    if len(columns) != 1:
        return None
    (place,) = columns

    def stamps(i: int) -> tuple[str | None, str]:
        cells = [str(r[i]).strip() for r in data if r[i] not in ("", None)]
        joined = bool(cells) and all(c.isdecimal() and len(c) in (8, 12, 14) for c in cells)
        return (guess_format(cells), cells[0]) if joined else (None, "")

    form, first = stamps(place)
    if form is not None and "%H" in form:
        return _format_question((place,), form, first, where)
    if not mostly([r[place] for r in data], is_clocked, 0.8, len(data)):
        return None
    for i in (i for i, name in enumerate(names) if i != place and is_time_header(name)):
        form, first = stamps(i)
        if form is not None and "%H" not in form:
            return _format_question((i, place), form, first, where)
    return None


def zone_question(names: list[str], data: list[list[Cell]], where: str, columns: Iterable[int]) -> QuestionError | None:
    """What to ask of times behind which a word stands that is no zone, or several: 2026-03-02 08:00:00 CST. None where
    none stands there. columns: that may hold the time."""
    for i in sorted(columns):
        cells = [r[i].strip() for r in (*data[:_ZONED_ROWS], *data[-_ZONED_ROWS:]) if isinstance(r[i], str) and r[i]]
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
        shown = " or ".join(zones) if zones else "Europe/Prague"
        said = {"time": {"column": i + 1, "format": form}}
        return QuestionError(
            f"times in a zone that has several meanings: '{word}'" if len(zones) > 1 else f"an unknown zone '{word}'",
            where=f"{where} column '{names[i]}'",
            expected=f"an offset such as +01:00, or one of {', '.join(HOURS)}",
            got=cell,
            hint=f"declare what it is in the source: timezone: {shown}; and table: {{time: {{column: {i + 1}, "
            f"format: '{form if spelled else '%Y-%m-%d %H:%M:%S ' + word}'}}}}",
            ask=f"zone of the times: what is '{word}'? write timezone: {shown} into this source",
            declare=said,
            meanwhile=said if spelled else {"time": {"period": 1.0}},
        )
    return None


def _format_question(columns: tuple[int, ...], form: str | None, got: str, where: str) -> QuestionError:
    """Asks for the format of times in strptime's letters; with one that fits, it is only to be confirmed."""
    column: Any = columns[0] + 1 if len(columns) == 1 else [c + 1 for c in columns]
    asked = (
        f"format of the times, in strptime's letters ('%d-%b-%Y %H:%M:%S'), or period: 10 s? they begin with '{got}'"
    )
    said = {"time": {"column": column, "format": form or UNKNOWN}}
    return QuestionError(
        "times that are written in no way that is read by itself",
        where=where,
        expected="a date and a time of day: 2026-03-01 08:00:00, 1.3.2026 8:00, ...",
        got=got,
        hint=f"declare table: {{time: {{column: {column}, format: '{form or '%d-%b-%Y %H:%M:%S'}'}}}}",
        ask=f"format of the times: is '{got}' {form}?" if form else asked,
        declare=said,
        meanwhile=said if form else {"time": {"period": 1.0}},
    )


def _time_question(names: list[str], data: list[list[Cell]], where: str) -> QuestionError | None:
    """What to ask of a table of numbers without a time; None where it is no such table."""
    width = len(names)
    numbers = [i for i in range(width) if sum(is_number(r[i]) for r in data) > 0.6 * len(data)]
    if len(data) < _FEWEST_ROWS or len(numbers) * 2 < width:
        return None
    rising = _rising(data)
    if rising is not None and all(name == f"column {i + 1}" for i, name in enumerate(names)):
        return unit_question(names[0], rising, where, 1)
    unit = low if (low := names[0].strip().lower()) in SECONDS else "s"
    other = f"; or is '{names[0]}' the time? then time: {{column: 1, unit: {unit}}}" if rising is not None else ""
    return QuestionError(
        "no time column found",
        where=where,
        expected="a column of dates, or one called time or with s, min or h as its unit",
        got=", ".join(names[:12]),
        hint="declare the time from row to row: table: {time: {period: 60 s}}; or a column: {column: 1, unit: s}",
        ask=f"period: the time from row to row, e.g. 10 s or 1 min? no column holds a time{other}",
        declare={"time": {"period": UNKNOWN}},
        meanwhile={"time": {"period": 1.0}},
    )


def _rising(data: Sequence[Sequence[Cell]]) -> Array | None:
    """The numbers of the first column where they rise from row to row in even steps, as a time does or a count."""
    values = np.array([v for r in data if (v := number_of(r[0])) is not None], np.float64)
    steps = np.diff(values)
    even = values.size >= max(2, 0.9 * len(data)) and bool((steps > 0).all())
    return values if even and float(np.mean(np.abs(steps - np.median(steps)) <= 0.1 * np.median(steps))) > 0.9 else None


def _milliseconds(column: int, names: list[str], times: Sequence[Cell], data: list[list[Cell]]) -> tuple[int, ...]:
    """The column of text behind a date and time of whole seconds that holds their milliseconds, where there is one."""
    if column >= len(names) or not MILLISECONDS.match(names[column]):
        return ()
    pairs = [(t, r[column]) for t, r in zip(times, data, strict=True) if is_stamp(t)]  # a repeated header is none
    whole = all(isinstance(t, str) and not _FRACTION.search(t.strip()) for t, _ in pairs)
    good = all(isinstance(c, str) and re.match(r"^\d{1,3}$", c.strip()) for _, c in pairs)
    return (column,) if pairs and whole and good else ()
