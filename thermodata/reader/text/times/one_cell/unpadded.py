"""Milliseconds that a program wrote without their zeros in front: '08:00:00.50' between '.0' and '.100' is 50 ms, and
would be half a second as a decimal fraction."""

from __future__ import annotations

import re
from collections.abc import Iterable

UNPADDED = "milliseconds without the zeros in front"
_FRACTION = re.compile(r":\d{2}[.,](\d{1,3})(?!\d)")
_FEWEST = 5


def unpadded_note(cells: Iterable[str]) -> str | None:
    """A note where the fractions of a second in a column can be no decimals: those have one length, or no zero at
    their end."""
    found = [m[1] for c in cells if (m := _FRACTION.search(c))]
    if len({len(f) for f in found}) < 2 or any(len(f) > 1 and f.startswith("0") for f in found):
        return None
    ending = [f for f in found if len(f) == 2 and f.endswith("0")]
    if len(found) < _FEWEST or not ending or max(map(len, found)) < 3:
        return None
    return (
        f"fractions of a second look like {UNPADDED}, as '.{ending[0]}' does beside fractions of three digits: read "
        "as decimals they stand at a wrong time; export them with three digits"
    )
