"""A log of many tests that is cut to one by the files of another source, and does not reach their ends: what is
missing, and that a clock that is wrong cuts so."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from thermodata.reader.times.step_back import in_words
from thermodata.schema.units.quantity import PROBED
from thermodata.store.tidy.clock.source_clock import Clock, first_ns, last_ns
from thermodata.store.tidy.plan.plan import SourcePlan, TestPlan

_LEAST_NS = 300 * 10**9  # loggers are switched on and off one after the other


def cut_short(plan: TestPlan, clocks: Mapping[str, Clock]) -> list[str]:
    """A sentence for each source of displacements, and each end. clocks: of the sources of the test."""
    names = plan.cut_by
    spans = {s.name: _span(s, clocks[s.name]) for s in plan.sources.values() if s.raws and s.is_dated}
    others = [spans[n] for n in names if n in spans]
    if not others:
        return []
    begin, end = min(b for b, _ in others), max(e for _, e in others)
    by, said = f"'{', '.join(names)}'", []
    for name in sorted({b.source for b in plan.bound.values() if b.channel.quantity in PROBED}):
        source = plan.sources.get(name)
        if source is None or not source.shared or name not in spans:
            continue
        first, last = spans[name]
        if last <= begin or first >= end:
            continue  # nothing is left, which is said elsewhere
        for missing, words in ((end - last, "ends {} before"), (first - begin, "begins {} after")):
            if missing >= _LEAST_NS:
                said.append(
                    f"test '{plan.test.id}': '{name}', which {by} cuts, {words.format(in_words(missing))} {by}: its "
                    "displacements are missing there. If it was logged, the clock or timezone of one of them is wrong, "
                    "and the cut with it"
                )
    return said


def _span(source: SourcePlan, clock: Clock) -> tuple[int, int]:
    first, last = first_ns(source), last_ns(source)
    begin, end = clock.correct(np.array([first, last]), first).tolist()
    return begin, end
