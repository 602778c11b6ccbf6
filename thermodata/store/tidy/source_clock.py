"""The time of a test: the clocks of its sources on one time line, and the window."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import UTC, datetime
from itertools import pairwise
from pathlib import Path

import numpy as np

from thermodata.plugin import Int1D
from thermodata.reader.zone import local_to_utc_ns
from thermodata.store.raw.streams import RawStream
from thermodata.store.tidy.plan import SourcePlan, TestPlan
from thermodata.store.tidy.timeline import Timeline, make_timeline

_NEAR_S = 60.0  # a start that a person wrote down is that exact


@dataclass(frozen=True, slots=True)
class Clock:
    """The correction of one source's clock. base_ns: what a relative clock counts from."""

    offset_ns: int = 0
    drift_ppm: float = 0.0
    base_ns: int = 0
    suspect: bool = False
    key: str = ""
    notes: tuple[str, ...] = ()

    def correct(self, t_ns: Int1D, first_ns: int) -> Int1D:
        """Recorded times, shape (n,), on the test's time line [ns]."""
        moved = t_ns + np.int64(self.offset_ns + self.base_ns)
        if self.drift_ppm:
            moved = moved + np.rint((t_ns - first_ns) * (self.drift_ppm * 1e-6)).astype(np.int64)
        return moved


@dataclass(frozen=True, slots=True)
class Span:
    """The test on the absolute time line: t_s counts from zero_ns; rows in [from_ns, to_ns) are the test's."""

    zero_ns: int
    from_ns: int | None
    to_ns: int | None
    history: bool
    relative: bool


def bases(plan: TestPlan) -> tuple[dict[str, int], list[str]]:
    """What each source's relative clock counts from, so that a test's sources share one time line, and notes on it."""
    absolute = [first_ns(s) for s in plan.sources.values() if s.raws and not is_relative(s)]
    notes = []
    base_ns = {}
    if plan.test.start is not None and absolute:
        apart_s = (min(absolute) - start_ns(plan.test.start, next(iter(plan.sources.values())))) / 1e9
        if abs(apart_s) > _NEAR_S:
            plan.problems.append(
                f"test '{plan.test.id}': start is {plan.test.start}, but its recordings have dates of their own, "
                f"{apart_s:+.0f} s from it: these count; try: take 'start' away, or set clock: {{offset: ...}}"
            )
    for name, source in plan.sources.items():
        base_ns[name] = 0
        if source.raws and is_relative(source) and not absolute and plan.test.start is not None:
            base_ns[name] = start_ns(plan.test.start, source)
        if source.raws and is_relative(source) and absolute:
            reference = [first_ns(s) for s in plan.reference if not is_relative(s)]
            base_ns[name] = min(reference or absolute)
            notes.append(
                f"source '{name}' has a relative clock: taken to start with the test; "
                "set clock: {align_to: ...} or {offset: ...} where it does not"
            )
    return base_ns, notes


def start_ns(start: str, source: SourcePlan) -> int:
    """The declared start of a test [ns UTC]: local to the source's timezone where it names no offset itself."""
    moment = datetime.fromisoformat(start)
    if moment.tzinfo is not None:
        moment, zone = moment.astimezone(UTC), None
    else:
        zone = source.spec.timezone
    return int(local_to_utc_ns(np.array([np.datetime64(moment.replace(tzinfo=None), "ns")]), zone)[0][0])


def is_relative(source: SourcePlan) -> bool:
    return all(raw.clock == "relative" and raw.start_ns is None for raw in source.raws)


def first_ns(source: SourcePlan) -> int:
    """The first recorded time of a source [ns]."""
    return min(_start_of(raw) + raw.first_ns for raw in source.raws)


def last_ns(source: SourcePlan) -> int:
    return max(_start_of(raw) + raw.last_ns for raw in source.raws)


def _start_of(raw: RawStream) -> int:
    # a relative clock whose file says when it began is an absolute one
    return raw.start_ns if raw.clock == "relative" and raw.start_ns is not None else 0


def span(plan: TestPlan, clocks: dict[str, Clock]) -> Span:
    """Where a test begins and ends; its recording begins with its reference sources."""
    sources = plan.reference
    begin = min((int(clocks[s.name].correct(np.array([first_ns(s)]), first_ns(s))[0]) for s in sources), default=0)
    with_data = [s for s in plan.sources.values() if s.raws]
    relative = not sources or all(is_relative(s) and not clocks[s.name].base_ns for s in with_data)
    if plan.test.window is None:
        return Span(begin, None, None, False, relative)
    a, b = (begin + round(x * 1e9) for x in plan.test.window)
    return Span(a, a, b, plan.test.history == "recording", relative)


def build(store: Path, raws: list[RawStream], clock: Clock, *, resets_allowed: bool) -> Timeline:
    """Joins the files of one stream in time order; see `timeline` for how their rows are put in order."""
    ordered = sorted(raws, key=lambda r: (_start_of(r) + r.first_ns,))
    notes: list[str] = []
    if (
        len(ordered) > 1
        and all(r.clock == "relative" and r.start_ns is None for r in ordered)
        and any(b.first_ns <= a.last_ns for a, b in pairwise(ordered))
    ):
        ordered = list(raws)
        notes.append("relative files that overlap: joined end to end in the order of their names")
        end = None
        shifts = []
        for raw in ordered:
            shifts.append(0 if end is None else end - raw.first_ns)
            end = shifts[-1] + raw.last_ns + max(raw.step_ns, 1)
    else:
        shifts = [_start_of(r) for r in ordered]
    first = min(s + r.first_ns for r, s in zip(ordered, shifts, strict=True))
    return make_timeline(
        store,
        list(zip(ordered, shifts, strict=True)),
        lambda t: clock.correct(t, first),
        suspect=clock.suspect,
        resets_allowed=resets_allowed,
        notes=notes,
    )
