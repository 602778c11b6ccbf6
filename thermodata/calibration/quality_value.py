"""What is wrong with a column's values: held and stuck readings, spikes, sudden offsets.

All of it leans on one look at the differences of neighbours (RunStats): how fine the readings are, how noisy,
and how often neighbours are equal by chance.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from thermodata.calibration.tread import exact_tread_of, tread_of
from thermodata.plugin import Array, Bool1D, Float1D, Int1D
from thermodata.schema.flag import Flag

_LEAST_HELD = 10  # samples
_LEAST_HELD_S = 5.0
_SPIKE = 10.0  # of the noise of a difference
_REACH = 8
_TAIL, _TAIL_TIMES = 0.995, 5.0  # a spike is so many times what a channel does every two hundred samples
_OFFSET_K = 5.0
_MANY_SPIKES = 0.005
_AROUND = 20  # samples that tell a level
_BACK = 0.3  # of a step: what comes so near to the level before it has come back


@dataclass(frozen=True, slots=True)
class RunStats:
    """starts, lengths: of the runs of equal readings of 10 samples and more. step: the typical difference of
    neighbours where they differ; finest: the smallest one. chance: of equal neighbours, outside those runs.
    alternates: how often the difference changes its sign there (noise 2/3, a smooth curve 0).

    low, high: of the readings, and leap: the largest difference of neighbours; NaN where a reading is no number. They
    tell most sound columns from the others, so that nobody has to look at them again."""

    starts: Array
    lengths: Array
    step: float
    finest: float
    chance: float
    alternates: float
    low: float = np.nan
    high: float = np.nan
    leap: float = np.nan

    @property
    def float_like(self) -> bool:
        """Fine enough for an exact repetition to mean something: not a reading in whole kelvin."""
        return self.finest > 0 and self.step >= 2.5 * self.finest and self.chance < 0.5


def run_stats(x: Float1D) -> RunStats:
    """One pass over the differences of x, shape (n,); NaN parts runs."""
    low, high = (float(np.min(x)), float(np.max(x))) if len(x) else (np.nan, np.nan)
    with np.errstate(invalid="ignore"):  # inf - inf
        d = np.diff(x)
        leap = float(max(np.max(d), -np.min(d))) if len(d) else np.nan
    if not np.isfinite(leap) or not np.isfinite(high - low):
        low = high = leap = np.nan
    equal = d == 0
    equals = int(np.count_nonzero(equal))
    starts, stops = true_runs(equal)
    lengths = stops - starts + 1
    long = lengths >= _LEAST_HELD
    starts, lengths = starts[long], lengths[long]
    within = int((lengths - 1).sum())
    outside = len(d) - within
    chance = (equals - within) / outside if outside else 1.0
    moving = d if not equals and np.isfinite(leap) else d[~equal & np.isfinite(d)]
    if len(moving) < 10:
        return RunStats(starts, lengths, 0.0, 0.0, 1.0, 0.0, low, high, leap)
    if len(moving) > 50_000:  # a sample of whole stretches is enough, and far quicker
        blocks = np.linspace(0, len(moving) - 500, 100).astype(np.int64)
        moving = moving[(blocks[:, None] + np.arange(500)).ravel()]
    size = np.abs(moving)
    # rounding makes equal steps differ in the last bits: the finest step is a low quantile, not the minimum
    finest, step = np.quantile(size, [0.01, 0.5]).tolist()
    turns = float(np.mean(moving[1:] * moving[:-1] < 0))
    return RunStats(starts, lengths, step, finest, chance, turns, low, high, leap)


def true_runs(hit: Bool1D) -> tuple[Int1D, Int1D]:
    """(first, past-the-last) index of each run of True; hit: shape (n,)."""
    rows = np.flatnonzero(hit)
    if not len(rows):
        return rows, rows
    parted = np.diff(rows) > 1
    return rows[np.concatenate([[True], parted])], rows[np.concatenate([parted, [True]])] + 1


def is_staircase(x: Float1D, own: RunStats) -> bool:
    """Whether a channel stands on treads that are coarse beside its changes, though means, or steps of several at
    once, make finer differences: on a tread it repeats a value, and an extreme, as a matter of course."""
    tread = exact_tread_of([x])
    return own.step < 2.5 * tread


def held_runs(
    x: Float1D, t_ns: Array, own: RunStats, others: Mapping[str, Array], stats: Mapping[str, RunStats]
) -> Iterator[tuple[int, int, bool, str]]:
    """(start, stop, stuck, why) of exactly constant stretches that chance can't explain.

    The channel must be fine-grained, and either noisy of its own, or jump where it is released while others moved
    (the drift that nobody saw). Stuck: it got there by a jump, so it is no reading that was held.
    """
    if not own.float_like or not len(own.starts) or is_staircase(x, own):
        return
    # expected number of such runs by chance under 1/1000
    least = np.log(1e-3 / len(x)) / np.log(max(own.chance, 1e-3)) * 1.5
    for start, length in zip(own.starts.tolist(), own.lengths.tolist(), strict=True):
        stop = start + length
        if length < max(_LEAST_HELD, least) or (t_ns[stop - 1] - t_ns[start]) < _LEAST_HELD_S * 1e9:
            continue
        jump_in = abs(x[start] - x[start - 1]) if start else 0.0
        jump_out = abs(x[stop] - x[stop - 1]) if stop < len(x) else 0.0
        moved = [k for k, s in stats.items() if k in others and s.float_like and _moves(others[k], start, stop)]
        if own.alternates < 0.2 and not (moved and jump_out > 8 * own.step):
            continue
        stuck = bool(jump_in > max(50 * own.step, 1e-12)) and jump_in > 0.2 * _spread(x, start)
        why = f"exactly {x[start]:.6g} for {length} samples"
        if moved:
            why += f" while {', '.join(moved[:3])} moved"
        yield start, stop, stuck, why


def _moves(x: Array, start: int, stop: int) -> bool:
    part = x[start : min(stop, start + 2000)]
    return bool(np.mean(part[1:] != part[:-1]) > 0.2)


def _spread(x: Float1D, before: int) -> float:
    past = x[max(0, before - 2000) : before]
    past = past[np.isfinite(past)]
    return float(np.ptp(past)) if len(past) else 0.0


def spikes(x: Float1D, own: RunStats) -> tuple[Bool1D, bool]:
    """(where 1 to 3 samples stand out from their neighbours on both sides, whether there are too many to be
    spikes). Only where a difference is far beyond the noise are neighbours looked at."""
    n = len(x)
    hit: Bool1D = np.zeros(n, dtype=bool)
    if own.step <= 0 or n < 2 * _REACH + 1:
        return hit, False
    noise = max(own.step, 2.0 * own.finest)
    if own.leap <= _SPIKE * noise:
        return hit, False
    rows, height = _stand_out(x, noise)
    if len(rows):
        # a flicker between two treads is no spike
        noise = max(noise, tread_of([x]))
        rows, height = rows[height > _SPIKE * noise], height[height > _SPIKE * noise]
    hit[rows] = True
    _without_long(hit)
    count = int(hit.sum())
    many = count > max(10, _MANY_SPIKES * n)
    if count:
        # air in a draught, a probe at high speed: what comes in all sizes is no spike
        beyond = _beyond(hit, rows, height, _TAIL_TIMES * _tail(x))
        if beyond.any() or not many:
            return beyond, int(beyond.sum()) > max(10, _MANY_SPIKES * n)
    return hit, many


def _beyond(hit: Bool1D, rows: Int1D, height: Float1D, least: float) -> Bool1D:
    """The runs of `hit` that stand out by more than `least` somewhere. rows, height: shape (k,)."""
    top = np.zeros(len(hit))
    top[rows] = height
    beyond = np.zeros_like(hit)
    for a, b in zip(*true_runs(hit), strict=True):
        beyond[a:b] = top[a:b].max() > least
    return beyond


def _stand_out(x: Float1D, noise: float) -> tuple[Int1D, Float1D]:
    """(rows that stand out from what is around them by more than 10 times the noise, by how much)."""
    n = len(x)
    with np.errstate(invalid="ignore"):
        jumps = np.flatnonzero(np.abs(np.diff(x)) > _SPIKE * noise)
    near = np.unique(np.clip((jumps[:, None] + np.array([1, 2, 3, 0, -1, -2])).ravel(), 0, n - 1))
    if len(near) > 0.2 * n + 1000:
        near = near[:: int(len(near) / (0.2 * n + 1000)) + 1]
    offsets = np.concatenate([np.arange(-_REACH, -2), np.arange(3, _REACH + 1)])
    around = x[np.clip(near[:, None] + offsets, 0, n - 1)]
    half = len(offsets) // 2
    fine = np.isfinite(around)
    enough = (fine[:, :half].sum(axis=1) >= 3) & (fine[:, half:].sum(axis=1) >= 3)
    near, around = near[enough], around[enough]
    if not len(near):
        return near, np.empty(0)
    left, right = np.nanmedian(around[:, :half], axis=1), np.nanmedian(around[:, half:], axis=1)
    middle = (left + right) / 2
    spread = np.nanmedian(np.abs(around - np.where(np.arange(2 * half) < half, left[:, None], right[:, None])), axis=1)
    height = np.abs(x[near] - middle)
    with np.errstate(invalid="ignore"):
        out = (height > np.maximum(_SPIKE * noise, 10 * spread)) & (np.abs(left - right) < 0.3 * height)
    return near[out], height[out]


def _without_long(hit: Bool1D) -> None:
    for a, b in zip(*true_runs(hit), strict=True):
        if b - a > 3:
            hit[a:b] = False


def _tail(x: Float1D) -> float:
    """How far a sample lies from the middle of what is 3 before and 3 after it, exceeded by one of two hundred (and
    by ten in any case, for so many spikes may be there)."""
    off = np.abs(x[3:-3] - (x[:-6] + x[6:]) / 2)
    off = off[np.isfinite(off)]
    if len(off) > 50_000:
        off = off[:: len(off) // 50_000 + 1]
    # the spikes themselves are among them, each with the two that it shifts
    share = max(1 - _TAIL, 30 / max(len(off), 1))
    return float(np.quantile(off, 1 - share)) / float(np.sqrt(1.5)) if share < 0.5 else 0.0


def offset_steps(
    x: Float1D, t_ns: Array, flags: Array, of_time: Array, own: RunStats
) -> Iterator[tuple[int, int, float, str]]:
    """(start, stop, size [K], how) where a temperature steps by more than 5 K within one sample, or over a pause by
    more than it ever changes in such a time, and stays there: thermal mass forbids it, a failing sensor or a
    changed plug does it. Ends at a step back, or at the end. Where the value comes back by itself the step was real.

    x: shape (n,), degC. flags: of the column so far; of_time: of the times; uint16, shape (n,).
    """
    if own.step <= 0:
        return
    ignored = Flag.SPIKE | Flag.STUCK | Flag.OUT_OF_RANGE | Flag.HELD
    least = max(_OFFSET_K, 40 * own.step)
    if own.leap <= least / 2 and not (flags & np.uint16(ignored)).any():
        return
    rows = np.flatnonzero((flags & np.uint16(ignored)) == 0)
    if len(rows) < 40:
        return
    y = x[rows]
    d = np.diff(y)
    gap = ((of_time[rows[1:]] & int(Flag.GAP)) != 0) | (np.diff(rows) > 5)
    jumps = np.flatnonzero(np.abs(d) > least / 2)
    open_at, looked, size, level, how = -1, 0, 0.0, 0.0, ""
    for j in jumps.tolist():
        if open_at >= 0 and _comes_back(y[looked : j + 1], level, size):
            open_at = -1
        looked = j + 1
        if open_at >= 0:
            if abs(d[j] + size) < 0.5 * abs(size):
                yield int(rows[open_at]), int(rows[j]) + 1, size, how
                open_at = -1
        elif abs(d[j]) > least and _stays(y, d, j) and (not gap[j] or _beyond_its_pace(y, t_ns[rows], d, j)):
            pause = (t_ns[rows[j + 1]] - t_ns[rows[j]]) / 1e9
            open_at, size = j + 1, float(d[j])
            level = float(np.median(y[max(0, j - _AROUND) : j + 1]))
            how = f"over a pause of {pause:.4g} s" if gap[j] else "within one sample"
    if open_at >= 0 and not _comes_back(y[looked:], level, size):
        yield int(rows[open_at]), len(x), size, how


def _comes_back(after: Float1D, level: float, size: float) -> bool:
    """Whether what follows a step returns, without a step, to the level before it: by medians of _AROUND samples."""
    whole = after[: len(after) // _AROUND * _AROUND].reshape(-1, _AROUND)
    return bool((np.abs(np.median(whole, axis=1) - level) < _BACK * abs(size)).any()) if len(whole) else False


def _beyond_its_pace(y: Float1D, t_ns: Array, d: Float1D, j: int) -> bool:
    """Whether the change over the pause after row j is more than twice what the channel does in such a time
    elsewhere, and more than its range on either side: over a long pause a machine may have cooled."""
    pause = int(t_ns[j + 1] - t_ns[j])
    later = np.searchsorted(t_ns, t_ns + pause)
    inside = later < len(y)
    inside[max(0, int(np.searchsorted(t_ns, t_ns[j] - pause))) : j + 1] = False  # those that span the pause itself
    rows = np.flatnonzero(inside)
    spread = max(float(np.ptp(y[: j + 1])), float(np.ptp(y[j + 1 :])))
    if len(rows) < 20:  # a pause longer than what was recorded on either side
        return abs(float(d[j])) > max(2 * _OFFSET_K, 3 * spread)
    usual = float(np.max(np.abs(y[later[rows]] - y[rows])))
    return abs(float(d[j])) > max(2 * usual, 1.2 * spread)


def _stays(y: Float1D, d: Float1D, j: int) -> bool:
    """Whether the step after row j lasts, and stands out of the changes around it."""
    before, after = y[max(0, j - 20) : j + 1], y[j + 1 : j + 21]
    if len(before) < 5 or len(after) < 5 or abs(np.median(after) - np.median(before)) < 0.7 * abs(d[j]):
        return False
    around = np.abs(np.concatenate([d[max(0, j - 200) : j], d[j + 1 : j + 201]]))
    around = around[around > 0]
    return not len(around) or bool(abs(d[j]) > 3 * np.quantile(around, 0.9))
