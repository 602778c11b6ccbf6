"""Two clocks of one table: the time of the rows in local time, and in another column where it stands from UTC."""

from __future__ import annotations

import re
from collections.abc import Sequence

from thermodata.reader.text.cells.cell import Cell, is_empty, mostly
from thermodata.reader.text.cells.first_rows import FirstRows
from thermodata.reader.text.cells.time_forms.zone_words import stated_zone

_ZONED = re.compile(r":\d\d(?:[.,]\d+)?\s*(?:Z|UTC|[+-]\d\d:?\d\d)$")
_CLOCK = re.compile(r"(\d{1,2}):(\d\d)(?::(\d\d)(?:[.,](\d+))?)?\s*([AaPp])?")
# clocks of what comes behind the measuring: of its way to a server, or of the row in a database
_OF_ITS_WAY = re.compile(
    r"(?i)recei|recv|rx|server|arriv|ingest|insert|sav(?:ed|ing)|stor(?:ed|age)|writ|upload|sent|publish|creat|modif|"
    r"updat|processed|empf[aä]ng|eingang|gespeichert|erstellt|ge[aä]ndert|přijat|uložen"
)
_DAY_MS, _HOUR_MS, _QUARTER_MS = 86_400_000, 3_600_000, 900_000


def zoned_beside(first: int, dates: Sequence[int], seen: FirstRows) -> int:
    """The column of the time: another one that says where it stands from UTC, where that of the local time beside it
    does not, and both are one clock. dates: columns that tell the hour too."""
    if _says_zone(first, seen):
        return first
    others = (i for i in dates if i != first and _says_zone(i, seen))
    return next((i for i in others if _is_same_clock(first, i, seen)), first)


def beside_note(time: int, seen: FirstRows) -> list[str]:
    """What is told of a time that stands in local time too."""
    if not _says_zone(time, seen):
        return []
    others = [i for i in range(len(seen.names)) if i != time and not _says_zone(i, seen)]
    return [
        f"the time is '{seen.names[time]}', which says where it stands from UTC; the same in '{seen.names[i]}' is not "
        f"used: declare table: {{time: {{column: {i + 1}}}}} if that is wrong"
        for i in others
        if _is_same_clock(i, time, seen)
    ]


def _says_zone(column: int, seen: FirstRows) -> bool:
    filled = [r[column] for r in seen.rows if not is_empty(r[column])]
    return stated_zone([seen.names[column]]) is not None or mostly(filled, _ends_in_zone, 0.9, len(filled))


def _ends_in_zone(cell: Cell) -> bool:
    return isinstance(cell, str) and _ZONED.search(cell.strip()) is not None


def _is_same_clock(local: int, zoned: int, seen: FirstRows) -> bool:
    """Whether two columns differ by the same quarters of an hour in all rows, or by two values an hour apart where
    clocks change; by their times of day, whose digits are the same in all orders of a date."""
    if _OF_ITS_WAY.search(seen.names[zoned]):
        return False
    pairs = [(a, b) for r in seen.rows if (a := _clock(r[local])) and (b := _clock(r[zoned]))]
    if 2 * len(pairs) < len(seen.rows) or len({a for a, _ in pairs}) < 2:
        return False
    step = max(coarse for pair in pairs for _, coarse in pair)  # one may leave parts of a second out
    apart = {(b // step - a // step) * step % _DAY_MS for (a, _), (b, _) in pairs}
    if any(ms % _QUARTER_MS for ms in apart) or len(apart) > 2:
        return False
    low, high = min(apart), max(apart)
    return low == high or high - low in (_HOUR_MS, _DAY_MS - _HOUR_MS)


def _clock(cell: Cell) -> tuple[int, int] | None:
    """(time of day [ms], what its last digit counts in [ms]); None where a cell holds none."""
    if hasattr(cell, "hour"):
        return ((cell.hour * 60 + cell.minute) * 60 + cell.second) * 1000 + cell.microsecond // 1000, 1
    match = _CLOCK.search(cell) if isinstance(cell, str) else None
    if match is None:
        return None
    hour, minute, second, part, half = match.groups()
    hours = int(hour) if half is None else int(hour) % 12 + 12 * (half in "Pp")
    ms = int(((part or "") + "000")[:3])
    coarse = 60_000 if second is None else 1000 if part is None else 1
    return ((hours * 60 + int(minute)) * 60 + int(second or 0)) * 1000 + ms, coarse
