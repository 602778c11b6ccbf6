"""Beyond which value of a channel a machine works: told by all its tests together, for in one that rests throughout the
largest value is noise."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

import numpy as np

from thermodata.plugin import Float1D
from thermodata.view.grid.dataset import TestData

ACTIVITY = ("rotational_speed", "feed", "power", "load")
METERED = ("power", "load")  # measured, with noise; speeds and feeds are numbers of a control
SHARE = 0.02  # of its largest value
NOISES = 5.0  # standard deviations of what a meter reads at rest: the largest of a million samples
FEWEST = 10  # samples that tell a noise
STRETCH = 60  # samples that are asked how much a meter moves
STANDBY = 0.25  # of its largest value at most: what a meter holds beyond may be the least work of all tests
QUIET, ALIKE = 0.1, 2.0  # of the stretches rest at least, and the noise of those differs by as much at most


def activity_channels(test: TestData) -> list[str]:
    """The channels that tell when the machine works."""
    return [name for name, info in test.channels.items() if info.quantity in ACTIVITY and name in test.values]


def with_limits(tests: Iterable[TestData]) -> tuple[TestData, ...]:
    """The same tests, each with the limits of its machine in `at_work`."""
    listed = tuple(tests)
    machines: dict[str, list[TestData]] = {}
    for test in listed:
        machines.setdefault(test.machine, []).append(test)
    limits = {machine: limits_of(some) for machine, some in machines.items()}
    return tuple(replace(t, at_work=limits[t.machine]) for t in listed)


def limits_of(tests: Sequence[TestData]) -> dict[str, float]:
    """Channel -> the value that its size is beyond while the machine works [its unit]. Absent where it is always 0."""
    found = {}
    for name in {n: None for t in tests for n in activity_channels(t)}:
        courses = [t.values[name][np.isfinite(t.values[name])] for t in tests if name in t.values]
        largest = max((float(np.abs(x).max(initial=0.0)) for x in courses), default=0.0)
        metered = any(t.channels[name].quantity in METERED for t in tests if name in t.channels)
        noise, standby = _at_rest(courses) if metered else (0.0, 0.0)
        standby = standby if standby <= STANDBY * largest else 0.0
        if largest > 0:
            found[name] = standby + max(SHARE * (largest - standby), NOISES * noise)
    return found


def _at_rest(courses: Sequence[Float1D]) -> tuple[float, float]:
    """(standard deviation of a meter from one sample to the next, the lowest level that it holds: what the machine
    takes in standby), in the stretches in which it moves least, of whichever test: in others the machine moves it."""
    parts = [p for x in courses for p in np.array_split(x, max(1, len(x) // STRETCH)) if len(p) >= FEWEST]
    each = np.array([1.4826 * np.median(np.abs(np.diff(p))) / np.sqrt(2.0) for p in parts])
    if not len(each):
        return 0.0, 0.0
    # one stretch seems quiet by chance; all that are about as quiet tell how much it is
    quiet = each <= ALIKE * np.quantile(each, QUIET, method="lower")
    levels = [abs(float(np.median(p))) for p, still in zip(parts, quiet, strict=True) if still]
    return float(np.median(each[quiet])), min(levels)
