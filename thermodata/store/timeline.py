"""The time of a test: the clocks of its sources on one axis, the joints between files, the window."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path

import numpy as np

from thermodata.plugin import Array, Bool1D, Int1D, Loss
from thermodata.schema.flag import Flag
from thermodata.store.plan import SourcePlan, TestPlan
from thermodata.store.raw import RawStream
from thermodata.store.rawfile import JITTER_NS
from thermodata.store.rawread import read_column


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
        """Recorded times, shape (n,), on the test's axis [ns]."""
        moved = t_ns + np.int64(self.offset_ns + self.base_ns)
        if self.drift_ppm:
            moved = moved + np.rint((t_ns - first_ns) * (self.drift_ppm * 1e-6)).astype(np.int64)
        return moved


@dataclass(frozen=True, slots=True)
class Span:
    """The test on the absolute axis: t_s counts from zero_ns; rows in [from_ns, to_ns) are the test's."""

    zero_ns: int
    from_ns: int | None
    to_ns: int | None
    history: bool
    relative: bool


@dataclass(frozen=True, slots=True)
class Timeline:
    """The rows of one (source, stream) of a test in time order.

    t_ns: shape (n,), non-decreasing. pieces: (raw, rows) in file order. order: the permutation that sorts the
    concatenated rows, or None where they are in order. clock_flags: shape (n,), CLOCK_SUSPECT where rows were moved.
    """

    t_ns: Int1D
    pieces: tuple[tuple[RawStream, int], ...]
    order: Int1D | None
    clock_flags: Array | None
    losses: tuple[Loss, ...]
    notes: tuple[str, ...]

    def column(self, store: Path, signal: str, start: int, stop: int, *, flags: bool = False) -> Array | None:
        """A raw column, rows start to stop in time order; None where no file has it."""
        rows = None if self.order is None else self.order[start:stop]
        low, high = (start, stop) if rows is None else (0, sum(n for _, n in self.pieces))
        parts: list[Array | int] = []
        at, found = 0, False
        for raw, n in self.pieces:
            a, b = max(low - at, 0), min(high - at, n)
            at += n
            if a >= b:
                continue
            column = raw.columns.get(signal)
            if flags:
                column = f"{column}__flag" if signal in raw.flagged else None
            if column is None:
                parts.append(b - a)
            else:
                found = True
                parts.append(read_column(store / raw.path, column, a, b))
        if not found:
            return None
        joined = _joined(parts, zero=flags)
        return joined if rows is None else joined[rows]


def _joined(parts: list[Array | int], *, zero: bool) -> Array:
    arrays = [p for p in parts if not isinstance(p, int)]
    if len(parts) == 1:
        return arrays[0]
    text = any(a.dtype == object for a in arrays)
    kind = np.dtype(object) if text else np.result_type(*arrays)
    if any(isinstance(p, int) for p in parts) and not text and not zero:
        kind = np.result_type(kind, np.float64)

    def missing(n: int) -> Array:
        if text:
            return np.full(n, None, dtype=object)
        return np.zeros(n, kind) if zero else np.full(n, np.nan)

    return np.concatenate([(missing(p) if isinstance(p, int) else p).astype(kind, copy=False) for p in parts])


def bases(plan: TestPlan) -> tuple[dict[str, int], list[str]]:
    """What each source's relative clock counts from, so that a test's sources share one axis, and notes on it."""
    absolute = [first_ns(s) for s in plan.sources.values() if s.raws and not is_relative(s)]
    notes = []
    found = {}
    for name, source in plan.sources.items():
        found[name] = 0
        if source.raws and is_relative(source) and absolute:
            reference = [first_ns(s) for s in plan.reference if not is_relative(s)]
            found[name] = min(reference or absolute)
            notes.append(f"source '{name}' has a relative clock: taken to start with the test; "
                         "set clock: {align_to: ...} or {offset: ...} where it does not")
    return found, notes


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
    """Joins the files of one stream in time order and puts their rows in order.

    Rows that step back by up to JITTER_NS are sorted in and flagged. A longer step back is a reset clock: what
    follows is moved behind what came before where resets are allowed, else it is lost with a reason.
    """
    ordered = sorted(raws, key=lambda r: (_start_of(r) + r.first_ns,))
    notes: list[str] = []
    if len(ordered) > 1 and all(r.clock == "relative" and r.start_ns is None for r in ordered) and any(
            b.first_ns <= a.last_ns for a, b in pairwise(ordered)):
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
    parts = [clock.correct(read_column(store / r.path, "t_ns", 0, r.rows).astype(np.int64, copy=False) + s, first)
             for r, s in zip(ordered, shifts, strict=True)]
    t = parts[0] if len(parts) == 1 else np.concatenate(parts)
    line = Timeline(t, tuple((r, r.rows) for r in ordered), None, None, (), tuple(notes))
    back = np.flatnonzero(np.diff(t) < 0) + 1
    if back.size:
        line = _in_order(line, back, resets_allowed)
    if clock.suspect:
        line = replace(line, clock_flags=_or(line.clock_flags, np.ones(len(line.t_ns), bool)))
    return line


def _in_order(line: Timeline, back: Int1D, resets_allowed: bool) -> Timeline:
    t = line.t_ns
    highest = np.maximum.accumulate(t)
    jumps = [int(i) for i in back if highest[i - 1] - t[i] > JITTER_NS]
    losses: list[Loss] = []
    notes = list(line.notes)
    keep = len(t)
    late = t < highest
    if jumps and resets_allowed:
        t = t.copy()
        for i in jumps:
            step = int(np.median(np.diff(t[max(0, i - 100):i]))) if i > 1 else 1
            t[i:] += (t[:i].max() + max(step, 1)) - t[i]
        notes.append(f"the clock was reset {len(jumps)} times: what follows was moved behind what came before")
        late = t < np.maximum.accumulate(t)
        late[jumps] = True
    elif jumps:
        keep = jumps[0]
        losses.append(Loss(
            where=f"{line.pieces[0][0].source_path} row {keep}", from_ns=int(t[keep]), to_ns=int(t[-1]),
            fraction=(len(t) - keep) / len(t),
            reason=f"clock goes backwards: expected >= 0 ns, got {int(t[keep] - t[keep - 1])}; split the test there "
                   "or set clock: {resets: allow}"))
    order = np.argsort(t[:keep], kind="stable")
    t = t[:keep][order]
    return replace(line, t_ns=t, order=order.astype(np.int64), clock_flags=_or(None, late[:keep][order]),
                   losses=tuple(losses), notes=tuple(notes))


def _or(flags: Array | None, where: Bool1D) -> Array:
    made = np.where(where, np.uint16(Flag.CLOCK_SUSPECT), np.uint16(0))
    return made if flags is None else flags | made
