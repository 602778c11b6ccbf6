"""Units of time that state what they count from: 's since 2000-01-01 00:00:00 UTC', 'Sekunden seit 01.01.1904',
'GPS time, s since 1980-01-06', or a name: 'seconds_since_1904'."""

from __future__ import annotations

import re
from dataclasses import dataclass
from datetime import datetime, timedelta
from functools import lru_cache

_UNITS = {
    "s": r"s|secs?|sek|seconds?|sekunden?|secondes|segundos|secondi|sekund",
    "min": r"min|mins|minutes?|minuten|minuti|minutos|minut",
    "h": r"h|hrs?|hours?|stunden|std|heures|ore|horas|hodin",
    "d": r"d|days?|tage|tagen|jours|giorni|dias|dn[ií]",
    "ms": r"ms|msec|milliseconds?|millisekunden",
    "us": r"us|µs|μs|usec|microseconds?|mikrosekunden",
    "ns": r"ns|nanoseconds?|nanosekunden",
}
_SINCE = r"since|seit(?:\s+dem)?|after|depuis(?:\s+le)?|desde(?:\s+el)?|dal|od"
_MONTHS = ["jan", "feb", "mar", "apr", "may", "jun", "jul", "aug", "sep", "oct", "nov", "dec"]
_DATE = (
    r"(?P<y>\d{4})-(?P<m>\d{1,2})-(?P<d>\d{1,2})(?!\d)|(?P<d2>\d{1,2})(?P<mark>[./])(?P<m2>\d{1,2})(?P=mark)"
    r"(?P<y2>\d{4})"
    rf"|(?P<d3>\d{{1,2}})\.?[ -](?P<n3>{'|'.join(_MONTHS)})[a-z]*\.?[ -](?P<y3>\d{{4}})"
    rf"|(?P<n4>{'|'.join(_MONTHS)})[a-z]*\.? (?P<d4>\d{{1,2}}),? (?P<y4>\d{{4}})"
    r"|(?P<y5>1900|1904|1970|1980|2000)(?![\d.:/-])"
)
_CLOCK = r"(?:(?:\s*,)?[ t]\s*(?P<hh>\d{1,2}):(?P<mm>\d{2})(?::(?P<ss>\d{2})(?:[.,](?P<part>\d{1,9})?\d*)?)?)?"
_ZONE = r"(?:\s*\(?(?P<zone>z|utc|gmt|ut)(?![a-z])(?P<own>[+-]\d{1,2}(?::?\d{2})?)?|\s*(?P<off>[+-]\d{2}:?\d{2}))?"
_MOMENT = re.compile(rf"(?i)(?:{_DATE}){_CLOCK}{_ZONE}")
_COUNT = re.compile(
    rf"(?i)(?<![\w.])(?<!\d )(?:{'|'.join(f'(?P<u_{unit}>{words})' for unit, words in _UNITS.items())})\.?\s*"
    rf"(?:[\])]\s*)?(?:elapsed |passed |vergangen )?(?:{_SINCE})\s+(?:the )?(?=\d|{'|'.join(_MONTHS)})"
)
# what all programs count in seconds from is in UTC, said or not
_OF_PROGRAMS = frozenset(datetime(y, m, d) for y, m, d in ((1900, 1, 1), (1904, 1, 1), (1970, 1, 1), (1980, 1, 6)))
_OF_UNIX = datetime(1970, 1, 1)
# scales that count leap seconds, and where they begin; clocks that go by PTP count these or UTC
PTP = "ptp"
_LEAPING = re.compile(r"(?i)(?<![a-z])(?:(?P<tai>tai)|(?P<gps>gps)|(?P<ptp>ptp))(?![a-z])")
_ZERO_S = {"tai": 0, "gps": 315_964_800, PTP: 0}
_UTC = re.compile(r"(?i)(?<![a-z])(?:utc|gmt|unix|posix)(?![a-z])|\d\s*z(?![a-z])")
_STEPS = {"s": "", "ms": "_ms", "us": "_us", "ns": "_ns"}  # of counts by these scales, behind their names
_JOINED = re.compile(r"(?<=\d)_(?=\d)")


@dataclass(frozen=True, slots=True)
class Zero:
    """What times count from. zero_s: on the Unix scale [s]; local: in the time of the place, not in UTC; part_ns: of a
    second, behind zero_s."""

    zero_s: int
    local: bool
    part_ns: int = 0

    def unit(self, of: str) -> str:
        """The unit of a count of 's', 'min', 'd', ... from there, as `since` reads it."""
        moment = _OF_UNIX + timedelta(seconds=self.zero_s)
        part = f".{self.part_ns:09d}".rstrip("0") if self.part_ns else ""
        return f"{of} since {moment.isoformat()}{part}{'' if self.local else 'z'}".lower()


@lru_cache(maxsize=1024)
def since(text: str) -> tuple[str, Zero] | None:
    """(unit, zero) of a text that says a count from a date somewhere in it; None where it says none."""
    low = text.lower()
    if not any(word in low for word in ("since", "seit", "after", "depuis", "desde", "dal", "od ")):
        return None
    if "since" in low or "seit" in low:  # of a name: 'seconds_since_2000_01_01'
        low = _JOINED.sub("-", low).replace("_", " ")
    count = _COUNT.search(low)
    if count is None:
        return None
    unit = next(name for name in _UNITS if count[f"u_{name}"])
    zero = moment_in(low[count.end() :], seconds=unit != "d")
    return None if zero is None else (unit, zero)


def count_in(text: str) -> str | None:
    """The unit of a count from a date that a text says: 's since 2000-01-01t00:00:00z', or 'gps_ms' where it is of a
    scale that counts leap seconds. None where it says none."""
    found = since(text)
    if found is None:
        return None
    unit, zero = found
    scale = leaping(text, zero)
    return f"{scale}{_STEPS[unit]}" if scale not in (None, PTP) and unit in _STEPS else zero.unit(unit)


def leaping(text: str, zero: Zero) -> str | None:
    """'tai' of 'PTP (TAI), ns since 1970-01-01': the scale with leap seconds that a count from its zero is said to be
    of, `PTP` where that leaves it open; None where the text says UTC, too, or another zero."""
    named = {str(m.lastgroup) for m in _LEAPING.finditer(text.replace("_", " "))}
    fitting = [scale for scale in _ZERO_S if scale in named and _ZERO_S[scale] == zero.zero_s]
    return fitting[0] if fitting and _UTC.search(text) is None else None


def leaves_leaps_open(text: str) -> bool:
    """Whether a text says a count by PTP, and not whether it counts leap seconds."""
    found = since(text)
    return found is not None and leaping(text, found[1]) == PTP


def moment_in(text: str, seconds: bool = True) -> Zero | None:
    """The moment that a text begins with, as what times count from; None where it is none, or where its day and month
    may be either way round. seconds: whether smaller units than days count from it."""
    match = _MOMENT.match(text.lower().strip())
    if match is None:
        return None
    part = match.groupdict()
    year, month, day = (
        _first_filled(part, keys) for keys in (("y", "y2", "y3", "y4", "y5"), ("m", "m2"), ("d", "d2", "d3", "d4"))
    )
    if (name := part["n3"] or part["n4"]) is not None:
        month = str(_MONTHS.index(name) + 1)
    if part["y5"]:
        month, day = "1", "6" if year == "1980" else "1"
    if year is None or month is None or day is None or (part["mark"] == "/" and month != day):
        return None
    try:
        # days of a year are counted from the day before its first
        hour, minute, second = (int(part[k] or 0) for k in ("hh", "mm", "ss"))
        moment = datetime(int(year), int(month), int(day) or 1, hour, minute, second)
    except ValueError:
        return None
    moment -= timedelta(days=int(day) == 0)
    offset = part["own"] or part["off"]
    zoned = part["zone"] is not None or offset is not None or (seconds and moment in _OF_PROGRAMS)
    ahead = timedelta(0)
    if offset is not None:
        digits = offset[1:].replace(":", "")
        ahead = timedelta(hours=int(digits[:2]), minutes=int(digits[2:] or 0)) * (-1 if offset[0] == "-" else 1)
    part_ns = int((part["part"] or "0").ljust(9, "0"))
    return Zero(round((moment - ahead - _OF_UNIX).total_seconds()), not zoned, part_ns)


def _first_filled(part: dict[str, str | None], keys: tuple[str, ...]) -> str | None:
    return next((part[k] for k in keys if part[k] is not None), None)
