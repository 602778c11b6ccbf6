"""How a channel reads in a test, gathered chunk by chunk: enough to tell it beside other tests."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Protocol

import numpy as np

from thermodata.calibration.quality.ends.range import LONG_TIMES, plateau_at_extreme
from thermodata.calibration.quality.ends.stays import stays_at_extreme
from thermodata.calibration.quality.ends.still import Reading, Shown
from thermodata.calibration.quality.value import RunStats, refreshed, run_stats
from thermodata.plugin import Array, Float1D
from thermodata.schema.flag import INVALID, Flag


class FlaggedValues(Protocol):
    """A channel's values and uint16 flags, shape (n,)."""

    @property
    def values(self) -> Array: ...
    @property
    def flags(self) -> Array: ...


def as_read(column: FlaggedValues) -> Float1D:
    """The values of a channel, NaN where they are none of it. What stands is wanted here: a verdict that flags it must
    come out the same once it is flagged."""
    judged = np.uint16(INVALID & ~(Flag.HELD | Flag.STUCK | Flag.SATURATED))
    return np.where((column.flags & judged) == 0, column.values, np.nan)


def reading_with(known: Reading | None, column: FlaggedValues, t_s: Float1D) -> Reading:
    """How a channel reads, from the chunk in which it moves most; and its longest stretch of one value in any."""
    x = as_read(column)
    stats = run_stats(x)
    d = np.diff(x)
    moving = int(np.count_nonzero(d[np.isfinite(d)]))
    stood = max(
        (float(t_s[a + n - 1] - t_s[a]) for a, n in zip(stats.starts.tolist(), stats.lengths.tolist(), strict=True)),
        default=0.0,
    )
    new = Reading(
        stats.step, stats.finest, stats.chance, stats.alternates, moving, stood, *_extremes(x, stats), _plateau(x, t_s)
    )
    if known is None:
        return new
    low, low_n = _further(min, (known.low, known.low_n), (new.low, new.low_n))
    high, high_n = _further(max, (known.high, known.high_n), (new.high, new.high_n))
    return replace(
        known if known.moving >= moving else new,
        stood_s=max(stood, known.stood_s),
        low=low,
        low_n=low_n,
        high=high,
        high_n=high_n,
        plateau=_with_times(known.plateau, new.plateau),
    )


def _plateau(x: Float1D, t_s: Float1D) -> Shown | None:
    """See `Reading`."""
    known = np.isfinite(x)
    found = plateau_at_extreme(t_s[known], x[known])
    return stays_at_extreme(x[known]) if found is None else (found.level, found.noise, found.side, LONG_TIMES)


def _with_times(known: Shown | None, new: Shown | None) -> Shown | None:
    """The plateau of two chunks: of both, where they are one; else the one that was shown more often."""
    if known is None or new is None:
        return known or new
    if known[2] == new[2] and abs(known[0] - new[0]) <= known[1]:
        return (*known[:3], known[3] + new[3])
    return max(known, new, key=lambda p: p[3])


def _extremes(x: Float1D, stats: RunStats) -> tuple[float | None, int, float | None, int]:
    """Lowest value of x and how many readings stand there, and the same of the highest. A reading is one, however often
    it is logged."""
    known = x[np.isfinite(x)]
    if not len(known):
        return None, 0, None, 0
    every, _ = refreshed(stats.lengths, len(x))
    low, high = float(known.min()), float(known.max())
    low_n, high_n = (int(np.count_nonzero(known == end)) // every for end in (low, high))
    return low, low_n, high, high_n


def _further(
    which: Callable[[float, float], float], a: tuple[float | None, int], b: tuple[float | None, int]
) -> tuple[float | None, int]:
    """The further one of two extremes, each with its number of samples; of the same, all of them."""
    if a[0] is None or b[0] is None:
        return b if a[0] is None else a
    if a[0] == b[0]:
        return a[0], a[1] + b[1]
    return a if which(a[0], b[0]) == a[0] else b
