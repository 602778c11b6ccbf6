"""The records of an MCAP file, walked in place; a damaged stretch is named and the next chunk found by its mark.

Layout (mcap.dev/spec): a magic, then records of opcode (1 byte), length (8) and content; messages stand in the
data section itself or inside (compressed) chunks.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator
from dataclasses import dataclass

MAGIC = b"\x89MCAP0\r\n"
HEADER, FOOTER, SCHEMA, CHANNEL, MESSAGE, CHUNK, MESSAGE_INDEX, DATA_END = 1, 2, 3, 4, 5, 6, 7, 0x0F
ATTACHMENT = 9
_KNOWN = set(range(1, 0x10))
_RECORD = struct.Struct("<BQ")
_CHUNK = struct.Struct("<QQQI")
_COMPRESSIONS = (b"\x04\0\0\0zstd", b"\x03\0\0\0lz4")


@dataclass(frozen=True, slots=True)
class Record:
    """A record of the data section: `start` and `stop` bound its content. cut: the file ends inside it."""

    opcode: int
    start: int
    stop: int
    cut: bool = False


@dataclass(frozen=True, slots=True)
class Damage:
    """Bytes that are no record, up to the next chunk or the end of the file."""

    start: int
    stop: int
    reason: str


@dataclass(frozen=True, slots=True)
class ChunkHead:
    """A chunk's header; `start` and `stop` bound its records as stored."""

    start_ns: int
    end_ns: int
    size: int
    crc: int
    compression: str
    start: int
    stop: int


def data_section(view: memoryview) -> Iterator[Record | Damage]:
    """The records up to the end of the data section. Indexes and statistics behind it are not needed."""
    at, size = len(MAGIC), len(view)
    while at < size:
        if at + 9 > size:
            yield Damage(at, size, "the file ends inside a record's head: it was cut")
            return
        opcode, length = _RECORD.unpack_from(view, at)
        stop = at + 9 + length
        if opcode in (DATA_END, FOOTER):
            return
        if view[at:at + 8] == MAGIC and at + 8 == size:
            return
        plausible = opcode in _KNOWN or opcode >= 0x80
        if plausible and stop <= size:
            yield Record(opcode, at + 9, stop)
            at = stop
            continue
        following = next_chunk(view, at + 1)
        cut = Record(opcode, at + 9, size, cut=True)
        if plausible and following is None and (opcode != CHUNK or chunk_head(view, cut) is not None):
            yield cut
            return
        stop = size if following is None else following
        yield Damage(at, stop, f"no record at byte {at} (opcode {opcode}, length {length})")
        at = stop
    yield Damage(size, size, "the file ends without the end of its data: it was cut")


def chunk_head(view: memoryview, record: Record) -> ChunkHead | None:
    """A chunk's header; None where the chunk is cut inside it or contradicts itself."""
    if record.stop - record.start < 40:
        return None
    start_ns, end_ns, size, crc = _CHUNK.unpack_from(view, record.start)
    (name_size,) = struct.unpack_from("<I", view, record.start + 28)
    at = record.start + 32 + name_size
    if name_size > 16 or at + 8 > record.stop:
        return None
    name = bytes(view[record.start + 32:at]).decode("ascii", "replace")
    (stored,) = struct.unpack_from("<Q", view, at)
    if not record.cut and at + 8 + stored != record.stop:
        return None
    return ChunkHead(start_ns, end_ns, size, crc, name, at + 8, min(at + 8 + stored, record.stop))


def next_chunk(view: memoryview, at: int) -> int | None:
    """Where the next whole compressed chunk begins, found by the name of its compression."""
    data = view.obj if hasattr(view.obj, "find") else bytes(view)
    best: int | None = None
    for mark in _COMPRESSIONS:
        found = data.find(mark, at + 37)
        while found >= 0:
            start = found - 37
            if view[start] == CHUNK:
                (length,) = struct.unpack_from("<Q", view, start + 1)
                stop = start + 9 + length
                if stop <= len(view) and chunk_head(view, Record(CHUNK, start + 9, stop)) is not None:
                    best = start if best is None else min(best, start)
                    break
            found = data.find(mark, found + 1)
    return best


def is_complete(view: memoryview) -> bool:
    """Whether the file ends as a finished recording does."""
    return len(view) >= 2 * len(MAGIC) and view[-len(MAGIC):] == MAGIC
