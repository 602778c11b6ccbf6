"""The time of a test: the clocks of its sources on one time line, and the window."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from itertools import pairwise
from pathlib import Path

import numpy as np

from thermodata.plugin import Int1D
from thermodata.reader.times.zone import local_to_utc_ns
from thermodata.store.raw.raw_stream import RawStream
from thermodata.store.tidy.clock.times_of_day import began, first_of
from thermodata.store.tidy.plan.plan import SourcePlan, TestPlan
from thermodata.store.tidy.rows.make_timeline import make_timeline
from thermodata.store.tidy.rows.timeline import Timeline

_NEAR_S = 60.0  # a start that a person wrote down is that exact
_TOGETHER_S = 120.0  # by how much two logs that begin and end together differ in length

_DAY_NS = 86_400 * 10**9
_OVERLAP_NS = 600 * 10**9  # by which a part begins before the end of the one before, and is none of the next day


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
    """What each source's relative clock counts from, so that a test's sources share one time line, and notes on it.

    A declared start is of the recording without dates; one whose probes have dates begins when they say.
    """
    known = [s for s in plan.sources.values() if s.raws]
    dated, undated = ([s for s in known if is_relative(s) is relative] for relative in (False, True))
    probes = [s for s in plan.reference if is_relative(s)]
    start = plan.test.start
    base_ns, notes = dict.fromkeys(plan.sources, 0), list[str]()
    if start is not None and dated and not probes:
        began = start_ns(start, plan)
        apart_s = (min(map(first_ns, plan.reference)) - began) / 1e9
        if abs(apart_s) > _NEAR_S:
            plan.problems.append(
                f"test '{plan.test.id}': start is {start}, but its recordings have dates of their own, "
                f"{apart_s:+.0f} s from it: these count; try: take 'start' away, or set clock: {{offset: ...}}"
            )
    if start is not None and (probes or not dated):
        for source in undated:
            base_ns[source.name] = start_ns(start, plan, source)
        plan.problems += _beside(plan, base_ns, dated, undated)
    elif dated:
        with_dates = [s for s in plan.reference if s in dated] or dated
        for source in undated:
            base_ns[source.name] = min(map(first_ns, with_dates))
            notes.append(
                f"source '{source.name}' has a relative clock: taken to start with the test; "
                "set clock: {align_to: ...} or {offset: ...} where it does not"
            )
        plan.problems += _in_doubt(plan, with_dates, [s for s in undated if not _is_told(s)])
    return base_ns, notes


def _beside(plan: TestPlan, base_ns: dict[str, int], dated: list[SourcePlan], undated: list[SourcePlan]) -> list[str]:
    """A start at which nothing that has dates was recorded."""
    if not dated or not undated:
        return []
    begin = min(base_ns[s.name] + first_ns(s) for s in undated)
    end = max(base_ns[s.name] + last_ns(s) for s in undated)
    first, last = min(map(first_ns, dated)), max(map(last_ns, dated))
    if begin <= last and first <= end:
        return []
    gap_s = (first - end if first > end else begin - last) / 1e9
    return [
        f"test '{plan.test.id}': from its start, {plan.test.start}, to its end nothing was recorded that has dates: "
        f"{', '.join(s.name for s in dated)} is {gap_s:.0f} s {'later' if first > end else 'earlier'}; try: correct "
        "'start', its time zone (timezone of the source), or the clock of the other: {offset: ...}"
    ]


def _is_told(source: SourcePlan) -> bool:
    """Whether the campaign file says what its clock has to do with the others'."""
    return source.spec.clock.offset is not None or source.spec.clock.align_to is not None


def _in_doubt(plan: TestPlan, dated: list[SourcePlan], undated: list[SourcePlan]) -> list[str]:
    """Logs without a date that last longer than what has dates, or shorter: they did not begin together, or did not end
    together, and nothing says which."""
    told = {s.name: _by_its_clock(plan, dated, s) for s in undated}
    by_clock = [said for said in told.values() if said is not None]
    undated = [s for s in undated if told[s.name] is None]
    log_s = (max(map(last_ns, dated)) - min(map(first_ns, dated))) / 1e9
    lasts_s = {s.name: (last_ns(s) - first_ns(s)) / 1e9 for s in undated}
    names = [n for n, s in lasts_s.items() if abs(log_s - s) > _TOGETHER_S]
    if not names:
        return by_clock
    probes = any(s.name in names for s in plan.reference)
    say = "give the test its start: 2026-03-04 08:15" if probes else "declare the source's clock: {align_to: ...}"
    own_s = lasts_s[names[0]]
    return [
        *by_clock,
        f"test '{plan.test.id}': nothing says when '{', '.join(names)}' began: it lasts {own_s / 3600:.3g} h, "
        f"what has dates {log_s / 3600:.3g} h, and is taken to begin with that; try: {say}, or, where they did begin "
        "together, clock: {offset: 0 s}",
    ]


def _by_its_clock(plan: TestPlan, dated: list[SourcePlan], source: SourcePlan) -> str | None:
    """A log without a date whose times of day say that it began at another time than what has dates."""
    of_day_ns = first_of([r.of_day_ns for r in source.raws])
    there = min(dated, key=first_ns)
    zone = source.spec.timezone or there.spec.timezone
    at = None if of_day_ns is None else began(of_day_ns, first_ns(there), zone)
    if at is None:
        return None
    way = f"give the test its start: {at}" if source in plan.reference else "declare its clock: {offset: ...}"
    return (
        f"test '{plan.test.id}': '{source.name}' tells times of day without a date, and is taken to begin with "
        f"'{there.name}'; by its first row it began {at}; try: {way}, or, where they did begin together, "
        "clock: {offset: 0 s}"
    )


def start_ns(start: str, plan: TestPlan, source: SourcePlan | None = None) -> int:
    """The declared start of a test [ns UTC]: local to the source's timezone where it names no offset itself, else to
    that of the probes' source, or of any other."""
    moment = datetime.fromisoformat(start)
    if moment.tzinfo is not None:
        moment, zone = moment.astimezone(UTC), None
    else:
        asked = [*([source] if source else []), *plan.reference, *plan.sources.values()]
        zone = next((s.spec.timezone for s in asked if s.spec.timezone is not None), None)
    return int(local_to_utc_ns(np.array([np.datetime64(moment.replace(tzinfo=None), "ns")]), zone)[0][0])


def is_relative(source: SourcePlan) -> bool:
    return not source.is_dated


def first_ns(source: SourcePlan) -> int:
    """The first recorded time of a source [ns]."""
    return min(recorded(raw)[0] for raw in source.raws)


def last_ns(source: SourcePlan) -> int:
    return max(recorded(raw)[1] for raw in source.raws)


def recorded(raw: RawStream) -> tuple[int, int]:
    """The first and the last recorded time of a file [ns]."""
    return _start_of(raw) + raw.first_ns, _start_of(raw) + raw.last_ns


def _start_of(raw: RawStream) -> int:
    # a relative clock whose file says when it began is an absolute one
    own = raw.start_ns if raw.clock == "relative" and raw.start_ns is not None else 0
    return own + raw.moved_ns


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
        by_day = _by_times_of_day(ordered)
        if by_day is None:
            notes.append("relative files that overlap: joined end to end in the order of their names")
        else:
            notes.append("times of day without a date in several files: each begins at its own, in the order of names")
        shifts = _end_to_end(ordered) if by_day is None else by_day
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


def _end_to_end(raws: Sequence[RawStream]) -> list[int]:
    """What is added to the times of each, so that it begins a sample after the one before [ns]."""
    shifts: list[int] = []
    end = None
    for raw in raws:
        shifts.append(0 if end is None else end - raw.first_ns)
        end = shifts[-1] + raw.last_ns + max(raw.step_ns, 1)
    return shifts


def _by_times_of_day(raws: Sequence[RawStream]) -> list[int] | None:
    """The same of parts that tell the time of day of their first rows: one that begins before the end of the one before
    is of the next day. None where one does not tell it, or begins a little before that end: their clock is no one."""
    shifts: list[int] = []
    end = raws[0].first_ns
    for raw in raws:
        if raw.of_day_ns is None:
            return None
        shift = raw.of_day_ns - (raws[0].of_day_ns or 0)  # of the row at 0, which in a file newest first is the last
        while shift + raw.first_ns < end:
            if end - shift - raw.first_ns < _OVERLAP_NS:
                return None
            shift += _DAY_NS
        shifts.append(shift)
        end = shift + raw.last_ns
    return shifts
