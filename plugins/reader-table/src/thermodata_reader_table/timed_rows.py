"""Rows that have a time: others are not delivered, and not counted."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from thermodata.plugin import Int1D
from thermodata.reader.times.zone import NAT


def nth_timed_row(parts: Iterable[Int1D], row: int) -> int | None:
    """The number, from 0, of the row-th time that is one."""
    done = start = 0
    for t_ns in parts:
        good = np.flatnonzero(t_ns != NAT)
        if row < done + good.size:
            return start + int(good[row - done])
        done, start = done + good.size, start + t_ns.size
    return None
