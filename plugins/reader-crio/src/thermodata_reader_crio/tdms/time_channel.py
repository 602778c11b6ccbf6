"""Channels that hold the time: timestamps, seconds from the start, or seconds since 1904 or 1970."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import BinaryIO

import numpy as np

from thermodata.plugin import Array, Bool1D, Int1D, Source
from thermodata.reader.text import split_unit
from thermodata_reader_crio.labview_clock import EPOCH_1904_NS, LABVIEW_SECONDS, LAST_NS, UNIX_SECONDS
from thermodata_reader_crio.tdms.channels import Channel
from thermodata_reader_crio.tdms.raw_values import read

# "t" is a time, "T" a temperature
_TIME_NAME = re.compile(r"^(t|(?i:time|zeit|čas|cas|time ?stamp|elapsed( time)?|x_?value|uhrzeit|时间|時間))$")
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
    recording's start."""

    channel: Channel
    seconds: float | None
    epoch_ns: int | None

    @property
    def absolute(self) -> bool:
        """Whether its times are since 1970 UTC, not since the start."""
        return self.epoch_ns is not None

    def times(self, values: Array) -> tuple[Int1D, Bool1D]:
        """(nanoseconds, whether there is a time at all) of the channel's values, shape (n,)."""
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


def is_time(channel: Channel, source: Source) -> bool:
    """Whether a channel holds the time of its neighbours: declared, of timestamps, or by its name and unit."""
    wanted = source.options.get("time")
    if wanted is not None:
        return wanted in (channel.signal.name, channel.short)
    if channel.is_timestamp:
        return True
    return (
        channel.signal.dtype not in ("str", "bool")
        and channel.signal.scaling is None
        and channel.joined_by is None
        and _TIME_NAME.match(split_unit(channel.short)[0]) is not None
        and _unit_seconds(channel) is not None
    )


def time_channel(channel: Channel, file: BinaryIO, notes: list[str]) -> TimeChannel:
    """What a time channel counts in, by its unit and its first values."""
    if channel.is_timestamp:
        return TimeChannel(channel, None, 0)
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


def _unit_seconds(channel: Channel) -> float | None:
    unit = channel.signal.unit or split_unit(channel.short)[1] or "s"
    return _SECONDS.get(unit.strip().lower())
