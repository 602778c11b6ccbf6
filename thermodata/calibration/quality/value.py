"""What is wrong with a column's values: held and stuck readings. (Sudden offsets: `quality.sudden.step`;
spikes: `quality.sudden.spike`.)

All of it leans on one look at the differences of neighbours (RunStats): how fine the readings are, how noisy,
and how often neighbours are equal by chance.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np

from thermodata.calibration.tread import exact_tread_of
from thermodata.plugin import Array, Bool1D, Float1D, Int1D

_LEAST_HELD = 10  # samples
_LEAST_HELD_S = 5.0
# runs of equal readings that tell a sensor which is asked less often than it is logged, how far one may be from a
# multiple of the time between two, and how many are not
_FEWEST_REFRESHED, _OUT_OF_STEP, _IN_STEP = 20, 0.15, 0.9


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
    with np.errstate(invalid="ignore", over="ignore"):  # inf - inf, and numbers at both ends of a float
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
    turns = float(np.mean((moving[1:] > 0) != (moving[:-1] > 0)))
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
    if not own.step < 2.5 * exact_tread_of([x]):
        return False
    if not len(own.starts):
        return True
    # a sensor that is stuck stands on any tread: a staircase is one without its longest stretch, too
    longest = int(np.argmax(own.lengths))
    start, stop = own.starts[longest], own.starts[longest] + own.lengths[longest]
    return bool(own.step < 2.5 * exact_tread_of([x[:start], x[stop:]]))


def held_runs(
    x: Float1D,
    t_ns: Array,
    own: RunStats,
    others: Mapping[str, Array],
    stats: Mapping[str, RunStats],
    elsewhere: RunStats | None,
) -> Iterator[tuple[int, int, bool, str]]:
    """(start, stop, stuck, why) of exactly constant stretches that chance can't explain.

    The channel must be fine-grained, and either noisy of its own, or jump where it is released while others moved
    (the drift that nobody saw). Stuck: it got there by a jump, so it is no reading that was held. elsewhere: how the
    channel reads in other tests, which counts where it stands for too long to tell here.
    """
    if not len(own.starts):
        return
    if elsewhere is not None and not own.float_like:
        own = replace(elsewhere, starts=own.starts, lengths=own.lengths)
    elif not own.float_like or is_staircase(x, own):
        return
    every, equal = refreshed(own.lengths, len(x))
    # expected number of such runs by chance under 1/1000
    least = np.log(1e-3 * every / len(x)) / np.log(max(own.chance, equal, 1e-3)) * 1.5
    for start, length in zip(own.starts.tolist(), own.lengths.tolist(), strict=True):
        stop = start + length
        if length < max(_LEAST_HELD, least) * every or (t_ns[stop - 1] - t_ns[start]) < _LEAST_HELD_S * 1e9:
            continue
        jump_in = abs(x[start] - x[start - 1]) if start else 0.0
        jump_out = abs(x[stop] - x[stop - 1]) if stop < len(x) else 0.0
        moved = [k for k, s in stats.items() if k in others and s.float_like and _changes_often(others[k], start, stop)]
        if own.alternates < 0.2 and not (moved and jump_out > 8 * own.step):
            continue
        stuck = bool(jump_in > max(50 * own.step, 1e-12)) and jump_in > 0.2 * _range_before(x, start)
        why = f"exactly {x[start]:.6g} for {length} samples"
        if moved:
            why += f" while {', '.join(moved[:3])} moved"
        yield start, stop, stuck, why


def refreshed(lengths: Int1D, samples: int) -> tuple[int, float]:
    """(samples that a reading is repeated for before the next one, how often the next one is equal by chance): of a
    sensor that is asked less often than it is logged. (1, 0) where it is asked each time. lengths: of the runs of equal
    readings, shape (k,). samples: of the channel."""
    if len(lengths) < _FEWEST_REFRESHED:
        return 1, 0.0
    every = float(np.median(lengths))
    times = np.maximum(np.round(lengths / every), 1)
    in_step = np.abs(lengths - times * every) <= _OUT_OF_STEP * times * every
    usual = lengths <= _LEAST_HELD * every
    if in_step[usual].mean() < _IN_STEP or lengths[usual].sum() < _IN_STEP * (samples - lengths[~usual].sum()):
        return 1, 0.0
    return round(every), float(min(1 - usual.sum() / times[usual].sum(), 0.99))


def _changes_often(x: Array, start: int, stop: int) -> bool:
    part = x[start : min(stop, start + 2000)]
    return bool(np.mean(part[1:] != part[:-1]) > 0.2)


def _range_before(x: Float1D, before: int) -> float:
    past = x[max(0, before - 2000) : before]
    past = past[np.isfinite(past)]
    return float(np.ptp(past)) if len(past) else 0.0
