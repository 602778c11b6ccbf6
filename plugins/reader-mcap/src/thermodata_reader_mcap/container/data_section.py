"""The records of an MCAP file, walked in place; a damaged stretch is named, and the walk goes on behind it.

Layout (mcap.dev/spec): a magic, then records of opcode (1 byte), length (8) and content; messages stand in the
data section itself or inside (compressed) chunks.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator
from dataclasses import dataclass

from thermodata_reader_mcap.container.mapped_file import MAPPED, release_pages
from thermodata_reader_mcap.container.records import (
    CHUNK,
    CHUNKS,
    DATA_END,
    FOOTER,
    HEAD,
    HEADER,
    IN_DATA,
    IN_SUMMARY,
    MAGIC,
    MESSAGE,
    MESSAGES,
    PRIVATE,
    Record,
    chunk_head,
    content_end,
    fits,
)
from thermodata_reader_mcap.container.resync import next_record

_FOOTER_BYTES = 20


@dataclass(frozen=True, slots=True)
class Damage:
    """Bytes that are no record, up to the next one or the end of the file. start == stop: nothing but the rest
    of the file is missing."""

    start: int
    stop: int
    reason: str


def data_section(view: memoryview) -> Iterator[Record | Damage]:
    """The records up to the end of the data section. Indexes and statistics behind it are not needed."""
    at, first, size, gone = len(MAGIC), len(MAGIC), len(view), 0
    while at < size:
        if at - gone > MAPPED:
            gone = release_pages(view, gone, at)
        if view[at:] == MAGIC:
            return
        if at + HEAD.size > size:
            yield Damage(at, size, "the file ends inside a record's head: it was cut")
            return
        opcode, length = HEAD.unpack_from(view, at)
        stop = at + HEAD.size + length
        record = Record(opcode, at + HEAD.size, min(stop, size), stop > size)
        if opcode in (DATA_END, FOOTER) or opcode in IN_SUMMARY - IN_DATA:
            end = end_of_file(view, at)
            if end == size:
                return
            if end is not None and view[end : end + len(MAGIC)] == MAGIC:  # recordings joined into one file
                at = first = end + len(MAGIC)
                continue
        elif not record.cut and _is_sound(view, record, first):
            yield record
            at = stop
            continue
        ended = opcode == DATA_END and length == 4
        # what looks like records inside of a cut chunk that is not compressed is the chunk's own
        inside = opcode == CHUNK and record.cut and _may_be_cut(view, record)
        following = next_record(view, at + 1, kinds=CHUNKS if inside else MESSAGES if ended else IN_DATA)
        if ended and following is None:
            return  # only what stands behind the data is damaged
        if record.cut and following is None and _may_be_cut(view, record):
            yield record
            return
        stop = size if following is None else following
        yield Damage(at, stop, f"no record at byte {at} (opcode {opcode}, length {length})")
        at = stop
    yield Damage(size, size, "the file ends without the end of its data: it was cut")


def _is_sound(view: memoryview, record: Record, first: int) -> bool:
    """Whether a record is what its head says; `first` is where the only header may stand. A length that a wrong bit
    made longer would swallow what follows."""
    if record.opcode == HEADER and record.start != first + HEAD.size:
        return False
    if record.opcode not in IN_DATA and record.opcode < PRIVATE:
        return False
    if record.opcode in IN_DATA and record.opcode != MESSAGE:
        end = content_end(view, record)
        return end == record.stop or (end is not None and _goes_on(view, record.stop) and fits(view, end) is None)
    if record.opcode == MESSAGE and content_end(view, record) is None:
        return False
    return _goes_on(view, record.stop) or next_record(view, record.start, record.stop) is None


def _goes_on(view: memoryview, at: int) -> bool:
    """Whether a record, or the end of the file, stands at a place."""
    if at == len(view) or view[at:] == MAGIC or at + HEAD.size > len(view):
        return True
    opcode, length = HEAD.unpack_from(view, at)
    if opcode not in IN_DATA and opcode not in IN_SUMMARY and opcode not in (DATA_END, FOOTER) and opcode < PRIVATE:
        return False
    return at + HEAD.size + length <= len(view) or opcode in (CHUNK, MESSAGE)


def _may_be_cut(view: memoryview, record: Record) -> bool:
    if record.opcode not in IN_DATA:
        return False
    if record.opcode != CHUNK:
        return True
    head = chunk_head(view, record)
    (length,) = struct.unpack_from("<Q", view, record.start - 8)
    return head is not None and head.start - record.start + head.stored == length


def end_of_file(view: memoryview, at: int) -> int | None:
    """Where the recording stops whose data end here: its mark, then a summary (or what a cut left of one), the
    footer and the magic. None where the data do not end: a wrong bit can make any record look like the end."""
    size = len(view)
    (opcode, length), marked = HEAD.unpack_from(view, at), False
    if opcode == DATA_END:
        if length != 4:
            return None
        at, marked = at + HEAD.size + length, True
    while at < size:
        if view[at:] == MAGIC or (marked and at + HEAD.size > size):
            return size
        if at + HEAD.size > size:
            return None
        opcode, length = HEAD.unpack_from(view, at)
        stop = at + HEAD.size + length
        if opcode == FOOTER:
            ended = length == _FOOTER_BYTES and MAGIC.startswith(bytes(view[stop : stop + len(MAGIC)]))
            return min(stop + len(MAGIC), size) if ended else None
        if opcode not in IN_SUMMARY or (stop <= size and fits(view, at, IN_SUMMARY) is None):
            return None
        at = stop
    return size if marked or at == size else None


def is_complete(view: memoryview) -> bool:
    """Whether the file ends as a finished recording does."""
    return len(view) >= 2 * len(MAGIC) and view[-len(MAGIC) :] == MAGIC
