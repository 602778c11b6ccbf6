"""Times of rows in LabVIEW's texts: dates and times of day, seconds since 1904, seconds from a start, rows counted."""

from __future__ import annotations

from fractions import Fraction

import numpy as np

from thermodata.plugin import Bool1D, Float1D, Int1D
from thermodata.reader.text.cells.time_forms.time_pattern import DAY_NS, TIME_OF_DAY, declared_format, with_zone
from thermodata.reader.text.times.one_cell.timestamp import parse_one
from thermodata.reader.times.time_units import to_ns
from thermodata.reader.times.zone import NAT, local_to_utc_ns
from thermodata_reader_crio.labview_clock import EPOCH_1904_NS, LABVIEW_SECONDS, LAST_NS

# 1/3/2026 is of January or of March, and 1.3.26 of any year: a date that LabVIEW did not write so is none
_DATES = tuple(map(declared_format, ("%Y/%m/%d", "%Y-%m-%d", "%Y.%m.%d", "%Y.%m.%d.", "%d.%m.%Y", "%d. %m. %Y")))
_TIME = with_zone(TIME_OF_DAY, False)


def local_ns(date: str, time: str) -> int | None:
    """Nanoseconds of a local date and time, as if they were UTC; None where they are none, or before LabVIEW's
    first year."""
    day = next((ns for form in _DATES if (ns := parse_one(date, form)) != NAT), None)
    of_day = parse_one(time, _TIME)
    return None if day is None or of_day == NAT or day < EPOCH_1904_NS else day + of_day


def is_zero(date: str) -> bool:
    """Whether a date is that of LabVIEW's zero, the begin of 1904 in UTC, in whatever zone: nobody set it."""
    day = next((ns for form in _DATES if (ns := parse_one(date, form)) != NAT), None)
    return day is not None and abs(day - EPOCH_1904_NS) <= DAY_NS


def utc_ns(local: Int1D, timezone: str | None) -> tuple[Int1D, list[str]]:
    """(UTC of the local starts of pieces in their order, shape (n,); notes of what had to be decided)."""
    return local_to_utc_ns(local.view("datetime64[ns]"), timezone, of="starts")


def is_labview_seconds(values: Float1D) -> bool:
    """Whether numbers are seconds since 1904 of the years 1997 to 2040."""
    finite = values[np.isfinite(values)]
    return bool(finite.size) and LABVIEW_SECONDS[0] <= float(np.median(finite)) <= LABVIEW_SECONDS[1]


def seconds_ns(values: Float1D, start_ns: int) -> tuple[Int1D, Bool1D]:
    """(nanoseconds, whether there is a time at all) of seconds from a start, shape (n,)."""
    since = to_ns(values, 1.0)
    good: Bool1D = (since != NAT) & (np.abs(since) < LAST_NS - abs(start_ns))
    return np.where(good, since + start_ns, start_ns), good


def counted_ns(first: int, n: int, step: Fraction, start_ns: int) -> tuple[Int1D, Bool1D]:
    """The same of rows [first, first + n) that are counted."""
    i = np.arange(first, first + n, dtype=np.int64)
    if abs(start_ns) + (first + n) * step >= LAST_NS:
        return np.full(n, start_ns, np.int64), np.zeros(n, bool)
    whole, rest = divmod(step.numerator, step.denominator)
    return start_ns + i * whole + ((i * rest) // step.denominator if rest else 0), np.ones(n, bool)
