"""Two logs that begin and end together in all tests but one, where both ends are off by the same: a wrong clock.

A log that was switched on late begins late and ends when it always does; one that lasts as long as ever, and stands
elsewhere, was dated by a clock that was not right.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from itertools import combinations
from typing import Any

import numpy as np

LEAST_S = 120.0  # by which both ends are off; people switch two loggers on within it,
APART = 10.0  # and so many times what the ends of the other tests differ by
OTHERS = 3  # tests in which both stand as they always do
BOTH = 0.1  # by how much, as a share of it, the shifts of both ends may differ


@dataclass(frozen=True, slots=True)
class _Ends:
    """Of one source in one test [s]."""

    first: float
    last: float


@dataclass(frozen=True, slots=True)
class OddClock:
    """A test in which the source `late` stands shift_s (> 0) later beside `early` than in the others."""

    test: str
    late: str
    early: str
    shift_s: float
    others: int

    def __str__(self) -> str:
        minutes = self.shift_s / 60
        late, early = f"{self.late}: {-self.shift_s:.0f} s", f"{self.early}: {self.shift_s:.0f} s"
        return (
            f"test '{self.test}': source '{self.late}' begins and ends {minutes:.3g} min later beside '{self.early}' "
            f"than in the {self.others} other tests, in which both ends agree: was a clock set wrongly? try at "
            f"this test clocks: {{{late}}} or clocks: {{{early}}}, or at the source clock: {{align_to: ..., by: "
            "[...]}, which estimates the offset of each test from what both logged"
        )


def odd_clocks(rows: Mapping[str, Iterable[Mapping[str, Any]]]) -> list[OddClock]:
    """Each as a sentence by `str`. rows: test -> its rows of the table `source`."""
    ends = {test: _ends(of_test) for test, of_test in rows.items()}
    sources = sorted({source for of_test in ends.values() for source in of_test})
    found = []
    for one, other in combinations(sources, 2):
        tests = [t for t, of_test in ends.items() if one in of_test and other in of_test]
        if len(tests) <= OTHERS:
            continue
        apart = np.array(
            [(ends[t][one].first - ends[t][other].first, ends[t][one].last - ends[t][other].last) for t in tests]
        )
        if (odd := _odd(apart)) is not None:
            place, shift_s = odd
            late, early = (one, other) if shift_s > 0 else (other, one)
            found.append(OddClock(tests[place], late, early, abs(shift_s), len(tests) - 1))
    return found


def _odd(apart: np.ndarray) -> tuple[int, float] | None:
    """(which test, by how much [s]). apart: how much later one log begins and ends than the other, shape (tests, 2)."""
    off = apart - np.median(apart, axis=0)
    place = int(np.argmax(np.abs(off).min(axis=1)))
    first, last = off[place]
    usual = np.abs(np.delete(off, place, axis=0)).max()
    size = min(abs(first), abs(last))
    both = first * last > 0 and abs(first - last) <= BOTH * size
    return (place, float((first + last) / 2)) if both and size >= max(LEAST_S, APART * usual) else None


def _ends(rows: Iterable[Mapping[str, Any]]) -> dict[str, _Ends]:
    """Of each source of a test that logs at even steps."""
    found: dict[str, list[_Ends]] = defaultdict(list)
    for row in rows:
        if row["start_ns"] is not None and row["step_s"] and row["rows"]:
            first = row["start_ns"] / 1e9
            found[row["source"]].append(_Ends(first, first + row["step_s"] * (row["rows"] - 1)))
    return {s: _Ends(min(e.first for e in some), max(e.last for e in some)) for s, some in found.items()}
