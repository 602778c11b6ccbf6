"""Quality flags of streams of any length: judged in windows that overlap, each as a whole, and joined.

Windows lie at fixed rows of the stream, so flags depend neither on how much memory there is nor on how the rows are
written. What lasts longer than a window is carried over: a reading that goes on standing still, a sensor that goes on
being off. Streams that fit into one window are judged as a whole.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from thermodata.calibration.quality.column import ColumnInput
from thermodata.calibration.quality.ends.range import Limits
from thermodata.calibration.quality.event import MOST_EVENTS, QualityEvent
from thermodata.calibration.quality.flags import flag_stream
from thermodata.calibration.quality.value import RunStats
from thermodata.plugin import Array, Int1D
from thermodata.schema.flag import Flag
from thermodata.store.tidy.values.chunk import Column

WINDOW_VALUES = 8_000_000  # values in a window: 64 MB of float64, and about as much while they are judged
WINDOW_ROWS = 2_000_000  # but not more rows: what is looked for in a column takes several times its size
MARGIN_ROWS = 4096  # of the neighbours, on both sides
MOST_COLUMNS = 200  # columns that are judged together
_STANDS = np.uint16(Flag.HELD | Flag.STUCK)
_OFFSET = np.uint16(Flag.OFFSET)
_BY_NAME = {f.word: np.uint16(f) for f in Flag if f}


@dataclass(slots=True)
class _Carried:
    """What a column was like at the last row of a window's own."""

    value: float
    stands: int = 0  # HELD or STUCK
    off: bool = False


@dataclass(slots=True)
class Joined:
    """Takes the windows of a stream in order. events: of the windows so far, in order of time. elsewhere: channel ->
    how it reads in other tests, where this one does not tell. limits: channel -> the ends of its range that other tests
    show."""

    events: list[QualityEvent] = field(default_factory=list)
    elsewhere: Mapping[str, RunStats] = field(default_factory=dict)
    limits: Mapping[str, Limits] = field(default_factory=dict)
    _carried: dict[str, _Carried] = field(default_factory=dict)
    _open: dict[tuple[str | None, str], int] = field(default_factory=dict)
    _count: dict[tuple[str | None, str], int] = field(default_factory=dict)

    def inputs(self, columns: Mapping[str, Column]) -> dict[str, ColumnInput]:
        """What the rules of quality ask of channels."""
        return {
            n: ColumnInput(
                values=c.values,
                quantity=c.bound.channel.quantity,
                flags=c.flags,
                at=c.bound.channel.at,
                elsewhere=self.elsewhere.get(n),
                limits=self.limits.get(n, (None, None)),
                held=c.bound.is_held,
                codes=c.codes,
            )
            for n, c in columns.items()
        }

    def add(self, t_ns: Int1D, columns: Mapping[str, Column], start: int, stop: int) -> dict[str, Array]:
        """Flags of the rows start to stop of a window, each of shape (stop - start,); the flags that the columns have
        are among them. The rows before and after are the window's margins, which belong to its neighbours.

        t_ns: shape (n,), non-decreasing.
        """
        flags, events = flag_stream(t_ns, self.inputs(columns))
        for name, column in columns.items():
            carried = self._carried.get(name)
            if start and carried is not None:
                events = _Seam(name, column.values, t_ns, flags[name], start, carried).continued(events)
        for name, column in columns.items():
            added = flags[name][stop - 1] & ~column.flags[stop - 1]
            value = column.values[stop - 1]
            self._carried[name] = _Carried(
                float(value) if column.values.dtype.kind in "iuf" else np.nan,
                int(added & _STANDS),
                bool(added & _OFFSET),
            )
        self._join(t_ns, flags, events, start, stop)
        return {name: whole[start:stop] for name, whole in flags.items()}

    def _join(self, t_ns: Int1D, flags: Mapping[str, Array], events: list[QualityEvent], start: int, stop: int) -> None:
        """Keeps the events of the window's own rows; one that began in the window before is made longer."""
        first, last = int(t_ns[start]), int(t_ns[stop - 1])
        for event in sorted(events, key=lambda e: e.from_ns):
            key = (event.channel, event.flag)
            at = self._open.get(key)
            if at is not None and event.from_ns <= self.events[at].to_ns and event.from_ns <= first:
                self.events[at] = _longer(self.events[at], event, t_ns, flags)
                continue
            if (
                event.to_ns < first
                or (start and event.from_ns < first and event.to_ns == first)
                or (stop < len(t_ns) and event.from_ns > last)
            ):
                continue
            self._keep_event(key, event)

    def _keep_event(self, key: tuple[str | None, str], event: QualityEvent) -> None:
        self._count[key] = self._count.get(key, 0) + 1
        if self._count[key] <= MOST_EVENTS:
            self._open[key] = len(self.events)
            self.events.append(event)
            return
        at, more = self._open[key], self._count[key] - MOST_EVENTS
        kept = self.events[at]
        detail = re.sub(r"; and \d+ more$", "", kept.detail)
        self.events[at] = replace(
            kept, to_ns=max(kept.to_ns, event.to_ns), n=kept.n + event.n, detail=f"{detail}; and {more} more"
        )


def _longer(event: QualityEvent, more: QualityEvent, t_ns: Int1D, flags: Mapping[str, Array]) -> QualityEvent:
    if more.to_ns <= event.to_ns:
        return event
    n = event.n + more.n
    if event.channel is not None:
        a, b = np.searchsorted(t_ns, [more.from_ns, event.to_ns + 1])
        n -= int(np.count_nonzero(flags[event.channel][a:b] & _BY_NAME.get(event.flag, np.uint16(0))))
    return replace(event, to_ns=more.to_ns, n=n, detail=re.sub(r"for \d+ samples", f"for {n} samples", event.detail))


@dataclass(frozen=True, slots=True)
class _Seam:
    """Where a column goes on from the window before. values, flags: shape (n,), of this window with the rows before
    `start`; flags are changed in place. carried: what it was like at the row before `start`."""

    name: str
    values: Array
    t_ns: Int1D
    flags: Array
    start: int
    carried: _Carried

    def continued(self, events: list[QualityEvent]) -> list[QualityEvent]:
        """The events of the window as they are beside what the window before ended in."""
        if self.carried.stands:
            events = self._stands_on(events)
        if self.carried.off and not self.flags[self.start - 1] & _OFFSET:
            events = self._off_again(events)
        return events

    def _stands_on(self, events: list[QualityEvent]) -> list[QualityEvent]:
        """A value that stood at the end of the window before goes on to stand until it moves."""
        start, flags, carried = self.start, self.flags, self.carried
        moved = np.flatnonzero(self.values[start:] != carried.value)
        stop = start + int(moved[0]) if moved.size else len(self.values)
        if stop == start:
            return events
        flags[start - 1 : stop] = (flags[start - 1 : stop] & ~_STANDS) | np.uint16(carried.stands)
        flag = Flag.STUCK if carried.stands & Flag.STUCK else Flag.HELD
        first, from_ns, to_ns = (int(self.t_ns[at]) for at in (start, start - 1, stop - 1))
        others = [
            e
            for e in events
            if not (e.channel == self.name and e.flag in ("held", "stuck") and e.from_ns <= first <= e.to_ns)
        ]
        detail = f"exactly {carried.value:.6g} for {stop - start} samples"
        return [*others, QualityEvent(self.name, flag.word, from_ns, to_ns, stop - start + 1, detail)]

    def _off_again(self, events: list[QualityEvent]) -> list[QualityEvent]:
        """This window has seen nothing but the sensor that is off: what it takes for a step away is the way back."""
        first, t_ns = self.start - 1, self.t_ns
        self.flags[first:] ^= _OFFSET
        off = ((self.flags[first:] & _OFFSET) != 0).view(np.int8)
        edges = np.flatnonzero(np.diff(np.concatenate([[0], off, [0]]))) + first
        others = [e for e in events if not (e.channel == self.name and e.flag == "offset")]
        return others + [
            QualityEvent(self.name, "offset", int(t_ns[a]), int(t_ns[b - 1]), b - a, "off again")
            for a, b in zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True)
        ]
