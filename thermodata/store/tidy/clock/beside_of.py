"""How far a clock that could not be aligned may be off: its log beside that of the other, and what puts it right."""

from __future__ import annotations

import numpy as np

from thermodata.plugin import Int1D
from thermodata.reader.times.step_back import in_words
from thermodata.store.tidy.clock.source_clock import Clock, first_ns, is_relative, last_ns
from thermodata.store.tidy.plan.plan import SourcePlan

_ALIKE_NS, _ALIKE = 60 * 10**9, 0.05  # by which the starts and the ends of two logs differ alike
_TOGETHER_NS = 120 * 10**9  # two logs that somebody switched on and off one after the other
_MIN_NS = 60 * 10**9


def how_far_apart(here: SourcePlan, own: Clock, there: SourcePlan, other: Clock) -> str:
    """By how much the log of a source begins and ends beside that of another one, and which key moves it. own, other:
    their clocks as far as they are known."""
    name, beside = here.name, there.name
    write = f"clocks: {{{name}: ...}} of the test, or clock: {{offset: ...}} of the source,"
    if is_relative(here) or is_relative(there):
        return f"its times are taken as they stand; what has to be added to them goes into {write} which ends the doubt"
    begins, ends = (
        int(own.correct(_at(of(here)), first_ns(here))[0] - other.correct(_at(of(there)), first_ns(there))[0])
        for of in (first_ns, last_ns)
    )
    apart = f"its log begins {_beside(begins)} and ends {_beside(ends)} that of '{beside}'"
    if max(abs(begins), abs(ends)) <= _TOGETHER_NS:
        return f"{apart}: where that is right, clocks: {{{name}: 0 s}} of the test says so"
    if abs(begins - ends) <= max(_ALIKE_NS, _ALIKE * abs(begins)):
        middle = -(begins + ends) / 2
        by = f"{middle / _MIN_NS:+.0f} min" if abs(middle) >= 10 * _MIN_NS else f"{middle / 1e9:+.0f} s"
        return f"{apart}: where that is its clock, clocks: {{{name}: {by}}} of the test puts it right"
    return f"{apart}; what has to be added to its times goes into {write} which ends the doubt"


def _at(ns: int) -> Int1D:
    return np.array([ns], np.int64)


def _beside(ns: int) -> str:
    if abs(ns) < 10**9:
        return "with"
    return f"{in_words(ns)} {'behind' if ns > 0 else 'before'}"
