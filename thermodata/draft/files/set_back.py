"""A clock that was set in the middle of a file, or strays, as ingest would find it, seen in a draft's sample."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from thermodata.plugin import Array, Block, Int1D
from thermodata.reader.times.clock_leaps import Leap
from thermodata.reader.times.newest_first import Steps
from thermodata.store.raw.order import find_order

_REPEATED = 0.9  # of the rows that go through times again: a copy of rows, which ingest leaves out
_LEAST = 20
_BITS = 62  # of an int64
_LOOKED_AT = 100_000  # rows, for a period


@dataclass(frozen=True, slots=True)
class SetBack:
    """row: of the stream, from 1; from_ns, to_ns: what it told before, and there; in_no_order: whether rows stand in no
    order at all; older: whether all that follows is older than what came before; apart: whether no signal changes both
    before and behind it."""

    row: int
    from_ns: int
    to_ns: int
    in_no_order: bool = False
    older: bool = False
    apart: bool = False


@dataclass(slots=True)
class Clock:
    """The times of a stream while its blocks pass, one value beside each, and a bit for each signal that has another
    one than before: what is written on change stands through rows that do not fill it."""

    t_ns: list[Int1D] = field(default_factory=list)
    values: list[Array] = field(default_factory=list)
    filled: list[Int1D] = field(default_factory=list)
    last: dict[str, float] = field(default_factory=dict)
    steps: Steps = field(default_factory=Steps)
    leap: Leap = field(default_factory=Leap)

    def add(self, block: Block) -> None:
        self.t_ns.append(block.t_ns)
        numbers = next((v for v in block.values.values() if v.dtype.kind in "iuf"), None)
        self.values.append(np.zeros(block.t_ns.size) if numbers is None else numbers.astype(np.float64))
        self.filled.append(_filled(block, self.last))
        self.steps.add(block.t_ns)
        self.leap.add(block.t_ns)

    @property
    def period_s(self) -> float:
        """How far its rows are usually apart; infinite of a single time."""
        steps = np.diff(np.unique(np.concatenate(self.t_ns)[:_LOOKED_AT]))
        return float(np.median(steps)) / 1e9 if len(steps) else float("inf")

    def notes(self) -> tuple[str, ...]:
        """What an ingest will say that it mended: leaps ahead, small steps back, strays. Rows that stand twice, or
        newest first, are no fault of the clock."""
        if self.leap.row is None and (not self.steps.back or self.steps.newest_first or self.steps.in_no_order):
            return ()
        t = np.concatenate(self.t_ns)
        again = np.flatnonzero(t[1:] <= np.maximum.accumulate(t)[:-1]) + 1
        if again.size and self._stands_before(again, t):
            return ()
        return find_order(lambda a, b: t[a:b], t.size, resets_allowed=False).notes

    def _stands_before(self, again: Int1D, t: Int1D) -> bool:
        """Whether the rows at times that had been there are copies of other rows. t: of all rows."""
        x = np.concatenate(self.values)
        others = np.delete(np.arange(t.size), again)
        before = set(zip(t[others].tolist(), x[others].tolist(), strict=True))
        same = sum(pair in before for pair in zip(t[again].tolist(), x[again].tolist(), strict=True))
        return same >= _REPEATED * again.size

    def extent(self) -> tuple[int, int] | None:
        """The first and the last time where the clock was set ahead by years, once what came before is moved up to it,
        or where a step back may be the seam of a ring buffer; None where there is neither."""
        if self.leap.row is None and (self.steps.back != 1 or self.set_back() is not None):
            return None
        t = np.concatenate(self.t_ns)
        return find_order(lambda a, b: t[a:b], t.size, resets_allowed=False).extent

    def set_back(self) -> SetBack | None:
        """Where it first went back for good; None where it did not, or where rows stand twice, or newest first."""
        if not self.steps.back or self.steps.newest_first:
            return None
        t = np.concatenate(self.t_ns)
        keep = find_order(lambda a, b: t[a:b], t.size, resets_allowed=False).keep
        if keep >= t.size or t.size - keep < _LEAST:
            return None
        high = int(t[:keep].max())
        again = np.flatnonzero(t[keep:] <= high) + keep
        if self._stands_before(again, t):
            return None
        older, filled = bool(t[keep:].max() < t[:keep].min()), np.concatenate(self.filled)
        before, behind = (int(np.bitwise_or.reduce(part)) for part in (filled[:keep], filled[keep:]))
        apart = before != 0 and behind != 0 and before & behind == 0
        return SetBack(keep + 1, high, int(t[keep]), self.steps.in_no_order, older, apart)


def _filled(block: Block, last: dict[str, float]) -> Int1D:
    """A bit for each of the first signals of numbers, where it has another value than in the row before, shape (n,).
    last: signal -> its value before the block; is brought up to its end."""
    found = np.zeros(block.t_ns.size, np.int64)
    numbers = [(name, v) for name, v in block.values.items() if v.dtype.kind in "iuf" and v.size]
    for k, (name, column) in enumerate(numbers[:_BITS]):
        before = np.concatenate([[last.get(name, np.nan)], column[:-1]])
        found |= (np.isfinite(column) & (column != before)).astype(np.int64) << k
        last[name] = float(column[-1])
    return found


def first_of(clocks: Mapping[str, Clock]) -> SetBack | None:
    """Of the streams of a file the first that was set back."""
    return next((found for clock in clocks.values() if (found := clock.set_back()) is not None), None)


def notes_of(clocks: Mapping[str, Clock]) -> tuple[str, ...]:
    """What an ingest will say of the clocks of a file, each thing once."""
    return tuple(dict.fromkeys(note for clock in clocks.values() for note in clock.notes()))


def extent_of(clocks: Mapping[str, Clock]) -> tuple[int, int] | None:
    """The first and the last time of a file in which any clock was set ahead by years; None where none was."""
    found = [clock.extent() for clock in clocks.values()]
    if not any(found):
        return None
    ends = [
        e or (int(min(t.min() for t in c.t_ns)), int(max(t.max() for t in c.t_ns)))
        for e, c in zip(found, clocks.values(), strict=True)
    ]
    return min(a for a, _ in ends), max(b for _, b in ends)
