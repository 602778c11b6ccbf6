"""Julian days, in which SQLite's julianday() counts: 2461143.75 is 2026-04-13 06:00 UTC."""

from __future__ import annotations

import re
from decimal import Decimal

from thermodata.reader.times.zone import NAT

_JULIAN = re.compile(r"\s*(24[3-8]\d{4}\.\d+)\s*", re.ASCII)  # of the years 1941 to 2131
_OF_1970 = Decimal("2440587.5")
_DAY_NS = 86_400 * 10**9


def julian_ns(cell: str) -> int:
    """Nanoseconds since 1970 of a number of days; NAT where it is none."""
    match = _JULIAN.fullmatch(cell)
    return NAT if match is None else int((Decimal(match[1]) - _OF_1970) * _DAY_NS)
