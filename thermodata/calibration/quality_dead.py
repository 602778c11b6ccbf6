"""A temperature sensor that stands on one reading through a whole test, though the machine moved as it does elsewhere.

Within a test a dead sensor is a sensor at rest; its other tests tell how far it moves.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from thermodata.calibration.quality_between import Levels
from thermodata.plugin import Float1D

_LEAST_POINTS = 16  # of a test, or nothing is said
_LEAST_S = 3600.0
_LEAST_READINGS = 6  # different ones in a test in which it moves: what counts in whole kelvins may stand
_TREADS = 10.0  # that it moves by elsewhere
_LEAST_OTHERS = 3
_AS_ELSEWHERE = 0.5  # of what the others move by in their other tests: a quiet test tells nothing


def dead_throughout(tests: Sequence[Levels]) -> set[tuple[str, str]]:
    """(test, channel) of each temperature that stands through a test of an hour and more, to the last digit."""
    courses = {
        (t.test, name): x
        for t in tests
        for name, course in t.series.items()
        if course.quantity == "temperature"
        and (x := _known(course.values)).size >= _LEAST_POINTS
        and float(course.t_s[-1] - course.t_s[0]) >= _LEAST_S
    }
    ranges = {key: float(np.ptp(x)) for key, x in courses.items()}
    # how far a channel moves in the tests in which it does
    usual = {
        name: float(np.median(moves))
        for name in dict.fromkeys(n for _, n in courses)
        if (moves := [r for (_, n), r in ranges.items() if n == name and r > 0])
    }
    found = set()
    for (test, name), span in ranges.items():
        if span > 0 or name not in usual:
            continue
        tread = min((_tread(x) for (_, n), x in courses.items() if n == name), default=np.inf)
        if usual[name] < _TREADS * tread:
            continue
        moved = [n for t, n in courses if t == test and n in usual and ranges[t, n] > 0]
        others = [ranges[test, n] / usual[n] for n in moved]
        if len(others) >= _LEAST_OTHERS and float(np.median(others)) >= _AS_ELSEWHERE:
            found.add((test, name))
    return found


def _known(values: Float1D) -> Float1D:
    return values[np.isfinite(values)]


def _tread(x: Float1D) -> float:
    """The least difference of two readings of a test; inf where it shows too few."""
    readings = np.unique(x)
    return float(np.diff(readings).min()) if len(readings) >= _LEAST_READINGS else np.inf
