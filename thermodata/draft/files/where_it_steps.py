"""Where in a long log a probe goes in sudden steps a few times: kept as it was logged, for a course thinned out over
hours has no point on such plateaus."""

from __future__ import annotations

import numpy as np

from thermodata.plugin import Bool1D, Float1D, Int1D

_EVERY_S = 1.0  # finer rows are passed over: an axis stands for seconds
_ROWS = 2  # over which a move is seen
_OF_NOISE, _OF_RANGE, _DIGITS = 12.0, 0.02, 5  # what a step stands out of
_APART_S = 600.0  # between two stretches, and the most that is kept beside one
_LONGEST_S = 1800.0
_LEAST_STEPS, _MOST_STEPS = 2, 80
_MOST_STRETCHES = 6  # what goes in steps all along, as between visits to a probe, is no jump test
_FEWEST_ROWS = 40  # by which plateaus are told
_LEAST = 60


def where_it_steps(t_ns: Int1D, x: Float1D) -> list[tuple[int, int]]:
    """(from, to) of the stretches in which a probe goes in sudden steps, with a plateau's time beside each [ns]. Empty
    where there are none, many, or a clock that does not run on. t_ns, x: shape (n,)."""
    fine = np.isfinite(x)
    t, v = t_ns[fine], x[fine]
    if t.size < _LEAST or (apart := np.diff(t)).min() <= 0:
        return []
    stride = max(1, int(_EVERY_S * 1e9 / float(np.median(apart))))
    t, v = t[::stride], v[::stride]
    if t.size < _LEAST:
        return []
    hits, up = _sudden(v)
    if hits.size < _LEAST_STEPS:
        return []
    at = t[hits]
    ends = np.flatnonzero(np.diff(at) > _APART_S * 1e9)
    parts = np.split(np.arange(hits.size), ends + 1)
    every = float(np.median(np.diff(t)))
    found = [s for part in parts if (s := _stretch(hits[part], at[part], up[part], every)) is not None]
    return found if len(found) <= _MOST_STRETCHES else []


def _sudden(v: Float1D) -> tuple[Int1D, Bool1D]:
    """(rows about which a step is, whether it goes up); shapes (k,)."""
    rise = v[_ROWS:] - v[:-_ROWS]
    height = np.abs(rise)
    span = float(np.ptp(v))
    noise = 1.4826 * float(np.median(height))
    least = max(_OF_NOISE * noise, _OF_RANGE * span)
    hits = np.flatnonzero(height > least)
    if hits.size:
        levels = np.unique(v)
        hits = hits[height[hits] >= _DIGITS * float(np.diff(levels).min())]
    return hits + _ROWS // 2, rise[hits] > 0


def _stretch(hits: Int1D, at: Int1D, up: Bool1D, every_ns: float) -> tuple[int, int] | None:
    """A stretch and what is kept beside it; None of one that is too long, or goes in too few or too many steps. at:
    the times of its sudden rows [ns]; every_ns: between rows."""
    new = np.concatenate([[True], (np.diff(hits) > _ROWS) | (np.diff(up.astype(np.int8)) != 0)])
    steps = at[new]
    lasts = int(at[-1] - at[0])
    if not _LEAST_STEPS <= steps.size <= _MOST_STEPS or lasts > _LONGEST_S * 1e9:
        return None
    pause = float(np.median(np.diff(steps)))
    missing = (_FEWEST_ROWS * every_ns - lasts) / 2  # of the rows that tell plateaus
    beside = round(min(max(pause, missing + 2 * every_ns), _APART_S * 1e9))
    return int(at[0]) - beside, int(at[-1]) + beside
