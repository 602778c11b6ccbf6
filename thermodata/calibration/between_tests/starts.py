"""A temperature sensor that is off from one test on, told by how tests start after a rest, and by where it cools to.

A motor that is 20 K warmer than all else in one test and reads 30 K too much in another is usual by the range of what
it does. But after hours of rest all parts of a machine are near the hall, each by as much beside it as ever. A sensor
whose starts alone leave that, by as much in every test from one on, is off, or its part was warmed up while nobody
logged. What tells these apart is a rest within the test: a warm part cools to where it used to stand, and what is off
cools as fast as ever, but to where it started. Where nothing rests within the tests nothing is said.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from thermodata.plugin import Bool1D, Float1D, Int1D

LEAST_K = 8.0  # beyond all starts before
ALIKE_K = 2.0  # starts that are off lie so near each other, but for how far those before lay apart; a real body whose
# rests differ does not
COOLS_K = 2.0  # what is warm falls by more below its start, beyond what it did before
BACK_K = 2.0  # what is off comes back to its start
HEATED_K = 8.0  # from further above it
COMPANY_K = 2.0  # where another one leaves its own starts by so much and the same way, the machine did not rest
LEAST_BEFORE = 3
LEAST_AFTER = 2
AS_FAST = 0.5  # of the fastest that it ever cooled to its usual level: it rested in these tests
SLOWER = 1 / 3  # one that is warm cools to the usual level faster
_FROM_K, _NEAREST_K = 5.0, 0.5  # above a level: further down its noise is all that cools; what is at it


@dataclass(frozen=True, slots=True)
class Start:
    """How a test goes on from its start, of a channel beside the median of all others. t_s, beside_k: shape (n,), in
    time order. asked: False of what is warm, cold or hot by itself after any rest."""

    t_s: Float1D
    beside_k: Float1D
    asked: bool = True

    @property
    def at_k(self) -> float:
        """Where it starts."""
        return float(self.beside_k[0])


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
        told = {name: _offset_from_test(name, starts, left, np.array(rested, dtype=bool)) for name in left}
        new = {name: off for name, off in told.items() if off is not None}
        if not new:
            return found
        found |= new


def _offset_from_test(
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
        was, now = ([starts[i][name] for i in some.tolist()] for some in (before, after))
        if not _cools_to_its_start(was, now, sign):
            return None
        return begin, float(np.median(x[after]) - np.median(x[before]))
    return None


def _in_company(name: str, at: Mapping[str, Float1D], before: Int1D, i: int, sign: float) -> bool:
    """Whether another channel starts a test beyond its own starts before, the same way."""
    others = [sign * x for n, x in at.items() if n != name and np.isfinite(x[i]) and np.isfinite(x[before]).any()]
    return any(float(x[i]) > float(np.nanmax(x[before])) + COMPANY_K for x in others)


def _cools_to_its_start(before: Sequence[Start], after: Sequence[Start], sign: float) -> bool:
    """Whether a channel comes back to its new start, and to no further, wherever its part rests within the tests. It
    needs tests before in which it was seen to cool."""
    if sum(map(_comes_back, after)) < LEAST_AFTER:
        return False
    if max(_leaves_start_k(x, sign) for x in after) > max(_leaves_start_k(x, sign) for x in before) + COOLS_K:
        return False
    usual, new = (float(np.median([x.at_k for x in some])) for some in (before, after))
    known = _fastest(before, usual)
    # what reads too little cools through the usual level, which no part that is merely cold does
    warm = sign > 0 and _fastest(after, usual) >= SLOWER * known
    return known > 0 and _fastest(after, new) >= AS_FAST * known and not warm


def _comes_back(x: Start) -> bool:
    """Whether it comes back to its start once it was heated."""
    above = x.beside_k - x.at_k
    top = int(np.argmax(above))
    return bool(above[top] >= HEATED_K and above[top:].min() <= BACK_K)


def _leaves_start_k(x: Start, sign: float) -> float:
    """How far it leaves its start the way that it would if it had started warm (sign 1) or cold (-1) [K]."""
    return float(np.max(sign * (x.at_k - x.beside_k)))


def _fastest(tests: Iterable[Start], level_k: float) -> float:
    """The fastest that it cools to a level in any of the tests, as the rate of an exponential [1/s]; 0 where it does
    not."""
    rates = [0.0]
    for x in tests:
        above = np.maximum(x.beside_k - level_k, _NEAREST_K)
        falls = above[:-1] >= _FROM_K
        rates += (np.log(above[:-1] / above[1:])[falls] / np.diff(x.t_s)[falls]).tolist()
    return max(rates)
