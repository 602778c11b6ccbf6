"""Dates of a sheet whose day and month a spreadsheet exchanged as it opened a text of the other order: '3/1/2026' is
1 March, and became 3 January. What it could not read so, a day above 12, stayed a text."""

from __future__ import annotations

import datetime as dt
import re
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from thermodata.errors import FormatError, QuestionError
from thermodata.plugin import Int1D
from thermodata.reader.text.times.in_memory import Stamps, times_of_dates
from thermodata.reader.text.times.one_cell import timestamp
from thermodata.reader.text.times.time_formats import find_formats
from thermodata.reader.times.open_questions import ASK, UNKNOWN, unanswered
from thermodata.reader.times.zone import NAT
from thermodata.schema.words.sentences import counted

SWAPPED, SHOWN = "swapped", "shown"
_TURNED = "day and month of its dates were exchanged: turned, for its rows go on from day to day only so"
_DAY_NS, _LEAST_APART = 86_400 * 10**9, 20 * 86_400 * 10**9
_MOST_DAY = 12
_ORDERS = ("dmy", "mdy")
_GOES_ON = 3  # usual steps, at most, from the last row of a day to the first of the next
_FEWEST_ROWS, _FEWEST_DAYS = 3, 4  # a day; in all
_TEXT = re.compile(r"\s*(\d{1,2})[/.-](\d{1,2})[/.-]\d{4}(?!\d)")


def swapped_times(cells: Sequence[Any], zone: str | None, declared: str | None, where: str) -> Stamps | None:
    """The times of cells that are dates, or dates and texts, where what is declared turns the dates; None where nothing
    is to be turned. declared: as `table.time.format`.

    QuestionError where they look as if day and month had been exchanged; FormatError where 'swapped' cannot be.
    """
    dates = [c for c in cells if isinstance(c, dt.datetime)]
    if not dates:
        return None
    if declared == UNKNOWN:
        raise unanswered("time.format", f"{SWAPPED}, {SHOWN}, dmy or mdy", where)
    may_be = all(d.day <= _MOST_DAY for d in dates)
    texts = [c for c in cells if isinstance(c, str) and c.strip()]
    order = _order_of(texts) if texts and may_be else None
    if declared == SWAPPED and (not may_be or (texts and order is None)):
        raise FormatError(
            "day and month of these dates were not exchanged",
            where=where,
            expected="dates with days of 1 to 12, and texts with days above",
            got=texts[0] if may_be else str(next(d for d in dates if d.day > _MOST_DAY)),
            hint=f"declare table: {{time: {{format: {'mdy' if texts else SHOWN}}}}}",
        )
    if texts:
        if order is None:
            return None
        if declared is None:
            raise _question_of_mixed(dates, texts, order, where)
        spelled = order if declared == SWAPPED else declared
        return _of_both(cells, zone, spelled, where) if order == _declared_order(spelled) else None
    if may_be and declared is not None and _declared_order(declared) in _ORDERS and not _looks_swapped(dates):
        return _as_shown(cells, dates, declared, zone)
    if declared == SHOWN or (declared != SWAPPED and not (may_be and _looks_swapped(dates))):
        return None
    if declared is None:
        raise _exchanged(dates, where)
    times = times_of_dates(_naive([_swapped(c) for c in cells]).view("datetime64[ns]"), zone)
    return times if declared == SWAPPED else replace(times, notes=(*times.notes, _TURNED))


def _as_shown(cells: Sequence[Any], dates: Sequence[dt.datetime], declared: str, zone: str | None) -> Stamps:
    """The times of cells that are all dates, where an order is declared as of texts: what made dates of the others of
    its source may have exchanged day and month of all of these."""
    times = times_of_dates(_naive(cells).view("datetime64[ns]"), zone)
    first = dates[0]
    note = (
        f"all cells of the time are dates, which '{declared}' does not turn: {ASK} {first:%Y-%m-%d} or "
        f"{_swapped(first):%Y-%m-%d}? declare table: {{time: {{format: {SHOWN}}}}} where they are right, or "
        f"{{format: {SWAPPED}}} where a spreadsheet exchanged day and month, as in a file of texts and dates"
    )
    return replace(times, notes=(*times.notes, note))


def _exchanged(dates: Sequence[dt.datetime], where: str) -> QuestionError:
    shown, turned = (" to ".join(f"{d:%Y-%m-%d}" for d in ends) for ends in (_ends(dates), map(_swapped, _ends(dates))))
    return QuestionError(
        "day and month of the dates look exchanged",
        where=where,
        expected="days that follow each other",
        got=f"{shown}, a month ahead from each day to the next",
        hint=f"declare table: {{time: {{format: {SWAPPED}}}}}, or {{format: {SHOWN}}} where they are right",
        ask=f"format of the dates: {SWAPPED} or {SHOWN}? they go from {shown}, a month ahead from day to day; "
        f"with day and month exchanged from {turned}, day by day",
        declare={"time": {"format": UNKNOWN}},
        meanwhile={"time": {"format": SHOWN}},
    )


def _ends(dates: Sequence[dt.datetime]) -> tuple[dt.datetime, dt.datetime]:
    return dates[0], dates[-1]


def _question_of_mixed(dates: Sequence[dt.datetime], texts: Sequence[str], order: str, where: str) -> QuestionError:
    both = f"{counted(len(dates), 'cell')} {'is a date' if len(dates) == 1 else 'are dates'}, {len(texts)} are text"
    return QuestionError(
        "the time column mixes dates and texts",
        where=where,
        expected="dates alone, or texts alone",
        got=f"{both}: {dates[0]:%Y-%m-%d} and '{texts[0].strip()}'",
        hint=f"declare table: {{time: {{format: {SWAPPED}}}}}, which reads files of dates alone as well, or "
        f"{{format: {order}}}: what made dates of the others exchanged day and month",
        ask=f"format of the dates: {SWAPPED} or {order}? {both} such as '{texts[0].strip()}', and no date is of a "
        f"day above 12: their day and month are exchanged, {dates[0]:%Y-%m-%d} is {_swapped(dates[0]):%Y-%m-%d}",
        declare={"time": {"format": UNKNOWN}},
        meanwhile={"time": {"format": SWAPPED}},
    )


def _of_both(cells: Sequence[Any], zone: str | None, declared: str, where: str) -> Stamps | None:
    """Texts as they are declared, dates turned round."""
    texts = [c if isinstance(c, str) else "" for c in cells]
    (form,) = find_formats([""], [[t for t in texts if t.strip()]], declared, where)
    if form.role == "time" or form.zoned:
        return None
    ns = np.where(_naive(cells) == NAT, timestamp.parse(texts, form), _naive([_swapped(c) for c in cells]))
    return times_of_dates(ns.view("datetime64[ns]"), zone)


def _naive(cells: Sequence[Any]) -> Int1D:
    shown = [c.isoformat() if isinstance(c, dt.datetime) else "NaT" for c in cells]
    return np.array(shown, "datetime64[ns]").view(np.int64)


def _swapped(cell: Any) -> Any:
    return cell.replace(month=cell.day, day=cell.month) if isinstance(cell, dt.datetime) else cell


def _order_of(texts: Sequence[str]) -> str | None:
    """The one order in which all of some texts are dates, none of which the other order could read; None else."""
    parts = [(int(m[1]), int(m[2])) for t in texts if (m := _TEXT.match(t))]
    if not parts or len(parts) < 0.9 * len(texts):
        return None
    if all(a <= _MOST_DAY < b for a, b in parts):
        return "mdy"
    return "dmy" if all(b <= _MOST_DAY < a for a, b in parts) else None


def _declared_order(declared: str) -> str:
    """dmy or mdy, also of strptime's letters."""
    letters = re.findall(r"%([dm])", declared)
    return f"{''.join(letters[:2])}y" if len(letters) >= 2 else declared


def _looks_swapped(dates: Sequence[dt.datetime]) -> bool:
    """Whether rows go on from day to day only once day and month are exchanged: as they stand, each day but the first
    begins about a month behind the one before, on one day of the month."""
    shown, turned = _naive(dates), _naive([_swapped(d) for d in dates])
    new = np.flatnonzero(shown[1:] // _DAY_NS != shown[:-1] // _DAY_NS)
    if not new.size or shown.size < _FEWEST_ROWS * (new.size + 1):  # a row a month is a sound table
        return False
    step = np.median(np.abs(np.diff(turned)))
    apart, pause = np.abs(np.diff(shown))[new], np.abs(np.diff(turned))[new]
    if not (apart >= _LEAST_APART).all():
        return False
    if step > 0 and (pause <= _GOES_ON * step).all():
        return True
    # a session a day
    days = np.diff((turned // _DAY_NS)[np.concatenate([[0], new + 1])])
    return new.size + 1 >= _FEWEST_DAYS and bool((days == 1).all())
