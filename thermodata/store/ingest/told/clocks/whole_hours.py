"""Two logs of one length that in every test stand whole hours apart: one clock is set to another zone.

In no test do they begin together, so no test is odd beside the others; but people who begin one log late by the minute
do not end it late by the same, each time, and by an hour.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass

import numpy as np

from thermodata.store.ingest.told.clocks.ends import LEAST_S, Rows, pairs

Declared = Mapping[str, Collection[str]]
LEAST = 2  # tests; of one alone nobody knows whether its logs were begun apart
HALF_HOUR_S = 1800.0  # zones differ by it, or by more of it,
MOST_S = 26 * 3600.0  # and by no more than this


@dataclass(frozen=True, slots=True)
class HoursApart:
    """In all tests the source `late` stands shift_s (> 0) later beside `early`, a number of half hours. tests: how
    many; declared: how many more there are of whose clocks somebody has said something."""

    late: str
    early: str
    shift_s: float
    tests: int
    declared: int = 0

    def __str__(self) -> str:
        by = f"{self.shift_s / 3600:g} h"
        late, early = f"{{offset: {-self.shift_s:.0f} s}}", f"{{offset: {self.shift_s:.0f} s}}"
        those = "have both" + (", and in which no clock of them is declared" if self.declared else "")
        return (
            f"source '{self.late}' begins and ends {by} later than '{self.early}' in all {self.tests} tests that "
            f"{those}, though their logs are as long as each other: is a clock set to another zone, or to summer time? "
            "If so, declare at the source whose clock is wrong its timezone (a zone without summer time such as "
            f"Etc/GMT-1 where it knows none), or clock: {late} at '{self.late}' or clock: {early} at '{self.early}'; "
            "if both are right, clock: {offset: 0 s} at one of them"
        )


def whole_hours(rows: Rows, declared: Declared | None = None) -> list[HoursApart]:
    """Each as a sentence by `str`. rows: test -> its rows of the table `source`; declared: test -> the sources of whose
    clocks there somebody has said something: they are not asked."""
    found = []
    for one, other, apart in pairs(rows):
        asked = [ends for test, ends in apart.items() if {one, other}.isdisjoint((declared or {}).get(test, ()))]
        if len(asked) < LEAST:
            continue
        ends = np.array(asked)  # shape (tests, 2)
        shift_s = float(HALF_HOUR_S * np.round(np.median(ends) / HALF_HOUR_S))
        alike = bool(np.abs(ends - shift_s).max() <= LEAST_S and np.abs(np.diff(ends, axis=1)).max() <= LEAST_S)
        if alike and 0 < abs(shift_s) <= MOST_S:
            late, early = (one, other) if shift_s > 0 else (other, one)
            found.append(HoursApart(late, early, abs(shift_s), len(asked), len(apart) - len(asked)))
    return found
