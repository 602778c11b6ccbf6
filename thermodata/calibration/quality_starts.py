"""A temperature sensor that is off from one test on, told by how tests start after a rest.

A motor that is 20 K warmer than all else in one test and reads 30 K too much in another is usual by the range of what
it does. But after hours of rest all parts of a machine are near the hall, each by as much beside it as ever: a sensor
whose starts alone leave that, by as much in every test from one on, and which cools from there no more than it did
before, is off.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from thermodata.plugin import Bool1D, Float1D, Int1D

LEAST_K = 8.0  # beyond all starts before
ALIKE_K = 2.0  # starts that are off lie so near each other, but for how far those before lay apart; a real body whose
# rests differ does not, nor one that was warmed up while nobody logged
COOLS_K = 2.0  # what is warm falls by more below its start, beyond what it did before
COMPANY_K = 2.0  # where another one leaves its own starts by so much and the same way, the machine did not rest
LEAST_BEFORE = 3
LEAST_AFTER = 2


@dataclass(frozen=True, slots=True)
class Start:
    """Of a channel in a test, beside the median of all others [K]: where it starts, and how far it falls below that, or
    rises above it. asked: False of what is warm, cold or hot by itself after any rest."""

    at_k: float
    falls_k: float
    rises_k: float
    asked: bool = True


def off_from_start(starts: Sequence[Mapping[str, Start]], rested: Sequence[bool]) -> dict[str, tuple[int, float]]:
    """Channel -> (number of the test that it is off from, by how much [K]).

    starts: of tests in the order of their days. rested: whether the machine did before each.
    """
    at: dict[str, Float1D] = {}
    for name in dict.fromkeys(n for test in starts for n in test):
        course = [test.get(name) for test in starts]
        if all(x is None or x.asked for x in course):
            at[name] = np.array([np.nan if x is None else x.at_k for x in course])
    found: dict[str, tuple[int, float]] = {}
    while True:  # one that is off is no company to the next one
        left = {name: x for name, x in at.items() if name not in found}
        told = {name: _off(name, starts, left, np.array(rested, dtype=bool)) for name in left}
        new = {name: off for name, off in told.items() if off is not None}
        if not new:
            return found
        found |= new


def _off(
    name: str, starts: Sequence[Mapping[str, Start]], at: Mapping[str, Float1D], rested: Bool1D
) -> tuple[int, float] | None:
    x = at[name]
    numbers = np.flatnonzero(rested & np.isfinite(x))
    for begin in numbers[LEAST_BEFORE:].tolist():
        before, after = numbers[numbers < begin], numbers[numbers >= begin]
        sign = 1.0 if np.median(x[after]) > np.median(x[before]) else -1.0
        if float(np.min(sign * x[after])) - float(np.max(sign * x[before])) < LEAST_K:
            continue
        alone = np.array([i for i in after.tolist() if not _in_company(name, at, before, i, sign)], dtype=np.int64)
        if len(alone) < LEAST_AFTER or np.ptp(x[after]) > np.ptp(x[before]) + ALIKE_K:
            return None
        back = [max(_comes_back(starts[i][name], sign) for i in some.tolist()) for some in (before, after)]
        if back[1] > back[0] + COOLS_K:
            return None
        return begin, float(np.median(x[after]) - np.median(x[before]))
    return None


def _in_company(name: str, at: Mapping[str, Float1D], before: Int1D, i: int, sign: float) -> bool:
    """Whether another channel starts a test beyond its own starts before, the same way."""
    others = [sign * x for n, x in at.items() if n != name and np.isfinite(x[i]) and np.isfinite(x[before]).any()]
    return any(float(x[i]) > float(np.nanmax(x[before])) + COMPANY_K for x in others)


def _comes_back(start: Start, sign: float) -> float:
    return start.falls_k if sign > 0 else start.rises_k
