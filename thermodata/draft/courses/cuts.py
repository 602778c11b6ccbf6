"""Whether a test in which spindle and axes work is one of cutting: by the load of the spindle, and when axes feed."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from thermodata.draft.files.sample import Course
from thermodata.plugin import Bool1D, Float1D

_TURNS_RPM, _FEEDS_M_MIN = 20.0, 0.05
_WITH_SPINDLE = 0.95  # of the time in which an axis feeds
_WORKS = 0.05  # of the rows, or nothing can be said
# times the power that it takes at the same speed, or at a higher one: grease that warms takes a third off
_LOADED = 2.0
_SEEN = 0.1  # of the largest power, or it is the noise of a drive that rests
_LEAST_ROWS, _SAME_SPEED = 20, 0.02


def feeds_with_spindle(speed: Course, feeds: Sequence[Course]) -> bool:
    """Whether axes feed, and hardly ever while the spindle stands. speed [rpm], feeds [m/min]."""
    turns = np.abs(speed.values) > _TURNS_RPM
    feeding: Bool1D = np.zeros(len(turns), dtype=bool)
    for feed in feeds:
        feeding |= np.abs(_at(speed, feed)) > _FEEDS_M_MIN
    if not feeding.mean() >= _WORKS:
        return False
    return bool(turns[feeding].mean() >= _WITH_SPINDLE) and bool(turns.mean() < 1)


def is_loaded(speed: Course, power: Course) -> bool:
    """Whether something else than the speed makes the power of a spindle: without a load it takes about as much at each
    speed, and no less at a higher one."""
    levels = sorted(_at_levels(np.abs(speed.values), np.abs(_at(speed, power))))
    usual = [float(np.median(p)) for _, p in levels]
    pairs = [tuple(np.quantile(p, [0.9, 0.1]).tolist()) for _, p in levels]
    pairs += [(p, q) for i, p in enumerate(usual) for q in usual[i + 1 :]]
    least = _SEEN * max((float(p.max()) for _, p in levels), default=0.0)
    return any(p > _LOADED * q and p - q > least for p, q in pairs)


def _at(speed: Course, other: Course) -> Float1D:
    """Another course at the times of the speed's, as it was logged last."""
    last = np.clip(np.searchsorted(other.t_ns, speed.t_ns, side="right") - 1, 0, len(other.t_ns) - 1)
    return np.asarray(other.values[last], dtype=np.float64)


def _at_levels(speed: Float1D, power: Float1D) -> Iterator[tuple[float, Float1D]]:
    """(speed, power while it turned at that), of each speed that it kept for a while."""
    known = np.isfinite(speed) & np.isfinite(power) & (speed > _TURNS_RPM)
    # the row after a change of speed is of neither, and so are those of an acceleration
    steady = known & (np.abs(np.diff(speed, prepend=np.nan)) < _SAME_SPEED * speed)
    cells = np.round(np.log(np.where(steady, speed, 1.0)) / _SAME_SPEED).astype(np.int64)
    for cell in np.unique(cells[steady]):
        at = steady & (cells == cell)
        if np.count_nonzero(at) >= _LEAST_ROWS:
            yield float(np.median(speed[at])), power[at]
