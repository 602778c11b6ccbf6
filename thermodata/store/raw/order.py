"""The order of a stream's rows in time: where a clock was set, and which short stretches are to be sorted.

Nothing here is as long as the stream: rows are looked at in chunks, and what is kept is a few numbers a chunk.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from thermodata.plugin import Int1D
from thermodata.reader.times.clock_leaps import LEAP_NS
from thermodata.schema.words.sentences import counted
from thermodata.store.raw.clock_faults import JITTER_NS, MOST_STRAYS, Faults, shifted

CHUNK_ROWS = 500_000
_NEAR, _LONGEST = 256, 65_536  # rows: stretches that lie so near are sorted as one, up to this length
_LEAST_OF_RING = 4  # rows: of fewer, strays are not told from a seam
_PERIODS_OF_SEAM = 3.0  # from the last row of a ring buffer to its first one
Times = Callable[[int, int], Int1D]


@dataclass(frozen=True, slots=True)
class Order:
    """keep: rows up to here are the stream's; beyond, a clock went back that may not.

    at, shifts: rows from which on another shift holds, and the shifts that are added to the times, shapes (k,) and
    (k + 1,): the first one holds from row 0. marked: rows whose time was made or at which the clock was set.
    islands: (first, past-the-last) rows of the stretches that are out of order, shape (m, 2): sorting each of them
    sorts the stream. extent: the earliest and latest time. notes: what was found, in words. trusted: whether each row
    has a time of its own, so that one which is out of order is no doubtful one.
    """

    keep: int
    at: Int1D
    shifts: Int1D
    marked: Int1D
    islands: Int1D
    extent: tuple[int, int] = (0, 0)
    notes: tuple[str, ...] = ()
    trusted: bool = False

    def moved(self, t_ns: Int1D, start: int) -> Int1D:
        """Times of the rows from start on, with the shifts."""
        if not len(self.at) and not self.shifts[0]:
            return t_ns
        return t_ns + shifted(self.at, self.shifts, start, len(t_ns))


def in_order(n: int) -> Order:
    """Of rows that are in order."""
    empty = np.empty(0, np.int64)
    return Order(n, empty, np.zeros(1, np.int64), empty, np.empty((0, 2), np.int64))


def find_order(
    times: Times, n: int, *, resets_allowed: bool, sound: Int1D | None = None, disorder_ns: int = JITTER_NS
) -> Order:
    """Looks at the times of n rows, twice. A step back by a second at most is disorder; for more see `clock_faults`.
    The rows of a ring buffer are sorted, whatever is allowed: its clock was not set.

    sound: (first, past-the-last) rows that may step back, for they belong among those before, shape (k, 2).
    disorder_ns: in place of the second.
    """
    order = _looked_at(times, n, resets_allowed=False, sound=sound, disorder_ns=disorder_ns)
    seam = order.keep if order.keep < n else _small_step_back(order)
    if seam is None:
        return order
    before = order if order.keep == seam else _looked_at(times, seam, resets_allowed=False)
    if _is_ring(times, n, before):
        note = f"a ring buffer: its oldest rows stand from row {seam + 1} on, and are put before the others"
        return replace(by_time(times, n), notes=(note,))
    if resets_allowed and order.keep < n:
        return _looked_at(times, n, resets_allowed=True, sound=sound, disorder_ns=disorder_ns)
    return order


def _small_step_back(order: Order) -> int | None:
    """The row of the one step back that was joined, for a time server may have made it, as the seam of a buffer of two
    minutes may be; None where there is none, or more than that."""
    return int(order.at[0]) if len(order.at) == 1 and not order.shifts[0] and order.shifts[1] > 0 else None


def _is_ring(times: Times, n: int, order: Order) -> bool:
    """Whether the rows behind a step back are the older ones of a buffer that was written over from its begin on: both
    stretches are in order, and the last time lies about a period before the first, or is the same, where a scan of
    several rows is torn. order: of the rows before the step
    back."""
    first, many = order.keep, n - order.keep
    if min(first, many) < _LEAST_OF_RING or len(order.at) or order.shifts[0]:
        return False
    older = _looked_at(lambda a, b: times(first + a, first + b), many, resets_allowed=False)
    if older.keep < many or len(older.at) or older.shifts[0]:
        return False
    near = (times(max(0, first - _NEAR), first), times(first, min(n, first + _NEAR)))
    period = max(float(np.median(steps)) for t in near if len(steps := np.diff(np.unique(t))))
    return 0 <= order.extent[0] - older.extent[1] <= _PERIODS_OF_SEAM * period


def _looked_at(
    times: Times, n: int, *, resets_allowed: bool, sound: Int1D | None = None, disorder_ns: int = JITTER_NS
) -> Order:
    """The order of n rows by the faults of their clock alone; see `find_order`."""
    faults = Faults(resets_allowed, disorder_ns)
    looked = times if sound is None or not len(sound) else _times_held(times, sound)
    for first in range(0, n, CHUNK_ROWS):
        t = looked(first, min(n, first + CHUNK_ROWS + MOST_STRAYS + 1))
        if not faults.look(t, first, min(CHUNK_ROWS, len(t))):
            break
    keep = n if faults.keep is None else faults.keep
    order = Order(
        keep,
        np.array(faults.at, np.int64),
        np.array(faults.shifts, np.int64),
        np.array(sorted(faults.marked), np.int64),
        np.empty((0, 2), np.int64),
        faults.extent,
        faults.notes(),
    )
    return replace(order, islands=_islands(times, order, faults.lowest))


def _times_held(times: Times, sound: Int1D) -> Times:
    """Times of which those of some stretches are replaced by the one before them."""

    def looked(start: int, stop: int) -> Int1D:
        t = times(start, stop).copy()
        for a, b in sound[(sound[:, 0] < stop) & (sound[:, 1] > start)].tolist():
            t[max(a - start, 0) : b - start] = times(a - 1, a)[0] if a <= start else t[a - start - 1]
        return t

    return looked


def by_time(times: Times, n: int, *, resets_allowed: bool = False) -> Order:
    """The order of n rows whose times are sound, wherever they stand: all are sorted. Rows a year apart are of a clock
    that was set between them, and never sorted among each other: see `clock_faults`."""
    order = replace(_looked_at(times, n, resets_allowed=resets_allowed, disorder_ns=LEAP_NS), trusted=True)
    rows = int((order.islands[:, 1] - order.islands[:, 0]).sum())
    notes = (f"{counted(rows, 'row', 'stands', 'stand')} out of order: sorted by their times",) if rows else ()
    return replace(order, notes=(*order.notes, *notes))


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
        torn = (before > behind).view(np.int8)  # no cut before this row
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
