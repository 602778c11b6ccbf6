"""The values of a test's channels: calibrated, on their own rows, or sampled onto another stream's."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from thermodata.calibration.result import CalibrationResult
from thermodata.errors import UsageError
from thermodata.plugin import Array, Float1D, Int1D, Loss
from thermodata.schema.quantity import canonical
from thermodata.store import derive, schedule
from thermodata.store.plan import SCHEDULE, Bound, TestPlan
from thermodata.store.timeline import Clock, Span, Timeline, build, last_ns

Member = tuple[str, str]
_HELD = frozenset({"state", "label"})


@dataclass(frozen=True, slots=True)
class Rows:
    """Row numbers of a timeline: history is [history, start), the test is [start, stop)."""

    history: int
    start: int
    stop: int


class TestSeries:
    """Reads the channels of one test from the raw layer. Not shared between threads while it fills its caches:
    call `prepare` first.

    calibrations: by name. Raises UsageError for a channel that cannot be calibrated.
    """

    __test__ = False

    def __init__(self, store: Path, plan: TestPlan, clocks: Mapping[str, Clock], span: Span,
                 calibrations: Mapping[str, CalibrationResult]) -> None:
        self.store, self.plan, self.span, self.calibrations = store, plan, span, calibrations
        self.clocks = dict(clocks)
        self._lines: dict[Member, Timeline] = {}
        self._sampled: dict[str, tuple[Int1D, Array, Array]] = {}

    def timeline(self, member: Member) -> Timeline:
        """The rows of a stream; those of the schedule are a grid of a minute plus its changes."""
        if member not in self._lines:
            if member[0] == SCHEDULE and member not in _stored(self.plan):
                self._lines[member] = Timeline(self._schedule_grid(), (), None, None, (), ())
            else:
                source = self.plan.sources[member[0]]
                self._lines[member] = build(self.store, source.streams[member[1]], self.clocks[member[0]],
                                            resets_allowed=source.spec.clock.resets == "allow")
        return self._lines[member]

    def rows(self, member: Member) -> Rows:
        """Which rows of a stream are the test's, and which its history."""
        t = self.timeline(member).t_ns
        n = len(t)
        low, high = self._limits(member)
        start = 0 if low is None else int(np.searchsorted(t, low))
        stop = n if high is None else int(np.searchsorted(t, high))
        return Rows(0 if self.span.history else start, start, max(start, stop))

    def _limits(self, member: Member) -> tuple[int | None, int | None]:
        span, source = self.span, self.plan.sources.get(member[0])
        if span.from_ns is not None or source is None or not source.shared:
            return span.from_ns, span.to_ns
        # a logger that all tests share is cut to this one, as far as other sources say where that lies
        others = [s for s in self.plan.reference if not s.shared]
        if not others or source in others:
            return None, None
        ends = [int(self.clocks[s.name].correct(np.array([last_ns(s)]), last_ns(s))[0]) for s in others]
        return span.zero_ns, max(ends) + 1

    def t_s(self, t_ns: Int1D) -> Float1D:
        """Seconds from the test's start."""
        return np.asarray((t_ns - self.span.zero_ns) / 1e9, dtype=np.float64)

    def values(self, bound: Bound, start: int, stop: int) -> tuple[Array, Array]:
        """(values, flags) of a channel on rows start to stop of its own stream: float64 in the canonical unit
        or text as object, and uint16; both of shape (stop - start,)."""
        if bound.channel.schedule is not None:
            return self._scheduled(bound, self.timeline((bound.source, bound.stream)).t_ns[start:stop])
        if bound.signal is None:
            return self._derived(bound, start, stop)
        line = self.timeline((bound.source, bound.stream))
        raw = line.column(self.store, bound.signal.name, start, stop)
        if raw is None:
            return np.full(stop - start, None if bound.is_text else np.nan, object if bound.is_text else float), \
                np.zeros(stop - start, np.uint16)
        values, flags = self._calibrated(bound, raw)
        from_reader = line.column(self.store, bound.signal.name, start, stop, flags=True)
        if from_reader is not None:
            flags = flags | from_reader.astype(np.uint16)
        if line.clock_flags is not None:
            flags = flags | line.clock_flags[start:stop]
        return values, flags

    def _calibrated(self, bound: Bound, raw: Array) -> tuple[Array, Array]:
        from thermodata.calibration.channel import calibrate

        assert bound.signal is not None
        named = bound.channel.calibration
        names = [named] if isinstance(named, str) else list(named or [])
        missing = [n for n in names if n not in self.calibrations]
        if missing:
            raise UsageError(f"calibration '{missing[0]}' is not available", where=f"channel {bound.name}")
        if bound.is_text:
            return np.array([None if v is None else str(v) for v in raw.tolist()], dtype=object), \
                np.zeros(len(raw), np.uint16)
        values, flags = calibrate(raw, channel=bound.channel, signal_unit=bound.unit, scaling=bound.signal.scaling,
                                  calibrations=[self.calibrations[n] for n in names], name=bound.name)
        return values, flags.astype(np.uint16, copy=False)

    def sampled(self, name: str, t_ns: Int1D) -> tuple[Array, Array]:
        """(values, flags) of a channel at other times: states are held, measurements run straight between two
        samples; NaN before the first and after the last sample."""
        bound = self.plan.bound[name]
        if bound.channel.schedule is not None:
            return self._scheduled(bound, t_ns)
        if name not in self._sampled:
            line = self.timeline((bound.source, bound.stream))
            values, flags = self.values(bound, 0, len(line.t_ns))
            self._sampled[name] = (line.t_ns, values, flags)
        t, values, flags = self._sampled[name]
        if not len(t):
            return np.full(len(t_ns), np.nan), np.zeros(len(t_ns), np.uint16)
        index = np.clip(np.searchsorted(t, t_ns, side="right") - 1, 0, len(t) - 1)
        outside = (t_ns < t[0]) | (t_ns > t[-1])
        if values.dtype == object:
            held = values[index]
            held[t_ns < t[0]] = None
            return held, flags[index]
        if bound.channel.quantity in _HELD:
            return np.where(t_ns < t[0], np.nan, values[index]), flags[index]
        found = np.interp((t_ns - t[0]).astype(np.float64), (t - t[0]).astype(np.float64), values)
        after = np.minimum(index + 1, len(t) - 1)
        return np.where(outside, np.nan, found), flags[index] | np.where(t[index] == t_ns, 0, flags[after]) \
            .astype(np.uint16)

    def _derived(self, bound: Bound, start: int, stop: int) -> tuple[Array, Array]:
        member = (bound.source, bound.stream)
        t = self.timeline(member).t_ns[start:stop]
        text = bound.channel.derive or ""
        values: dict[str, Array] = {}
        flags: Array = np.zeros(stop - start, np.uint16)
        for name in derive.names(text):
            other = self.plan.bound[name]
            found, marks = self.values(other, start, stop) if (other.source, other.stream) == member \
                else self.sampled(name, t)
            values[name], flags = found, flags | marks
        units = {n: canonical(self.plan.bound[n].channel.quantity) for n in values}
        return derive.evaluate(bound, values, units), flags

    def _scheduled(self, bound: Bound, t_ns: Int1D) -> tuple[Array, Array]:
        times, values = schedule.steps(bound.name, bound.channel, self.plan.test)
        recording = self._recording_ns()
        found = schedule.held(np.asarray((t_ns - recording) / 1e9, dtype=np.float64), times, values)
        return found, np.zeros(len(t_ns), np.uint16)

    def _recording_ns(self) -> int:
        window = self.plan.test.window
        return self.span.zero_ns - (round(window[0] * 1e9) if window is not None else 0)

    def _schedule_grid(self) -> Int1D:
        begin = self._recording_ns()
        ends = [int(self.timeline(m).t_ns[-1]) for m in _stored(self.plan)
                if self.plan.sources[m[0]] in self.plan.reference and len(self.timeline(m).t_ns)]
        end = max(ends, default=begin)
        changes = [schedule.steps(b.name, b.channel, self.plan.test)[0] for b in self.plan.bound.values()
                   if b.channel.schedule is not None]
        at = np.concatenate(changes) if changes else np.empty(0)
        return schedule.grid(begin, end, np.rint(at * 1e9).astype(np.int64) + begin)

    def losses(self) -> list[tuple[Member, Loss]]:
        """What the joints of the streams seen so far lost."""
        return [(member, loss) for member, line in self._lines.items() for loss in line.losses]


def _stored(plan: TestPlan) -> list[Member]:
    return [(s.name, stream) for s in plan.sources.values() for stream in s.streams]
