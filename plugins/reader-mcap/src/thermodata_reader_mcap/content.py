"""A recording's messages in the order of the file, with its channels and schemas, and what is damaged."""

from __future__ import annotations

import mmap
import struct
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import numpy.typing as npt

from thermodata.errors import FormatError
from thermodata.plugin import Loss
from thermodata_reader_mcap.chunk import ChunkError, records
from thermodata_reader_mcap.walk import (
    ATTACHMENT,
    CHANNEL,
    CHUNK,
    MAGIC,
    MESSAGE,
    MESSAGE_INDEX,
    SCHEMA,
    Damage,
    Record,
    chunk_head,
    data_section,
)

_RECORD = struct.Struct("<BQ")
LATEST_NS = 9_000_000_000_000_000_000


@dataclass(frozen=True, slots=True)
class Schema:
    name: str
    encoding: str
    data: bytes


@dataclass(frozen=True, slots=True)
class Channel:
    topic: str
    encoding: str
    schema: Schema | None


@dataclass(slots=True)
class Batch:
    """Messages of one channel: payloads, and parts of their log and publish times [ns], uint64."""

    payloads: list[bytes] = field(default_factory=list)
    log_ns: list[npt.NDArray[np.uint64]] = field(default_factory=list)
    publish_ns: list[npt.NDArray[np.uint64]] = field(default_factory=list)

    def times(self) -> tuple[npt.NDArray[np.uint64], npt.NDArray[np.uint64]]:
        """All log and publish times, shape (n,) each."""
        none = [np.empty(0, np.uint64)]
        return np.concatenate(self.log_ns or none), np.concatenate(self.publish_ns or none)


@dataclass(slots=True)
class Content:
    """What a walk has met so far."""

    name: str
    size: int
    channels: dict[int, Channel] = field(default_factory=dict)
    schemas: dict[int, Schema] = field(default_factory=dict)
    attachments: int = 0
    pending: int = 0                 # bytes of messages taken since the batches were emptied
    last_ns: int | None = None

    def loss(self, start: int, stop: int, reason: str, from_ns: int | None = None, to_ns: int | None = None) -> Loss:
        """A loss of bytes of the file, dated by the chunk or by the last message before."""
        first = self.last_ns if from_ns is None else from_ns
        last = to_ns if to_ns is None or first is None or to_ns >= first else None
        return Loss(f"{self.name} byte {start}", first, last, min(1.0, (stop - start) / max(1, self.size)), reason)


@contextmanager
def opened(path: Path) -> Iterator[memoryview]:
    """The file's bytes, mapped; FormatError where it is empty or no MCAP."""
    with path.open("rb") as file:
        start = file.read(len(MAGIC))
        if start != MAGIC:
            raise FormatError("not an MCAP file", where=path.name, expected=repr(MAGIC), got=repr(start))
        mapped = mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ)
    view = memoryview(mapped)
    try:
        yield view
    finally:
        with suppress(BufferError):          # a payload that somebody still holds points into it
            view.release()
            mapped.close()


Pick = Callable[[int], bool]


def walk(view: memoryview, content: Content, into: dict[int, Batch], full: Callable[[], bool],
         wanted: Pick | None = None) -> Iterator[Loss | None]:
    """Walks the data section: messages go `into` a batch a channel; yields None whenever full() says that the
    batches should be emptied, and each loss. wanted(k): whether to open the k-th chunk (default: all)."""
    number = -1
    waiting: tuple[Record, list[npt.NDArray[np.int64]]] | None = None      # a chunk, and the indexes behind it

    def opened_chunk() -> Iterator[Loss | None]:
        nonlocal waiting
        if waiting is None:
            return
        record, index = waiting
        waiting = None
        loss = _chunk(view, record, content, into, number, index)
        if loss is not None:
            yield None
            yield loss
        if full():
            yield None

    for record in data_section(view):
        if isinstance(record, Record) and record.opcode == MESSAGE_INDEX and not record.cut:
            if waiting is not None and (record.stop - record.start - 6) % 16 == 0:
                entries = np.frombuffer(view[record.start + 6:record.stop], "<u8").reshape(-1, 2)
                waiting[1].append(entries[:, 1].astype(np.int64))
            continue
        yield from opened_chunk()
        if isinstance(record, Damage):
            yield None
            yield content.loss(record.start, record.stop, record.reason)
        elif record.opcode == CHUNK:
            number += 1
            if wanted is None or wanted(number):
                waiting = (record, [])
        elif record.cut:
            yield None
            yield content.loss(record.start - 9, record.stop, "the file ends inside a record: it was cut")
        else:
            _one(view, record, content, into)
            if full():
                yield None
    yield from opened_chunk()


def _chunk(view: memoryview, record: Record, content: Content, into: dict[int, Batch], number: int,
           index: list[npt.NDArray[np.int64]]) -> Loss | None:
    head = chunk_head(view, record)
    if head is None:
        return content.loss(record.start - 9, record.stop, f"chunk {number}: its header contradicts itself or is cut")
    times = (head.start_ns, head.end_ns) if head.start_ns <= head.end_ns < LATEST_NS else (None, None)
    try:
        inner = records(view, head, record.cut)
    except ChunkError as error:
        return content.loss(record.start - 9, record.stop, f"chunk {number}: {error}", *times)
    content.pending += len(inner)
    used = _indexed(inner, content, into, index) if index and not record.cut else None
    if used is None:
        used = _messages(inner, content, into)
    if record.cut:
        missing = 1 - used / head.size if head.size else 0.0
        first = content.last_ns if used else times[0]
        return content.loss(record.start - 9 + round((record.stop - record.start) * (1 - missing)), record.stop,
                            f"chunk {number}: the file ends inside it; {100 * missing:.0f} % of the chunk is lost",
                            first, times[1])
    if used != len(inner):
        return content.loss(record.start - 9, record.stop, f"chunk {number}: a record in it runs past its end", *times)
    return None


def _indexed(inner: bytes, content: Content, into: dict[int, Batch],
             index: list[npt.NDArray[np.int64]]) -> int | None:
    """The same as _messages, where the chunk's index names every message: nothing is walked but what lies between
    them. None where the index and the records do not agree: then the records are right."""
    at = np.sort(np.concatenate(index))
    if not at.size or at[0] < 0 or at[-1] + 31 > len(inner):
        return None
    heads = np.frombuffer(inner, np.uint8)[at[:, None] + np.arange(9)]
    stops = at + 9 + np.ascontiguousarray(heads[:, 1:9]).view("<i8")[:, 0]
    ends, starts = np.concatenate([[0], stops]), np.concatenate([at, [len(inner)]])
    if (heads[:, 0] != MESSAGE).any() or (starts < ends).any() or (stops < at + 31).any():
        return None
    others: list[Record] = []
    for gap in np.flatnonzero(starts != ends).tolist():
        place, stop = int(ends[gap]), int(starts[gap])
        while place < stop:
            if place + 9 > stop:
                return None
            opcode, length = _RECORD.unpack_from(inner, place)
            if opcode == MESSAGE:
                return None
            others.append(Record(opcode, place + 9, place + 9 + length))
            place += 9 + length
        if place != stop:
            return None
    for record in others:
        _one(memoryview(inner), record, content, into)
    _take(inner, at, content, into)
    return len(inner)


def _messages(inner: bytes, content: Content, into: dict[int, Batch]) -> int:
    """Takes the records of a chunk; returns how many bytes of whole records there were."""
    at, size, unpack = 0, len(inner), _RECORD.unpack_from
    found: list[int] = []
    add = found.append
    while at + 9 <= size:
        opcode, length = unpack(inner, at)
        stop = at + 9 + length
        if stop > size:
            break
        if opcode == MESSAGE and length >= 22:
            add(at)
        else:
            _one(memoryview(inner), Record(opcode, at + 9, stop), content, into)
        at = stop
    if found:
        _take(inner, np.array(found, np.int64), content, into)
    return at


def _take(inner: bytes, at: npt.NDArray[np.int64], content: Content, into: dict[int, Batch]) -> None:
    """Puts the messages whose records begin at these places into the batches of their channels."""
    data = np.frombuffer(inner, np.uint8)
    heads = data[at[:, None] + np.arange(31)]
    channels = np.ascontiguousarray(heads[:, 9:11]).view("<u2")[:, 0]
    starts, stops = at + 31, at + 9 + np.ascontiguousarray(heads[:, 1:9]).view("<i8")[:, 0]
    log_ns = np.ascontiguousarray(heads[:, 15:23]).view("<u8")[:, 0]
    publish_ns = np.ascontiguousarray(heads[:, 23:31]).view("<u8")[:, 0]
    content.last_ns = int(log_ns[-1])
    targets: dict[int, tuple[Batch, list[int]]] = {}
    for channel in np.unique(channels).tolist():
        batch = into.setdefault(channel, Batch())
        targets.setdefault(id(batch), (batch, []))[1].append(channel)
    for batch, members in targets.values():
        mine = slice(None) if len(targets) == 1 else np.isin(channels, members)
        batch.payloads += [inner[a:b] for a, b in zip(starts[mine].tolist(), stops[mine].tolist(), strict=True)]
        batch.log_ns.append(log_ns[mine])
        batch.publish_ns.append(publish_ns[mine])


def _one(view: memoryview, record: Record, content: Content, into: dict[int, Batch]) -> None:
    body = view[record.start:record.stop]
    if record.opcode == MESSAGE and len(body) >= 22:
        content.pending += len(body)
        _take(bytes(view[record.start - 9:record.stop]), np.zeros(1, np.int64), content, into)
        return
    try:
        _definition(body, record.opcode, content)
    except struct.error:                         # shorter than its kind: a damaged definition defines nothing
        return


def _definition(body: memoryview, opcode: int, content: Content) -> None:
    if opcode == SCHEMA:
        (number,) = struct.unpack_from("<H", body)
        name, at = _text(body, 2)
        encoding, at = _text(body, at)
        (size,) = struct.unpack_from("<I", body, at)
        content.schemas[number] = Schema(name, encoding, bytes(body[at + 4:at + 4 + size]))
    elif opcode == CHANNEL:
        number, schema = struct.unpack_from("<HH", body)
        topic, at = _text(body, 4)
        encoding, _ = _text(body, at)
        content.channels[number] = Channel(topic or f"channel {number}", encoding, content.schemas.get(schema))
    elif opcode == ATTACHMENT:
        content.attachments += 1


def _text(body: memoryview, at: int) -> tuple[str, int]:
    (size,) = struct.unpack_from("<I", body, at)
    return bytes(body[at + 4:at + 4 + size]).decode("utf-8", "replace"), at + 4 + size
