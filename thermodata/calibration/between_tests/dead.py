"""A temperature sensor that stands on one reading through a whole test, though the machine moved as it does elsewhere.

Within a test a dead sensor is a sensor at rest; its other tests tell how far it moves.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from thermodata.calibration.between_tests.levels import Levels
from thermodata.plugin import Float1D

_LEAST_POINTS = 16  # of a test, or nothing is said
_LEAST_S = 3600.0
_LEAST_READINGS = 6  # different ones in a test in which it moves: what counts in whole kelvins may stand
_TREADS = 10.0  # that it moves by elsewhere
_NEVER_STILL = 4.0  # and in each other test at least: a motor that rests in a steady hall moves by two or three
_LEAST_OTHERS = 3
# three of four others move by so many of its treads: what rests in a hall that warms by a kelvin stands, in whole ones
_AT_REST, _REST_TREADS = 0.25, 2.0
_ONE_TREAD = 1.5  # as far lies the next reading of a live one; where a dead one drops out it is anywhere
_AS_ELSEWHERE = 0.5  # of what the others move by in their other tests: a quiet test tells nothing


def dead_throughout(tests: Sequence[Levels]) -> set[tuple[str, str]]:
    """(test, channel) of each temperature that stands through a test of an hour and more, to the last digit. A coarse
    one in a calm place does so at all moments of a test that are kept, and shows the next tread between them, often."""
    courses: dict[str, dict[str, Float1D]] = {}
    for test in tests if len(tests) > 1 else ():
        for name, course in test.series.items():
            if course.quantity != "temperature" or len(course.t_s) < _LEAST_POINTS:
                continue
            x = course.values[np.isfinite(course.values)]
            if x.size >= _LEAST_POINTS and float(course.t_s[-1] - course.t_s[0]) >= _LEAST_S:
                courses.setdefault(name, {})[test.test] = x
    ranges = {name: {test: float(np.ptp(x)) for test, x in own.items()} for name, own in courses.items()}
    # how far a channel moves in the tests in which it does
    usual = {name: float(np.median(r)) for name, own in ranges.items() if (r := [x for x in own.values() if x > 0])}
    standing: dict[str, float] = {}
    for name, most in usual.items():
        tread = _tread(courses[name].values())
        least = min(r for r in ranges[name].values() if r > 0)
        if min(ranges[name].values()) == 0 and most >= _TREADS * tread and least >= _NEVER_STILL * tread:
            standing[name] = tread
    moved: dict[str, list[float]] = {}
    for name in usual if standing else ():
        for key, span in ranges[name].items():
            if span > 0:
                moved.setdefault(key, []).append(span / usual[name])
    alive = {t for t, r in moved.items() if len(r) >= _LEAST_OTHERS and float(np.median(r)) >= _AS_ELSEWHERE}

    flickers = {(x.test, name): c.flickers for x in tests for name, c in x.series.items() if c.flickers is not None}

    def shows_next_tread(name: str, test: str) -> bool:
        return flickers.get((test, name), np.inf) <= _ONE_TREAD * standing[name]

    def rests(name: str, test: str) -> bool:
        others = [r[test] for n, r in ranges.items() if n != name and test in r]
        return float(np.quantile(others, _AT_REST)) < _REST_TREADS * standing[name]

    return {
        (test, name)
        for name in standing
        for test, span in ranges[name].items()
        if span == 0 and test in alive and not shows_next_tread(name, test) and not rests(name, test)
    }


def _tread(courses: Iterable[Float1D]) -> float:
    """The least difference of two readings of a test; inf where all show too few."""
    readings = [np.unique(x) for x in courses]
    return min((float(np.diff(x).min()) for x in readings if len(x) >= _LEAST_READINGS), default=np.inf)
