"""Quality flags of a test's channels, and when it measures: a stream's chunks with their flags, ready to be written."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field

import numpy as np

from thermodata.calibration.quality.concise import concise
from thermodata.calibration.quality.event import QualityEvent
from thermodata.errors import ThermodataError
from thermodata.plugin import Array, Bool1D, Int1D
from thermodata.schema.files.campaign import Measuring
from thermodata.schema.flag import Flag
from thermodata.schema.units.quantity import MEASURED
from thermodata.store.tidy.flags.beside.between import Verdict
from thermodata.store.tidy.flags.event import Event
from thermodata.store.tidy.flags.in_windows import windows
from thermodata.store.tidy.flags.in_windows.changes import Changes
from thermodata.store.tidy.flags.in_windows.cuts import ahead, cuts
from thermodata.store.tidy.flags.in_windows.releases import Releases
from thermodata.store.tidy.flags.in_windows.windows import Joined
from thermodata.store.tidy.flags.measured.measured_alone import DOUBTED, cleared
from thermodata.store.tidy.flags.measured.measuring import Stretches, find_stretches, lasts, measures, said
from thermodata.store.tidy.flags.measured.not_measuring import Activity, join_while_not_measuring
from thermodata.store.tidy.flags.measured.standing import join_while_standing
from thermodata.store.tidy.flags.measured.trimmed import Trimmed
from thermodata.store.tidy.plan.plan import SCHEDULE, Bound
from thermodata.store.tidy.values.chunk import Chunk, Column, calibrated
from thermodata.store.tidy.values.series import Member, TestSeries

_PERIOD_ROWS = 1_000_000


@dataclass(slots=True)
class Flagged:
    """Walks through a stream once, or twice where it has too many columns to be held side by side.

    bounds: the channels. start, stop: rows. events: complete once `chunks` has ended. problems: gets what can't be
    calibrated, and why `measuring` can't be evaluated. verdict: what other tests say of the channels.
    """

    series: TestSeries
    member: Member
    bounds: Sequence[Bound]
    start: int
    stop: int
    problems: list[str]
    verdict: Verdict = field(default_factory=Verdict)
    events: list[Event] = field(default_factory=list)
    _judged: list[QualityEvent] = field(default_factory=list)
    _activity: dict[str, Activity] = field(default_factory=dict)
    _repeats: dict[tuple[str, str], Activity] = field(default_factory=dict)
    _timed: list[str] = field(default_factory=list)
    _untold: bool = False  # `measuring` can't be evaluated: what it would mask is not known, so nothing counts
    _trimmed: Trimmed = field(default_factory=Trimmed)
    _kept: dict[str, Stretches] = field(default_factory=dict)
    _releases: Releases = field(init=False)

    def __post_init__(self) -> None:
        self._releases = Releases(self.series, self.stop)

    def chunks(self, rows: int, borders: Sequence[int] = ()) -> Iterator[tuple[int, Int1D, dict[str, Column]]]:
        """(first row, times, channels with all their flags) of chunks of so many rows; none crosses a border."""
        with ThreadPoolExecutor(2) as pool:
            self._look_when_measured(pool)
            yield from self._measured(self._judged_chunks(rows, borders, pool))
        self._judged += self._of_the_clock()
        zero = self.series.span.zero_ns
        self.events += [
            Event(e.channel, e.flag, (e.from_ns - zero) / 1e9, (e.to_ns - zero) / 1e9, e.n, e.detail or None)
            for e in concise(join_while_standing(self._joined_events(), self.series))
        ]

    def _joined_events(self) -> list[QualityEvent]:
        """What was judged, as far as its flags stay; between the measuring phases one event a channel and flag."""
        return join_while_not_measuring(self._trimmed.events(self._judged), self._activity, self._repeats)

    def _of_the_clock(self) -> list[QualityEvent]:
        if self.member[0] == SCHEDULE or self.start >= self.stop:
            return []
        line = self.series.timeline(self.member)
        first, last = int(line.times(self.start, self.start + 1)[0]), int(line.times(self.stop - 1, self.stop)[0])
        return [
            QualityEvent(None, "clock_suspect", max(a, first), min(b, last), n, why)
            for a, b, n, why in line.clock_stretches()
            if a <= last and b >= first
        ]

    def _judged_chunks(
        self, rows: int, borders: Sequence[int], pool: ThreadPoolExecutor
    ) -> Iterator[tuple[Chunk, dict[str, Column]]]:
        if self.member[0] == SCHEDULE:
            for a, b in cuts(self.start, self.stop, rows, borders):
                chunk = self._chunk(a, b)
                yield chunk, calibrated(chunk, self.bounds, self.problems, pool)
        elif len(self.bounds) <= windows.MOST_COLUMNS:
            for chunk, columns, first, stop in self._windows(self.bounds, rows, pool):
                for a, b in cuts(first, stop, rows, borders):
                    yield chunk.part(a, b), {n: c.part(a - first, b - first) for n, c in columns.items()}
        else:
            yield from self._wide(rows, borders, pool)

    def _windows(
        self, bounds: Sequence[Bound], rows: int, pool: ThreadPoolExecutor
    ) -> Iterator[tuple[Chunk, dict[str, Column], int, int]]:
        """(chunk, its channels on the window's own rows, the first and past-the-last of these)."""
        wanted = min(windows.WINDOW_ROWS, windows.WINDOW_VALUES // max(1, len(bounds)))
        size = max(1, wanted // rows) * rows
        margin = min(windows.MARGIN_ROWS, size // 2)
        joined = Joined(
            elsewhere={n: r.stats() for b in bounds if (r := self.verdict.reading(n := b.name))},
            limits=self.verdict.limits,
        )

        def load(a: int) -> tuple[Chunk, dict[str, Column], dict[str, Column]]:
            chunk = self._chunk(max(self.start, a - margin), min(self.stop, a + size + margin), bounds)
            columns = calibrated(chunk, bounds, self.problems, pool)
            return chunk, columns, self._releases.ahead_of(columns, a + size, chunk.stop)

        for a, (chunk, columns, seen) in ahead(load, range(self.start, self.stop, size), self._may_read_ahead()):
            b = min(a + size, self.stop)
            low = chunk.start
            flags = joined.add(chunk.t_ns, seen, a - low, b - low)
            own = {n: c.part(a - low, b - low) for n, c in columns.items()}
            masks = self._masks(chunk.part(a, b), own)
            given, t_ns = flags, chunk.t_ns[a - low : b - low]
            flags = cleared(t_ns, joined.inputs(own), given, masks)
            for name in masks:
                self._trimmed.add(name, t_ns, given[name], flags[name])
            yield chunk, {n: Column(c.bound, c.values, flags[n]) for n, c in own.items()}, a, b
        self._judged += joined.events

    def _may_read_ahead(self) -> bool:
        # `measuring` may look into any stream, and timelines aren't for several threads
        return self.series.plan.test.measuring is None

    def _wide(
        self, rows: int, borders: Sequence[int], pool: ThreadPoolExecutor
    ) -> Iterator[tuple[Chunk, dict[str, Column]]]:
        """Judges some columns after the other, keeps where their flags change, and then reads all side by side."""
        changes = Changes()
        for i in range(0, len(self.bounds), windows.MOST_COLUMNS):
            some = self.bounds[i : i + windows.MOST_COLUMNS]
            before = len(self._judged)
            for _, columns, first, _ in self._windows(some, rows, pool):
                for name, column in columns.items():
                    changes.add(name, first, column.flags)
            if i:  # what concerns the whole stream was said with the first columns
                self._judged[before:] = [e for e in self._judged[before:] if e.channel is not None]
        changes.join()
        for a, b in cuts(self.start, self.stop, rows, borders):
            chunk = self._chunk(a, b)
            columns = calibrated(chunk, self.bounds, self.problems, pool)
            for name, column in columns.items():
                if name in changes:
                    column.flags = changes.between(name, a, b)
            yield chunk, columns

    def _chunk(self, start: int, stop: int, bounds: Sequence[Bound] | None = None) -> Chunk:
        return Chunk(self.series, self.member, start, stop, self.bounds if bounds is None else bounds)

    def _look_when_measured(self, pool: ThreadPoolExecutor) -> None:
        """Finds the channels that are measured at times only, and the stretches that count as a whole."""
        spec = self.series.plan.test.measuring
        if spec is None or self.member[0] == SCHEDULE:
            return
        names = self._timed = [b.name for b in self.bounds if b.channel.quantity in MEASURED]
        try:
            if names and isinstance(spec, Measuring) and lasts(spec):
                self._kept = self._stretches(spec, names, pool)
        except ThermodataError as error:
            self._cannot_measure(error)

    def _mask(self, chunk: Chunk, name: str, columns: Mapping[str, Column]) -> Bool1D:
        """Where a channel is measured, shape (n,) of the chunk."""
        if self._kept:
            return self._kept[name].mask(chunk.start, chunk.t_ns)
        try:
            if not self._untold:
                return measures(chunk, columns[name], columns)
        except ThermodataError as error:
            self._cannot_measure(error)
        return np.zeros(len(chunk.t_ns), dtype=bool)

    def _masks(self, chunk: Chunk, columns: Mapping[str, Column]) -> dict[str, Bool1D]:
        return {n: self._mask(chunk, n, columns) for n in self._timed if n in columns}

    def _measured(
        self, chunks: Iterator[tuple[Chunk, dict[str, Column]]]
    ) -> Iterator[tuple[int, Int1D, dict[str, Column]]]:
        """Adds NOT_MEASURING to the channels that are measured."""
        for chunk, columns in chunks:
            for name in [n for n in self._timed if n in columns]:
                mask = self._mask(chunk, name, columns)
                own = columns[name].flags
                self._activity.setdefault(name, Activity()).add(chunk.t_ns, mask)
                for flag in Flag(int(DOUBTED)):
                    times = self._repeats.setdefault((name, flag.word), Activity())
                    times.add(chunk.t_ns, mask & ((own & np.uint16(flag)) != 0))
                columns[name].flags = own | np.where(mask, np.uint16(0), np.uint16(Flag.NOT_MEASURING))
            yield chunk.start, chunk.t_ns, columns

    def never_measured(self) -> tuple[str, ...]:
        """What is told once `chunks` has ended: of a `measuring` that holds at no time."""
        never = [] if self._untold else [n for n, activity in self._activity.items() if not activity.ever]
        spec = self.series.plan.test.measuring
        return (f"measuring ({said(spec)}) never holds: {', '.join(never)} counts at no time",) if never else ()

    def _cannot_measure(self, error: ThermodataError) -> None:
        self._untold = True
        self.problems.append("measuring: " + "; ".join(str(error).splitlines()) + "; none of the test counts")

    def _stretches(self, spec: Measuring, names: Sequence[str], pool: ThreadPoolExecutor) -> dict[str, Stretches]:
        """Where each channel is measured, from a look at the whole stream."""
        line = self.series.timeline(self.member)
        steps = np.diff(line.times(self.start, min(self.stop, self.start + _PERIOD_ROWS)))
        period = float(np.median(steps)) if len(steps) else 0.0
        rows = max(1, windows.WINDOW_VALUES // 8)
        stretches: dict[str, Stretches] = {}
        for bound in (b for b in self.bounds if b.name in names):

            def parts(bound: Bound = bound) -> Iterator[tuple[int, Int1D, Array]]:
                for a, b in cuts(self.start, self.stop, rows, ()):
                    chunk = self._chunk(a, b, [bound])
                    columns = calibrated(chunk, [bound], [], pool)
                    if columns:
                        yield a, chunk.t_ns, measures(chunk, columns[bound.name], columns)

            stretches[bound.name] = find_stretches(parts(), period, spec)
            if spec.in_range != "in_range":
                return dict.fromkeys(names, stretches[bound.name])  # says nothing of the channel itself
        return stretches
