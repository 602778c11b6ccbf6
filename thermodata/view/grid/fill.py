"""What stands between the bins that have samples: states are held, drivers bridged, displacements left alone."""

from __future__ import annotations

import numpy as np

from thermodata.plugin import Float1D, Int1D
from thermodata.store.views.grid import INTERPOLATED_PERIODS

BRIDGE_S = 300.0


def on_grid(k: Int1D, value: Float1D, first: int, size: int) -> Float1D:
    """Scatters bins onto the grid. Returns shape (size,), NaN where no bin stands."""
    out = np.full(size, np.nan)
    out[k - first] = value
    return out


def hold(k: Int1D, value: Float1D, stands: Float1D, first: int, size: int) -> Float1D:
    """On the grid, each bin's value, and from it to the next bin what stands there, be it NaN; NaN before the first.
    Shape (size,). k: in any order; of a bin that is told twice the last stands."""
    out = np.full(size, np.nan)
    if k.size:
        order = np.argsort(k, kind="stable")
        last = np.searchsorted(k[order] - first, np.arange(size), side="right") - 1
        out = np.where(last >= 0, stands[order][np.maximum(last, 0)], np.nan)
        out[k[order] - first] = value[order]
    return out


def reach_bins(period_s: float, step_s: float) -> float:
    """How far apart [bins] the neighbours may stand that a driver is interpolated between."""
    return max(BRIDGE_S, INTERPOLATED_PERIODS * period_s) / step_s


def bridge(value: Float1D, reach: float, undirected: bool = False) -> Float1D:
    """Linear interpolation between known neighbours at most `reach` bins apart; the nearest value over the same
    distance at both ends. What is further from a known value stays NaN. undirected: between neighbours of two signs
    the size is interpolated, for a line through nought makes the axis stand that only turned."""
    known = np.flatnonzero(np.isfinite(value))
    if known.size in (0, value.size) or reach < 1:
        return value
    grid = np.arange(value.size)
    right = np.searchsorted(known, grid)
    before, after = known[np.maximum(right - 1, 0)], known[np.minimum(right, known.size - 1)]
    inside = (right > 0) & (right < known.size)
    filled = np.isnan(value) & inside & (after - before <= reach)
    ends = np.isnan(value) & ~inside & (np.minimum(np.abs(grid - before), np.abs(grid - after)) <= reach)
    out = value.copy()
    out[filled | ends] = np.interp(grid[filled | ends], known, value[known])
    if undirected:
        turned = filled & (value[before] * value[after] < 0)
        out[turned] = np.interp(grid[turned], known, np.abs(value[known]))
    return out
