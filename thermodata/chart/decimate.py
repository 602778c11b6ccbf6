"""Fewer points for a page: the extremes of each stretch of time, or its mean."""

from __future__ import annotations

import numpy as np

from thermodata.plugin import Float1D

MOST_POINTS = 1200
_GAP_STEPS = 3.5  # a step of so many usual steps is a hole in the data


def block_size(n: int, most: int) -> int:
    """How many samples one drawn point stands for."""
    return max(1, -(-n // most))


def block_mean(values: Float1D, size: int) -> Float1D:
    """Means of blocks of `size` samples, shape (ceil(n / size),); NaN where a block holds no value."""
    if size <= 1:
        return np.asarray(values, dtype=np.float64)
    blocks = -(-len(values) // size)
    padded = np.full(blocks * size, np.nan)
    padded[: len(values)] = values
    table = padded.reshape(blocks, size)
    there = np.isfinite(table)
    count = there.sum(axis=1)
    total = np.where(there, table, 0.0).sum(axis=1)
    return np.asarray(np.divide(total, count, out=np.full(blocks, np.nan), where=count > 0))


def min_max(x: Float1D, y: Float1D, span: tuple[float, float], bins: int) -> tuple[Float1D, Float1D]:
    """The smallest and the largest value of each of `bins` stretches of `span`: no peak is lost.

    x: shape (n,), non-decreasing. y: shape (n,), NaN where nothing counts. Returns shape (2 * bins,) each, two points a
    stretch, at a quarter and three quarters of it, so that all channels of a window share one x; the order of the two
    follows the samples. A stretch without a value is NaN: a gap stays a gap.
    """
    low, high = span
    edges = np.linspace(low, high, bins + 1)
    width = (high - low) / bins
    at = np.repeat(edges[:-1], 2) + np.tile([0.25, 0.75], bins) * width
    out = np.full((bins, 2), np.nan)
    cut = np.searchsorted(x, edges)
    cut[-1] = np.searchsorted(x, high, side="right")
    filled = np.flatnonzero(cut[1:] > cut[:-1])
    if len(filled):
        # between two starts of filled stretches stand the samples of the first alone, the empty ones have none
        starts, values = cut[filled], np.asarray(y[: cut[-1]], dtype=np.float64)
        smallest, largest = np.fmin.reduceat(values, starts), np.fmax.reduceat(values, starts)
        first, last = values[starts], values[cut[filled + 1] - 1]
        falling = last < first
        out[filled, 0] = np.where(falling, largest, smallest)
        out[filled, 1] = np.where(falling, smallest, largest)
    return at, out.ravel()


def columns_in(
    x: Float1D, columns: dict[str, Float1D], span: tuple[float, float] | None, most: int = 2 * MOST_POINTS
) -> tuple[Float1D, dict[str, Float1D]]:
    """What a window shows of some channels: every sample where they are at most `most`, else their extremes.

    x: shape (n,), non-decreasing, shared by the columns of shape (n,). span: of x, everything where None. One sample on
    either side of the window comes along, so that lines run to its edges.
    """
    if not len(x):
        return x, columns
    low, high = span if span is not None else (float(x[0]), float(x[-1]))
    first = max(int(np.searchsorted(x, low)) - 1, 0)
    last = min(int(np.searchsorted(x, high, side="right")) + 1, len(x))
    if last - first <= most:
        inside = slice(first, last)
        at, holes = _with_gaps(x[inside])
        return at, {name: _with_holes(values[inside], holes) for name, values in columns.items()}
    at = x[:0]
    made = {}
    for name, values in columns.items():
        at, made[name] = min_max(x, values, (low, high), most // 2)
    return at, made


def shortened(x: Float1D, y: Float1D, most: int = 2 * MOST_POINTS) -> tuple[Float1D, Float1D]:
    """One channel in at most `most` points; see `columns_in`."""
    at, made = columns_in(x, {"y": y}, None, most)
    return at, made["y"]


def _with_gaps(x: Float1D) -> tuple[Float1D, np.ndarray]:
    """x with one point more in each hole, and where they come before: shape (holes,)."""
    steps = np.diff(x)
    usual = float(np.median(steps)) if len(steps) else 0.0
    holes = np.flatnonzero(steps > _GAP_STEPS * usual) + 1 if usual > 0 else np.empty(0, np.int64)
    middles = (x[holes - 1] + x[holes]) / 2
    return np.insert(x, holes, middles), holes


def _with_holes(values: Float1D, holes: np.ndarray) -> Float1D:
    return np.insert(np.asarray(values, dtype=np.float64), holes, np.nan)
