"""A log that dies whole: the logger, or what exports it, repeats its last row to the end of the test.

No sensor tells it, for beside each all others stand, too: in a hall at rest coarse readings do so for hours. What tells
it is a reading with noise finer than it moves, which stands to the last digit to the end, and one of another quantity
that flickered all the time until then: no main switch makes the drift of both end in one moment.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from thermodata.calibration.quality.frozen import LEAST_S, LEAST_SAMPLES, flickers
from thermodata.calibration.quality.value import RunStats, held_runs
from thermodata.plugin import Array, Int1D


class Reading(NamedTuple):
    """A column of numbers. values: shape (n,); stats: of one whose readings carry noise."""

    values: Array
    quantity: str
    stats: RunStats | None
    elsewhere: RunStats | None


def last_row_repeats(t_ns: Int1D, readings: Mapping[str, Reading]) -> int | None:
    """The row from which on all columns stand to the end, for half an hour and 100 samples at least, though two of them
    can't; None where they may. t_ns: shape (n,). readings: the stream's columns of numbers, but those that are written
    on change."""
    start = max((_stands_from(each.values) for each in readings.values()), default=len(t_ns))
    if len(t_ns) - start < LEAST_SAMPLES or t_ns[-1] - t_ns[start] < LEAST_S * 1e9:
        return None
    stats = {name: each.stats for name, each in readings.items() if each.stats is not None}
    fine = {readings[name].quantity for name in stats if _is_held(name, start, t_ns, readings, stats)}
    noisy = {readings[name].quantity for name in stats if _flickered(readings[name], start)}
    return start if fine and len(fine | noisy) > 1 else None


def _stands_from(x: Array) -> int:
    """The first row of those that all have the last value."""
    other = np.flatnonzero(x != x[-1]) if len(x) and x[-1] == x[-1] else np.flatnonzero(x == x)
    return int(other[-1]) + 1 if other.size else 0


def _is_held(
    name: str, start: int, t_ns: Int1D, readings: Mapping[str, Reading], stats: Mapping[str, RunStats]
) -> bool:
    x, _, own, elsewhere = readings[name]
    others = {k: readings[k].values for k in stats if k != name}
    if own is None or not np.isfinite(x[-1]):
        return False
    runs = held_runs(np.asarray(x, np.float64), t_ns, own, others, stats, elsewhere)
    return any(stop == len(x) and first <= start for first, stop, _, _ in runs)


def _flickered(reading: Reading, start: int) -> bool:
    x, own = np.asarray(reading.values, np.float64), reading.stats
    return own is not None and bool(np.isfinite(x[-1])) and flickers(x, own.finest, [(start, len(x))])
