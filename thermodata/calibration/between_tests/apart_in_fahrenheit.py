"""A temperature that stands in degrees Fahrenheit in one test and in degrees Celsius in others, and does so alone: its
column changed its unit, which its head doesn't say.

A part that was warm before its test starts too warm as well. But it cools towards the others, while a column in
Fahrenheit stays beyond all that it ever was beside them, and taken for what it is it stays within.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace

import numpy as np

from thermodata.calibration.between_tests.levels import Levels, differences_of
from thermodata.plugin import Float1D

BEYOND_K = 8.0  # what was seen of it beside the others in other tests, by every reading: as of a sensor that fails
WITHIN_K = 3.0  # of what was seen there, once it is converted
LEAST_TESTS = 2  # others, or nobody knows what is usual


def as_ever_in_fahrenheit(tests: Sequence[Levels], suspects: Mapping[str, Collection[str]]) -> dict[str, list[str]]:
    """Test -> those of its suspects that are as in other tests once their readings are taken for degF.

    suspects: test -> temperatures [degC] that may be in degF there. Each is held against the median of the temperatures
    that are none in any test, three at least; what the machine was said to be warm for tells nothing of what is usual.
    """
    found: dict[str, list[str]] = {}
    never = {n for t in tests for n in t.series} - {n for names in suspects.values() for n in names}
    for test in tests:
        for name in suspects.get(test.test, ()):
            sound = [t for t in tests if t is not test and not t.warm and name not in suspects.get(t.test, ())]
            others = [d for t in sound if len(d := _beside(t, name, never))]
            here = _beside(test, name, never)
            if len(others) < LEAST_TESTS or not len(here):
                continue
            usual = np.concatenate(others)
            low, high = float(usual.min()), float(usual.max())
            converted = _beside(_converted(test, name), name, never)
            inside = (converted >= low - WITHIN_K) & (converted <= high + WITHIN_K)
            if float(here.min()) > high + BEYOND_K and bool(inside.all()):
                found.setdefault(test.test, []).append(name)
    return found


def _beside(test: Levels, name: str, others: Collection[str]) -> Float1D:
    """How far a temperature lies from the median of some others [K]; empty where there are too few of them."""
    some = {n: c for n, c in test.series.items() if n == name or n in others}
    nothing: Float1D = np.empty(0)
    return differences_of([replace(test, series=some)])[0].get(name, (nothing, nothing))[1]


def _converted(test: Levels, name: str) -> Levels:
    course = test.series[name]
    return replace(test, series={**test.series, name: replace(course, values=(course.values - 32.0) / 1.8)})
