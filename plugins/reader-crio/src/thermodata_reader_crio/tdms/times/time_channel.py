"""Channels that hold the time: timestamps, seconds from the start, or seconds from a date that the file states."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, BinaryIO

import numpy as np

from thermodata.plugin import Array, Bool1D, Float1D, Int1D, Source
from thermodata.reader.text import split_unit
from thermodata.reader.text.cells.cell import is_dated, mostly
from thermodata.reader.text.clocks.counts_of_seconds import ask_what_counts, names_scale, scale_question
from thermodata.reader.text.clocks.time_groups import one_time
from thermodata.reader.text.names.time_header import is_time_header, unit_of_time
from thermodata.reader.text.page.timed.counted_from import counted_from
from thermodata.reader.text.times.in_memory import Stamps, times_of_numbers, times_of_texts
from thermodata.reader.times.since import count_in
from thermodata.reader.times.time_units import EPOCHS, SECONDS, check_unit, known_unit
from thermodata.reader.times.wrapped_counter import may_begin_anew
from thermodata.reader.times.zone import NAT
from thermodata_reader_crio.labview_clock import LABVIEW_SECONDS, LAST_NS, UNIX_SECONDS
from thermodata_reader_crio.tdms.channels.channel import Channel
from thermodata_reader_crio.tdms.raw.values import read

# "t" is a time, "T" a temperature
_TIME_NAME = re.compile(r"^(t|(?i:time|zeit|čas|cas|time ?stamp|elapsed( time)?|x_?value|uhrzeit|时间|時間))$")
_LOOKED_AT = 100  # rows of a channel of text


@dataclass(frozen=True, eq=False)
class TimeChannel:
    """unit: in which the channel counts, from a date or from the recording's start; None for timestamps. told: the
    times of all rows where it holds text, or counts in the time of the place. notes: on how it was read."""

    channel: Channel
    unit: str | None
    told: Stamps | None = None
    notes: tuple[str, ...] = ()

    @property
    def absolute(self) -> bool:
        """Whether its times are since 1970 UTC, not since the start."""
        return self.unit is None or self.unit in EPOCHS if self.told is None else self.told.absolute

    def times(self, values: Array, first: int) -> tuple[Int1D, Bool1D]:
        """(nanoseconds, whether there is a time at all) of the channel's values from a row on, shape (n,)."""
        if self.told is not None:
            t = self.told.t_ns[first : first + len(values)]
        elif self.unit is None:
            t = values.astype(np.int64)
            return t, np.abs(t) < LAST_NS
        else:
            t = times_of_numbers(values, self.unit, None).t_ns
        good = (t != NAT) & (np.abs(t) < LAST_NS)
        return np.where(good, t, 0), good


def time_channels(members: Sequence[Channel], source: Source, file: BinaryIO) -> list[Channel]:
    """Those of a group's channels that hold the time of their neighbours; where none is called a time, and nothing else
    dates the group, the ones whose name hints at the scale that they count by."""
    bare = [c for c in members if c.clock is None]
    found = [c for c in bare if _is_time(c, source, file)]
    if found or len(bare) < len(members) or _declared_of_time(source, "column") is not None:
        return found
    return [c for c in bare if _is_number(c) and _hints_at_scale(c, file)]


def _declared_of_time(source: Source, key: str) -> Any:
    """What is declared of the time: under `table`, or its channel under `options`."""
    said = one_time(source.table, "table").get(key)
    return source.options.get("time", said) if key == "column" else said


def _is_time(channel: Channel, source: Source, file: BinaryIO) -> bool:
    """Whether a channel holds the time of its neighbours: declared, of timestamps, or by its name and unit; where it
    holds text, by its name and first values."""
    wanted = _declared_of_time(source, "column")
    if wanted is not None:
        return wanted in (channel.signal.name, channel.short)
    if channel.is_timestamp:
        return True
    if channel.signal.dtype == "str":
        return _TIME_NAME.match(split_unit(channel.short)[0]) is not None and _are_dates(channel, file)
    if not _is_number(channel):
        return False
    unit, own = channel.signal.unit, split_unit(channel.short)[1]
    if _TIME_NAME.match(split_unit(channel.short)[0]) is not None:
        return known_unit(unit or own or "s") is not None
    return unit_of_time(channel.short, unit) is not None and is_time_header(channel.short, unit)


def _is_number(channel: Channel) -> bool:
    kind = channel.signal
    return kind.dtype not in ("str", "bool") and kind.scaling is None and channel.joined_by is None


def _first_values(channel: Channel, file: BinaryIO) -> Float1D:
    found = read(file, list(channel.columns), 0, min(_LOOKED_AT, channel.length))[0].astype(np.float64)
    return found[np.isfinite(found)]


def _hints_at_scale(channel: Channel, file: BinaryIO) -> bool:
    first = _first_values(channel, file) if names_scale(channel.short) else np.zeros(0)
    return bool((np.diff(first) > 0).all()) and scale_question(channel.short, first, "") is not None


def time_channel(channel: Channel, file: BinaryIO, source: Source, above: Sequence[Mapping[str, Any]]) -> TimeChannel:
    """What a time channel counts in, by its unit, by what it, its group or the file (`above`) says, and by its first
    values. FormatError, QuestionError: it holds text that is no time, or one that may be read in several ways, or it is
    open what it counts from."""
    if channel.is_timestamp:
        return TimeChannel(channel, None)
    name = channel.signal.name
    if channel.signal.dtype == "str":
        cells = [str(c).strip() for c in read(file, list(channel.columns), 0, channel.length)[0]]
        told = times_of_texts(cells, source.timezone, _declared_of_time(source, "format"), name)
        return TimeChannel(channel, None, told, tuple(told.notes))
    unit, notes = _unit_of(channel, file, _declared_of_time(source, "unit"), above)

    def load(start: int, stop: int) -> Array:
        return read(file, list(channel.columns), start, stop)[0]

    # the order of all rows tells the hour that repeats, and where a counter is full
    if not (EPOCHS[unit].local if unit in EPOCHS else may_begin_anew(load, channel.length)):
        return TimeChannel(channel, unit, notes=tuple(notes))
    told = times_of_numbers(load(0, channel.length), unit, source.timezone, name)
    return TimeChannel(channel, None, told, (*notes, *told.notes))


def _unit_of(
    channel: Channel, file: BinaryIO, declared: str | None, above: Sequence[Mapping[str, Any]]
) -> tuple[str, list[str]]:
    """(what a channel of numbers counts in, notes on it)."""
    name, short = channel.signal.name, channel.short
    if declared is not None:
        return check_unit(str(declared), name), []
    said = channel.signal.unit or split_unit(short)[1]
    written = next((text for text in (said, short) if text and (text is said or count_in(text))), None)
    written = written if written is not None and known_unit(written) is not None else unit_of_time(short)
    first = _first_values(channel, file)
    layers = [{k: str(v) for k, v in layer.items()} for layer in (channel.signal.properties, *above)]
    stated, notes = counted_from(short, first, written or "s", layers, name)
    if stated is not None:
        return stated, notes
    if (asked := scale_question(short, first, name, unit=written)) is not None:
        raise asked
    known = known_unit(written or "s") or "s"
    if known in SECONDS and (year := _by_size(first * SECONDS[known])) is not None:
        as_labview = ", as LabVIEW counts" if year == 1904 else ""
        taken = f"{name}: its values are taken as seconds since {year} UTC{as_labview}"
        return check_unit(f"{_short_unit(known)} since {year}-01-01", name), [*notes, taken]
    ask_what_counts(short, first, written or "s", name)
    return known, notes


def _by_size(first_s: Float1D) -> int | None:
    """The year that seconds are counted from, where they can be of no other."""
    for year, (low, high) in ((1904, LABVIEW_SECONDS), (1970, UNIX_SECONDS)):
        if first_s.size and low <= first_s.min() and first_s.max() <= high:
            return year
    return None


def _short_unit(unit: str) -> str:
    """'s' of 'seconds'."""
    return next(u for u in ("s", "min", "h", "d", "ms", "us", "ns") if SECONDS[u] == SECONDS[unit])


def _are_dates(channel: Channel, file: BinaryIO) -> bool:
    cells = [str(c).strip() for c in read(file, list(channel.columns), 0, min(_LOOKED_AT, channel.length))[0]]
    return bool(cells) and mostly(cells, is_dated, 0.8, len(cells))
