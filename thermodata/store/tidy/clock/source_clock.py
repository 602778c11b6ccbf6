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
from thermodata.store.tidy.plan.plan import SourcePlan, TestPlan
from thermodata.store.tidy.rows.make_timeline import make_timeline
from thermodata.store.tidy.rows.timeline import Timeline

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


def start_ns(start: str, plan: TestPlan, source: SourcePlan | None = None) -> int:
    """The declared start of a test [ns UTC]: local to the source's timezone where it names no offset itself, else to
    that of the probes' source, or of any other."""
    moment = datetime.fromisoformat(start)
    if moment.tzinfo is not None:
        moment, zone = moment.astimezone(UTC), None
    else:
        zone = _zone_of_start(plan, source)
    return int(local_to_utc_ns(np.array([np.datetime64(moment.replace(tzinfo=None), "ns")]), zone)[0][0])


def names_no_zone(start: str, plan: TestPlan) -> bool:
    """Whether neither a declared start names its offset, nor any source of the test its zone."""
    return datetime.fromisoformat(start).tzinfo is None and _zone_of_start(plan, None) is None


def _zone_of_start(plan: TestPlan, source: SourcePlan | None) -> str | None:
    asked = [*([source] if source else []), *plan.reference, *plan.sources.values()]
    return next((s.spec.timezone for s in asked if s.spec.timezone is not None), None)


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
    relative = not sources or (plan.test.start is None and all(map(is_relative, with_data)))
    if plan.test.window is None:
        return Span(begin, None, None, False, relative)
    a, b = (begin + round(x * 1e9) for x in plan.test.window)
    return Span(a, a, b, plan.test.history == "recording", relative)


def build(store: Path, raws: list[RawStream], clock: Clock, *, resets_allowed: bool, shared: bool = False) -> Timeline:
    """Joins the files of one stream in time order; see `make_timeline` for how their rows are put in order."""
    ordered = sorted(raws, key=lambda r: (_start_of(r) + r.first_ns,))
    notes: list[str] = []
    if (
        len(ordered) > 1
        and all(r.is_undated for r in ordered)
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
    line = make_timeline(
        store,
        list(zip(ordered, shifts, strict=True)),
        lambda t: clock.correct(t, first),
        suspect=clock.suspect,
        resets_allowed=resets_allowed,
        notes=notes,
        shared=shared,
    )
    line.doubt = "; ".join(clock.notes) if clock.suspect else ""
    return line


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
