"""TDMS: what describe() and blocks() say of a file."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import BinaryIO

import numpy as np

from thermodata.plugin import Array, Block, Loss, Recording, Source
from thermodata.schema.flag import Flag
from thermodata.schema.words.sentences import counted, with_count
from thermodata_reader_crio.tdms.channels.channel import Channel
from thermodata_reader_crio.tdms.file import File, open_file
from thermodata_reader_crio.tdms.losses import losses
from thermodata_reader_crio.tdms.raw.places import TEXT
from thermodata_reader_crio.tdms.raw.values import read
from thermodata_reader_crio.tdms.streams import Stream

BLOCK_VALUES = 2_000_000  # values a block, over all its signals: 16 MB, a row group of the store
_TEXT_BYTES = 16 << 20  # and bytes of text


def describe(path: Path, source: Source) -> Recording:
    """Streams, signals and notes of a file; nothing of the bulk is read. FormatError: not one segment can be read."""
    file = open_file(path, source, keep=True)
    notes = [*file.notes, *file.partly]
    absolute = _any_absolute(file)
    starts = [t for s, t in _first_times(path, file) if s.absolute]
    if absolute:
        relative = [s.name for s in file.streams if not s.absolute]
        if relative:
            notes.append(f"no date in {with_count(relative, 5)}: counted from the start of the others")
    if file.index.damage:
        notes.append(file.index.damage)
    return Recording(
        signals=tuple(c.signal for s in file.streams for c in s.channels),
        clock="absolute" if absolute else "relative",
        start_ns=min(starts) if absolute and starts else (0 if absolute else None),
        complete=_is_complete(file),
        notes=tuple(notes),
    )


def _is_complete(file: File) -> bool | None:
    """False where something is gone. A file that ends behind one of several segments may have had more."""
    if file.index.damage is not None or file.index.holes or file.partly:
        return False
    return True if file.index.segments == 1 else None


def _any_absolute(file: File) -> bool:
    return any(s.absolute for s in file.streams)


def _first_times(path: Path, file: File) -> list[tuple[Stream, int]]:
    """The first time of each stream that has one."""
    found = []
    with path.open("rb") as handle:
        for stream in file.streams:
            if stream.rows:
                t, good = _times(handle, stream, 0, 1)
                found += [(stream, int(t[0]))] if good is None or good[0] else []
    return found


def blocks(path: Path, source: Source) -> Iterator[Block | Loss]:
    """The values as stored, times in ns since 1970 UTC (or since the start), and a loss for all that damage took."""
    file = open_file(path, source)
    absolute = _any_absolute(file)
    origin = min((t for s, t in _first_times(path, file) if s.absolute), default=0)
    last_ns: int | None = None
    with path.open("rb") as handle:
        for stream in file.streams:
            shift = origin if absolute and not stream.absolute else 0
            size, timeless = _block_rows(stream, source), 0
            for first in range(0, stream.rows, size):
                last = min(stream.rows, first + size)
                block = _block(handle, stream, first, last, shift)
                timeless += last - first - block.t_ns.size
                if block.t_ns.size:
                    last_ns = max(int(block.t_ns[-1]), last_ns if last_ns is not None else int(block.t_ns[-1]))
                    yield block
            if timeless:
                yield Loss(
                    f"{path.name} stream '{stream.name}'",
                    fraction=timeless / stream.rows,
                    reason=f"{counted(timeless, 'row')} whose time channel holds no time",
                )
    yield from losses(file, path, last_ns)


def _block_rows(stream: Stream, source: Source) -> int:
    rows = BLOCK_VALUES // (len(stream.channels) + 1)
    wide = sum(
        int(c.stride.max()) // max(1, int(c.n[int(c.stride.argmax())])) + 8
        for channel in stream.channels
        for c in channel.columns
        if c.dtype == TEXT
    )
    if wide:
        rows = min(rows, _TEXT_BYTES // wide)
    return max(1, int(source.options.get("block_rows", rows)))


def _times(handle: BinaryIO, stream: Stream, first: int, last: int):  # type: ignore[no-untyped-def]
    if stream.time_channel is None:
        return stream.times(first, last)
    return stream.times(first, last, read(handle, list(stream.time_channel.channel.columns), first, last)[0])


def _block(handle: BinaryIO, stream: Stream, first: int, last: int, shift: int) -> Block:
    wanted = [c for channel in stream.channels for c in channel.columns]
    extra = list(stream.time_channel.channel.columns) if stream.time_channel is not None else []
    raw = read(handle, wanted + extra, first, last)
    t_ns, good = stream.times(first, last, raw[-1] if extra else None)
    if shift:
        t_ns = t_ns + shift
    suspect = stream.clock.suspects(first, last) if stream.clock is not None else None
    values: dict[str, Array] = {}
    flags: dict[str, Array] = {}
    at = 0
    for channel in stream.channels:
        parts = raw[at : at + len(channel.columns)]
        at += len(channel.columns)
        value, flag = _with_lost_end(_joined_values(channel, parts), last - first)
        if suspect is not None:
            flag = suspect * np.uint16(Flag.CLOCK_SUSPECT) | (0 if flag is None else flag)
        values[channel.signal.name] = value
        if flag is not None:
            flags[channel.signal.name] = flag
    if good is not None and not good.all():
        t_ns = t_ns[good]
        values = {k: v[good] for k, v in values.items()}
        flags = {k: v[good] for k, v in flags.items()}
    return Block(stream.name, t_ns, values, flags or None)


def _joined_values(channel: Channel, parts: list[Array]) -> Array:
    if len(parts) == 1:
        return parts[0].astype(bool) if channel.signal.dtype == "bool" else parts[0]
    # imported here: the calibration floor is needed for such channels only
    from thermodata.calibration.scaling import apply_scaling

    n = min(p.size for p in parts)
    raw = {int(c.part or 0): p[:n] for c, p in zip(channel.columns, parts, strict=True)}
    return apply_scaling(channel.joined_by, raw, channel=channel.signal.name)


def _with_lost_end(value: Array, n: int) -> tuple[Array, Array | None]:
    """A channel that a cut file ends before its neighbours: NaN, zero or empty text, flagged as not measuring, so
    that the neighbours keep their rows; and text that the file's own offsets do not give, flagged alike."""
    flag = None
    if value.dtype.kind == "O":
        absent = np.array([v is None for v in value.tolist()], bool)
        if absent.any():
            value = np.where(absent, "", value)
            flag = absent * np.uint16(Flag.NOT_MEASURING)
    if value.size < n:
        fill = {"f": np.nan, "O": ""}.get(value.dtype.kind, 0)
        missing = np.full(n, Flag.NOT_MEASURING, np.uint16)
        missing[: value.size] = 0 if flag is None else flag
        flag, value = missing, np.concatenate([value, np.full(n - value.size, fill, value.dtype)])
    return value, flag
