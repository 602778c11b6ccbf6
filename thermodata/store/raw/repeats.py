"""Rows that stand in a recording twice: two files of it overlap, or a part was copied in again.

A clock that was set back looks alike, but what it logs under the times that it goes through again is something else.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from thermodata.plugin import Array, Bool1D, Int1D
from thermodata.schema.words.sentences import counted
from thermodata.store.raw.clock_faults import JITTER_NS

CHUNK_ROWS = 500_000
_MOST_OTHERS = 200  # stretches that are no copies: in a log of so many steps back nobody looks further
_MOST_COPIES = 10_000  # nor is any log copied in so many pieces: each is held against all before it
_MOST_VALUES = 4_000_000  # held at once [32 MB]
_FIRST_LOOK = 16  # rows of a stretch, one of which has been there before if it is a copy
Hashes = npt.NDArray[np.uint64]
Times = Callable[[int, int], Int1D]
Keys = Callable[[int, int], Hashes]


@dataclass(frozen=True, slots=True)
class Repeats:
    """cut: (first, past-the-last) rows, all of which repeat earlier ones, shape (k, 2). mixed: the same of stretches in
    which others stand between those. rows: how many repeat earlier ones. The times of all of them are sound."""

    cut: Int1D = field(default_factory=lambda: np.empty((0, 2), np.int64))
    mixed: Int1D = field(default_factory=lambda: np.empty((0, 2), np.int64))
    rows: int = 0

    @property
    def sound(self) -> Int1D:
        """All stretches, shape (k, 2), in order."""
        both = np.concatenate([self.cut, self.mixed])
        stretches: Int1D = both[np.argsort(both[:, 0])]
        return stretches

    def left(self) -> Int1D:
        """The mixed stretches, counted without the rows that are cut, shape (k, 2)."""
        ends = self.cut[:, 1]
        gone = np.concatenate([[0], np.cumsum(ends - self.cut[:, 0])])
        shifted: Int1D = self.mixed - gone[np.searchsorted(ends, self.mixed, side="right")]
        return shifted

    def notes(self) -> tuple[str, ...]:
        """What was found, in words."""
        left_out = int((self.cut[:, 1] - self.cut[:, 0]).sum())
        notes = []
        if left_out:
            notes.append(f"{counted(left_out, 'row', 'repeats', 'repeat')} earlier ones, times and values: left out")
        if self.rows > left_out:
            notes.append(
                f"{counted(self.rows - left_out, 'row', 'repeats', 'repeat')} earlier ones among others: "
                "sorted in, and flagged"
            )
        return tuple(notes)


@dataclass(frozen=True, slots=True)
class _Compared:
    """same: which rows were there before; other: which have the time of an earlier row, and other values."""

    same: Bool1D
    other: Bool1D
    keys: Hashes


@dataclass(frozen=True, slots=True)
class _Rows:
    """The n rows of a recording, chunk by chunk. lows, highs: the earliest and latest time of each chunk, as far as
    `behind` has come."""

    times: Times
    keys: Keys
    n: int
    lows: list[int] = field(default_factory=list)
    highs: list[int] = field(default_factory=list)

    def behind(self) -> Iterator[tuple[int, int]]:
        """(first, past-the-last) rows between a step back in time and the first row that is later than all before."""
        high, begin, level = np.iinfo(np.int64).min, -1, 0
        for first in range(0, self.n, CHUNK_ROWS):
            t = self.times(first, min(self.n, first + CHUNK_ROWS))
            self.lows.append(int(t.min()))
            self.highs.append(int(t.max()))
            high = max(high, int(t[0]))
            before = np.maximum(np.concatenate([[high], np.maximum.accumulate(t)[:-1]]), high)
            behind = np.flatnonzero(t.astype(np.float64) < before.astype(np.float64) - JITTER_NS)
            high = max(high, self.highs[-1])
            at = 0
            while True:
                if begin < 0:
                    k = int(np.searchsorted(behind, at))
                    if k == len(behind):
                        break
                    at = int(behind[k])
                    begin, level = first + at, int(before[at])
                later = np.flatnonzero(t[at:] > level)
                if not later.size:
                    break
                at += int(later[0])
                yield begin, first + at
                begin = -1
        if begin >= 0:
            yield begin, self.n

    def compared(self, begin: int, start: int, stop: int) -> _Compared:
        """Rows start to stop beside all those before a stretch that begins at `begin`."""
        t, own = self.times(start, stop), self.keys(start, stop)
        low, high = int(t.min()), int(t.max())
        whole = _mixed_hashes(t.view(np.uint64), own)
        same, there = np.zeros(len(t), bool), np.zeros(len(t), bool)
        for chunk, first in enumerate(range(0, begin, CHUNK_ROWS)):
            if self.lows[chunk] > high or self.highs[chunk] < low:
                continue
            before = self.times(first, min(begin, first + CHUNK_ROWS))
            within = np.flatnonzero((before >= low) & (before <= high))
            if not within.size:
                continue
            p, q = int(within[0]), int(within[-1]) + 1
            there |= np.isin(t, before[p:q])
            same |= np.isin(whole, _mixed_hashes(before[p:q].view(np.uint64), self.keys(first + p, first + q)))
        return _Compared(same, there & ~same, own)


def find_repeats(times: Times, keys: Keys, n: int, begins: Sequence[int] = (), *, held: bool) -> Repeats:
    """Looks for stretches behind a step back in time whose rows were all there before, with the same values.

    keys: a number for the values of each row (see `keys_of`); begins: rows with which a file begins. Where nothing
    moves, a copy and a clock that was set back are the same to see: only the begin of a file tells them apart. held:
    the values are written on change, so that the first rows of a copy may hold others.
    """
    recording = _Rows(times, keys, n)
    cut: list[tuple[int, int]] = []
    mixed: list[tuple[int, int]] = []
    rows = others = 0
    for a, b in recording.behind():
        some = recording.compared(a, a, min(b, a + _FIRST_LOOK))
        first = a + (int(np.argmax(some.same)) if held else 0)
        same = new = 0
        values: set[int] = set()
        for start in range(first, b, CHUNK_ROWS) if some.same.any() else ():
            found = recording.compared(a, start, min(b, start + CHUNK_ROWS))
            if found.other.any():
                same = 0
                break
            same, new = same + int(found.same.sum()), new + int((~found.same).sum())
            values |= set(np.unique(found.keys[found.same])[:2].tolist())
        if same and same >= new + first - a and (len(values) > 1 or a in begins):
            rows += same
            (mixed if new else cut).append((first, b))
            if first > a:
                mixed.append((a, first))
            if len(cut) + len(mixed) >= _MOST_COPIES:
                break
            continue
        others += 1
        if others == _MOST_OTHERS:
            break
    return Repeats(_pairs(cut), _pairs(mixed), rows)


def pieces(lengths: Sequence[int], cut: Int1D) -> Iterator[tuple[int, int, int]]:
    """(which file, first, past-the-last row of it) of what is not cut, in file order. lengths: rows of each file; cut:
    as `Repeats` has it, over all files."""
    at = 0
    for k, n in enumerate(lengths):
        low = 0
        for a, b in (cut[(cut[:, 0] < at + n) & (cut[:, 1] > at)] - at).tolist():
            if low < a:
                yield k, low, a
            low = min(b, n)
        if low < n:
            yield k, low, n
        at += n


def _pairs(stretches: list[tuple[int, int]]) -> Int1D:
    return np.array(sorted(stretches), np.int64).reshape(-1, 2)


def keys_of(columns: Iterable[Array], n: int) -> Hashes:
    """A number for the values of each row, shape (n,): equal where all values are; no value is as good as another.
    columns: of shape (n,)."""
    keys = np.zeros(n, np.uint64)
    for values in columns:
        if values.dtype == object:
            bits = np.fromiter((hash(v) & 0xFFFFFFFFFFFFFFFF for v in values), np.uint64, len(values))
        else:
            number = values.astype(np.float64)
            bits = np.where(np.isnan(number), np.nan, number).view(np.uint64)
            if values.dtype.kind in "iu":  # what a float64 does not hold
                rest = np.where(np.abs(number) < 2.0**53, 0, values.astype(np.uint64))
                bits = bits ^ rest.astype(np.uint64)
        keys = _mixed_hashes(keys, bits)
    return keys


def batches(names: Sequence[str], rows: int) -> Iterator[Sequence[str]]:
    """Columns of which so many rows may be held at once."""
    width = max(1, _MOST_VALUES // max(rows, 1))
    for k in range(0, len(names), width):
        yield names[k : k + width]


def _mixed_hashes(a: Hashes, b: Hashes) -> Hashes:
    """Two numbers in one, as splitmix64 stirs them."""
    x = a * np.uint64(0x9E3779B97F4A7C15) + b
    x = (x ^ (x >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    x = (x ^ (x >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return x ^ (x >> np.uint64(31))
