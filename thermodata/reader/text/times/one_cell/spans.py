"""Spans of time as programs write them: 1.02:03:04 (.NET), 0 days 00:00:10 (pandas), 10 sec (MATLAB), T#1m10s (IEC
61131-3), PT1M10S (ISO 8601). They count from a start; what is written as a time of day alone may be one."""

from __future__ import annotations

import re
from collections.abc import Sequence
from itertools import pairwise

from thermodata.reader.text.cells.time_forms.time_pattern import DAY_NS, TimeFormat
from thermodata.reader.times.zone import NAT

_S = 10**9
_FINE = 10**9  # parts of a nanosecond that nine decimals of one tell apart
_UNITS = {
    **dict.fromkeys(["d", "day", "days"], DAY_NS),
    **dict.fromkeys(["h", "hr", "hrs", "hour", "hours", "std"], 3600 * _S),
    **dict.fromkeys(["m", "min", "mins", "minute", "minutes"], 60 * _S),
    **dict.fromkeys(["s", "sec", "secs", "second", "seconds", "sek"], _S),
    **dict.fromkeys(["ms", "msec"], _S // 1000),
    **dict.fromkeys(["us", "µs", "μs", "usec"], _S // 10**6),
    "ns": 1,
}
_CLOCK = re.compile(
    r"(?P<sign>-)?(?:(?P<days>\d{1,5})(?:\.| ?days?,? (?P<own>[+-]?)))?(?P<H>\d{1,5}):(?P<M>[0-5]\d):(?P<S>[0-5]\d)"
    r"(?:[.,](?P<f>\d{1,9})\d*)?",
    re.ASCII | re.IGNORECASE,
)
_PREFIX = re.compile(r"(?P<prefix>L?T(?:IME)?#|P)", re.IGNORECASE)
_PART = re.compile(r"\s*(\d{1,12})(?:[.,](\d{1,9}))?\s*([µμ]s|[A-Za-z]+)", re.ASCII)
_LONGEST = 60  # letters of a cell that holds a span
_LAST_NS = 100 * 366 * DAY_NS


def _ns(cell: str) -> int:
    """Nanoseconds of a span; NAT where a cell is none."""
    text = cell.strip()
    if not text or len(text) > _LONGEST:
        return NAT
    clock = _CLOCK.fullmatch(text) if ":" in text else None
    if clock is not None:
        days, hours = int(clock["days"] or 0) * DAY_NS, int(clock["H"])
        if clock["days"] is not None and hours > 23:
            return NAT
        of_day = (hours * 3600 + int(clock["M"]) * 60 + int(clock["S"])) * _S + int((clock["f"] or "0").ljust(9, "0"))
        first = -1 if clock["sign"] else 1
        # -1.02:03:04 is all negative, but beside a word for days the clock has a sign of its own: -1 days +23:59:50
        second = first if clock["own"] is None else -1 if clock["own"] == "-" else 1
        return first * days + second * of_day
    return _of_words(text) if text[-1].isalpha() else NAT  # most cells that are asked are plain numbers


def _of_words(text: str) -> int:
    """Nanoseconds of numbers with their units, from the largest to the smallest; NAT where a text is none."""
    negative, text = text.startswith("-"), text.removeprefix("-")
    prefix = _PREFIX.match(text)
    rest = text[prefix.end() :] if prefix else text
    if prefix is not None and prefix[0] in "pP":
        day, mark, clock = rest.upper().partition("T")
        rest = day + clock if mark or "D" in day else "?"
    total, last, parts = 0, _LAST_NS, 0  # total: in ns / _FINE
    at = 0
    while at < len(rest):
        part = _PART.match(rest, at)
        each = None if part is None else _UNITS.get(part[3].casefold())
        if part is None or each is None or each >= last:
            return NAT
        total += int(part[1] + (part[2] or "").ljust(9, "0")) * each
        last, at, parts = each, part.end(), parts + 1
        # "10 m" may be a length
        if prefix is None and parts == 1 and at == len(rest) and part[3] in ("m", "M"):
            return NAT
    ns, left = divmod(total, _FINE)
    ns += 2 * left + (ns & 1) > _FINE  # half to even
    return NAT if not parts or ns > _LAST_NS else -ns if negative else ns


SPAN = TimeFormat("time", None, "a span of time: 1.02:03:04, 0 days 00:00:10, 10 sec, T#1m10s, PT10S", reads=_ns)


def is_span(cell: str) -> bool:
    """Whether a text is a span that says so: with days, or with units."""
    ns = _ns(cell)
    clock = _CLOCK.fullmatch(cell.strip()) if ns != NAT else None
    return ns != NAT and (clock is None or clock["days"] is not None)


def are_spans(cells: Sequence[str]) -> bool:
    """Whether the cells of a column that hold anything are spans that never fall, and some of them say so; a time of
    day that is damaged is none."""
    ns = [_ns(c) for c in cells if c and c.strip()]
    good = [n for n in ns if n != NAT]
    return len(good) > 0.8 * len(ns) and any(map(is_span, cells)) and all(a <= b for a, b in pairwise(good))
