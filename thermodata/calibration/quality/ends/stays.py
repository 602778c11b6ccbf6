"""Short stays at the end of a range: a probe that is out of reach between two measurements stands on its extreme for
minutes, again and again, as quiet as its converter, or to the last digit."""

from __future__ import annotations

import numpy as np

from thermodata.calibration.quality.value import true_runs
from thermodata.plugin import Float1D

_LEAST_ROWS = 10  # of a stay
BAND = 8.0  # of its noise, between the extremes of a plateau of thousands of rows
_APART, _JUMPS = 0.1, 300.0  # of the channel's span, and times the noise, that nothing is read between it and the rest
_FLAT = 6.0  # standard errors that the mean of a stay may lie off their level: what is measured drifts
_QUIET = 0.75  # of the noise of all else, at most: there a probe measures nothing
_SELDOM = 0.5  # of neighbours of all else that are equal, where a stay to the last digit is no tread
_EXACT = 1e-9  # of the level: of one reading that was rounded
_MIDDLE = 0.789  # standard deviations: that of the middle nine tenths of a normal scatter
_ON_THE_WAY = 2  # rows of a stay in which the probe comes there or leaves
_BROKEN = 0.05  # of the rows, in stays that are too short to tell anything


def stays_at_extreme(x: Float1D) -> tuple[float, float, int, int] | None:
    """(level, noise, -1 for the lowest or 1 for the highest readings, stays) where a channel jumps to one level beyond
    all that it reads else, stands there for some rows and jumps back, in all stays alike. noise: 0 where all of them
    are one reading to the last digit. x: shape (n,), finite, in order."""
    if x.size < 4 * _LEAST_ROWS:
        return None
    found = [(side, stays) for side in (-1, 1) if (stays := _at_top(side * x)) is not None]
    if not found:
        return None
    side, (level, noise, n) = max(found, key=lambda one: one[1][2])
    return side * level, noise, side, n


def _at_top(x: Float1D) -> tuple[float, float, int] | None:
    """(level, noise, stays) at the highest readings of x."""
    ordered = np.sort(x)
    apart = np.diff(ordered)
    wide = np.flatnonzero(apart >= _APART * (ordered[-1] - ordered[0]))
    if not wide.size or x.size - wide[-1] - 1 < _LEAST_ROWS:
        return None
    top = ordered[wide[-1] + 1 :]
    level = float(np.median(top))
    noise = _scatter(top)
    exact = noise <= _EXACT * abs(level)
    noise = 0.0 if exact else noise
    if noise * _JUMPS >= apart[wide[-1]] or top[-1] > level + BAND * noise:
        return None
    at = x >= level - BAND * noise
    starts, stops = true_runs(at)
    long = stops - starts >= _LEAST_ROWS
    n = int(long.sum())
    broken = int((stops - starts)[~long].sum())
    if not n or top.size - int(at.sum()) > _ON_THE_WAY * n or broken > _BROKEN * top.size:
        return None
    lasted = zip(starts[long].tolist(), stops[long].tolist(), strict=True)
    off = [abs(float(x[a:b].mean()) - level) * np.sqrt(b - a) for a, b in lasted]
    rest = x < ordered[wide[-1] + 1]
    calm = np.abs(np.diff(x))[rest[1:] & rest[:-1]]
    if not calm.size:
        return None
    if exact:  # a reading in treads repeats any of its values; one that flickers by its counts does not; 0 is a rest
        flickers = level != 0 and np.mean(calm == 0) < _SELDOM and apart[wide[-1]] >= _JUMPS * float(np.median(calm))
        return (level, noise, n) if flickers else None
    if max(off) > _FLAT * noise:
        return None
    return (level, noise, n) if noise <= _QUIET * float(np.median(calm)) / (0.6745 * np.sqrt(2)) else None


def _scatter(ordered: Float1D) -> float:
    """The standard deviation of a normal scatter, from its middle nine tenths: without rows on the way, and of readings
    in counts that are not much finer. ordered: shape (n,)."""
    n = ordered.size // 20
    return float(ordered[n : ordered.size - n].std()) / _MIDDLE
