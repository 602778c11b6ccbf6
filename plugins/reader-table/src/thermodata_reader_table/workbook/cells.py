"""What a row's cells of a workbook say together of its time: a date, a time of day, a duration, or words."""

from __future__ import annotations

import datetime as dt
from typing import Any

from thermodata.reader.text.cells.cell import is_empty


def seconds_of(cell: Any) -> Any:
    if isinstance(cell, dt.time):
        return (dt.datetime.combine(dt.date.min, cell) - dt.datetime.min).total_seconds()
    return cell.total_seconds() if isinstance(cell, dt.timedelta) else cell


def part_of_date(cell: Any) -> str:
    """The text of a number that is part of a date: a workbook keeps all of them as floats."""
    if cell in ("", None):
        return ""
    if isinstance(cell, dt.date):
        return str(_bare_day(cell))
    return str(int(cell)) if isinstance(cell, float) and cell.is_integer() else str(cell).strip()


def joined(cells: tuple[Any, ...]) -> Any:
    """One date and time of a row's time cells."""
    if len(cells) == 1:
        cell = cells[0]
        if isinstance(cell, dt.time):
            return dt.datetime.combine(dt.date.min, cell) - dt.datetime.min
        if isinstance(cell, dt.date) and not isinstance(cell, dt.datetime):
            return dt.datetime.combine(cell, dt.time())
        return cell
    day, clock = cells[0], cells[1]
    if isinstance(day, dt.date) and isinstance(clock, dt.time | dt.timedelta | dt.datetime):
        midnight = dt.datetime(day.year, day.month, day.day)
        if isinstance(clock, dt.timedelta):
            return midnight + clock
        return dt.datetime.combine(midnight.date(), clock.time() if isinstance(clock, dt.datetime) else clock)
    return " ".join(str(c).strip() for c in cells)


def joined_words(cells: tuple[Any, ...]) -> str:
    """One text of a row's time cells, words among them: '2026-03-14 01:00:00 PM'; '' where one is empty."""
    if any(map(is_empty, cells)):
        return ""
    clocked = any(isinstance(c, dt.time | dt.timedelta) or ":" in str(c) for c in cells[1:])
    return " ".join(str(_bare_day(c) if clocked and not k else c).strip() for k, c in enumerate(cells))


def _bare_day(day: Any) -> Any:
    """The date of a moment at midnight, as a workbook keeps a day."""
    return day.date() if isinstance(day, dt.datetime) else day
