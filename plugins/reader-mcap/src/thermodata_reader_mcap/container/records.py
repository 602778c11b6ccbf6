"""What an MCAP record looks like: its kinds, its head, and how long its content says it is (mcap.dev/spec)."""

from __future__ import annotations

import struct
from collections.abc import Callable
from dataclasses import dataclass

MAGIC = b"\x89MCAP0\r\n"
HEADER, FOOTER, SCHEMA, CHANNEL, MESSAGE, CHUNK, MESSAGE_INDEX = 1, 2, 3, 4, 5, 6, 7
CHUNK_INDEX, ATTACHMENT, ATTACHMENT_INDEX, STATISTICS, METADATA, METADATA_INDEX = 8, 9, 10, 11, 12, 13
SUMMARY_OFFSET = 14
DATA_END = 15
IN_DATA = frozenset({HEADER, SCHEMA, CHANNEL, MESSAGE, CHUNK, MESSAGE_INDEX, ATTACHMENT, METADATA})
IN_SUMMARY = frozenset({SCHEMA, CHANNEL, CHUNK_INDEX, ATTACHMENT_INDEX, STATISTICS, METADATA_INDEX, SUMMARY_OFFSET})
MESSAGES = frozenset({MESSAGE, CHUNK, MESSAGE_INDEX})
CHUNKS = frozenset({CHUNK})
PRIVATE = 0x80  # opcodes from here on belong to applications
HEAD = struct.Struct("<BQ")
MESSAGE_HEAD = 22  # channel, sequence, log time, publish time
_U16, _U32, _U64 = struct.Struct("<H"), struct.Struct("<I"), struct.Struct("<Q")
_CHUNK = struct.Struct("<QQQI")
Bytes = bytes | memoryview


@dataclass(frozen=True, slots=True)
class Record:
    """A record: `start` and `stop` bound its content. cut: the file ends inside it."""

    opcode: int
    start: int
    stop: int
    cut: bool = False


@dataclass(frozen=True, slots=True)
class ChunkHead:
    """A chunk's header; `start` and `stop` bound its records as stored, `size` is what they unpack to;
    `stored` is how many bytes of them there should be."""

    start_ns: int
    end_ns: int
    size: int
    crc: int
    compression: str
    start: int
    stop: int
    stored: int


class ShortError(Exception):
    """A record whose content ends before its fields do."""


def number(view: Bytes, at: int, stop: int, kind: struct.Struct) -> tuple[int, int]:
    """A number and where it ends."""
    if at + kind.size > stop:
        raise ShortError
    return kind.unpack_from(view, at)[0], at + kind.size


def u16(view: Bytes, at: int, stop: int) -> tuple[int, int]:
    """A number of 2 bytes and where it ends. ShortError."""
    return number(view, at, stop, _U16)


def u32(view: Bytes, at: int, stop: int) -> tuple[int, int]:
    """A number of 4 bytes and where it ends. ShortError."""
    return number(view, at, stop, _U32)


def u64(view: Bytes, at: int, stop: int) -> tuple[int, int]:
    """A number of 8 bytes and where it ends. ShortError."""
    return number(view, at, stop, _U64)


def octets(view: Bytes, at: int, stop: int) -> tuple[Bytes, int]:
    """Bytes behind their length of 4 bytes (text, maps and arrays are stored so), and where they end."""
    size, at = u32(view, at, stop)
    if at + size > stop:
        raise ShortError
    return view[at : at + size], at + size


def text(view: Bytes, at: int, stop: int) -> tuple[str, int]:
    """A text and where it ends."""
    stored, at = octets(view, at, stop)
    return bytes(stored).decode("utf-8", "replace"), at


def text_map(view: Bytes, at: int, stop: int) -> tuple[dict[str, str], int]:
    """A map of texts and where it ends."""
    stored, end = octets(view, at, stop)
    found, at = dict[str, str](), 0
    while at < len(stored):
        key, at = text(stored, at, len(stored))
        found[key], at = text(stored, at, len(stored))
    return found, end


def chunk_head(view: Bytes, record: Record) -> ChunkHead | None:
    """A chunk's header; None where the chunk is cut inside it or contradicts itself."""
    if record.stop - record.start < 40:
        return None
    start_ns, end_ns, size, crc = _CHUNK.unpack_from(view, record.start)
    try:
        name, at = octets(view, record.start + 28, record.stop)
        stored, at = u64(view, at, record.stop)
    except ShortError:
        return None
    if len(name) > 16 or (not record.cut and at + stored > record.stop):
        return None
    return ChunkHead(
        start_ns, end_ns, size, crc, bytes(name).decode("ascii", "replace"), at, min(at + stored, record.stop), stored
    )


def _schema(view: Bytes, at: int, stop: int) -> int:
    _, at = u16(view, at, stop)
    for _ in range(3):
        _, at = octets(view, at, stop)
    return at


def _channel(view: Bytes, at: int, stop: int) -> int:
    _, at = u32(view, at, stop)
    for _ in range(2):
        _, at = octets(view, at, stop)
    return text_map(view, at, stop)[1]


def _message(view: Bytes, at: int, stop: int) -> int:
    if stop - at < MESSAGE_HEAD:
        raise ShortError
    return stop


def _chunk(view: Bytes, at: int, stop: int) -> int:
    head = chunk_head(view, Record(CHUNK, at, stop))
    if head is None:
        raise ShortError
    return head.stop


def _message_index(view: Bytes, at: int, stop: int) -> int:
    entries, end = octets(view, at + 2, stop)
    if len(entries) % 16:
        raise ShortError
    return end


def _attachment(view: Bytes, at: int, stop: int) -> int:
    _, at = octets(view, at + 16, stop)
    _, at = octets(view, at, stop)
    size, at = u64(view, at, stop)
    if at + size + 4 > stop:
        raise ShortError
    return at + size + 4


def _header(view: Bytes, at: int, stop: int) -> int:
    _, at = octets(view, at, stop)
    return octets(view, at, stop)[1]


def _metadata(view: Bytes, at: int, stop: int) -> int:
    _, at = octets(view, at, stop)
    return text_map(view, at, stop)[1]


def _chunk_index(view: Bytes, at: int, stop: int) -> int:
    _, at = octets(view, at + 32, stop)
    _, at = octets(view, at + 8, stop)
    return at + 16


def _attachment_index(view: Bytes, at: int, stop: int) -> int:
    return _header(view, at + 40, stop)


def _statistics(view: Bytes, at: int, stop: int) -> int:
    return octets(view, at + 42, stop)[1]


def _metadata_index(view: Bytes, at: int, stop: int) -> int:
    return octets(view, at + 16, stop)[1]


def _summary_offset(view: Bytes, at: int, stop: int) -> int:
    return at + 17


_ENDS: dict[int, Callable[[Bytes, int, int], int]] = {
    HEADER: _header,
    SCHEMA: _schema,
    CHANNEL: _channel,
    MESSAGE: _message,
    CHUNK: _chunk,
    MESSAGE_INDEX: _message_index,
    ATTACHMENT: _attachment,
    METADATA: _metadata,
    CHUNK_INDEX: _chunk_index,
    ATTACHMENT_INDEX: _attachment_index,
    STATISTICS: _statistics,
    METADATA_INDEX: _metadata_index,
    SUMMARY_OFFSET: _summary_offset,
}


def content_end(view: Bytes, record: Record) -> int | None:
    """Where a record's content ends by its own fields (later versions may add some behind them); `stop` for kinds
    that do not say, None where the fields contradict the length."""
    end = _ENDS.get(record.opcode)
    if end is None:
        return record.stop
    try:
        found = end(view, record.start, record.stop)
    except ShortError:
        return None
    return found if found <= record.stop else None


def fits(view: Bytes, at: int, kinds: frozenset[int] = IN_DATA) -> int | None:
    """Where the record that begins at a place ends, if one of these kinds does begin there and fills its length."""
    if at + HEAD.size > len(view):
        return None
    opcode, length = HEAD.unpack_from(view, at)
    stop = at + HEAD.size + length
    if opcode not in kinds or stop > len(view):
        return None
    return stop if content_end(view, Record(opcode, at + HEAD.size, stop)) == stop else None
