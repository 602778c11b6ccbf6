"""Times as receivers of GPS count them: the number of the week since 1980-01-06 and the seconds in it, in two columns.
UTC lags by the leap seconds since then, which are taken off."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from functools import partial

import numpy as np

from thermodata.plugin import Array, Int1D
from thermodata.reader.text.cells.cell import Cell, is_empty, is_number, number_of
from thermodata.reader.text.names.header import split_unit
from thermodata.reader.times.time_units import EPOCHS
from thermodata.reader.times.zone import NAT

_WEEK_S = 604_800
_ROLL = 1024  # after which the number of ten bits that satellites send begins anew: in 1999, 2019 and 2038
_SINCE_2001, _BEFORE_2100 = 1095, 6262  # weeks
_WEEK = re.compile(r"(?i)(?P<gps>gps[ _.]?)?(?:week|wk|wn|week[ _]?(?:no|nr|number))")
_IN_WEEK = re.compile(
    r"(?i)(?:gps[ _.]?)?(?P<sure>i?tow|sow|(?:time|seconds?|secs?)[ _]?(?:of|in)[ _]?(?:the[ _])?week)"
    r"(?:[ _](?P<a>m?s))?|gps[ _.]?(?:time|seconds?|secs?|s)(?:[ _](?P<b>m?s))?|gps[ _.]?(?P<c>ms)"
)
_PIECE = re.compile(r"gps_week(?:\+(?P<more>\d{4}))?")
_STEPS_NS = {"gps_s": 10**9, "gps_ms": 10**6}


def find_weeks(names: Sequence[str], data: Sequence[Sequence[Cell]]) -> tuple[tuple[int, int], str] | None:
    """(columns, format) of a week of GPS and the time in it, by their names and values: 'gps_week gps_s', with
    'gps_week+2048' for a number that began anew. None where there are none."""
    weeks = {i: m for i, name in enumerate(names) if (m := _WEEK.fullmatch(_without_unit(name))) is not None}
    times = {i: m for i, name in enumerate(names) if (m := _IN_WEEK.fullmatch(_without_unit(name))) is not None}
    if len(weeks) != 1 or len(times) != 1:
        return None
    (week, in_week), (place, of_week) = next(iter(weeks.items())), next(iter(times.items()))
    if not (in_week["gps"] or of_week["sure"]):
        return None
    numbers = [(_number(r[week]), _number(r[place])) for r in data if not is_empty(r[week]) and not is_empty(r[place])]
    whole = [(w, s) for w, s in numbers if w is not None and s is not None and not w % 1 and w >= 0 <= s]
    if len(whole) < max(2, 0.9 * len(data)):
        return None
    first, last = min(w for w, _ in whole), max(w for w, _ in whole)
    more = 0 if first >= _SINCE_2001 else 2 * _ROLL if last < _ROLL else None
    if more is None or last + more >= _BEFORE_2100:
        return None
    unit = of_week["a"] or of_week["b"] or of_week["c"] or split_unit(names[place])[1] or ""
    milli = unit.casefold() == "ms" or max(s for _, s in whole) >= _WEEK_S
    if max(s for _, s in whole) >= _WEEK_S * (1000 if milli else 1):
        return None
    return (week, place), f"gps_week{f'+{more}' if more else ''} gps_{'ms' if milli else 's'}"


def may_be_of_weeks(name: str) -> bool:
    """Whether a column is called as a week of GPS or as the time in it is."""
    return _WEEK.fullmatch(_without_unit(name)) is not None or _IN_WEEK.fullmatch(_without_unit(name)) is not None


def reads_weeks(pieces: Sequence[str]) -> Callable[[str], int] | None:
    """What reads '2417 108000.5' in the pieces 'gps_week', 'gps_s' of a format; None where they are others."""
    week = _PIECE.fullmatch(pieces[0]) if len(pieces) == 2 and pieces[1] in _STEPS_NS else None
    return None if week is None else partial(_utc_of_week, int(week["more"] or 0), _STEPS_NS[pieces[1]])


def seconds_of_weeks(weeks: Array, in_week: Array, form: str) -> Array:
    """Seconds since 1980-01-06, with leap seconds, of weeks and the times in them, shapes (n,)."""
    week, step = form.split()
    more = _PIECE.fullmatch(week)
    counted = weeks.astype(np.float64) + int((more and more["more"]) or 0)
    seconds: Array = counted * _WEEK_S + in_week.astype(np.float64) * (_STEPS_NS[step] / 1e9)
    return seconds


def utc_of_weeks(weeks: Array, in_week: Array, form: str) -> Int1D:
    """Nanoseconds since 1970 UTC of weeks and the times in them, shapes (n,); NAT where one is none."""
    week, step = form.split()
    more = _PIECE.fullmatch(week)
    counted, within = weeks.astype(np.float64), in_week.astype(np.float64) * _STEPS_NS[step]
    with np.errstate(invalid="ignore"):
        good = (counted >= 0) & (counted < _BEFORE_2100) & (counted % 1 == 0) & (within >= 0) & (within < _WEEK_S * 1e9)
    whole = np.where(good, counted, 0).astype(np.int64) + int((more and more["more"]) or 0)
    ns = whole * (_WEEK_S * 10**9) + np.rint(np.where(good, within, 0)).astype(np.int64)
    return np.where(good, EPOCHS["gps_ns"].ns(ns), NAT)


def _utc_of_week(more: int, step_ns: int, text: str) -> int:
    cells = text.split()
    week, in_week = (_number(c) for c in cells) if len(cells) == 2 else (None, None)
    if week is None or in_week is None or week % 1 or week < 0 or not 0 <= in_week * step_ns < _WEEK_S * 10**9:
        return NAT
    ns = (int(week) + more) * _WEEK_S * 10**9 + round(in_week * step_ns)
    utc: Int1D = EPOCHS["gps_ns"].ns(np.array([ns], np.int64))
    return int(utc[0])


def _number(cell: Cell) -> float | None:
    return number_of(cell) if is_number(cell) and not isinstance(cell, bool) else None


def _without_unit(name: str) -> str:
    return split_unit(name)[0].strip(" #.:_")
