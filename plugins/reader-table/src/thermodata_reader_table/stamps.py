"""Dates and times as tables write them. The order of day and month is read from the whole column, never guessed."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from thermodata.errors import FormatError, UsageError
from thermodata.plugin import Int1D
from thermodata.reader.text import local_to_utc_ns
from thermodata.reader.zone import NAT

_CLOCK = r"(\d{1,2}):(\d{2})(?::(\d{2})(?:[.,:](\d{1,9}))?\d*)?\s*([AaPp][Mm])?"
_ZONE = r"\s*(Z|[+-]\d{2}:?\d{2})?"
_YEAR_FIRST = re.compile(
    rf"^(\d{{4}})[-/.年년]\s?(\d{{1,2}})[-/.月월]\s?(\d{{1,2}})[日일]?"
    rf"(?:(?:[T _]+|(?<=[日일])){_CLOCK}{_ZONE})?$"
)
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


@dataclass(frozen=True, slots=True)
class Writing:
    """How the dates of a column are written. kind: year_first, year_last, clock (no date) or form."""

    kind: str
    month_first: bool = False
    form: str | None = None

    @property
    def pattern(self) -> re.Pattern[str]:
        return _YEAR_FIRST if self.kind == "year_first" else _YEAR_LAST


def find_writing(parts: Iterable[Sequence[str]], form: str | None, where: str) -> Writing:
    """The writing of a column, from as many of its parts as it takes to know which number is the month.

    FormatError where day and month could be either way round in the whole column, or no cell is a date.
    """
    if form is not None:
        return Writing("form", form=form)
    kind: str | None = None
    first: re.Match[str] | None = None
    for cells in parts:
        if kind is None:
            sample = [c.strip() for c in cells[:1000]]
            if sum(map(is_time_of_day, sample)) > 0.5 * len(sample):
                return Writing("clock")
            if sum(_YEAR_FIRST.match(c) is not None for c in sample) > 0.5 * len(sample):
                return Writing("year_first")
            kind = "year_last"
        for cell in cells:
            match = _YEAR_LAST.match(cell.strip())
            if match is None:
                continue
            first = first or match
            if match[2] == "." or int(match[1]) > 12:
                return Writing("year_last")
            if int(match[3]) > 12:
                return Writing("year_last", month_first=True)
    if first is None:
        raise FormatError(
            "no date in the time column",
            where=where,
            expected="2026-03-01 08:00:00, 1.3.2026 8:00, ...",
            hint="declare table: {time: {column: ..., format: '%d.%m.%Y %H:%M:%S'}}",
        )
    raise FormatError(
        "day and month of the dates could be either way round",
        where=where,
        expected="one date with a day above 12",
        got=first[0],
        hint="declare table: {time: {format: '%d/%m/%Y %H:%M:%S'}} or '%m/%d/%Y ...'",
    )


@dataclass(frozen=True, slots=True)
class Local:
    """Times of a part of a column. ns: shape (n,), local, or UTC where `zoned` (the cells name their offset), or
    from midnight where the writing is a clock's; NAT where a cell holds no time."""

    ns: Int1D
    zoned: bool


def local(cells: Sequence[str], writing: Writing) -> Local:
    """Local times of cells of a known writing."""
    if writing.kind == "form":
        return _by_format(cells, writing.form or "")
    if writing.kind == "clock":
        return Local(
            np.array(
                [_clock_ns(list(m.groups())) if (m := _TIME_ONLY.match(c.strip())) else NAT for c in cells], np.int64
            ),
            False,
        )
    fast = _iso(cells) if writing.kind == "year_first" else None
    if fast is not None:
        return Local(fast.astype("datetime64[ns]").view(np.int64), False)
    ns = np.full(len(cells), NAT, np.int64)
    shift = np.zeros(len(cells), np.int64)
    zoned = np.zeros(len(cells), bool)
    days: dict[tuple[str, str, str], int | None] = {}
    for i, cell in enumerate(cells):
        match = writing.pattern.match(cell.strip())
        if match is None:
            continue
        if writing.kind == "year_first":
            year, month, day, *clock, offset = match.groups()
        else:
            day, _, month, year, *clock, offset = match.groups()
            if writing.month_first:
                day, month = month, day
        key = (year, month, day)
        if key not in days:
            days[key] = _day(_year(year), month, day)
        midnight, time = days[key], _clock_ns(clock)
        if midnight is None or time == NAT:
            continue
        ns[i] = midnight + time
        if offset:
            zoned[i] = True
            shift[i] = _offset_ns(offset)
    if zoned.any():
        return Local(np.where(zoned & (ns != NAT), ns - shift, NAT), True)
    return Local(ns, False)


def resolved(parts: Sequence[Local], writing: Writing, timezone: str | None) -> Stamps:
    """All parts of a column in UTC: local times want the whole, for the order of all rows tells the hour that
    repeats, and which midnight a clock has passed."""
    ns = np.concatenate([p.ns for p in parts]) if parts else np.zeros(0, np.int64)
    if writing.kind == "clock":
        return times_of_day(ns)
    if any(p.zoned for p in parts):
        # a part that names no offset among parts that do is no time
        whole = [p.ns if p.zoned else np.full(p.ns.shape, NAT, np.int64) for p in parts]
        return Stamps(np.concatenate(whole), True, ())
    utc, notes = local_to_utc_ns(ns.view("datetime64[ns]"), timezone)
    return Stamps(utc, True, tuple(notes))


def parse(cells: Sequence[str], timezone: str | None, form: str | None, where: str) -> Stamps:
    """Times of a column of texts, in UTC. form: a strptime format, else what is_date and is_time_of_day know.

    FormatError where day and month could be either way round in the whole column.
    """
    writing = find_writing([cells], form, where)
    return resolved([local(cells, writing)], writing, timezone)


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


def times_of_day(t: Int1D) -> Stamps:
    """Times of day without a date count from the first; each step back by half a day is the next midnight."""
    good = t != NAT
    values = t[good]
    half_day = 43_200_000_000_000
    nights = np.cumsum(np.concatenate(([0], (np.diff(values) < -half_day).astype(np.int64)))) if values.size else values
    t[good] = values + nights * 2 * half_day - (values[0] if values.size else 0)
    return Stamps(t, False, ("times of day without a date: counted from the first row",))


def _by_format(cells: Sequence[str], form: str) -> Local:
    import pandas as pd

    try:
        parsed = pd.to_datetime(
            pd.Series(list(cells), dtype=object).str.strip(), format=form, errors="coerce", utc="%z" in form
        )
    except ValueError as error:
        raise UsageError(
            "no such format of dates",
            expected="strptime's, such as %d.%m.%Y %H:%M:%S",
            got=form,
            hint=str(error).splitlines()[0],
        ) from None
    zoned = "%z" in form
    naive = parsed.dt.tz_localize(None) if zoned else parsed
    return Local(naive.to_numpy("datetime64[ns]").view(np.int64), zoned)


def _year(text: str) -> str:
    return text if len(text) == 4 else f"20{text}"


def _day(year: str, month: str, day: str) -> int | None:
    try:
        return int(np.datetime64(f"{year}-{int(month):02}-{int(day):02}", "ns").astype(np.int64))
    except ValueError:
        return None


def _clock_ns(clock: Sequence[str | None]) -> int:
    """From midnight; NAT where there is no such time."""
    hour, minute, second, fraction, half = clock
    if hour is None:
        return 0
    h = int(hour)
    if h > 23 or int(minute or 0) > 59 or int(second or 0) > 59 or (half and not 1 <= h <= 12):
        return int(NAT)
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
