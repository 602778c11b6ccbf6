"""Channels that hold the time: timestamps, seconds from the start, or seconds since 1904 or 1970."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import BinaryIO

import numpy as np

from thermodata.plugin import Array, Bool1D, Int1D, Source
from thermodata.reader.text import split_unit
from thermodata.reader.text.cells.cell import is_dated, mostly
from thermodata.reader.text.clocks.time_groups import one_time
from thermodata.reader.text.times.in_memory import Stamps, times_of_texts
from thermodata.reader.zone import NAT
from thermodata_reader_crio.labview_clock import EPOCH_1904_NS, LABVIEW_SECONDS, LAST_NS, UNIX_SECONDS
from thermodata_reader_crio.tdms.channels import Channel
from thermodata_reader_crio.tdms.raw_values import read

# "t" is a time, "T" a temperature
_TIME_NAME = re.compile(r"^(t|(?i:time|zeit|čas|cas|time ?stamp|elapsed( time)?|x_?value|uhrzeit|时间|時間))$")
_LOOKED_AT = 100  # rows of a channel of text
_SECONDS = {
    "s": 1.0,
    "sec": 1.0,
    "seconds": 1.0,
    "min": 60.0,
    "h": 3600.0,
    "ms": 1e-3,
    "us": 1e-6,
    "µs": 1e-6,
    "μs": 1e-6,
    "ns": 1e-9,
}


@dataclass(frozen=True, eq=False)
class TimeChannel:
    """seconds: one unit of the channel, None for timestamps; epoch_ns: of its zero, None where it counts from the
    recording's start. told: the times of all rows where it holds text."""

    channel: Channel
    seconds: float | None
    epoch_ns: int | None
    told: Stamps | None = None

    @property
    def absolute(self) -> bool:
        """Whether its times are since 1970 UTC, not since the start."""
        return self.epoch_ns is not None if self.told is None else self.told.absolute

    def times(self, values: Array, first: int) -> tuple[Int1D, Bool1D]:
        """(nanoseconds, whether there is a time at all) of the channel's values from a row on, shape (n,)."""
        if self.told is not None:
            t = self.told.t_ns[first : first + len(values)]
            return np.where(t == NAT, 0, t), t != NAT
        if self.seconds is None:
            t = values.astype(np.int64)
            return t, np.abs(t) < LAST_NS
        v = values.astype(np.float64)
        offset = self.epoch_ns or 0
        good = np.isfinite(v) & (np.abs(v) * self.seconds < (LAST_NS - abs(offset)) / 1e9)
        whole = np.floor(np.where(good, v, 0.0))
        # whole seconds and the rest apart: 3.9e9 s with microseconds is at the end of what a double holds
        if self.seconds == 1.0:
            rest = np.rint((np.where(good, v, 0.0) - whole) * 1e9)
            return whole.astype(np.int64) * 1_000_000_000 + rest.astype(np.int64) + offset, good
        return np.rint(np.where(good, v, 0.0) * (self.seconds * 1e9)).astype(np.int64) + offset, good


def is_time(channel: Channel, source: Source, file: BinaryIO) -> bool:
    """Whether a channel holds the time of its neighbours: declared, of timestamps, or by its name and unit; where it
    holds text, by its name and first values."""
    wanted = source.options.get("time")
    if wanted is not None:
        return wanted in (channel.signal.name, channel.short)
    if channel.is_timestamp:
        return True
    if channel.signal.dtype == "str":
        return _TIME_NAME.match(split_unit(channel.short)[0]) is not None and _are_dates(channel, file)
    return (
        channel.signal.dtype not in ("str", "bool")
        and channel.signal.scaling is None
        and channel.joined_by is None
        and _TIME_NAME.match(split_unit(channel.short)[0]) is not None
        and _unit_seconds(channel) is not None
    )


def time_channel(channel: Channel, file: BinaryIO, source: Source, notes: list[str]) -> TimeChannel:
    """What a time channel counts in, by its unit and its first values. FormatError, QuestionError: it holds text that
    is no time, or one that may be read in several ways."""
    if channel.is_timestamp:
        return TimeChannel(channel, None, 0)
    if channel.signal.dtype == "str":
        form = one_time(source.table, channel.signal.name).get("format")
        cells = [str(c).strip() for c in read(file, list(channel.columns), 0, channel.length)[0]]
        told = times_of_texts(cells, source.timezone, form, channel.signal.name)
        notes.extend(n for n in told.notes if n not in notes)
        return TimeChannel(channel, None, None, told)
    seconds = _unit_seconds(channel) or 1.0
    first = read(file, list(channel.columns), 0, min(100, channel.length))[0].astype(np.float64) * seconds
    first = first[np.isfinite(first)]
    if first.size and LABVIEW_SECONDS[0] <= first.min() and first.max() <= LABVIEW_SECONDS[1]:
        notes.append(f"{channel.signal.name}: its values are taken as seconds since 1904 UTC, as LabVIEW counts")
        return TimeChannel(channel, seconds, EPOCH_1904_NS)
    if first.size and UNIX_SECONDS[0] <= first.min() and first.max() <= UNIX_SECONDS[1]:
        notes.append(f"{channel.signal.name}: its values are taken as seconds since 1970 UTC")
        return TimeChannel(channel, seconds, 0)
    return TimeChannel(channel, seconds, None)


def _are_dates(channel: Channel, file: BinaryIO) -> bool:
    cells = [str(c).strip() for c in read(file, list(channel.columns), 0, min(_LOOKED_AT, channel.length))[0]]
    return bool(cells) and mostly(cells, is_dated, 0.8, len(cells))


def _unit_seconds(channel: Channel) -> float | None:
    unit = channel.signal.unit or split_unit(channel.short)[1] or "s"
    return _SECONDS.get(unit.strip().lower())
