"""The messages inside a chunk's records, and the definitions between them, in order."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from thermodata.plugin import Int1D
from thermodata_reader_mcap.container.data_section import Damage
from thermodata_reader_mcap.container.records import (
    CHANNEL,
    HEAD,
    MESSAGE,
    MESSAGE_HEAD,
    PRIVATE,
    SCHEMA,
    Bytes,
    Record,
    content_end,
)
from thermodata_reader_mcap.container.resync import next_record

_LOOKED_AHEAD = 1 << 16
_IN_CHUNK = frozenset({SCHEMA, CHANNEL, MESSAGE})


@dataclass(frozen=True, slots=True)
class ChunkPart:
    """Definitions (content and kind), then messages: where their records begin. stop: where the part ends."""

    definitions: tuple[tuple[Bytes, int], ...]
    messages: Int1D
    stop: int


def chunk_parts(inner: Bytes, index: list[Int1D]) -> Iterator[ChunkPart | Damage]:
    """All records of a chunk. index: what its message indexes say, where it has some."""
    quick = _by_index(inner, np.sort(np.concatenate(index))) if index else None
    if quick is not None:
        yield from quick
    else:
        yield from _by_walking(inner)


def _by_index(inner: Bytes, at: Int1D) -> list[ChunkPart] | None:
    """The same as by walking, where the chunk's index names every message: nothing is walked but what lies between
    them. None where the index and the records do not agree: then the records are right."""
    if not at.size or at[0] < 0 or at[-1] + HEAD.size + MESSAGE_HEAD > len(inner):
        return None
    data = np.frombuffer(inner, np.uint8)
    heads = np.lib.stride_tricks.sliding_window_view(data, HEAD.size)[at]
    stops = at + HEAD.size + np.ascontiguousarray(heads[:, 1:9]).view("<i8")[:, 0]
    ends, starts = np.concatenate([[0], stops]), np.concatenate([at, [len(inner)]])
    if (heads[:, 0] != MESSAGE).any() or (starts < ends).any() or (stops < at + HEAD.size + MESSAGE_HEAD).any():
        return None
    parts: list[ChunkPart] = []
    done = 0
    between: list[tuple[Bytes, int]] = []
    for gap in np.flatnonzero(starts != ends).tolist():
        place, stop = int(ends[gap]), int(starts[gap])
        if gap > done:
            parts.append(ChunkPart(tuple(between), at[done:gap], place))
            between, done = [], gap
        while place < stop:
            if place + HEAD.size > stop:
                return None
            opcode, length = HEAD.unpack_from(inner, place)
            record = Record(opcode, place + HEAD.size, place + HEAD.size + length)
            if record.stop > stop or opcode == MESSAGE or not _may_stand_in_chunk(inner, record):
                return None
            between.append((inner[record.start : record.stop], opcode))
            place = record.stop
    if between or done < at.size:
        parts.append(ChunkPart(tuple(between), at[done:], len(inner)))
    return parts


def _by_walking(inner: Bytes) -> Iterator[ChunkPart | Damage]:
    at, size, unpack = 0, len(inner), HEAD.unpack_from
    between: list[tuple[Bytes, int]] = []
    found: list[int] = []
    while at + HEAD.size <= size:
        opcode, length = unpack(inner, at)
        stop = at + HEAD.size + length
        if opcode == MESSAGE and length >= MESSAGE_HEAD and stop <= size:
            if (
                stop == size
                or inner[stop] in _IN_CHUNK
                or inner[stop] >= PRIVATE
                or next_record(inner, at + HEAD.size, min(stop, at + _LOOKED_AHEAD), _IN_CHUNK) is None
            ):
                found.append(at)
                at = stop
                continue
        elif stop <= size and _may_stand_in_chunk(inner, Record(opcode, at + HEAD.size, stop)):
            if found:
                yield ChunkPart(tuple(between), np.array(found, np.int64), at)
                between, found = [], []
            between.append((inner[at + HEAD.size : stop], opcode))
            at = stop
            continue
        if found or between:
            yield ChunkPart(tuple(between), np.array(found, np.int64), at)
            between, found = [], []
        following = next_record(inner, at + 1, None, _IN_CHUNK) or size
        yield Damage(at, following, "no record")
        at = following
    if found or between:
        yield ChunkPart(tuple(between), np.array(found, np.int64), at)
    if at < size:
        yield Damage(at, size, "no record")


def _may_stand_in_chunk(inner: Bytes, record: Record) -> bool:
    """Whether a record may stand in a chunk, beside messages."""
    if record.opcode in (SCHEMA, CHANNEL):
        return content_end(inner, record) is not None
    return record.opcode >= PRIVATE
