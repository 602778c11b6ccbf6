"""TDMS: what describe() and blocks() say of a file."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import BinaryIO

import numpy as np

from thermodata.plugin import Array, Block, Loss, Recording, Source
from thermodata.schema.flag import Flag
from thermodata_reader_crio.columns import read
from thermodata_reader_crio.streams import Channel, File, Stream, open_file

BLOCK_VALUES = 2_000_000   # values a block, over all its signals: 16 MB


def describe(path: Path, source: Source) -> Recording:
    file = open_file(path, source)
    notes = list(file.notes)
    starts: list[int] = []
    with path.open("rb") as handle:
        for stream in file.streams:
            if stream.rows and (stream.absolute or not _any_absolute(file)):
                starts.append(int(_times(handle, stream, 0, 1)[0]))
    absolute = _any_absolute(file)
    if absolute:
        relative = [s.name for s in file.streams if not s.absolute]
        if relative:
            notes.append(f"no date in {', '.join(relative)}: counted from the start of the others")
    if file.index.damage:
        notes.append(file.index.damage)
    return Recording(
        signals=tuple(c.signal for s in file.streams for c in s.channels),
        clock="absolute" if absolute else "relative",
        start_ns=min(starts) if absolute and starts else (0 if absolute else None),
        complete=file.index.damage is None,
        notes=tuple(notes),
    )


def _any_absolute(file: File) -> bool:
    return any(s.absolute for s in file.streams)


def blocks(path: Path, source: Source) -> Iterator[Block | Loss]:
    file = open_file(path, source)
    absolute = _any_absolute(file)
    ends: list[int] = []
    with path.open("rb") as handle:
        origin = min((int(_times(handle, s, 0, 1)[0]) for s in file.streams if s.absolute and s.rows), default=0)
        for stream in file.streams:
            shift = origin if absolute and not stream.absolute else 0
            rows = stream.rows if stream.time is None else min(stream.rows, stream.time.length)
            size = max(1, int(source.options.get("block_rows", BLOCK_VALUES // (len(stream.channels) + 1))))
            for first in range(0, rows, size):
                last = min(rows, first + size)
                block = _block(handle, stream, first, last, shift)
                if block.t_ns.size:
                    ends.append(int(block.t_ns[-1]))
                yield block
    if file.index.damage is not None:
        yield _loss(file, path, max(ends, default=None))


def _times(handle: BinaryIO, stream: Stream, first: int, last: int) -> Array:
    if stream.time is None:
        return stream.times(first, last)
    return stream.times(first, last, read(handle, list(stream.time.columns), first, last)[0])


def _block(handle: BinaryIO, stream: Stream, first: int, last: int, shift: int) -> Block:
    wanted = [c for channel in stream.channels for c in channel.columns]
    extra = list(stream.time.columns) if stream.time is not None else []
    raw = read(handle, wanted + extra, first, last)
    t_ns = stream.times(first, last, raw[-1] if extra else None) + shift
    values: dict[str, Array] = {}
    flags: dict[str, Array] = {}
    at = 0
    for channel in stream.channels:
        parts = raw[at:at + len(channel.columns)]
        at += len(channel.columns)
        value = _joined(channel, parts)
        if value.size < last - first:
            value, flag = _padded(value, last - first)
            flags[channel.signal.name] = flag
        values[channel.signal.name] = value
    return Block(stream.name, t_ns, values, flags or None)


def _joined(channel: Channel, parts: list[Array]) -> Array:
    if len(parts) == 1:
        return parts[0].astype(bool) if channel.signal.dtype == "bool" else parts[0]
    # imported here: the calibration floor is needed for such channels only
    from thermodata.calibration.scaling import apply_scaling

    n = min(p.size for p in parts)
    raw = {int(c.scale_id or 0): p[:n] for c, p in zip(channel.columns, parts, strict=True)}
    return apply_scaling(channel.joined_by, raw, channel=channel.signal.name)


def _padded(value: Array, n: int) -> tuple[Array, Array]:
    """A channel that a cut file ends before its neighbours: NaN, zero or empty text, flagged as not measuring, so
    that the neighbours keep their rows."""
    fill = {"f": np.nan, "O": ""}.get(value.dtype.kind, 0)
    flag = np.zeros(n, np.uint16)
    flag[value.size:] = Flag.NOT_MEASURING
    return np.concatenate([value, np.full(n - value.size, fill, value.dtype)]), flag


def _loss(file: File, path: Path, last_ns: int | None) -> Loss:
    """What the end of the file took with it, as far as the file still says."""
    index = file.index
    missing = (index.expected_end or index.size) - index.good_end
    planned = [int(s.times(s.planned - 1, s.planned)[0]) for s in file.streams
               if s.time is None and s.planned > s.rows]
    to_ns = max(planned, default=None)
    if to_ns is not None and last_ns is not None and to_ns < last_ns:
        to_ns = None
    fraction = missing / (index.good_end + missing) if missing else None
    return Loss(f"{path.name} byte {index.good_end}", last_ns, to_ns, fraction, (index.damage or "").split(": ", 1)[-1])
