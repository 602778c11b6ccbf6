"""Days that many rows share, beside a text that differs in each of them: what tells the hour is written in no way that
is read, and without it all rows of a day would stand at midnight."""

from __future__ import annotations

import datetime as dt
import re
from collections import Counter
from collections.abc import Sequence

from thermodata.errors import QuestionError
from thermodata.reader.text.cells.cell import Cell, is_clocked, is_dated, is_number, mostly
from thermodata.reader.text.cells.first_rows import FirstRows
from thermodata.reader.text.cells.time_forms.calendar_words import folded, is_worded_date
from thermodata.reader.text.cells.time_forms.clock_pattern import says_the_hour
from thermodata.reader.text.clocks.format_question import format_question
from thermodata.reader.text.names.time_header import is_time_header, unit_of_time
from thermodata.reader.text.times.one_cell.odd_stamps import fitting_formats, guess_format, is_iso_week
from thermodata.reader.text.times.several_cells.days_without_year import is_day_without_year, is_week_without_year
from thermodata.reader.times.open_questions import UNKNOWN

_MANY = 10  # rows of one day
_EACH = 0.9  # of the rows, that have a text of their own
_WEEKDAY_FIRST = re.compile(r"[^\W\d_]{2,10}[.,]{0,2} ?\d{1,4}([-/.])\d{1,2}\1\d{2,4}")  # Mo 04.05.2026
_DAY_WORDS = frozenset(("tag", "day", "jour", "giorno", "dia", "den", "dzien", "dag", "nap", "data", "messtag"))
_CLOCK = re.compile(r"([01]?\d|2[0-3])([-.])([0-5]\d)\2([0-5]\d)")  # 08-00-00, 08.00.00
_POINTED = re.compile(r"([01]?\d|2[0-3])[.,]([0-5]\d)")  # 08.59
_YEARS, _DAYS = 3, frozenset(range(1, 32))  # a column of dates is of fewer, or has days last
_SHAPE = re.compile(r"([01]?\d|2[0-3])\D{1,4}[0-5]\d(\D.*)?")  # 8h05, 08-00-00, 8 Uhr 05


def clock_question(columns: tuple[int, ...], seen: FirstRows) -> QuestionError | None:
    """What to ask where a column of dates alone was found for the time, and another column may tell the hour. None
    where the dates tell the rows apart, or nothing else does."""
    if len(columns) != 1:
        return None
    (place,) = columns
    if looks_like_dates(cells := seen.column(place)):
        first = next(c.strip() for c in cells if isinstance(c, str) and c.strip())
        mark = first.lstrip("0123456789")[0]
        return format_question((place,), seen, mark.join(("%H", "%M", "%S")), first, ", or a format of dates")
    dated = [(r, day) for r in seen.rows if (day := _day_of(r[place]))]
    days = [day for _, day in dated]
    if not days or any(map(says_the_hour, days)) or max(Counter(days).values()) < _MANY:
        return None
    others = [i for i in range(len(seen.names)) if i != place and _differs(i, seen.rows)]
    odd = next((i for i in range(len(seen.names)) if i != place and _is_odd_clock(i, seen)), None)
    if odd is not None:
        together = [f"{day} {str(r[odd]).strip()}" for r, day in dated if r[odd] not in ("", None)]
        forms = fitting_formats(together)
        return format_question((place, odd), seen, forms[0] if len(forms) == 1 else None, together[0], either=forms)
    if not others:
        return None
    worded = (i for i in others if is_time_header(seen.names[i]))
    other = next(worded, next((i for i in others if _is_shaped(i, seen.rows)), None))
    if other is None:
        return _period_question(place, days[0], seen)
    first = str(next(r[other] for r in seen.rows if r[other] not in ("", None))).strip()[:40]
    column = [place + 1, other + 1]
    return QuestionError(
        f"dates without a time of day in many rows, beside '{seen.names[other]}', which is not read as one",
        where=f"{seen.where} column '{seen.names[place]}'",
        expected="a date and a time of day: 2026-03-01 08:00:00, 1.3.2026 8:00 PM, ...",
        got=f"{days[0]} and {first}",
        hint=f"declare table: {{time: {{column: {column}, format: '%d.%m.%Y %H:%M:%S'}}}} in strptime's letters, or "
        "time: {period: 10 s}",
        times=[seen.names[place], seen.names[other]],
        ask=f"format of the time in columns {column[0]} and {column[1]}, in strptime's letters, or period: 10 s? "
        f"'{days[0]}' tells no hour, and '{first}' is not read",
        declare={"time": {"column": column, "format": UNKNOWN}},
        meanwhile={"time": {"period": 1.0}},
    )


def day_question(columns: tuple[int, ...], seen: FirstRows) -> QuestionError | None:
    """What to ask where a time of day alone was found, and another column may tell the day: text under a word for time,
    or dates with names of months and weekdays. Left out, a pause of days would be one of hours. None where there is
    none."""
    place = columns[0]
    if not mostly((c := seen.column(place)), is_clocked, _EACH, len(c)):
        return None
    day = next((i for i in range(len(seen.names)) if i not in columns and _tells_the_day(i, seen)), None)
    if day is None:
        return None
    both = [(r[day], r[place]) for r in seen.rows if r[day] not in ("", None) and r[place] not in ("", None)]
    together = [f"{str(one).strip()} {str(clock).strip()}" for one, clock in both]
    otherwise = f", or {{column: {place + 1}}} alone where '{seen.names[day]}' is no day"
    return format_question((day, *columns), seen, guess_format(together), together[0], otherwise)


def _tells_the_day(column: int, seen: FirstRows) -> bool:
    """Whether the cells of a column are texts that may be days: no numbers, and no dates that are read. Of one day, in
    a calendar week that says no year, times of day need none."""
    cells = [c.strip() for c in seen.column(column) if isinstance(c, str) and c.strip()]
    if cells and all(map(is_week_without_year, cells)):
        return len(set(cells)) > 1
    if len(cells) <= _EACH * len(seen.rows) or any(map(_is_read, cells)):
        return False
    worded = all(is_worded_date(c) or _WEEKDAY_FIRST.fullmatch(c) or is_iso_week(c) for c in set(cells))
    named = is_time_header(seen.names[column]) or folded(seen.names[column].strip(" .:")) in _DAY_WORDS
    return worded or (named and all(re.search(r"\d", c) for c in set(cells)))


def _is_read(cell: str) -> bool:
    return is_number(cell) or is_dated(cell) or is_clocked(cell) or is_day_without_year(cell)


def _period_question(place: int, day: str, seen: FirstRows) -> QuestionError:
    """What to ask where no other column looks like a time."""
    return QuestionError(
        "dates without a time of day in many rows",
        where=f"{seen.where} column '{seen.names[place]}'",
        expected="a date and a time of day: 2026-03-01 08:00:00, 1.3.2026 8:00 PM, ...",
        got=day,
        hint="declare the time from row to row: table: {time: {period: 10 s}}",
        ask=f"period: the time from row to row, e.g. 10 s or 1 min? '{day}' tells no hour, and no other column looks "
        "like a time",
        declare={"time": {"period": UNKNOWN}},
        meanwhile={"time": {"period": 1.0}},
    )


def _day_of(cell: Cell) -> str:
    """The text of a date without a time of day; '' of another cell."""
    if isinstance(cell, str):
        return cell.strip() if is_dated(cell) else ""
    if isinstance(cell, dt.datetime):
        return cell.isoformat(" ").removesuffix(" 00:00:00")
    return cell.isoformat() if isinstance(cell, dt.date) else ""


def _is_odd_clock(column: int, seen: FirstRows) -> bool:
    """Whether a column beside one of days holds times of day that are not read as such."""
    return looks_like_dates(seen.column(column)) or are_pointed_clocks(column, seen)


def are_pointed_clocks(column: int, seen: FirstRows) -> bool:
    """Whether numbers under a word for time are hours and minutes (8.59, then 9.00): minutes of two digits that never
    reach 60, behind hours of two digits or over the end of one."""
    texts = [c.strip() for c in seen.column(column) if isinstance(c, str) and c.strip()]
    parts = [match for c in texts if (match := _POINTED.fullmatch(c)) is not None]
    if not is_time_header(seen.names[column]) or unit_of_time(seen.names[column], seen.units[column]) is not None:
        return False
    if len(parts) < max(_MANY, len(texts)):
        return False
    hours = {match[1] for match in parts}
    return any(hour[0] == "0" and len(hour) == 2 for hour in hours) or (
        len(hours) > 1 and any(int(match[2]) >= 50 for match in parts)
    )


def looks_like_dates(cells: Sequence[Cell]) -> bool:
    """Whether cells are times of day such as 08-00-00 or 08.00.00, which look like dates of two digits: in either order
    of day and month some of them are none, or they would be of many years."""
    parts = [_CLOCK.fullmatch(c.strip()) for c in cells if isinstance(c, str) and c.strip()]
    found = [tuple(map(int, match.group(1, 3, 4))) for match in parts if match is not None]
    if not found or len(found) < len(parts):
        return False
    last = {second for _, _, second in found}
    return (len(last) >= _YEARS and not last <= _DAYS) or all(
        any(not (1 <= numbers[month] <= 12 and 1 <= numbers[day] <= 31) for numbers in found)
        for day, month in ((0, 1), (1, 0))
    )


def _is_shaped(column: int, data: Sequence[Sequence[Cell]]) -> bool:
    """Whether most texts of a column look like times of day, in whatever signs."""
    return mostly((r[column] for r in data), _is_clock, _EACH, len(data))


def _is_clock(cell: Cell) -> bool:
    return isinstance(cell, str) and _SHAPE.fullmatch(cell.strip()) is not None


def _differs(column: int, data: Sequence[Sequence[Cell]]) -> bool:
    """Whether a column holds texts with digits, another in each row."""
    cells = [r[column].strip() for r in data if isinstance(r[column], str) and r[column].strip()]
    words = [c for c in cells if not is_number(c) and re.search(r"\d", c)]
    return len(words) > _EACH * len(data) and len(set(words)) > _EACH * len(words)
