"""Which parts of a time stand between colons: 05:10 may be five minutes or five hours. Told by the header ("Time
(mm:ss)"), declared (`format: mm:ss`), or asked where the cells may be either."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from itertools import pairwise

from thermodata.errors import QuestionError
from thermodata.reader.text.cells.cell import Cell
from thermodata.reader.text.names.time_header import unit_of_time
from thermodata.reader.times.open_questions import UNKNOWN

CLOCKS = ("mm:ss", "hh:mm", "hh:mm:ss")  # what may be declared in place of strptime's letters
_HOURS, _MINUTES, _SECONDS = (
    r"\[?(?:h{1,3}|hrs?|hours?|std|hod)\]?",
    r"\[?(?:m{1,3}|mins?|minutes?)\]?",
    r"\[?(?:s{1,2}|se[ck]s?|seconds?)\]?",
)
_SPELLED = {
    "hh:mm:ss": f"{_HOURS}:{_MINUTES}:{_SECONDS}",
    "mm:ss": f"{_MINUTES}:{_SECONDS}",
    "hh:mm": f"{_HOURS}:{_MINUTES}",
}
_HEADERS = {said: re.compile(rf"(?i)(?<![^\W_])(?<!:){body}(?![^\W_])(?!:)") for said, body in _SPELLED.items()}
_OF_DAY = re.compile(r"(?i)uhrzeit|time[ _]of[ _]day|clock")
_TWO_PARTS = re.compile(r"\s*'?(\d{1,5}):(\d{2})(?:[.,]\d{1,9})?\s*", re.ASCII)
_FIRST = 40  # cells that show how a column begins
_SOME = 0.01  # of the cells go beyond the hours of a day: fewer may be damaged


def said_clock(header: str, unit: str | None, cells: Sequence[Cell]) -> str | None:
    """The parts that a header names, where its cells have two: "mm:ss" or "hh:mm"; None where it says nothing of
    them, or where the cells have three and leave nothing open."""
    if not _pairs(cells):
        return None
    text = f"{header} {unit or ''}"
    said = next((s for s, known in _HEADERS.items() if known.search(text)), None)
    if said is not None:
        return said if said != "hh:mm:ss" else None
    return "hh:mm" if unit_of_time(header, unit) in ("h", "hr", "hrs", "std", "hod", "hour", "hours") else None


def ask_for_minutes(name: str, cells: Sequence[str], more: Callable[[], Sequence[str]], where: str) -> None:
    """QuestionError where cells such as 05:10 may be minutes and seconds: they go on behind 23, begin at 00:00 in even
    steps, or stand under another unit than theirs ("Time [min]", "hh:mm:ss"). more: further cells."""
    begin = _pairs(cells[:_FIRST])
    if not begin:
        return
    pairs = _pairs([*cells, *more()])
    beyond = sum(first > 23 for first, _ in pairs)
    other = _HEADERS["hh:mm:ss"].search(name) is not None or unit_of_time(name) is not None
    past = beyond > 1 and beyond >= _SOME * len(pairs)
    if not (past or other or (_from_zero(begin) and not _OF_DAY.search(name))):
        return
    shown = ", ".join(c.strip() for c in cells[:3])
    raise QuestionError(
        f"times of two parts that may be minutes and seconds, or hours and minutes: '{name}'",
        where=where,
        expected="a header that names them, such as 'Time (mm:ss)', or their format declared",
        got=f"{shown} ...",
        hint="declare table: {time: {format: mm:ss}} or {format: hh:mm}",
        ask=f"format of the times: mm:ss or hh:mm? they begin with {shown}"
        + (f" and reach {max(pairs)[0]}:{max(pairs)[1]:02d}" if past else ""),
        declare={"time": {"format": UNKNOWN}},
        meanwhile={"time": {"format": "mm:ss" if past else "hh:mm"}},
    )


def _pairs(cells: Sequence[Cell]) -> list[tuple[int, int]]:
    """Both numbers of each cell; none where not nearly all have two."""
    full = [c for c in cells if c not in ("", None)]
    found = [m for c in full if isinstance(c, str) and (m := _TWO_PARTS.fullmatch(c))]
    return [(int(m[1]), int(m[2])) for m in found] if len(found) > 0.8 * len(full) else []


def _from_zero(pairs: Sequence[tuple[int, int]]) -> bool:
    """Whether they count from zero in even steps, as a recording does and a day's clock hardly ever."""
    counts = [60 * a + b for a, b in pairs]
    steps = [b - a for a, b in pairwise(counts)]
    return len(steps) > 1 and counts[0] == 0 and steps[0] > 0 and steps.count(steps[0]) >= 0.9 * len(steps)
