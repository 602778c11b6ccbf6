"""What is wrong with a clock, seen in the times that it gave: strays, steps back, and the moment at which it was set.

A stray is a time of one to three rows that lies far from its neighbours: it is drawn between them. A leap forward by
more than a year is a clock without a battery that was set while it ran: what came before is moved up to it. After a
step back of up to two minutes (a time server) the rows go on behind what came before; after a longer one only where
the campaign file allows it, and while what is joined ends within the times that are counted at all.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from thermodata.plugin import Int1D
from thermodata.reader.times.clock_leaps import LEAP_NS
from thermodata.schema.words.sentences import counted

JITTER_NS = 1_000_000_000  # a step back up to this is disorder
SMALL_NS = 120_000_000_000  # up to this, what a time server corrects
FARTHEST_NS = 2**62  # in 2116: dates that go back by decades again and again are no clock's
MOST_STRAYS = 3
_RECENT = 100


@dataclass(slots=True)
class Faults:
    """Looks at the times of a stream, chunk by chunk. See `Order` for at, shifts and marked.

    keep: the row at which the clock went back by more than it may, or None. lowest: the earliest time of each chunk.
    disorder_ns: a step back up to this is none of the clock's, for rows stand out of order.
    """

    resets_allowed: bool
    disorder_ns: int = JITTER_NS
    keep: int | None = None
    at: list[int] = field(default_factory=list)
    shifts: list[int] = field(default_factory=lambda: [0])
    marked: set[int] = field(default_factory=set)
    lowest: list[int] = field(default_factory=list)
    strays: int = 0
    resets: list[int] = field(default_factory=list)  # how far back [ns]
    leaps: list[int] = field(default_factory=list)  # how far ahead [ns]
    _highest: int = np.iinfo(np.int64).min
    _recent: Int1D = field(default_factory=lambda: np.empty(0, np.int64))

    @property
    def extent(self) -> tuple[int, int]:
        """The earliest and the latest time of what was looked at [ns]."""
        return min(self.lowest, default=0), self._highest

    def look(self, t_ns: Int1D, first: int, own: int) -> bool:
        """The next chunk: its recorded times, which go some rows beyond its own where there are more, its first row,
        and how many rows are its own. False: no more chunks are needed."""
        t = t_ns + shifted(self.at, self.shifts, first, len(t_ns))
        more = len(t_ns) > own
        at = 0
        while (row := self._next_fault(t, at)) is not None:
            high = max(self._highest, int(t[at:row].max(initial=self._highest)))
            stray = self._stray(t, at, row, high, more)
            if row >= own and (stray is None or stray[0] >= own):
                break  # the next chunk's, which sees more of it
            if stray is not None:
                self._mend(t, *stray, first)
                at = max(stray[0] - 1, 0)
                continue
            if int(t[row]) > high:
                self._leap(t, row, first, high)
            elif self._joins(high, int(t[row])):
                self._reset(t, row, first, high)
            else:
                self.keep = first + row
                self._remember_times(t[:row])
                return False
            self._highest, at = int(t[row]), row
        self._remember_times(t[:own])
        return True

    def _joins(self, high: int, back: int) -> bool:
        """Whether rows from a step back on, from one time to another [ns], are moved behind those before."""
        return high - back <= SMALL_NS or (self.resets_allowed and 2 * high - back < FARTHEST_NS)

    def _remember_times(self, t: Int1D) -> None:
        self._highest = max(self._highest, int(t.max(initial=self._highest)))
        self._recent = np.concatenate([self._recent, t])[-_RECENT:]
        self.lowest.append(int(t.min(initial=np.iinfo(np.int64).max)))

    def notes(self) -> tuple[str, ...]:
        """What was found, in words."""
        notes = []
        if self.strays:
            notes.append(f"{counted(self.strays, 'row')} with a stray time: drawn between their neighbours and flagged")
        if self.leaps:
            notes.append(
                f"the clock was set ahead by {_long(max(self.leaps))} while it ran: what came before was moved "
                "up to it; how long it paused is not known"
            )
        if self.resets:
            often = "once, by" if len(self.resets) == 1 else f"{len(self.resets)} times, by up to"
            notes.append(
                f"the clock was set back {often} {_long(max(self.resets))}: what follows was moved behind "
                "what came before"
            )
        return tuple(notes)

    def _next_fault(self, t: Int1D, at: int) -> int | None:
        """The first row behind by more than jitter, or ahead by more than a leap. Looks a little ahead first, and ever
        further: a clock with a stray in every hundred rows is not looked through to its end for each."""
        high, size = self._highest, _RECENT
        while at < len(t):
            part = t[at : at + size]
            top = np.maximum(np.maximum.accumulate(part), high)
            before = np.concatenate([part[:1] if high == np.iinfo(np.int64).min else [high], top[:-1]])
            # a difference of int64 may overflow where a time is absurd: compare as floats
            ahead = part.astype(np.float64) - before.astype(np.float64) > LEAP_NS
            rows = np.flatnonzero((part < top - self.disorder_ns) | ahead)
            if rows.size:
                return at + int(rows[0])
            high, at, size = int(top[-1]), at + len(part), 2 * size
        return None

    def _stray(self, t: Int1D, at: int, row: int, high: int, more: bool) -> tuple[int, int] | None:
        """(first, past-the-last) of up to three rows around `row` without which the clock is sound."""
        none = np.iinfo(np.int64).min
        step = min((x for x in (self._step(t[:row]), _median_step(t[row : row + _RECENT])) if x), default=0)
        for stop in range(row + 1, min(row + 1 + MOST_STRAYS, len(t))):  # sound again soon behind it?
            # rows that go on from a smaller time come back to the old one too, but later than they should
            least = high - self.disorder_ns if step < self.disorder_ns else high + step * (stop - row + 1) // 2
            if high == none or least <= int(t[stop]) <= high + LEAP_NS:
                return row, stop
        if int(t[row]) < high:  # or is it sound, and those before it were ahead?
            for start in range(row - 1, max(at - 1, row - 1 - MOST_STRAYS), -1):
                before = max(self._highest, int(t[at:start].max(initial=self._highest)))
                if before == none and start:
                    continue
                late = step * (row - start + 1) // 2
                most = int(t[row]) + self.disorder_ns if step < self.disorder_ns else int(t[row]) - late
                if before <= most and int(t[row]) + self.disorder_ns < int(t[start]):
                    return start, row
        # the last rows of all can't be told from a clock that was set: they are drawn in all the same
        return (row, len(t)) if not more and len(t) - row <= MOST_STRAYS and high != none else None

    def _mend(self, t: Int1D, start: int, stop: int, first: int) -> None:
        """Draws the times of rows start to stop between their neighbours."""
        n = stop - start
        step = self._step(t[:start]) or self._step(t[stop:])
        before = t[start - 1 : start] if start else self._recent[-1:]
        left = int(before[0]) if len(before) else int(t[stop]) - step * (n + 1)
        right = int(t[stop]) if stop < len(t) else left + step * (n + 1)
        going = self.shifts[-1]
        for i in range(start, stop):
            drawn = left + (right - left) * (i - start + 1) // (n + 1)
            self._shift(first + i, going + drawn - int(t[i]))
            t[i] = drawn
        self._shift(first + stop, going)
        self.marked |= set(range(first + start, first + stop))
        self.strays += n

    def _reset(self, t: Int1D, row: int, first: int, high: int) -> None:
        delta = high + max(self._step(t[:row]), 1) - int(t[row])
        self.resets.append(high - int(t[row]))
        t[row:] += delta
        self._shift(first + row, self.shifts[-1] + delta)
        self.marked.add(first + row)

    def _leap(self, t: Int1D, row: int, first: int, high: int) -> None:
        """Moves all that came before, up to `high`, up to the row."""
        delta = int(t[row]) - max(self._step(t[:row]), 1) - high
        self.leaps.append(delta)
        going = self.shifts[-1]
        t[:row] += delta
        self._recent = self._recent + delta
        self.lowest = [low + delta for low in self.lowest]
        self.shifts = [s + delta for s in self.shifts]
        self._shift(first + row, going)
        self.marked.add(first + row)

    def _shift(self, row: int, total: int) -> None:
        if self.at and self.at[-1] == row:
            self.shifts[-1] = total
        else:
            self.at.append(row)
            self.shifts.append(total)

    def _step(self, before: Int1D) -> int:
        """The usual time from row to row [ns] before a row of the chunk; 0 where there are none."""
        return _median_step(np.concatenate([self._recent, before[-_RECENT:]])[-_RECENT:])


def _median_step(t: Int1D) -> int:
    return max(int(np.median(np.diff(t))), 1) if len(t) > 1 else 0


def shifted(at: Sequence[int] | Int1D, shifts: Sequence[int] | Int1D, start: int, n: int) -> Int1D:
    """What is added to the times of n rows from `start` on, shape (n,); see `Order` for at and shifts."""
    if not len(at):
        return np.full(n, shifts[0], np.int64)
    added: Int1D = np.asarray(shifts, np.int64)[np.searchsorted(at, np.arange(start, start + n), side="right")]
    return added


def _long(ns: int) -> str:
    s = ns / 1e9
    for size, unit in ((365.25 * 86_400, "years"), (86_400.0, "days"), (3600.0, "h"), (60.0, "min")):
        if s >= 1.5 * size:
            return f"{s / size:.3g} {unit}"
    return f"{s:.3g} s"
