"""Times of day in one number, zeros in front left out: 80000 for 8:00:00 in the format %H%M%S."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from functools import partial

from thermodata.reader.times.zone import NAT

_NS = (3600 * 10**9, 60 * 10**9, 10**9)


def joined_clock(text: str) -> Callable[[str], int] | None:
    """What reads '80000' and '5' in the format '%H%M%S'; None for another format."""
    return partial(read_joined, 6 if "%S" in text else 4) if re.fullmatch(r"%H%M(%S)?", text) else None


def read_joined(digits: int, cell: str) -> int:
    """Nanoseconds in the day of a number of as many digits at most, NAT where it is none. 2400 ends a day."""
    bare = re.sub(r"[.,]0*$", "", cell.strip())
    if not (bare.isascii() and bare.isdecimal() and len(bare) <= digits):
        return NAT
    padded = bare.zfill(digits)
    parts = [int(padded[k : k + 2]) for k in range(0, digits, 2)]
    if max(parts[1:]) > 59 or parts[0] > 24 or (parts[0] == 24 and any(parts[1:])):
        return NAT
    return sum(p * ns for p, ns in zip(parts, _NS, strict=False))


def format_of_joined(cells: Sequence[str]) -> str | None:
    """'%H%M%S' or '%H%M' of cells that are such numbers; None where they are others, or too short to tell."""
    longest = max(map(len, cells), default=0)
    letters, digits = ("%H%M%S", 6) if longest > 4 else ("%H%M", 4)
    return letters if longest >= 3 and all(read_joined(digits, c) != NAT for c in cells) else None
