"""Times written as numbers: seconds, minutes, ... from any start, or counted from a date (datenum, Excel, Unix).

The one list of units of time, for readers of text and of arrays alike.
"""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import Any

import numpy as np

from thermodata.errors import FormatError
from thermodata.plugin import Array, Int1D
from thermodata.reader.times.open_questions import UNKNOWN, unanswered
from thermodata.reader.times.since import count_in, since
from thermodata.reader.times.time_words import UNIT_OF_WORD
from thermodata.reader.times.zone import NAT

_DAY = 86400.0
SECONDS = {
    "s": 1.0,
    "sec": 1.0,
    "sek": 1.0,
    "second": 1.0,
    "seconds": 1.0,
    "sekunden": 1.0,
    "secs": 1.0,
    "min": 60.0,
    "minute": 60.0,
    "minutes": 60.0,
    "minuten": 60.0,
    "mins": 60.0,
    "h": 3600.0,
    "hr": 3600.0,
    "hrs": 3600.0,
    "hod": 3600.0,
    "std": 3600.0,
    "hour": 3600.0,
    "hours": 3600.0,
    "stunden": 3600.0,
    "d": _DAY,
    "day": _DAY,
    "days": _DAY,
    "ms": 1e-3,
    "msec": 1e-3,
    "us": 1e-6,
    "µs": 1e-6,
    "μs": 1e-6,
    "usec": 1e-6,
    "ns": 1e-9,
    "秒": 1.0,
    "分": 60.0,
    "小时": 3600.0,
    "時間": 3600.0,
}


@dataclass(frozen=True, slots=True)
class Epoch:
    """seconds: of one unit; zero_s: its zero on the Unix scale [s]; local: in the time of the place, not in UTC; years:
    the units are years, each as long as it is, and `seconds` is their mean; leaps: by how many leap seconds it was
    ahead of UTC in 1980, where it counts them, and UTC does not; None where it does not either; part_ns: of a second,
    behind zero_s."""

    seconds: float
    zero_s: int
    local: bool
    years: bool = False
    leaps: int | None = None
    part_ns: int = 0

    def ns(self, values: Array) -> Int1D:
        """Nanoseconds on the Unix scale, in UTC or local time, shape as values; NAT where a number is no time."""
        if self.years:
            return _ns_of_years(values)
        ns = to_ns(values, self.seconds, self.zero_s)
        if self.part_ns:
            ns = np.where(ns == NAT, NAT, ns + self.part_ns)
        return ns if self.leaps is None else _without_leaps(ns, self.leaps)


class _Epochs(dict[str, Epoch]):
    """The counts from a date by their names, and any other that states its own: 's since 2000-01-01'."""

    def __missing__(self, name: str) -> Epoch:
        found = since(name)
        if found is None:
            raise KeyError(name)
        unit, zero = found
        return Epoch(SECONDS[unit], zero.zero_s, zero.local, part_ns=zero.part_ns)

    def __contains__(self, name: object) -> bool:
        return super().__contains__(name) or (isinstance(name, str) and since(name) is not None)

    def get(self, name: str, default: Any = None) -> Any:
        try:
            return self[name]
        except KeyError:
            return default


_STEPS = {"": 1.0, "_ms": 1e-3, "_us": 1e-6, "_ns": 1e-9}
EPOCHS = _Epochs(
    {
        "datenum": Epoch(_DAY, -719529 * 86400, True),
        "excel": Epoch(_DAY, -25569 * 86400, True),
        "excel1904": Epoch(_DAY, -24107 * 86400, True),
        "mjd": Epoch(_DAY, -40587 * 86400, False),  # modified Julian days, since 1858-11-17
        "jd": Epoch(_DAY, -210_866_760_000, False),  # Julian days, which begin at noon
        "unix": Epoch(1.0, 0, False),
        "posix": Epoch(1.0, 0, False),
        "unix_ms": Epoch(1e-3, 0, False),
        "unix_us": Epoch(1e-6, 0, False),
        "unix_ns": Epoch(1e-9, 0, False),
        "labview": Epoch(1.0, -2082844800, False),
        "filetime": Epoch(1e-7, -11644473600, False),
        "ticks": Epoch(1e-7, -62135596800, True),  # of .NET, which programs mostly take in local time
        "decimal_year": Epoch(365.2425 * _DAY, -62167219200, True, years=True),  # 2026.5 is in the middle of 2026
        "ntp": Epoch(1.0, -2208988800, False),
        # both count leap seconds, too; PTP's own scale is TAI
        **{f"gps{of}": Epoch(seconds, 315964800, False, leaps=0) for of, seconds in _STEPS.items()},
        **{f"tai{of}": Epoch(seconds, 0, False, leaps=19) for of, seconds in _STEPS.items()},
    }
)
# the midnights at whose beginning UTC lagged by a second more, since 1980
_LEAPS = np.array(
    [
        *("1981-07", "1982-07", "1983-07", "1985-07", "1988-01", "1990-01", "1991-01", "1992-07", "1993-07", "1994-07"),
        *("1996-01", "1997-07", "1999-01", "2006-01", "2009-01", "2012-07", "2015-07", "2017-01"),
    ],
    "datetime64[s]",
).astype(np.int64)
# other words for them: of Windows' OLE automation, in which Gantner and .NET count Excel's days
_ALSO = {
    "ole": "excel",
    "ole date": "excel",
    "oledate": "excel",
    "oadate": "excel",
    "excel date": "excel",
    "matlab datenum": "datenum",
    "unix time": "unix",
    "epoch": "unix",
    "decimal year": "decimal_year",
    "decimal years": "decimal_year",
    "unix s": "unix",
    "unix ms": "unix_ms",
}
_WITHOUT_STEP = ("epoch", "unix time")
_LOGGED_NS = (978_307_200 * 10**9, 4_102_444_800 * 10**9)  # 2001 to 2100
_OF_CLOCKS_S = 2 * _DAY  # by which a logger's clock may be ahead, its zone in it
REACH_S = 9e9  # beyond which nanoseconds in int64 end


def date_of_count(number: float, unit: str) -> str:
    """The day and hour that a count from a date says."""
    (ns,) = EPOCHS[unit].ns(np.array([number], np.float64))
    return str(np.datetime64((int(ns) + 5 * 10**8) // 10**9, "s")).replace("T", " ")


def known_unit(text: str) -> str | None:
    """A unit of time, or a count from a date, by its name here: 'excel' of '[OLE]'. None where it is none."""
    low = text.strip().strip("[]()").strip().lower()
    low = _ALSO.get(low, low)
    low = low if low in SECONDS else UNIT_OF_WORD.get(low.removesuffix("."), low)
    if low not in SECONDS and (stated := count_in(low)) is not None:
        return stated
    return low if low in SECONDS or low in EPOCHS else None


def with_step(text: str | None) -> str | None:
    """A unit of time; None where it names a count since 1970 and leaves open in what, so that its size has to tell:
    'epoch' is in seconds, ms or µs."""
    return None if text is not None and text.strip().strip("[]()").strip().lower() in _WITHOUT_STEP else text


def check_unit(text: str, where: str) -> str:
    """A unit of time in lower case; FormatError with the known ones where it is none."""
    if (known := known_unit(text)) is not None:
        return known
    if text.strip().strip("[]()").lower() == UNKNOWN:
        raise unanswered("time.unit", "s, min, h or ms", where)
    raise FormatError(
        f"unknown unit of time '{text}'",
        where=where,
        got=text,
        expected=", ".join(k for k in SECONDS if k.isascii()) + "; or, counted from a date, " + ", ".join(EPOCHS),
        hint="declare it: table: {time: {column: NAME, unit: s}}",
    )


def is_logged(values: Array, unit: str) -> bool:
    """Whether counts from a date, shape (n,), are of years in which anything is logged."""
    ns = EPOCHS[unit].ns(values)
    ns = ns[ns != NAT]
    return bool(ns.size) and _LOGGED_NS[0] < int(ns.min()) and int(ns.max()) < _LOGGED_NS[1]


def is_absolute(unit: str) -> bool:
    return unit in EPOCHS


def to_ns(values: Array, seconds: float, zero_s: int = 0) -> Int1D:
    """Nanoseconds of a count of units; NAT where it is no number or beyond 285 years."""
    out = np.full(values.shape, NAT, np.int64)
    each = round(seconds * 1e9)
    zero, rest = divmod(zero_s * 10**9, each)  # in units: FILETIME's zero is no time in int64 nanoseconds
    if values.dtype.kind in "iu":
        low, high = (int((sign * REACH_S - zero_s) / seconds) for sign in (-1, 1))
        whole = (values >= max(low, np.iinfo(np.int64).min)) & (values <= min(high, np.iinfo(np.int64).max))
        out[whole] = (values[whole].astype(np.int64) + zero) * each + rest
        return out
    with np.errstate(over="ignore", invalid="ignore"):
        full = values.astype(np.float64)
        good = np.isfinite(full) & (np.abs(full * seconds + zero_s) < REACH_S) & (np.abs(full * seconds) < 1e12)
    safe = full if good.all() else np.where(good, full, 0.0)
    base = np.floor(safe)
    part = safe - base  # exact: the whole and the fraction keep all digits of the double
    if seconds >= 1:
        whole_ns = (base.astype(np.int64) * round(seconds) + zero_s) * 1_000_000_000
        out = whole_ns + np.rint(part * (seconds * 1e9)).astype(np.int64)
    else:
        out = (base.astype(np.int64) + zero) * each + np.rint(part * each).astype(np.int64)
    return out if safe is full else np.where(good, out, NAT)


def _without_leaps(ns: Int1D, leaps: int) -> Int1D:
    """UTC of times that count leap seconds; they are of the Unix scale but for those."""
    lag_s = leaps + np.searchsorted(_LEAPS * 10**9 + (np.arange(_LEAPS.size) + leaps + 1) * 10**9, ns, side="right")
    utc: Int1D = np.where(ns == NAT, NAT, ns - lag_s.astype(np.int64) * 10**9)
    return utc


def _ns_of_years(values: Array) -> Int1D:
    """Nanoseconds of decimal years, to the millisecond: ten digits behind the point tell no more."""
    full = values.astype(np.float64)
    good = (full >= 1700) & (full < 2200)
    safe = np.where(good, full, 1970.0)
    year = np.floor(safe).astype(np.int64)
    begin, end = ((year - 1970 + k).astype("datetime64[Y]").astype("datetime64[s]").astype(np.int64) for k in (0, 1))
    ms = begin * 1000 + np.rint((safe - year) * (end - begin) * 1000).astype(np.int64)
    return np.where(good, ms * 1_000_000, NAT)


def found_epoch(values: Array) -> str | None:
    """Which count from a date numbers without a unit are, where their size leaves no other sense: MATLAB's datenum
    (from 1862 to 2135), Unix time, Windows' FILETIME, .NET's ticks (2000 to 2035 all), LabVIEW's seconds since 1904
    until now: what they would date later may as well count from 1900, as NTP does."""
    full = values.astype(np.float64)
    full = full[np.isfinite(full)]
    if not full.size:
        return None
    low, high = float(full.min()), float(full.max())
    for unit, first, last in (
        ("datenum", 680_000, 780_000),
        ("unix", 9.4e8, 2.1e9),
        ("labview", 3.0e9, time.time() - EPOCHS["labview"].zero_s + _OF_CLOCKS_S),
        ("unix_ms", 9.4e11, 2.1e12),
        ("unix_us", 9.4e14, 2.1e15),
        ("filetime", 1.259e17, 1.37e17),
        ("ticks", 6.308e17, 6.42e17),
        ("unix_ns", 9.4e17, 2.1e18),
    ):
        if first <= low <= high <= last and (unit != "datenum" or high - low < 4000):
            return unit
    return None
