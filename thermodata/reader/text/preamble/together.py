"""Several columns or sheets of one file that tell times of day without a date: one clock, which all count from."""

from __future__ import annotations

from collections.abc import Sequence

from thermodata.reader.text.cells.time_forms.time_pattern import DAY_NS
from thermodata.reader.text.preamble.begin import FirstTimes


def begin_later_ns(firsts: Sequence[FirstTimes | None]) -> list[int]:
    """By how much each begins after the earliest of all [ns]. firsts: the first rows of each, in the order of the file;
    None of what tells no times of day.

    Each is taken to begin as near to the one before as times of day can: blocks of tests side by side go on over
    midnight. All are 0 where one tells none, or begins at its zero and another does not: durations are written so.
    """
    told = [first for first in firsts if first is not None and first.of_day and first.ns]
    if len(told) < len(firsts) or len({first.near_zero for first in told}) > 1:
        return [0] * len(firsts)
    begins = [told[0].ns[0]]
    for first in told[1:]:
        apart = (first.ns[0] - begins[-1] + DAY_NS // 2) % DAY_NS - DAY_NS // 2
        begins.append(begins[-1] + apart)
    return [ns - min(begins) for ns in begins]
