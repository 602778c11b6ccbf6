"""Edges that look like parts of a spike and are none: the ends of a longer dropout, and a pause in the log."""

from __future__ import annotations

import numpy as np

from thermodata.calibration.quality.value import true_runs
from thermodata.plugin import Array, Bool1D, Float1D

_LEVEL = 4  # samples: one more than a spike or a puff of air has
_REACH = 3  # samples before and after, between which a spike is looked for
_OF_THE_LEAP = 0.5  # at a pause: what a sample that stands out leaps by on its other side, too


def without_pauses(hit: Bool1D, x: Float1D, after_pause: Bool1D) -> Bool1D:
    """The runs of `hit` but for those that only a pause tells from what is sound. after_pause: first samples after one.

    In a pause a channel may go anywhere. What stands beside one is a spike where it leaps on its other side as well,
    from or to its neighbour in the same stretch of the log. All of shape (n,).
    """
    if not (hit.any() and after_pause.any()):
        return hit
    kept = hit.copy()
    for a, b in zip(*true_runs(hit), strict=True):
        before, after = bool(after_pause[a]), b < len(x) and bool(after_pause[b])
        if not before and not after:
            continue
        into = abs(x[a] - x[a - 1]) if a else 0.0
        out = abs(x[b] - x[b - 1]) if b < len(x) else 0.0
        beside, other = (into, 0.0) if before and after else (into, out) if before else (out, into)
        kept[a:b] = not other < _OF_THE_LEAP * beside  # where a neighbour is no number, nothing speaks against it
    return kept


def across_steps(x: Float1D, leap: float) -> Bool1D:
    """Rows of x, shape (n,), whose neighbours three before and after lie on either side of a clean step: one by more
    than `leap` between two levels, each of more samples than a spike has, beside which these are still."""
    n = len(x)
    mask: Bool1D = np.zeros(n, dtype=bool)
    if n < 2 * _LEVEL:
        return mask
    with np.errstate(invalid="ignore", over="ignore"):
        size = np.abs(np.diff(x))
        rows = np.flatnonzero(size > leap)
    rows = rows[(rows >= _LEVEL - 1) & (rows < n - _LEVEL)]
    if not len(rows):
        return mask
    before, after = _level(x, rows, 1 - _LEVEL), _level(x, rows, 1)
    with np.errstate(invalid="ignore", over="ignore"):
        still = np.maximum(np.ptp(before, axis=1), np.ptp(after, axis=1)) < 0.1 * size[rows]
    for row in rows[still].tolist():
        mask[max(0, row - _REACH + 1) : row + _REACH + 1] = True
    return mask


def _level(x: Float1D, rows: Array, first: int) -> Array:
    """Samples from `first` on, beside each of the rows; shape (k, _LEVEL)."""
    return np.asarray(x[rows[:, None] + np.arange(first, first + _LEVEL)])
