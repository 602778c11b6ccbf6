"""Where a row of a TDMS file stands: its segment, and the bytes of its values."""

from __future__ import annotations

from pathlib import Path
from typing import BinaryIO

import numpy as np

from thermodata.plugin import Source
from thermodata_reader_crio.tdms.file import open_file
from thermodata_reader_crio.tdms.raw.columns import Column
from thermodata_reader_crio.tdms.raw.places import TEXT
from thermodata_reader_crio.tdms.raw.values import read
from thermodata_reader_crio.tdms.streams import Stream

_NAMED = 12  # channels whose bytes are told one by one
_ROWS = 1_000_000  # times read at once


def locate(path: Path, source: Source, stream: str, row: int) -> str | None:
    """`segment 812 of 86400, byte 123456 (Eddy/Z), byte 123464 (Eddy/X)` of a row (counted from 0) of a stream; None
    where the file has no such row."""
    file = open_file(path, source)
    found = next((s for s in file.streams if s.name == stream), None)
    if found is None:
        return None
    with path.open("rb") as handle:
        at = _file_row(handle, found, row)
    if at is None:
        return None
    starts = np.frombuffer(file.index.starts, np.int64)
    named: dict[int, list[str]] = {}
    channels = [c for c in found.channels if at < c.length]
    for channel in channels if len(channels) <= _NAMED else (channels[0], channels[-1]):
        for column in channel.columns:
            byte = byte_of(column, at)
            part = "" if column.part is None or len(channel.columns) == 1 else f" part {column.part}"
            text = "offset of its text at " if column.dtype == TEXT else ""
            named.setdefault(int(np.searchsorted(starts, byte, "right")), []).append(
                f"{text}byte {byte} ({channel.signal.name}{part})"
            )
    more = f" and {len(channels) - 2} channels between" if len(channels) > _NAMED else ""
    return (
        "; ".join(
            f"segment {number} of {file.index.segments}, {', '.join(bytes_)}"
            for number, bytes_ in sorted(named.items())
        )
        + more
    )


def byte_of(column: Column, row: int) -> int:
    """The first byte of a value; of a text, that of its entry in the chunk's table of offsets."""
    piece = int(np.searchsorted(column.row, row, "right")) - 1
    which = int(column.runs.which[piece])
    chunk, inside = divmod(row - int(column.row[piece]), int(column.n[which]))
    step = 4 if column.dtype == TEXT else int(column.stride[which])
    return int(column.runs.position[piece] + chunk * column.runs.pitch[which] + column.start[which]) + inside * step


def _file_row(handle: BinaryIO, stream: Stream, row: int) -> int | None:
    """The row in the file of a delivered one: rows whose time channel holds no time are not delivered."""
    if stream.time_channel is None:
        return row if row < stream.rows else None
    done = 0
    for first in range(0, stream.rows, _ROWS):
        last = min(stream.rows, first + _ROWS)
        _, good = stream.times(first, last, read(handle, list(stream.time_channel.channel.columns), first, last)[0])
        places = np.arange(first, last) if good is None else first + np.flatnonzero(good)
        if row < done + places.size:
            return int(places[row - done])
        done += places.size
    return None
