"""What speaks for rows of several series in a table, by the clock of the table, those of the words and the values.

A false split costs a channel, a missed one mixes values: rows are parted only where it is plain.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum

import numpy as np

from thermodata.plugin import Array, Float1D, Int1D

FEWEST = 5  # rows of a word, by which its steps are known
_MIXED = 0.4  # of the changes that words make which never stand twice in a row; chance makes half of them
_MEET = 0.05  # of the rows share their time with another word's,
_EXPLAINED = 0.95  # of which this share are other words
_TWICE, _OWN = 0.1, 0.8  # of pairs are one word by chance: words that differ say something; of a word's steps are alike
_STEADY = 0.9  # of the steps are like their median: a clock
_SLIGHT = 0.005  # fewer steps like it are within the words of what leaves holes in that clock
_ODD = 0.03  # of the steps are unlike it, and want a reason
_HALTING, _WORSE = 0.5, 0.75  # such a share is a clock that halts where the words have less of it than this share
_RESOLVED = 0.25  # of the odd steps may be left within the words
_NARROW = 1.2  # times its median that the steps of a clock with jitter spread over
_IN_TURN = 0.9  # of the rows are followed by another word, the same one each time
_EVEN = 0.8  # of the rows are of words with at least half as many rows as the most frequent one
_MOST = 0.5  # of the numbers move with the words; of a wide log one or two do, such as a power
_APART = 3.0  # times as far from the row before as from the row before of the same word
_BACK = 0.25  # of the way on that times which begin anew go back


class Verdict(Enum):
    """PLAIN: the rows are of several series. DOUBTFUL: they may be. ONE: they are of one."""

    ONE = 0
    DOUBTFUL = 1
    PLAIN = 2


@dataclass(frozen=True, slots=True)
class Header:
    """numbers: the words are ids, or counts of something. named: the header says that it names something; sensor: what
    is measured; identity: which sensor or host it is, never how that is."""

    numbers: bool
    named: bool
    sensor: bool
    identity: bool


@dataclass(frozen=True, slots=True)
class Rows:
    """t_ns, codes, pieces: shape (n,), when, which word, and in which part of the file that was read on end; values:
    the other columns of numbers, shape (n,) each."""

    t_ns: Int1D
    codes: Int1D
    pieces: Int1D
    values: Sequence[Float1D]

    @property
    def joined(self) -> Array:
        """shape (n - 1,), which rows stand behind the one before: between pieces lies what nobody looked at."""
        joined: Array = self.pieces[1:] == self.pieces[:-1]
        return joined

    @property
    def changed(self) -> Array:
        changed: Array = self.codes[1:] != self.codes[:-1]
        return changed


def judge(rows: Rows, header: Header, *, absolute: bool) -> Verdict:
    """Whether a column parts rows into series."""
    counts = np.bincount(rows.codes) if rows.codes.size else np.zeros(1, np.int64)
    if int((counts >= FEWEST).sum()) < 2:
        return Verdict.ONE
    changes = int(rows.changed.sum())
    words = not header.numbers
    steps = np.diff(rows.t_ns)
    if (back := int((steps < 0).sum())) and _begins_anew(rows):
        far = int(-steps[steps < 0].sum()) >= _BACK * int(steps[steps > 0].sum())
        return _plain_or_one_series(absolute and far and 2 * back >= changes and (header.named or words))
    mixed = changes / (2 * (rows.codes.size - int(counts.max()))) >= _MIXED
    if _meet(rows):
        return _who_meets(rows, counts, header) if mixed else Verdict.ONE
    even = _even(counts)
    far_apart = even and _jumps(rows) > _MOST
    often = words and header.sensor and changes > 2 * (counts > 0).sum()
    if often and (far_apart or (header.identity and mixed)):
        return Verdict.PLAIN
    if not mixed:
        return Verdict.DOUBTFUL if often else Verdict.ONE
    in_turn = _in_turn(rows)
    if not in_turn and _one_clock(rows, counts):
        return Verdict.DOUBTFUL if words and header.named else Verdict.ONE
    if words and header.identity and in_turn:
        return Verdict.PLAIN
    if (words or header.named) and _clocks_apart(rows, counts):
        return Verdict.PLAIN
    if header.sensor and ((words and even) or far_apart):
        return Verdict.PLAIN
    if header.named:
        return Verdict.PLAIN if words and far_apart else Verdict.DOUBTFUL
    # numbers that come in turn, as sensors that are asked one after the other, and move all values, may be these
    return Verdict.DOUBTFUL if (words or (in_turn and even)) and _jumps(rows) == 1.0 else Verdict.ONE


def _plain_or_one_series(so: bool) -> Verdict:
    return Verdict.PLAIN if so else Verdict.ONE


def _begins_anew(rows: Rows) -> bool:
    """Whether times go back between words only, each of which stands in order."""
    return all(bool((np.diff(rows.t_ns[rows.codes == k]) >= 0).all()) for k in np.unique(rows.codes))


def _meet(rows: Rows) -> bool:
    """Whether rows share their times, and differ in their words there."""
    times = np.unique(rows.t_ns).size
    again = rows.t_ns.size - times
    pairs = np.unique(np.stack([rows.t_ns, rows.codes]), axis=1).shape[1]
    return again >= max(_MEET * rows.t_ns.size, FEWEST) and pairs - times >= _EXPLAINED * again


def _who_meets(rows: Rows, counts: Int1D, header: Header) -> Verdict:
    """Of rows that share their times: whether that says more than that one of many words seldom comes twice."""
    same = float(np.sum((counts / counts.sum()) ** 2))
    own_clock = _steady(_own_steps(rows, counts)) >= _OWN
    if header.numbers:
        if header.sensor or (header.named and own_clock) or _jumps(rows) == 1.0:
            return Verdict.PLAIN
        return Verdict.DOUBTFUL if header.named else Verdict.ONE
    return Verdict.PLAIN if header.named or same >= _TWICE or own_clock else Verdict.DOUBTFUL


def _steps(rows: Rows, of: Array) -> Float1D:
    """Between some rows, within the pieces."""
    pieces = rows.pieces[of]
    steps: Float1D = np.diff(rows.t_ns[of])[pieces[1:] == pieces[:-1]].astype(np.float64)
    return steps


def _own_steps(rows: Rows, counts: Int1D) -> list[Float1D]:
    return [_steps(rows, rows.codes == k) for k in np.flatnonzero(counts >= FEWEST)]


def _one_clock(rows: Rows, counts: Int1D) -> bool:
    """Whether the clock of the table goes on whatever the word, and the words leave holes in it."""
    table, own = [_steps(rows, np.ones(rows.codes.size, bool))], _own_steps(rows, counts)
    whole = _steady(table)
    if whole >= _STEADY and _steady(own) < whole - _SLIGHT:
        return True
    if whole >= _HALTING and _steady(own) < _WORSE * whole:
        return True
    return _spread_of_steps(table) < min(_NARROW, 0.5 * _spread_of_steps(own))


def _clocks_apart(rows: Rows, counts: Int1D) -> bool:
    """Whether the table has no clock, and each word has one."""
    odd = 1 - _steady([_steps(rows, np.ones(rows.codes.size, bool))])
    return odd >= _ODD and 1 - _steady(_own_steps(rows, counts)) <= _RESOLVED * odd


def _steady(parts: Sequence[Float1D]) -> float:
    """The share of steps that are nearly the median of their part's."""
    like = total = 0
    for steps in parts:
        usual = float(np.median(steps)) if steps.size else 0.0
        like += int((np.abs(steps - usual) <= 0.1 * usual).sum()) if usual > 0 else 0
        total += steps.size
    return like / max(1, total)


def _spread_of_steps(parts: Sequence[Float1D]) -> float:
    """Over how many times their part's median nine of ten steps spread."""
    usual = [(steps, float(np.median(steps))) for steps in parts if steps.size]
    relative = [steps / m for steps, m in usual if m > 0]
    if not relative:
        return 0.0
    low, high = np.percentile(np.concatenate(relative), [5, 95])
    return float(high - low)


def _in_turn(rows: Rows) -> bool:
    """Whether words follow each other in one order, as where sensors are asked one after the other."""
    before, behind = rows.codes[:-1][rows.joined], rows.codes[1:][rows.joined]
    other = before != behind
    if other.sum() < _IN_TURN * max(1, before.size):
        return False
    pairs, times = np.unique(np.stack([before[other], behind[other]]), axis=1, return_counts=True)
    usual = sum(int(times[pairs[0] == k].max()) for k in np.unique(pairs[0]))
    return usual >= _IN_TURN * int(other.sum())


def _even(counts: Int1D) -> bool:
    """Whether at least two words share the rows: one that comes seldom is a mark."""
    often = counts[2 * counts >= counts.max()]
    return often.size > 1 and int(often.sum()) >= _EVEN * int(counts.sum())


def _jumps(rows: Rows) -> float:
    """The share of the numbers that move which do so with the words: far from the row before, near the word's own row
    before."""
    moved = jumped = 0
    for x in rows.values:
        full = np.isfinite(x)
        v, c = x[full], rows.codes[full]
        if np.unique(c).size < 2 or np.unique(v).size < 2:
            continue
        across = np.abs(np.diff(v))[c[1:] != c[:-1]]
        within = np.concatenate([np.abs(np.diff(v[c == k])) for k in np.unique(c)])
        moved += 1
        jumped += bool(across.size and within.size and np.median(across) > _APART * np.median(within))
    return jumped / max(1, moved)
