"""The streams of a TDMS file: channels of one group with one clock. Others of the group become `group@2`, ..."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any, BinaryIO

import numpy as np

from thermodata.plugin import Array, Bool1D, Int1D, Source
from thermodata_reader_crio.tdms.channels.channel import Channel
from thermodata_reader_crio.tdms.channels.channel_clock import counted_clock
from thermodata_reader_crio.tdms.channels.waveform_clock import Clock, runs_over
from thermodata_reader_crio.tdms.segments.index import Index
from thermodata_reader_crio.tdms.times.date_and_time import date_and_time
from thermodata_reader_crio.tdms.times.time_channel import TimeChannel, time_channel, time_channels
from thermodata_reader_crio.tdms.times.weeks_of_gps import weeks_of_gps

_SAME_SCAN_NS = 1_000_000  # channels of one scan may start up to this apart (a multiplexed converter)


@dataclass(frozen=True, eq=False)
class Stream:
    """Signals that share rows. Their time is a clock, or a channel that holds it."""

    name: str
    channels: tuple[Channel, ...]
    clock: Clock | None
    time_channel: TimeChannel | None

    @property
    def rows(self) -> int:
        """Rows that can be delivered."""
        longest = max(c.length for c in self.channels)
        return longest if self.time_channel is None else min(longest, self.time_channel.channel.length)

    @property
    def planned(self) -> int:
        """Rows that the file announced: more than there are where it was cut."""
        return max(c.planned for c in self.channels)

    @property
    def absolute(self) -> bool:
        """Whether its times are since 1970 UTC, not since the start."""
        return (
            self.time_channel.absolute
            if self.time_channel is not None
            else self.clock is not None and self.clock.absolute
        )

    def times(self, first: int, last: int, read: Array | None = None) -> tuple[Int1D, Bool1D | None]:
        """(times of rows [first, last), which of them have one: None for all). read: the time channel's values."""
        if self.time_channel is not None:
            assert read is not None
            return self.time_channel.times(read, first)
        assert self.clock is not None
        return self.clock.times(first, last), None


class StreamMaker:
    """Makes the streams of a file, group by group. notes: what is told of them.

    source: as the file is declared; file: for the first values of channels that hold a time.
    """

    def __init__(self, index: Index, source: Source, file: BinaryIO) -> None:
        self.notes: list[str] = []
        self._index, self._source, self._file = index, source, file
        self._step_s = _seconds(source.options.get("increment"))
        self._taken: dict[str, int] = {}  # names of streams, and the number to try next

    def streams(self, group: str, members: Sequence[Channel]) -> Iterator[Stream]:
        """Those of one group of channels. UsageError: an `increment` that is no time."""
        filled = [c for c in members if c.planned or c.length]
        self.notes.extend(f"{c.signal.name} holds no values" for c in members if not (c.planned or c.length))
        times = _Times(filled, self._index, self._source, self._file)
        begins = min((_first_piece(c) for c in filled if c.length), default=0)
        for part in _parts([c for c in filled if self._is_measured(c, times)], self._index):
            name = self._name(group)
            holding = None if part[0].clock is not None else times.of_rows(part[0])
            if holding is not None:
                yield self._timed_stream(name, part, times.taken(holding))
            else:
                yield self._clocked(name, part, begins)
        for c in times.left():  # a time channel beside waveforms is a signal like any other
            yield self._timed_stream(self._name(group), [c], times.taken(c))

    def _is_measured(self, channel: Channel, times: _Times) -> bool:
        """Whether a channel holds no time, and stands over time: not over a frequency or a position, as its properties
        may say where nothing else does."""
        if times.hold(channel):
            return False
        if self._step_s is not None or channel.clock is not None:
            return True
        over = runs_over(channel.signal.properties)
        if over is None or times.of_rows(channel) is not None:
            return True
        self.notes.append(f"{channel.signal.name}: stands over {over}, not over time; left out")
        return False

    def _name(self, group: str) -> str:
        """A stream's name that no other has, in upper or lower case."""
        base, taken = group or "data", self._taken
        name, number = base, taken.get(base.casefold(), 2)
        while name.casefold() in taken:
            name, number = f"{base}@{number}", number + 1
        taken[base.casefold()] = number
        taken.setdefault(name.casefold(), 2)
        return name

    def _timed_stream(self, name: str, part: Sequence[Channel], time: TimeChannel) -> Stream:
        """A stream whose time a channel holds."""
        self.notes.extend(n for n in time.notes if n not in self.notes)
        return Stream(name, tuple([c.in_stream(name) for c in part]), None, time)

    def _clocked(self, name: str, part: Sequence[Channel], begins: int) -> Stream:
        """A stream whose time no channel holds. begins: the first piece of the file that holds rows of its group."""
        clock = self._clock(name, part)
        if part[0].length and _first_piece(part[0]) > begins:
            self.notes.append(
                f"stream '{name}' begins after others of its group; its time is what its own properties say"
            )
        return Stream(name, tuple([c.in_stream(name) for c in part]), clock, None)

    def _clock(self, name: str, part: Sequence[Channel]) -> Clock:
        """The channels' own clock, or one that counts rows."""
        clock = part[0].clock
        if clock is None:
            if self._step_s is None:
                self.notes.append(
                    f"stream '{name}' has no time: its rows are counted as 1 s each; declare "
                    "options: {increment: 0.1 s}, or {time: CHANNEL}"
                )
            return counted_clock(self._index, part[0].columns[0], self._step_s or 1.0)
        if any(not np.array_equal(c.clock.base_ns, clock.base_ns) for c in part if c.clock not in (None, clock)):
            self.notes.append(
                f"stream '{name}': its channels start up to 1 ms apart (one scan of a multiplexed converter); "
                "rows carry the time of the first; each channel's own start stands in its wf_start_time"
            )
        return clock


class _Times:
    """The channels of a group that hold times, and which of them are the time of a stream already."""

    def __init__(self, filled: list[Channel], index: Index, source: Source, file: BinaryIO) -> None:
        self._index, self._source, self._file = index, source, file
        # two channels that tell a time together stand for its first one
        self._pair = weeks_of_gps(filled, source, file) or date_and_time(filled, source, file)
        self._channels = time_channels(filled, source, file) if self._pair is None else [self._pair.members[0]]
        self._ids = {*map(id, self._channels), *(() if self._pair is None else map(id, self._pair.members))}
        self._above = [index.properties.get(path, {}) for path in (_path_above(filled), "/")]
        self._taken: set[int] = set()

    def hold(self, channel: Channel) -> bool:
        """Whether a channel is one of them, or the second of two."""
        return id(channel) in self._ids

    def of_rows(self, channel: Channel) -> Channel | None:
        """The first that has the same rows as a channel."""
        return next((c for c in self._channels if _same_rows(c, channel, self._index)), None)

    def taken(self, time: Channel) -> TimeChannel:
        """One of them as the time of a stream."""
        self._taken.add(id(time))
        if self._pair is not None:
            return self._pair.time_channel(self._file)
        return time_channel(time, self._file, self._source, self._above)

    def left(self) -> list[Channel]:
        """Those that are the time of no stream."""
        return [c for c in self._channels if id(c) not in self._taken]


def _first_piece(channel: Channel) -> int:
    """The number of the file's first piece that holds rows of a channel."""
    return int(channel.columns[0].runs.piece[0])


def _parts(members: list[Channel], index: Index) -> Iterable[list[Channel]]:
    """Channels by clock and rows. A file may have 100,000, so each is compared with few others only."""
    near: dict[Any, list[list[Channel]]] = {}
    parts: list[list[Channel]] = []
    for c in members:
        key, cell = _key(c, index)
        fit = next(
            (
                p
                for at in (cell, cell - 1, cell + 1)
                for p in near.get((key, at), ())
                if _same_clock(p[0], c) and _same_rows(p[0], c, index)
            ),
            None,
        )
        if fit is None:
            parts.append([c])
            near.setdefault((key, cell), []).append(parts[-1])
        else:
            fit.append(c)
    return parts


def _key(c: Channel, index: Index) -> tuple[Any, int]:
    """(what must be equal, a cell of time in which, or beside which, the others start)."""
    rows = c.length if index.damage is None and not index.holes else None
    if c.clock is None:
        return (None, rows), 0
    return (c.clock.steps[0], c.clock.row.size, c.clock.absolute, rows), int(c.clock.base_ns[0]) // _SAME_SCAN_NS


def _same_clock(a: Channel, b: Channel) -> bool:
    """Equal clocks, but for the shift of a few microseconds between the channels of one scan."""
    if a.clock is None or b.clock is None:
        return a.clock is b.clock
    return a.clock.nearly(b.clock, _SAME_SCAN_NS)


def _same_rows(a: Channel, b: Channel, index: Index) -> bool:
    """Equal lengths; where the file was cut, lengths that it would have made equal, or almost."""
    if a.length == b.length:
        return True
    if index.damage is None:
        return False
    return a.planned == b.planned or abs(a.length - b.length) <= max(a.last_run, b.last_run)


def _path_above(members: list[Channel]) -> str:
    """The path of the group that channels stand in, as the file has it."""
    return members[0].columns[0].path.rpartition("/")[0] if members else ""


def _seconds(step: Any) -> float | None:
    if step is None:
        return None
    from thermodata.schema.units.value import value_in

    return value_in(step, "s")
