"""Below a sample: aligns a stretch with events of one log with the other log, in continuous time."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from thermodata.plugin import Float1D, Int1D

_MOST_STRETCHES = 24
_MOST_SAMPLES = 4000
_QUIET = 8  # samples without a change that part two events
_LEAST_SAMPLES = 6  # of a stretch
_LEAST_CORRELATION = 0.7  # of a stretch with the other log
_NEAR_THE_END = 0.98  # of the reach: the best lag may lie beyond


def stretches_with_events(t_a: Float1D, a: Float1D, lag: float, t_b: Float1D) -> list[slice]:
    """Slices of `a`, within the overlap with `b`, that each hold a good part of its changes."""
    low, high = max(t_a[0], t_b[0] - lag), min(t_a[-1], t_b[-1] - lag)
    first, last = np.searchsorted(t_a, [low, high])
    if last - first < 8:
        return []
    bounds = first + _cuts(np.abs(np.diff(a[first:last])))
    parts = [slice(int(p), int(q)) for p, q in pairwise(bounds)]
    return [p for p in parts if p.stop - p.start >= 6 and a[p].std() > 0.05]


def _cuts(change: Float1D) -> Int1D:
    """Bounds of pieces, cut in the quiet between events; a signal that always moves is cut evenly."""
    moving = np.flatnonzero((change > 6 * float(np.median(change))) & (change > 0.05 * change.max()))
    n = len(change) + 1
    if len(moving) == 0 or len(moving) > 0.2 * n:
        return np.linspace(0, n, min(12, max(1, n // 50)) + 1).astype(np.int64)
    pauses = np.flatnonzero(np.diff(moving) > _QUIET)
    pauses = pauses[np.linspace(0, len(pauses) - 1, min(_MOST_STRETCHES - 1, len(pauses))).astype(np.int64)]
    inner = (moving[pauses] + moving[pauses + 1]) // 2 + 1
    return np.unique(np.concatenate([[0], inner, [n]])).astype(np.int64)


def refine(
    t_a: Float1D, a: Float1D, t_b: Float1D, b: Float1D, lag: float, reach: float
) -> tuple[float, float, float, float] | None:
    """(time of the events, lag, weight, correlation) of a stretch; None where it can't be told.

    The lag is the best correlation of `a` with `b` read at t + lag between its samples, found by a grid over
    lag +- reach that narrows, then a parabola.
    """
    where = _near_events(a)
    t, x = t_a[where], a[where]
    if len(t) < _LEAST_SAMPLES or x.std() == 0:
        return None

    def misfit(shift: float) -> float:
        y = np.interp(t + shift, t_b, b)
        y = y - y.mean()
        spread = float(np.sqrt(np.mean(y * y)))
        return 1.0 - float(np.mean((x - x.mean()) * y)) / (float(x.std()) * spread) if spread > 1e-9 else 2.0

    best, width = lag, reach
    for _ in range(7):
        shifts = best + np.linspace(-width, width, 13)
        costs = np.array([misfit(s) for s in shifts])
        best, width = _middle(shifts, costs), width / 3
    correlation = 1.0 - misfit(best)
    if not is_told(best - lag, reach, correlation):
        return None
    changes = np.abs(np.diff(x))
    events = float(np.sum((t[1:] + t[:-1]) / 2 * changes) / changes.sum())
    return events, best, float(changes.sum()), correlation


def is_told(moved: float, reach: float, correlation: float) -> bool:
    """Whether a stretch tells its own lag. moved: from where the search began, within +- reach."""
    return abs(moved) <= _NEAR_THE_END * reach and correlation >= _LEAST_CORRELATION


def _middle(shifts: Float1D, costs: Float1D) -> float:
    """The middle of the lowest costs: a signal in steps has a flat bottom as wide as a sample."""
    low = float(costs.min())
    bottom = costs <= low + 1e-9 + 1e-6 * abs(low)
    return float(shifts[bottom].mean())


def _near_events(a: Float1D) -> Int1D:
    """Rows to compare: all of a short stretch, else those near changes and a thin sample of the rest."""
    if len(a) <= _MOST_SAMPLES:
        return np.arange(len(a))
    change = np.abs(np.diff(a, prepend=a[0]))
    rows = np.argsort(-change, kind="stable")[: _MOST_SAMPLES // 40]
    near = np.unique(np.clip((rows[:, None] + np.arange(-10, 11)).ravel(), 0, len(a) - 1))
    return np.union1d(near, np.linspace(0, len(a) - 1, _MOST_SAMPLES // 2).astype(np.int64))
