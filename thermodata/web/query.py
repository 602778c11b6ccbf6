"""Numbers out of an address; what is no number is refused in words."""

from __future__ import annotations

import math
from collections.abc import Mapping

from thermodata.errors import UsageError


def number_in(given: Mapping[str, str], name: str, default: int) -> int:
    """A whole number that is at least 0."""
    text = given.get(name, "")
    if not text:
        return default
    if not text.isdecimal() or len(text) > 9:
        raise UsageError(
            f"'{name}' is a whole number",
            got=text[:60],
            hint="give it in digits, without a point",
        )
    return int(text)


def seconds_in(given: Mapping[str, str], name: str) -> float | None:
    """A finite number [s]; None where there is none."""
    text = given.get(name, "")
    if not text:
        return None
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise UsageError(
            f"'{name}' is a time in seconds",
            got=text[:60],
            hint="give seconds from the start of the test: 3600",
        )
    return value
