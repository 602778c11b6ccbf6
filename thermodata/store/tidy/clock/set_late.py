"""A log whose clock was set back while it ran, and that is joined to what came before: that clock was right from then
on, or until then. A log that began and ended with it tells."""

from __future__ import annotations

from pathlib import Path

from thermodata.store.tidy.clock.second_pass import go_together, is_known
from thermodata.store.tidy.clock.source_clock import Clock, build, first_ns, last_ns
from thermodata.store.tidy.plan.plan import SourcePlan, TestPlan

_LEAST_NS = 240 * 10**9  # by which it was set: less is within what two logs that begin together differ by


def tell_clocks_set_late(store: Path, plan: TestPlan) -> None:
    """A problem of the plan where a joined log begins and ends with another one only if its clock was right once it was
    set. A declared offset answers it."""
    for source in plan.sources.values():
        clock = source.spec.clock
        if clock.resets != "allow" or clock.offset is not None or clock.align_to is not None or not is_known(source):
            continue
        back_ns, joined = _set_back(store, source)
        if back_ns < _LEAST_NS:
            continue
        moved = (joined[0] - back_ns, joined[1] - back_ns)
        others = [s for s in plan.sources.values() if s is not source and is_known(s) and s.spec.clock.align_to is None]
        spans = {s.name: _span(s) for s in others}
        if any(go_together(joined, span) for span in spans.values()):
            continue
        beside = next((name for name, span in spans.items() if go_together(moved, span, both=True)), None)
        if beside is not None:
            plan.problems.append(
                f"test '{plan.test.id}': the clock of '{source.name}' was set back by {back_ns / 60e9:.3g} min, and "
                "what follows is joined to what came before, as if it was right until then; so it begins and ends as "
                f"much later than '{beside}'; try: clock: {{resets: allow, offset: -{back_ns / 1e9:.0f} s}} where it "
                "was right once it was set, or offset: 0 s where not"
            )


def _span(source: SourcePlan) -> tuple[int, int]:
    """The first and the last time of a source, its declared offset applied [ns]."""
    offset = round((source.spec.clock.offset or 0.0) * 1e9)
    return first_ns(source) + offset, last_ns(source) + offset


def _set_back(store: Path, source: SourcePlan) -> tuple[int, tuple[int, int]]:
    """(by how much the clock of a source was set back in all [ns], its first and last time once joined); of one with
    several streams, whose clock is one, by the first."""
    raws = next(iter(source.streams.values()))
    line = build(store, raws, Clock(), resets_allowed=True)
    return int(line.order.shifts[-1] - line.order.shifts[0]), line.order.extent
