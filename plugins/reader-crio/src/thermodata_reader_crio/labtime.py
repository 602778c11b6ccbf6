"""Times as LabVIEW writes them in text: dates and times of day, seconds since 1904, seconds from a start."""

from __future__ import annotations

import re
from fractions import Fraction

import numpy as np

from thermodata.plugin import Bool1D, Float1D, Int1D
from thermodata.reader.zone import local_to_utc_ns
from thermodata_reader_crio.labview_clock import EPOCH_1904_NS, LABVIEW_SECONDS, LAST_NS

_BILLION = 1_000_000_000
_TIME = re.compile(r"^(\d{1,2}):(\d{2})(?::(\d{2})(?:[.,](\d+))?)?\s*([AaPp])?\.?(?:[Mm]\.?)?$")
_DATES = (
    re.compile(r"^(?P<y>\d{4})[/.\-](?P<m>\d{1,2})[/.\-](?P<d>\d{1,2})\.?$"),
    re.compile(r"^(?P<d>\d{1,2})\.\s?(?P<m>\d{1,2})\.\s?(?P<y>\d{4})$"),
)


def local_ns(date: str, time: str) -> int | None:
    """Nanoseconds of a local date and time, as if they were UTC; None where they are none."""
    day = next((m for p in _DATES if (m := p.match(date.strip()))), None)
    hour = _TIME.match(time.strip())
    if day is None or hour is None:
        return None
    h = int(hour[1])
    if hour[5]:
        h = h % 12 + (12 if hour[5] in "pP" else 0)
    try:
        naive = np.datetime64(
            f"{int(day['y']):04}-{int(day['m']):02}-{int(day['d']):02}T{h:02}:{hour[2]}:{hour[3] or '00'}", "s"
        )
    except ValueError:
        return None
    if not 1904 <= int(day["y"]) <= 2200:
        return None
    return int(naive.astype(np.int64)) * _BILLION + int((hour[4] or "0")[:9].ljust(9, "0"))


def utc_ns(local: int, timezone: str | None, notes: list[str]) -> int:
    """UTC of a local time; what had to be decided is noted."""
    found, more = local_to_utc_ns(np.array([local], np.int64).view("datetime64[ns]"), timezone)
    notes.extend(n for n in more if n not in notes)
    return int(found[0])


def is_labview_seconds(values: Float1D) -> bool:
    """Whether numbers are seconds since 1904 of the years 1997 to 2040."""
    finite = values[np.isfinite(values)]
    return bool(finite.size) and LABVIEW_SECONDS[0] <= float(np.median(finite)) <= LABVIEW_SECONDS[1]


def seconds_ns(values: Float1D, start_ns: int) -> tuple[Int1D, Bool1D]:
    """(nanoseconds, whether there is a time at all) of seconds from a start, shape (n,). Whole seconds and the rest
    are taken apart, for seconds since 1904 with microseconds are at the end of what a double holds."""
    good = np.isfinite(values) & (np.abs(values) < (LAST_NS - abs(start_ns)) / _BILLION)
    safe = np.where(good, values, 0.0)
    whole = np.floor(safe)
    rest = np.rint((safe - whole) * _BILLION).astype(np.int64)
    return whole.astype(np.int64) * _BILLION + rest + start_ns, good


def counted_ns(first: int, n: int, step: Fraction, start_ns: int) -> tuple[Int1D, Bool1D]:
    """The same of rows [first, first + n) that are counted."""
    i = np.arange(first, first + n, dtype=np.int64)
    if abs(start_ns) + (first + n) * step >= LAST_NS:
        return np.full(n, start_ns, np.int64), np.zeros(n, bool)
    whole, rest = divmod(step.numerator, step.denominator)
    return start_ns + i * whole + ((i * rest) // step.denominator if rest else 0), np.ones(n, bool)


__all__ = ["EPOCH_1904_NS", "counted_ns", "is_labview_seconds", "local_ns", "seconds_ns", "utc_ns"]
