"""A temperature that steps and stays: a sensor that fails, a changed plug; and one that stood still before it stepped.

What may be heat is left alone: a heater warms by many kelvin between two samples, and goes on doing so.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from thermodata.calibration.quality.value import RunStats
from thermodata.plugin import Array, Float1D, Int1D
from thermodata.schema.flag import Flag

_OFFSET_K = 5.0  # within a moment no part warms by more,
_PACE_K_S = 0.25  # a heater by so much a second,
_MOST_REAL_K = 20.0  # and over a pause, however long, nothing that a neighbour would not show
_USUAL_CHANGES = 40  # a step is so many of a fine reading's usual changes,
_TREADS = 6  # or so many treads of a coarse one
_SMALL, _LEAST_SMALL = 0.25, 3  # changes of a quarter of the step: a reading that has fewer of them is a set point
_GOES_ON = 0.15  # of a step: what goes on by so much the same way, more than before it, is heat
_SOON = 9  # samples in which it does; later the heater may be off again
_AROUND = 20  # samples that tell a level
_BACK = 0.3  # of a step: what comes so near to the level before has come back
_STOOD_S = 2 * 3600.0  # a coarse reading that stays on one tread for so long
_MOVED_K = 5.0  # while a neighbour moves by so much
IGNORED = Flag.SPIKE | Flag.STUCK | Flag.OUT_OF_RANGE | Flag.HELD  # readings that tell nothing of a step


@dataclass(frozen=True, slots=True)
class Step:
    """Rows start to stop are off by size [K]; how: over what it came."""

    start: int
    stop: int
    size: float
    how: str


def offset_steps(x: Float1D, t_ns: Int1D, flags: Array, of_time: Array, own: RunStats) -> Iterator[Step]:
    """Where a temperature steps by more than heat can do between two samples, or over a pause by more than it ever
    changes in such a time, and stays there. Ends at a step back, or at the end. Where the value comes back by itself,
    or goes on the same way, the step was real.

    x: shape (n,), degC. t_ns: shape (n,). flags: of the column so far; of_time: of the times; uint16, shape (n,).
    """
    if own.leap <= _OFFSET_K / 2 and not (flags & np.uint16(IGNORED)).any():
        return
    rows = np.flatnonzero((flags & np.uint16(IGNORED)) == 0)
    if len(rows) < 2 * _AROUND:
        return
    y, t = x[rows], t_ns[rows]
    d = np.diff(y)
    moves = np.sort(np.abs(d[(d != 0) & np.isfinite(d)]))
    if len(moves) <= _LEAST_SMALL:
        return
    least = least_step(moves, _OFFSET_K)
    gap = ((of_time[rows[1:]] & int(Flag.GAP)) != 0) | (np.diff(rows) > 5)
    open_at, looked, size, level, how = -1, 0, 0.0, 0.0, ""
    for j in np.flatnonzero(np.abs(d) > least / 2).tolist():
        if open_at >= 0 and comes_back(y[looked : j + 1], level, size):
            open_at = -1
        looked = j + 1
        if open_at >= 0:
            if abs(d[j] + size) < 0.5 * abs(size):
                yield Step(int(rows[open_at]), int(rows[j]) + 1, size, how)
                open_at = -1
            continue
        pause = float(t[j + 1] - t[j]) / 1e9
        if (
            abs(d[j]) > max(least, min(_PACE_K_S * pause, _MOST_REAL_K))
            and np.searchsorted(moves, _SMALL * abs(d[j])) >= _LEAST_SMALL
            and _stays(y, d, j)
            and not _goes_on(y, j, float(d[j]))
            and (not gap[j] or (abs(d[j]) > _MOST_REAL_K and _beyond_its_pace(y, t, d, j)))
        ):
            open_at, size = j + 1, float(d[j])
            level = float(np.median(y[max(0, j - _AROUND) : j + 1]))
            how = f"over a pause of {pause:.4g} s" if gap[j] else "within one sample"
    if open_at >= 0 and not comes_back(y[looked:], level, size):
        yield Step(int(rows[open_at]), len(x), size, how)


def stood_before(x: Float1D, t_ns: Int1D, step: Step, own: RunStats, neighbours: Sequence[Float1D]) -> int | None:
    """The row from which a coarse reading stood on one tread up to a step, for hours, while a neighbour moved; None
    where it did not. Then it is not what follows that is wrong: it was held, and the step is its release.

    neighbours: other temperatures, each of shape (n,).
    """
    levels = np.unique(x[np.isfinite(x)])
    tread = own.finest if 0 < own.step < 2.5 * own.finest else float(np.min(np.diff(levels)))
    back = x[: step.start][::-1]
    wide = np.fmax.accumulate(back) - np.fmin.accumulate(back) > 1.01 * tread
    start = step.start - (int(np.argmax(wide)) if wide.any() else step.start)
    if step.start - start < 2 * _AROUND or (t_ns[step.start - 1] - t_ns[start]) / 1e9 < _STOOD_S:
        return None
    after = x[step.start : step.stop]
    if abs(step.size) < _TREADS * tread or np.nanmax(after) - np.nanmin(after) <= 2.01 * tread:
        return None
    ends = (slice(start, start + _AROUND), slice(step.start - _AROUND, step.start))
    moved = [abs(float(np.nanmedian(o[ends[1]])) - float(np.nanmedian(o[ends[0]]))) for o in neighbours]
    return start if max(moved, default=0.0) >= _MOVED_K else None


def least_step(moves: Float1D, least_k: float) -> float:
    """The smallest step [K] that stands out of a reading's own changes, shape (k,), sorted; least_k at least."""
    finest, step = moves[len(moves) // 100], moves[len(moves) // 2]
    return float(max(least_k, _TREADS * finest if step < 2.5 * finest else _USUAL_CHANGES * step))


def _goes_on(y: Float1D, j: int, size: float) -> bool:
    """Whether what follows the step after row j goes the same way, by more than the reading went before it."""
    after, before = y[j + 1 : j + 1 + _SOON], y[max(0, j + 1 - _SOON) : j + 1]
    further = float(np.median(after[len(after) // 3 :]) - after[0])
    usual = float(before[-1] - np.median(before[: -(len(before) // 3) or None]))
    return bool((further - usual) * np.sign(size) > _GOES_ON * abs(size))


def comes_back(after: Float1D, level: float, size: float) -> bool:
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
