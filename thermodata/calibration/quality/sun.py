"""What readings of the sun do by themselves: they rest by night, and about a clear noon in coarse counts."""

from __future__ import annotations

import numpy as np

from thermodata.calibration.quality.value import RunStats
from thermodata.calibration.tread import exact_tread_of
from thermodata.plugin import Float1D, Int1D

# Quantities that rest, exactly, and up to where: by night no sun shines, but for a lamp and the sensor's offset [W/m2].
RESTS_BELOW = {"irradiance": 30.0}
_DAWN = 300.0 / 3600e9  # [W/m2/ns] the clear sky's steepest dawn; what comes quicker is no night that begins or ends
_SUN_NS = 24 * 3600e9 / (2 * np.pi)  # in which it goes on by a radian
_LEAP = 0.25  # of a reading of the sun: a cable or a lamp leaps to it on both sides


def rests(x: Float1D, t_ns: Int1D, start: int, stop: int, quantity: str) -> bool:
    """Whether samples [start, stop), one reading, are a rest: low, and come or gone at the pace of a dawn on one side
    at least. A cable that is off leaps on both."""
    low = RESTS_BELOW.get(quantity)
    if low is None or not x[start] <= low:
        return False

    def dawns(a: int, b: int) -> bool:
        # a reading that is none says nothing
        return a < 0 or b >= len(x) or not abs(x[b] - x[a]) > low + _DAWN * float(t_ns[b] - t_ns[a])

    return dawns(start - 1, start) or dawns(stop - 1, stop)


def least_count_of_sun(x: Float1D, quantity: str, own: RunStats) -> float:
    """Of a reading of the sun; 0 of other quantities."""
    return max(exact_tread_of([x]), own.finest) if quantity == "irradiance" else 0.0


def is_clear_sky(x: Float1D, t_ns: Int1D, first: int, stop: int, count: float) -> bool:
    """Whether one reading of the sun, in samples from `first` to `stop`, is a clear sky's: it lasts no longer than
    the sun takes about noon to change that by the least count of the sensor, and what is read just before and
    after is no brighter than the sun may make it in that time. Clouds make it darker only, and not at once on both
    sides."""
    if not 0 < count < x[first] or t_ns[stop - 1] - t_ns[first] > 2 * _SUN_NS * np.arccos(1 - count / x[first]):
        return False
    before, after = slice(max(0, 2 * first - stop), first), slice(stop, 2 * stop - first)
    away = np.concatenate([t_ns[first] - t_ns[before], t_ns[after] - t_ns[stop - 1]])
    beside = np.concatenate([x[before], x[after]])
    leaps = [abs(x[row] - x[first]) for row in (first - 1, stop) if 0 <= row < len(x)]
    return bool((beside <= x[first] + count + x[first] * away / _SUN_NS).all()) and not (
        len(leaps) > 1 and min(leaps) > _LEAP * x[first]
    )
