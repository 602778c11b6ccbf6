"""The values of a test's channels: calibrated, on their own rows, or sampled onto another stream's."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from thermodata.calibration.result import CalibrationResult
from thermodata.plugin import Array, Float1D, Int1D, Loss
from thermodata.schema.units.quantity import STATES
from thermodata.store.tidy.clock.source_clock import Clock, Span, build, last_ns
from thermodata.store.tidy.plan import derive, schedule
from thermodata.store.tidy.plan.plan import SCHEDULE, Bound, TestPlan
from thermodata.store.tidy.rows.on_change import BY_HAND, MOST_BY_HAND, SET, Written, has_no_rate, written_by_hand
from thermodata.store.tidy.rows.timeline import Timeline, given_timeline
from thermodata.store.tidy.values.chunk import Chunk
from thermodata.store.tidy.values.rated import LEAST_LEG, Pace, pace_of, rate_on_rows, rows_of_rate

Member = tuple[str, str]
_SHORT = 1_000_000  # rows: a stream that others look into is kept as a whole up to this length


@dataclass(frozen=True, slots=True)
class Rows:
    """Row numbers of a timeline: history is [history, start), the test is [start, stop)."""

    history: int
    start: int
    stop: int


class TestSeries:
    """Reads the channels of one test from the raw layer, chunk by chunk. Not shared between threads.

    calibrations: by name. Raises UsageError for a channel that cannot be calibrated.
    """

    __test__ = False

    def __init__(
        self,
        store: Path,
        plan: TestPlan,
        clocks: Mapping[str, Clock],
        span: Span,
        calibrations: Mapping[str, CalibrationResult],
    ) -> None:
        self.store, self.plan, self.span, self.calibrations = store, plan, span, calibrations
        self.clocks = dict(clocks)
        self._lines: dict[Member, Timeline] = {}
        self._sampled: dict[str, tuple[Int1D, Array, Array]] = {}
        self._no_rate: dict[Member, bool] = {}
        self._by_hand: dict[str, Written | None] = {}
        self._paces: dict[str, Pace] = {}

    def timeline(self, member: Member) -> Timeline:
        """The rows of a stream; those of the schedule are a grid of a minute plus its changes."""
        if member not in self._lines:
            if member[0] == SCHEDULE and member not in _stored(self.plan):
                self._lines[member] = given_timeline(self._schedule_grid())
            else:
                source = self.plan.sources[member[0]]
                self._lines[member] = build(
                    self.store,
                    source.streams[member[1]],
                    self.clocks[member[0]],
                    resets_allowed=source.spec.clock.resets == "allow",
                    shared=source.shared and len(self.plan.campaign.tests) > 1,
                )
                self._lines[member].parts = source.parts
        return self._lines[member]

    def as_written(self, bound: Bound) -> Bound:
        """The same, with what its rows show: what is set stands until the next row of a log that has no rate, or that
        somebody wrote by hand; and so does the rate of what was written on change."""
        if bound.channel.derive is not None:
            return replace(bound, on_change=True) if self._rates_stand(bound.channel.derive) else bound
        if bound.channel.quantity not in BY_HAND or bound.is_said or bound.signal is None:
            return bound
        member = (bound.source, bound.stream)
        no_rate = bound.channel.quantity in SET and self.has_no_rate(member)
        return replace(bound, on_change=no_rate or self.by_hand(bound) == "on change")

    def has_no_rate(self, member: Member) -> bool:
        """Whether the rows of a stream come at no rate."""
        if member not in self._no_rate:
            self._no_rate[member] = has_no_rate(self.timeline(member))
        return self._no_rate[member]

    def by_hand(self, bound: Bound) -> Written | None:
        """Whether somebody wrote a logged channel's steps down, by its rows and by what was logged beside them."""
        if bound.channel.quantity not in BY_HAND or bound.signal is None or bound.is_said:
            return None
        if not (beside_ns := self.plan.step_beside(bound)):
            return None
        if bound.name not in self._by_hand:
            line = self.timeline((bound.source, bound.stream))
            rows = min(line.rows, MOST_BY_HAND + 1)
            found = line.columns([bound.signal.name], 0, rows).get(bound.signal.name)
            told = (
                None
                if found is None
                else written_by_hand(bound.channel.quantity, line.times(0, rows), found, beside_ns)
            )
            self._by_hand[bound.name] = told
        return self._by_hand[bound.name]

    def rated(self, bound: Bound, start: int, stop: int) -> tuple[Array, Array]:
        """(rates in the canonical unit by the second, flags) of a logged channel on rows start to stop of its own
        stream; both of shape (stop - start,)."""
        return rate_on_rows(self, bound, self._pace(bound), start, stop)

    def pace_of_rates(self, bound: Bound) -> Pace | None:
        """Of the rates that a derived channel takes that which loses most where its axis turns; None of no rate."""
        rated = derive.rated(bound.channel.derive) if bound.channel.derive is not None else ()
        paces = [self._pace(self.plan.bound[n]) for n in rated]
        return max(paces, key=lambda pace: (pace.leg < LEAST_LEG, pace.lost), default=None)

    def rows_of_rate(self, bound: Bound, row: int) -> list[int]:
        """The rows of its stream between which its rate on a row was taken."""
        return rows_of_rate(self, bound, self._pace(bound), row)

    def _rates_stand(self, text: str) -> bool:
        """Whether an expression, or one that it derives from, takes the rate of what was written on change."""
        operands = [self.plan.bound[n] for n in derive.names(text)]
        return any(self._pace(self.plan.bound[n]).on_change for n in derive.rated(text)) or any(
            b.channel.derive is not None and self._rates_stand(b.channel.derive) for b in operands
        )

    def _pace(self, bound: Bound) -> Pace:
        if bound.name not in self._paces:
            self._paces[bound.name] = pace_of(self, bound)
        return self._paces[bound.name]

    def rows(self, member: Member) -> Rows:
        """Which rows of a stream are the test's, and which its history."""
        line = self.timeline(member)
        low, high = self._limits(member)
        start = 0 if low is None else line.find(low)
        stop = line.rows if high is None else line.find(high)
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
        return Chunk(self, (bound.source, bound.stream), start, stop, [bound]).values(bound)

    def sampled(self, name: str, t_ns: Int1D) -> tuple[Array, Array]:
        """(values, flags) of a channel at other times, ascending: states, and what is written on change, are held,
        measurements run straight between two samples; NaN before the first and after the last sample."""
        bound = self.as_written(self.plan.bound[name])
        if bound.channel.schedule is not None:
            return self.scheduled(bound, t_ns)
        line = self.timeline((bound.source, bound.stream))
        if not line.rows or not len(t_ns):
            return np.full(len(t_ns), np.nan), np.zeros(len(t_ns), np.uint16)
        if line.rows <= _SHORT:
            if name not in self._sampled:
                self._sampled[name] = (line.t_ns, *self.values(bound, 0, line.rows))
            return self._values_at(bound, t_ns, *self._sampled[name], (True, True))
        start = max(0, line.find(int(t_ns[0])) - 1)
        stop = min(line.rows, line.find(int(t_ns[-1]) + 1) + 1)
        if stop - start > _SHORT and len(t_ns) > 1:
            half = len(t_ns) // 2
            (a, f), (b, g) = self.sampled(name, t_ns[:half]), self.sampled(name, t_ns[half:])
            return np.concatenate([a, b]), np.concatenate([f, g])
        return self._values_at(
            bound, t_ns, line.times(start, stop), *self.values(bound, start, stop), (start == 0, stop == line.rows)
        )

    @staticmethod
    def _values_at(
        bound: Bound, t_ns: Int1D, t: Int1D, values: Array, flags: Array, ends: tuple[bool, bool]
    ) -> tuple[Array, Array]:
        """ends: whether t begins and ends with the stream. What lies beside t lies beside the stream then."""
        assert ends[0] or t[0] <= t_ns[0]
        index = np.clip(np.searchsorted(t, t_ns, side="right") - 1, 0, len(t) - 1)
        before, after = t_ns < t[0], t_ns > t[-1]
        if values.dtype == object:
            held = values[index]
            held[before] = None
            return held, flags[index]
        if bound.channel.quantity in STATES or bound.is_held:
            return np.where(before, np.nan, values[index]), flags[index]
        follows = np.minimum(index + 1, len(t) - 1)
        exact = t[index] == t_ns
        # from the sample before, so that the result doesn't depend on where the chunk begins
        with np.errstate(invalid="ignore"):
            part = (t_ns - t[index]) / np.maximum(t[follows] - t[index], 1)
            between = np.where(exact, values[index], values[index] + (values[follows] - values[index]) * part)
        return np.where(before | after, np.nan, between), flags[index] | np.where(exact, 0, flags[follows]).astype(
            np.uint16
        )

    def scheduled(self, bound: Bound, t_ns: Int1D) -> tuple[Array, Array]:
        """(values, flags) of a channel that nobody logged, shape of t_ns."""
        times, values = schedule.steps(bound.name, bound.channel, self.plan.test)
        recording = self._recording_ns()
        held = schedule.held(np.asarray((t_ns - recording) / 1e9, dtype=np.float64), times, values)
        return held, np.zeros(len(t_ns), np.uint16)

    def _recording_ns(self) -> int:
        window = self.plan.test.window
        return self.span.zero_ns - (round(window[0] * 1e9) if window is not None else 0)

    def _schedule_grid(self) -> Int1D:
        begin = self._recording_ns()
        lines = [self.timeline(m) for m in _stored(self.plan) if self.plan.sources[m[0]] in self.plan.reference]
        ends = [int(line.times(line.rows - 1, line.rows)[0]) for line in lines if line.rows]
        end = max(ends, default=begin)
        changes = [
            schedule.steps(b.name, b.channel, self.plan.test)[0]
            for b in self.plan.bound.values()
            if b.channel.schedule is not None
        ]
        at = np.concatenate(changes) if changes else np.empty(0)
        return schedule.grid(begin, end, np.rint(at * 1e9).astype(np.int64) + begin)

    def losses(self) -> list[tuple[Member, Loss]]:
        """What the joints of the streams seen so far lost."""
        return [(member, loss) for member, line in self._lines.items() for loss in line.losses]


def _stored(plan: TestPlan) -> list[Member]:
    return [(s.name, stream) for s in plan.sources.values() for stream in s.streams]
