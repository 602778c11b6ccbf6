"""Dates and times as tables write them. The order of day and month is read from the whole column, never guessed."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from thermodata.errors import FormatError
from thermodata.plugin import Int1D
from thermodata.reader.text import local_to_utc_ns
from thermodata.reader.zone import NAT

_CLOCK = r"(\d{1,2}):(\d{2})(?::(\d{2})(?:[.,:](\d{1,9}))?\d*)?\s*([AaPp][Mm])?"
_ZONE = r"\s*(Z|[+-]\d{2}:?\d{2})?"
_YEAR_FIRST = re.compile(rf"^(\d{{4}})[-/.](\d{{1,2}})[-/.](\d{{1,2}})(?:[T _]+{_CLOCK}{_ZONE})?$")
_YEAR_LAST = re.compile(rf"^(\d{{1,2}})([-/.])\s?(\d{{1,2}})\2\s?(\d{{4}}|\d{{2}})(?:,?[T _]+{_CLOCK}{_ZONE})?$")
_ISO = re.compile(r"^\d{4}-\d\d-\d\d[T ]\d\d:\d\d(:\d\d(\.\d{1,9})?)?$")
_TIME_ONLY = re.compile(rf"^{_CLOCK}$")


def is_date(text: str) -> bool:
    text = text.strip()
    return bool(_YEAR_FIRST.match(text) or _YEAR_LAST.match(text))


def is_time_of_day(text: str) -> bool:
    return bool(_TIME_ONLY.match(text.strip()))


@dataclass(frozen=True, slots=True)
class Stamps:
    """t_ns: shape (n,), `NAT` where a cell holds no time; absolute: False for times of day without a date."""

    t_ns: Int1D
    absolute: bool
    notes: tuple[str, ...]


def parse(cells: Sequence[str], timezone: str | None, form: str | None, where: str) -> Stamps:
    """Times of a column of texts, in UTC. form: a strptime format, else what is_date and is_time_of_day know.

    FormatError where day and month could be either way round in the whole column.
    """
    if form is not None:
        return _by_format(cells, timezone, form)
    sample = [c.strip() for c in cells[:1000]]
    if sum(map(is_time_of_day, sample)) > 0.5 * len(sample):
        return _times_of_day(cells)
    fast = _iso(cells)
    if fast is not None:
        utc, notes = local_to_utc_ns(fast, timezone)
        return Stamps(utc, True, tuple(notes))
    year_first = sum(_YEAR_FIRST.match(c) is not None for c in sample) > 0.5 * len(sample)
    pattern = _YEAR_FIRST if year_first else _YEAR_LAST
    month_first = not year_first and _month_first(cells, where)
    local = np.full(len(cells), NAT, np.int64)
    shift = np.zeros(len(cells), np.int64)
    zoned = np.zeros(len(cells), bool)
    days: dict[tuple[str, str, str], int | None] = {}
    for i, cell in enumerate(cells):
        match = pattern.match(cell.strip())
        if match is None:
            continue
        if year_first:
            year, month, day, *clock, offset = match.groups()
        else:
            day, _, month, year, *clock, offset = match.groups()
            if month_first:
                day, month = month, day
        key = (year, month, day)
        if key not in days:
            days[key] = _day(_year(year), month, day)
        midnight = days[key]
        if midnight is None:
            continue
        local[i] = midnight + _clock_ns(clock)
        if offset:
            zoned[i] = True
            shift[i] = _offset_ns(offset)
    if zoned.any():
        return Stamps(np.where(zoned, local - shift, NAT), True, ())
    utc, notes = local_to_utc_ns(local.view("datetime64[ns]"), timezone)
    return Stamps(utc, True, tuple(notes))


def _iso(cells: Sequence[str]) -> npt.NDArray[np.datetime64] | None:
    """Dates of one width such as 2026-03-01 08:00:00.125, at numpy's speed; None where any is written otherwise."""
    width = len(cells[0]) if cells else 0
    if not width or any(len(c) != width or _ISO.match(c) is None for c in cells):
        return None
    try:
        return np.array(cells, dtype="datetime64[ns]")
    except ValueError:
        return None


def local_stamps(naive: npt.NDArray[np.datetime64], timezone: str | None) -> Stamps:
    """The same from cells that are dates already (a workbook's)."""
    utc, notes = local_to_utc_ns(naive, timezone)
    return Stamps(utc, True, tuple(notes))


def _times_of_day(cells: Sequence[str]) -> Stamps:
    """Times of day without a date count from midnight; each step back is the next midnight."""
    t = np.array([_clock_ns(list(m.groups())) if (m := _TIME_ONLY.match(c.strip())) else NAT for c in cells], np.int64)
    good = t != NAT
    values = t[good]
    half_day = 43_200_000_000_000
    nights = np.cumsum(np.concatenate(([0], (np.diff(values) < -half_day).astype(np.int64)))) if values.size else values
    t[good] = values + nights * 2 * half_day - (values[0] if values.size else 0)
    return Stamps(t, False, ("times of day without a date: counted from the first row",))


def _by_format(cells: Sequence[str], timezone: str | None, form: str) -> Stamps:
    import pandas as pd

    parsed = pd.to_datetime(pd.Series(list(cells), dtype=object).str.strip(), format=form, errors="coerce",
                            utc="%z" in form)
    if "%z" in form:
        return Stamps(parsed.dt.tz_localize(None).to_numpy("datetime64[ns]").view(np.int64), True, ())
    utc, notes = local_to_utc_ns(parsed.to_numpy("datetime64[ns]"), timezone)
    return Stamps(utc, True, tuple(notes))


def _month_first(cells: Sequence[str], where: str) -> bool:
    """Whether the month comes first, by the first date of which one number is above 12."""
    first: re.Match[str] | None = None
    for cell in cells:
        match = _YEAR_LAST.match(cell.strip())
        if match is None:
            continue
        first = first or match
        if match[2] == "." or int(match[1]) > 12:
            return False
        if int(match[3]) > 12:
            return True
    if first is None:
        raise FormatError("no date in the time column", where=where, expected="2026-03-01 08:00:00, 1.3.2026 8:00, ...",
                          hint="declare table: {time: {column: ..., format: '%d.%m.%Y %H:%M:%S'}}")
    raise FormatError("day and month of the dates could be either way round", where=where,
                      expected="one date with a day above 12", got=first[0],
                      hint="declare table: {time: {format: '%d/%m/%Y %H:%M:%S'}} or '%m/%d/%Y ...'")


def _year(text: str) -> str:
    return text if len(text) == 4 else f"20{text}"


def _day(year: str, month: str, day: str) -> int | None:
    try:
        return int(np.datetime64(f"{year}-{int(month):02}-{int(day):02}", "ns").astype(np.int64))
    except ValueError:
        return None


def _clock_ns(clock: Sequence[str | None]) -> int:
    hour, minute, second, fraction, half = clock
    if hour is None:
        return 0
    h = int(hour)
    if half:
        h = h % 12 + (12 if half.lower() == "pm" else 0)
    seconds = (h * 60 + int(minute or 0)) * 60 + int(second or 0)
    return seconds * 1_000_000_000 + int((fraction or "0").ljust(9, "0"))


def _offset_ns(text: str) -> int:
    if text == "Z":
        return 0
    digits = text[1:].replace(":", "")
    minutes = int(digits[:2]) * 60 + int(digits[2:])
    return (-minutes if text[0] == "-" else minutes) * 60_000_000_000
