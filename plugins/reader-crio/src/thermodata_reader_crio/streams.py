"""The streams of a TDMS file: channels of one group with one clock. Others of the group become `group@2`, ..."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from thermodata.errors import FormatError
from thermodata.plugin import Array, Int1D, Scaling, Signal, Source
from thermodata.reader.text import split_unit
from thermodata_reader_crio.clock import Waveform, waveform
from thermodata_reader_crio.columns import Column, columns
from thermodata_reader_crio.index import Index, walk
from thermodata_reader_crio.metadata import CLOCK, TIMESTAMP, Layout

KNOWN_SCALES = ("Linear", "Polynomial", "RTD", "Strain", "Table", "Thermistor", "Thermocouple", "Add", "Subtract",
                "AdvancedAPI")
_SCALE_TYPE = re.compile(r"^NI_Scale\[(\d+)\]_Scale_Type$")
_PATH = re.compile(r"'((?:[^']|'')*)'")
# "t" is a time, "T" a temperature
_TIME_NAME = re.compile(r"^(t|(?i:time|zeit|čas|cas|timestamp|elapsed( time)?|x_?value))$")
_SECONDS = {"s": 1.0, "sec": 1.0, "seconds": 1.0, "min": 60.0, "h": 3600.0, "ms": 1e-3, "us": 1e-6, "µs": 1e-6}
_SAME_SCAN_NS = 1_000_000   # channels of one scan may start up to this apart (a multiplexed converter)


@dataclass(frozen=True)
class Channel:
    """One signal: its columns (several: a DAQmx channel whose scaling joins several raw numbers)."""

    signal: Signal
    group: str
    columns: tuple[Column, ...]
    pieces: tuple[tuple[int, Waveform], ...]   # (first sample, clock from there on)
    joined_by: Scaling | None = None

    @property
    def length(self) -> int:
        return min(c.length for c in self.columns)

    @property
    def planned(self) -> int:
        return max(c.planned for c in self.columns)


@dataclass(frozen=True)
class Stream:
    """Signals that share rows. time: the channel that holds the time, where no waveform does; seconds: what one
    unit of it is, None for TDMS timestamps."""

    name: str
    channels: tuple[Channel, ...]
    time: Channel | None
    seconds: float | None = None

    @property
    def rows(self) -> int:
        return max(c.length for c in self.channels)

    @property
    def planned(self) -> int:
        return max(c.planned for c in self.channels)

    @property
    def absolute(self) -> bool:
        if self.time is not None:
            return self.seconds is None
        return bool(self.channels[0].pieces) and self.channels[0].pieces[0][1].start_ns is not None

    def times(self, first: int, last: int, read: Array | None = None) -> Int1D:
        """Times of rows [first, last); read: the time channel's values of these rows."""
        if self.time is not None:
            assert read is not None
            if self.seconds is None:
                return read.astype(np.int64)
            return np.rint(read.astype(np.float64) * (self.seconds * 1e9)).astype(np.int64)
        pieces = self.channels[0].pieces
        found = []
        for i, (start, clock) in enumerate(pieces):
            stop = pieces[i + 1][0] if i + 1 < len(pieces) else last
            a, b = max(first, start), min(last, stop)
            if a < b:
                found.append(clock.times(a - start, b - start))
        return np.concatenate(found) if found else np.zeros(0, np.int64)


@dataclass(frozen=True)
class File:
    index: Index
    streams: tuple[Stream, ...]
    notes: tuple[str, ...]


def names(path: str) -> tuple[str, ...]:
    """`/'Eddy'/'Z'` -> ('Eddy', 'Z')."""
    return tuple(part.replace("''", "'") for part in _PATH.findall(path))


def scaling(layers: Sequence[Mapping[str, Any]], where: str) -> Scaling | None:
    """The NI scaling that a channel, its group or the file declares. FormatError for a scale of a type that
    nobody here knows: volts must not pass for micrometres."""
    for properties in layers:
        scales = {m[1]: v for k, v in properties.items() if (m := _SCALE_TYPE.match(k))}
        if not scales or properties.get("NI_Number_Of_Scales", 1) == 0:
            continue
        # "scaled": the numbers were written with the scaling already applied
        if properties.get("NI_Scaling_Status", "unscaled") == "scaled":
            return None
        for number, kind in scales.items():
            if kind not in KNOWN_SCALES:
                raise FormatError(f"NI scale {number} has the unknown type '{kind}'", where=where,
                                  expected=", ".join(KNOWN_SCALES), got=str(kind),
                                  hint=f"options: {{unscaled: ['{where.split(' ', 1)[-1]}']}} takes the raw numbers")
        found = {k: v for k, v in properties.items() if k.startswith("NI_Scal") or k == "NI_Number_Of_Scales"}
        return Scaling("ni", found)
    return None


def open_file(path: Path, source: Source) -> File:
    """Index, streams and notes of a TDMS file; reads no bulk (but the text of none, the start of time channels)."""
    index = walk(path)
    try:
        cols = columns(index)
    except ValueError as error:
        raise FormatError("a channel changes its type within the file", where=path.name, got=str(error)) from None
    notes: list[str] = []
    unscaled = set(source.options.get("unscaled", ()))
    types = _types(index.layouts)
    groups: dict[str, list[Channel]] = {}
    for object_path, found in cols.items():
        parts = names(object_path)
        if len(parts) != 2:
            continue
        made = _channel(path, index, object_path, found, types[object_path], unscaled, notes)
        groups.setdefault(parts[0], []).append(made)
    streams = [s for group, channels in groups.items() for s in _streams(group, channels, index, source, notes)]
    return File(index, tuple(streams), tuple(notes))


def _types(layouts: list[Layout]) -> dict[str, int]:
    return {path: index.type for layout in layouts for path, index in layout.objects}


def _channel(path: Path, index: Index, object_path: str, found: list[Column], kind: int, unscaled: set[str],
             notes: list[str]) -> Channel:
    group, name = names(object_path)
    full = f"{group}/{name}"
    own = index.properties.get(object_path, {})
    layers = [own, index.properties.get("/'" + group.replace("'", "''") + "'", {}), index.properties.get("/", {})]
    unit = own.get("unit_string") or own.get("NI_UnitDescription") or None
    dtype = {"V16": "int64", "str": "str"}.get(found[0].dtype) or np.dtype(found[0].dtype).name
    if dtype.startswith("complex"):
        raise FormatError("a channel of complex numbers", where=f"{path.name} {full}", expected="real numbers",
                          got=dtype)
    scale = None if full in unscaled or name in unscaled else \
        scaling(layers, f"{path.name} {full}")
    properties = {k: str(v) for k, v in own.items()}
    if len(found) > 1:
        if scale is None:
            raise FormatError("a DAQmx channel of several raw numbers without a scaling that joins them",
                              where=f"{path.name} {full}")
        properties["scaled_by_reader"] = f"{len(found)} raw inputs"
        notes.append(f"{full}: its scaling joins {len(found)} raw numbers (a thermocouple and its cold junction, "
                     "say), so it is delivered scaled by the file's own formula")
        dtype = "float64"
    if kind == TIMESTAMP:
        properties["kind"] = "timestamp"
        unit = unit or "ns"
    joined_by = scale if len(found) > 1 else None
    signal = Signal(full, group, str(unit) if unit else None, dtype, None if joined_by else scale, properties)
    return Channel(signal, group, tuple(found), _clock_pieces(index, object_path, own), joined_by)


def _clock_pieces(index: Index, object_path: str, own: Mapping[str, Any]) -> tuple[tuple[int, Waveform], ...]:
    """Clocks by first sample: a start time that is written anew in a later segment starts a new piece there."""
    if "wf_increment" not in own:
        return ()
    state: dict[str, Any] = {}
    pieces: list[tuple[int, Waveform]] = []
    for at, changed in index.clock_changes.get(object_path, []):
        state.update({k: v for k, v in changed.items() if k in CLOCK})
        clock = waveform(state)
        if clock is None:
            continue
        if pieces and pieces[-1][0] == at:
            pieces.pop()
        pieces.append((at if pieces else 0, clock))
    return tuple(pieces)


def _same_clock(a: Channel, b: Channel) -> bool:
    """Equal clocks, but for the shift of a few microseconds between the channels of one scan."""
    if len(a.pieces) != len(b.pieces):
        return False
    for (i, x), (j, y) in zip(a.pieces, b.pieces, strict=True):
        if i != j or x.step != y.step or (x.start_ns is None) != (y.start_ns is None):
            return False
        apart = abs((x.start_ns or 0) + x.offset_ns - (y.start_ns or 0) - y.offset_ns)
        if apart and apart >= min(_SAME_SCAN_NS, float(x.step) / 2):
            return False
    return True


def _same_rows(a: Channel, b: Channel, index: Index) -> bool:
    """Equal lengths; where the file was cut, lengths that it would have made equal, or almost."""
    if a.length == b.length:
        return True
    if index.damage is None:
        return False
    last_run = max((int(c.n.max()) for ch in (a, b) for c in ch.columns if c.n.size), default=0)
    return a.planned == b.planned or abs(a.length - b.length) <= last_run


def _streams(group: str, channels: list[Channel], index: Index, source: Source, notes: list[str]) -> list[Stream]:
    filled = [c for c in channels if c.planned or c.length]
    for c in channels:
        if c not in filled:
            notes.append(f"{c.signal.name} holds no values")
    clocks = [c for c in filled if not c.pieces and _is_time(c, source)]
    parts: list[list[Channel]] = []
    for c in filled:
        if c in clocks:
            continue
        fit = next((p for p in parts if _same_clock(p[0], c) and _same_rows(p[0], c, index)), None)
        if fit is None:
            parts.append([c])
        else:
            fit.append(c)
    found: list[Stream] = []
    used: set[str] = set()
    for part in parts:
        time = None
        if not part[0].pieces:
            time = next((c for c in clocks if _same_rows(c, part[0], index)), None)
        if time is not None:
            used.add(time.signal.name)
        name = group if not found else f"{group}@{len(found) + 1}"
        found.append(_stream(name, part, time, source, notes))
    # a time channel beside waveforms is a signal like any other
    for c in clocks:
        if c.signal.name not in used:
            name = group if not found else f"{group}@{len(found) + 1}"
            found.append(_stream(name, [c], c, source, notes))
    return found


def _is_time(channel: Channel, source: Source) -> bool:
    wanted = source.options.get("time")
    short = channel.signal.name.split("/", 1)[1]
    if wanted is not None:
        return wanted in (channel.signal.name, short)
    if channel.signal.properties.get("kind") == "timestamp":
        return True
    return channel.signal.dtype != "str" and _TIME_NAME.match(split_unit(short)[0]) is not None \
        and _unit_seconds(channel) is not None


def _unit_seconds(channel: Channel) -> float | None:
    unit = channel.signal.unit or split_unit(channel.signal.name)[1] or "s"
    return _SECONDS.get(unit.strip().lower())


def _stream(name: str, part: list[Channel], time: Channel | None, source: Source, notes: list[str]) -> Stream:
    renamed = []
    for c in part:
        s = c.signal
        signal = replace(s, stream=name)
        renamed.append(replace(c, signal=signal))
    if time is not None:
        seconds = None if time.signal.properties.get("kind") == "timestamp" else _unit_seconds(time)
        return Stream(name, tuple(renamed), time, seconds)
    if not renamed[0].pieces:
        step = source.options.get("increment")
        if step is None:
            notes.append(f"stream '{name}' has no time: its rows are counted as 1 s each; declare "
                         "options: {increment: 0.1 s}, or {time: CHANNEL}")
        clock = waveform({"wf_increment": _seconds(step)})
        assert clock is not None
        renamed = [replace(c, pieces=((0, clock),)) for c in renamed]
    elif len({(p[0][1].start_ns, p[0][1].offset_ns) for p in (c.pieces for c in renamed)}) > 1:
        notes.append(f"stream '{name}': its channels start up to 1 ms apart (one scan of a multiplexed converter); "
                     "rows carry the time of the first; each channel's own start stands in its wf_start_time")
    return Stream(name, tuple(renamed), None)


def _seconds(step: Any) -> float:
    if step is None:
        return 1.0
    from thermodata.schema.quantity import value_in

    return value_in(step, "s")
