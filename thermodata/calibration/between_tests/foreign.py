"""A part of a test that belongs to another one: after a pause every channel lies elsewhere."""

from __future__ import annotations

import numpy as np

from thermodata.calibration.between_tests.levels import Course, Levels
from thermodata.plugin import Float1D

_LEAST_CHANNELS = 4
_SHARE = 0.8  # of them
_LEAST_POINTS = 4  # on either side
_RANGES = 1.2  # of all that the channel does on its longer side
_LEAST_STEP = {"temperature": 3.0, "displacement": 5.0, "tilt": 20.0, "humidity": 10.0}  # K, um, urad, %


def foreign_part(test: Levels) -> tuple[float, float, str] | None:
    """(from, to, why) [s] of the shorter side of a pause over which nearly every channel steps; None where none does.

    A channel steps where it changes over the pause by more than its whole range on the longer side. Where the pause is
    longer than that side nobody can tell what the machine did in it, and nothing is said.
    """
    for a, b in test.pauses:
        told = [x for x in test.series.values() if x.quantity in _LEAST_STEP and _has_room_around(x, a, b)]
        stepped = [x for x in told if _steps(x, a, b)]
        if len(told) < _LEAST_CHANNELS or len(stepped) < _SHARE * len(told):
            continue
        first = min(float(x.t_s[0]) for x in told)
        last = max(float(x.t_s[-1]) for x in told)
        why = f"after a pause of {b - a:.4g} s {len(stepped)} of {len(told)} channels lie elsewhere: another recording?"
        return (-np.inf, a, why) if a - first < last - b else (b, np.inf, why)
    return None


def _has_room_around(x: Course, a: float, b: float) -> bool:
    before, after = _sides(x, a, b)
    longer = max(a - float(x.t_s[0]), float(x.t_s[-1]) - b)
    return min(len(before), len(after)) >= _LEAST_POINTS and b - a <= longer


def _sides(x: Course, a: float, b: float) -> tuple[Float1D, Float1D]:
    sound = np.isfinite(x.values)
    return x.values[sound & (x.t_s <= a)], x.values[sound & (x.t_s >= b)]


def _steps(x: Course, a: float, b: float) -> bool:
    before, after = _sides(x, a, b)
    step = abs(float(np.median(after[:3]) - np.median(before[-3:])))
    longer = before if a - x.t_s[0] >= x.t_s[-1] - b else after
    return step > max(_LEAST_STEP[x.quantity], _RANGES * float(np.ptp(longer)))
