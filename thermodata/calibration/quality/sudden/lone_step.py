"""A temperature that steps by little, once, within one sample: another sensor in its place, a connector that was
touched.

Heat of a body takes time: what it did within a sample it goes on doing in the next ones, and what steps again and again
(a valve, a draught, a drive that disturbs its sensor) may be its own. So a small step is told where the log is quick,
where nothing else in the test comes near to it, where it is over within the sample, and where no other temperature
does it.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from thermodata.calibration.quality.sudden.step import IGNORED, Step, comes_back, least_step
from thermodata.calibration.quality.value import RunStats
from thermodata.plugin import Array, Float1D, Int1D
from thermodata.schema.flag import Flag

LEAST_K = 0.8
QUICK_S = 30.0  # between two samples: a sensor in a slower log may follow what it lies in within one of them
NEXT = 0.25  # of the step: what the reading does elsewhere within a sample, and what another temperature does here
LINE = 30  # samples on each side that lie on one line but for the step,
LEAST_LINE = 10
OFF_LINE = 0.1  # of the step: what is left there at most; heat is not over within a sample
SOON_S = 3600.0  # in which it does not come back by itself, as what was splashed or touched does


def lone_step(
    x: Float1D, t_ns: Int1D, flags: Array, of_time: Array, own: RunStats, others: Iterable[Float1D]
) -> Step | None:
    """The one step of a temperature that is too small for `offset_steps`; None where there is none.

    x: shape (n,), degC. t_ns: shape (n,). flags: of the column so far; of_time: of the times; uint16, shape (n,).
    others: temperatures of the same rows, each of shape (n,).
    """
    if own.leap < LEAST_K:
        return None
    rows = np.flatnonzero((flags & np.uint16(IGNORED)) == 0)
    if len(rows) < 2 * LINE:
        return None
    y, t_s = x[rows], t_ns[rows] / 1e9
    moves = np.abs(np.diff(y))
    moves[~np.isfinite(moves)] = 0.0
    j = int(np.argmax(moves))
    moving = np.sort(moves[moves > 0])
    if len(moving) < LINE or moves[j] < least_step(moving, LEAST_K) or moving[-2] > NEXT * moves[j]:
        return None
    apart = np.diff(t_s)
    gap = (of_time[rows[j + 1]] & int(Flag.GAP)) != 0 or rows[j + 1] - rows[j] > 1
    if gap or apart[j] > min(QUICK_S, 1.5 * float(np.median(apart))):
        return None
    size = float(y[j + 1] - y[j])
    if not _is_over_at_once(y, t_s, j, size):
        return None
    soon = y[j + 1 : int(np.searchsorted(t_s, t_s[j + 1] + SOON_S)) + 1]
    if comes_back(soon, float(np.median(y[max(0, j - LINE) : j + 1])), size):
        return None
    at = rows[j : j + 2]
    if any(abs(float(o[at[1]] - o[at[0]])) > NEXT * abs(size) for o in others):
        return None
    return Step(int(at[1]), len(x), size, "within one sample, the only one, at once over")


def _is_over_at_once(y: Float1D, t_s: Float1D, j: int, size: float) -> bool:
    """Whether the samples around row j lie on one line but for a step behind it."""
    first, stop = max(0, j + 1 - LINE), min(len(y), j + 1 + LINE)
    if j + 1 - first < LEAST_LINE or stop - j - 1 < LEAST_LINE:
        return False
    if min(float(np.ptp(y[first : j + 1])), float(np.ptp(y[j + 1 : stop]))) == 0.0:
        return False  # what stood before, or stands since: which side is wrong, the step doesn't tell
    t, after = t_s[first:stop] - t_s[j], np.arange(first, stop) > j
    columns = np.stack([np.ones(len(t)), t, after.astype(np.float64)], axis=1)
    found = np.linalg.lstsq(columns, y[first:stop], rcond=None)[0]
    left = np.abs(y[first:stop] - columns @ found)
    return bool(np.max(left) <= OFF_LINE * abs(size) and abs(found[2] - size) <= 2 * OFF_LINE * abs(size))
