"""Days that say no year (`12.03.`, `KW19-1`) beside times of day: they are no dates, and the year is asked for."""

from __future__ import annotations

import re
from collections.abc import Sequence

from thermodata.reader.text.cells.cell import is_empty
from thermodata.reader.text.names.time_header import is_time_header, unit_of_time
from thermodata.reader.times.open_questions import YEAR

_DAY = re.compile(r"(\d{1,2})(?:\.\s?|[/-])(\d{1,2})\.?")
# a calendar week, and mostly the day in it: KW19-1, CW 19, W19-1; a W with a number alone may be a workpiece
_WEEK = re.compile(r"(?i)(?:[KC]W[\W_]?(?P<a>\d{1,2})(?:[-/.](?P<b>[1-7]))?|W(?P<c>\d{1,2})-[1-7])")
_SAID = re.compile(r"(?<!\d)(?:19|20)\d\d(?=\D|[01]\d[0-3]\d|$)")


def yearless_note(
    names: Sequence[str], units: Sequence[str | None], rows: Sequence[Sequence[str]], of_day: int, where: str
) -> str | None:
    """The note on a column of days without a year, whose year the name of the file may say; None where there is none.
    of_day: the column of the times of day."""
    for i, (name, unit) in enumerate(zip(names, units, strict=True)):
        cells = [r[i] for r in rows if i < len(r) and not is_empty(r[i])]
        weeks = bool(cells) and all(map(is_week_without_year, cells))
        if i == of_day or not (weeks or is_time_header(name)) or unit_of_time(name, unit) is not None:
            continue  # which counts hours
        if not cells or not all(map(is_day_without_year, cells)):
            continue
        clock = next((r[of_day].strip() for r in rows if of_day < len(r) and not is_empty(r[of_day])), "08:00:00")
        said = set(_SAID.findall(where))
        year = said.pop() if len(said) == 1 else None
        by_name = f" ({year} by the file's name)" if year else ""
        return (
            f"'{name}' says days without a year, '{cells[0].strip()}', and is not read, so times of day count from the "
            f"first row: {YEAR}{by_name} Give each test its start: {year or 'YYYY'}-MM-DD {clock}"
        )
    return None


def is_day_without_year(cell: str) -> bool:
    """Whether a cell is a day and a month in either order, as '0.5' and '12.30' are not, or a calendar week."""
    if is_week_without_year(cell):
        return True
    match = _DAY.fullmatch(cell.strip())
    low, high = sorted(map(int, match.groups())) if match else (0, 0)
    return 1 <= low <= 12 and high <= 31


def is_week_without_year(cell: str) -> bool:
    """Whether a cell is a calendar week, with the day in it or without."""
    match = _WEEK.fullmatch(cell.strip())
    return match is not None and 1 <= int(match["a"] or match["c"]) <= 53
