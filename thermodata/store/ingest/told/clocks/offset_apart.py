"""A declared offset of a clock that sets two logs apart which begin and end together without it, or with its opposite:
its sign was mistaken, or it was counted twice.

`offset` is added to the times of its source, so that of a clock that is slow is positive: half of those who write one
think the other way, and a clock that is declared is asked by nothing else.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from thermodata.schema.words.durations import how_long
from thermodata.store.ingest.told.clocks.ends import LEAST_S, Rows, pairs
from thermodata.store.ingest.told.clocks.whole_hours import LEAST


@dataclass(frozen=True, slots=True)
class OffsetApart:
    """With the offset that is declared for it, `source` stands late_s later beside `other` at both ends of all tests;
    with `fits_s` in its place both agree."""

    source: str
    other: str
    offset_s: float
    late_s: float
    fits_s: float
    tests: int

    def __str__(self) -> str:
        way = "later" if self.late_s > 0 else "earlier"
        instead = f"with clock: {{offset: {self.fits_s:.0f} s}}" if self.fits_s else "without it"
        was = (
            "was its sign mistaken?"
            if self.fits_s
            else "was it meant for another log? Keep it where samples came late within a log whose clock was right"
        )
        return (
            f"source '{self.source}' begins and ends {how_long(abs(self.late_s))} {way} than '{self.other}' in all "
            f"{self.tests} tests that have both, with the clock: {{offset: {self.offset_s:.0f} s}} that is declared; "
            f"{instead} both ends agree. An offset is added to the times of its source: that of a clock that is slow "
            f"is positive, of one that is ahead negative; {was}"
        )


def offsets_apart(rows: Rows, offsets: Mapping[str, float]) -> list[OffsetApart]:
    """Each as a sentence by `str`. rows: test -> its rows of the table `source`; offsets: source -> the offset that is
    declared for all tests [s]."""
    found = []
    for one, other, apart in pairs(rows):
        ends = np.array(list(apart.values()))  # shape (tests, 2)
        if len(ends) < LEAST or (one in offsets) == (other in offsets):
            continue
        middle = float(np.median(ends))
        if abs(middle) <= LEAST_S or np.abs(ends - middle).max() > LEAST_S:
            continue
        source, beside, late_s = (one, other, middle) if one in offsets else (other, one, -middle)
        offset_s = offsets[source]
        fits = [w for w in (-offset_s, 0.0) if abs(late_s + w - offset_s) <= min(LEAST_S, abs(offset_s) / 4)]
        found += [OffsetApart(source, beside, offset_s, late_s, w, len(ends)) for w in fits[:1]]
    return found
