"""The streams of a TDMS file: channels of one group with one clock. Others of the group become `group@2`, ..."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, BinaryIO

import numpy as np

from thermodata.plugin import Array, Bool1D, Int1D, Source
from thermodata_reader_crio.tdms.channel_clock import counted_clock
from thermodata_reader_crio.tdms.channels import Channel
from thermodata_reader_crio.tdms.date_and_time import date_and_time
from thermodata_reader_crio.tdms.segment_index import Index
from thermodata_reader_crio.tdms.time_channel import TimeChannel, time_channel, time_channels
from thermodata_reader_crio.tdms.waveform_clock import Clock, runs_over
from thermodata_reader_crio.tdms.weeks_of_gps import weeks_of_gps

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


def streams_of(
    group: str,
    members: list[Channel],
    index: Index,
    source: Source,
    notes: list[str],
    taken: dict[str, int],
    file: BinaryIO,
) -> Iterable[Stream]:
    """The streams of one group of channels. taken: names of streams so far; file: for the first values of channels
    that hold a time."""
    filled = [c for c in members if c.planned or c.length]
    notes.extend(f"{c.signal.name} holds no values" for c in members if not (c.planned or c.length))
    pair = weeks_of_gps(filled, source, file) or date_and_time(filled, source, file)
    clocks = time_channels(filled, source, file) if pair is None else [pair.members[0]]
    apart = {*map(id, clocks), *(() if pair is None else map(id, pair.members))}

    def timed(time: Channel) -> TimeChannel:
        return time_channel(time, file, source, notes, above) if pair is None else pair.time_channel(file, notes)

    late = min((int(c.columns[0].runs.piece[0]) for c in filled if c.length), default=0)
    used: set[int] = set()
    step = _seconds(source.options.get("increment"))
    if step is None:
        for c in filled:
            over = runs_over(c.signal.properties) if c.clock is None and id(c) not in apart else None
            if over is not None and not any(_same_rows(time, c, index) for time in clocks):
                notes.append(f"{c.signal.name}: stands over {over}, not over time; left out")
                apart.add(id(c))
    above = [index.properties.get(path, {}) for path in (_path_above(filled), "/")]
    for part in _parts([c for c in filled if id(c) not in apart], index):
        time = None if part[0].clock is not None else next((c for c in clocks if _same_rows(c, part[0], index)), None)
        name = _name(group, taken)
        own = tuple([c.in_stream(name) for c in part])
        if time is not None:
            used.add(id(time))
            yield Stream(name, own, None, timed(time))
            continue
        clock = part[0].clock
        if clock is None:
            clock = counted_clock(index, part[0].columns[0], step or 1.0)
            if step is None:
                notes.append(
                    f"stream '{name}' has no time: its rows are counted as 1 s each; declare "
                    "options: {increment: 0.1 s}, or {time: CHANNEL}"
                )
        elif any(not np.array_equal(c.clock.base_ns, clock.base_ns) for c in part if c.clock not in (None, clock)):
            notes.append(
                f"stream '{name}': its channels start up to 1 ms apart (one scan of a multiplexed converter); "
                "rows carry the time of the first; each channel's own start stands in its wf_start_time"
            )
        if part[0].length and int(part[0].columns[0].runs.piece[0]) > late:
            notes.append(f"stream '{name}' begins after others of its group; its time is what its own properties say")
        yield Stream(name, own, clock, None)
    for c in clocks:
        # a time channel beside waveforms is a signal like any other
        if id(c) not in used:
            name = _name(group, taken)
            yield Stream(name, (c.in_stream(name),), None, timed(c))


def _name(group: str, taken: dict[str, int]) -> str:
    """A stream's name that no other has, in upper or lower case. taken: names, and the number to try next."""
    base = group or "data"
    name, number = base, taken.get(base.casefold(), 2)
    while name.casefold() in taken:
        name, number = f"{base}@{number}", number + 1
    taken[base.casefold()] = number
    taken.setdefault(name.casefold(), 2)
    return name


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
    from thermodata.schema.units.quantity import value_in

    return value_in(step, "s")
