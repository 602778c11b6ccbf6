"""The order of a stream's rows in time: where a clock was reset, and which short stretches are to be sorted.

Nothing here is as long as the stream: rows are looked at in chunks, and what is kept is a few numbers a chunk.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from thermodata.plugin import Int1D
from thermodata.store.rawfile import JITTER_NS

CHUNK_ROWS = 500_000
_NEAR, _LONGEST = 256, 65_536         # rows: stretches that lie so near are sorted as one, up to this length
Times = Callable[[int, int], Int1D]


@dataclass(frozen=True, slots=True)
class Order:
    """keep: rows up to here are the stream's; beyond, a clock went back that may not.

    resets, shifts: rows at which the clock was reset, and what is added to the times from there on, shapes (k,).
    islands: (first, past-the-last) rows of the stretches that are out of order, shape (m, 2): sorting each of them
    sorts the stream.
    """

    keep: int
    resets: Int1D
    shifts: Int1D
    islands: Int1D

    def moved(self, t_ns: Int1D, start: int) -> Int1D:
        """Times of the rows from start on, with what the resets add."""
        if not len(self.resets):
            return t_ns
        total = np.concatenate([[0], self.shifts])
        moved: Int1D = t_ns + total[np.searchsorted(self.resets, np.arange(start, start + len(t_ns)), side="right")]
        return moved


def in_order(n: int) -> Order:
    """Of rows that are in order."""
    empty = np.empty(0, np.int64)
    return Order(n, empty, empty, np.empty((0, 2), np.int64))


def find_order(times: Times, n: int, *, resets_allowed: bool) -> Order:
    """Looks at the times of n rows, twice. A step back by up to JITTER_NS is disorder; a longer one is a reset."""
    keep, resets, shifts, lowest = _resets(times, n, resets_allowed)
    found = Order(keep, np.array(resets, np.int64), np.array(shifts, np.int64), np.empty((0, 2), np.int64))
    return Order(keep, found.resets, found.shifts, _islands(times, found, lowest))


def _resets(times: Times, n: int, allowed: bool) -> tuple[int, list[int], list[int], list[int]]:
    """(rows to keep, rows of resets, shifts from there on, the earliest time of each chunk)."""
    resets: list[int] = []
    shifts: list[int] = []
    lowest: list[int] = []
    shift, highest = 0, np.iinfo(np.int64).min
    recent = np.empty(0, np.int64)
    for first in range(0, n, CHUNK_ROWS):
        t = times(first, min(n, first + CHUNK_ROWS)) + shift
        at = 0
        while True:
            high = np.maximum(np.maximum.accumulate(t[at:]), highest)
            behind = np.flatnonzero(t[at:] < high - JITTER_NS)
            if not behind.size:
                break
            row = at + int(behind[0])
            if not allowed:
                lowest.append(int(t[:row].min()) if row else int(np.iinfo(np.int64).max))
                return first + row, resets, shifts, lowest
            before = np.concatenate([recent, t[:row]])[-100:]
            step = int(np.median(np.diff(before))) if len(before) > 1 else 1
            delta = int(high[row - at - 1] if row > at else highest) + max(step, 1) - int(t[row])
            t[row:] += delta
            shift += delta
            resets.append(first + row)
            shifts.append(shift)
            highest, at = int(t[row]), row
        highest = max(highest, int(high[-1]))
        recent = np.concatenate([recent, t])[-100:]
        lowest.append(int(t.min()))
    return n, resets, shifts, lowest


def _islands(times: Times, order: Order, lowest: list[int]) -> Int1D:
    """The stretches between which the stream may be cut: all before is no later than all behind."""
    top = np.iinfo(np.int64).max
    later = np.append(np.minimum.accumulate(np.array(lowest, np.int64)[::-1])[::-1], top)
    highest = np.iinfo(np.int64).min
    runs: list[tuple[int, int]] = []
    for chunk, first in enumerate(range(0, order.keep, CHUNK_ROWS)):
        t = order.moved(times(first, min(order.keep, first + CHUNK_ROWS)), first)
        before = np.maximum(np.concatenate([[highest], np.maximum.accumulate(t)[:-1]]), highest)
        behind = np.minimum(np.minimum.accumulate(t[::-1])[::-1], later[chunk + 1])
        torn = (before > behind).view(np.int8)                  # no cut before this row
        edges = np.flatnonzero(np.diff(np.concatenate([[0], torn, [0]])))
        for a, b in zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True):
            _append(runs, first + a - 1, first + b)
        highest = max(highest, int(t.max(initial=highest)))
    return np.array(runs, np.int64).reshape(-1, 2)


def _append(runs: list[tuple[int, int]], start: int, stop: int) -> None:
    if runs and (start < runs[-1][1] or (start - runs[-1][1] <= _NEAR and stop - runs[-1][0] <= _LONGEST)):
        runs[-1] = (runs[-1][0], stop)
    else:
        runs.append((start, stop))
