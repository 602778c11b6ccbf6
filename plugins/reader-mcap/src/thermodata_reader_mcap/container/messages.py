"""A recording's messages in the order of the file, with its channels and schemas, and what is damaged."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterator
from contextlib import suppress
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from thermodata.plugin import Loss
from thermodata_reader_mcap.container.chunk_records import chunk_parts
from thermodata_reader_mcap.container.chunks import ChunkError, records
from thermodata_reader_mcap.container.data_section import Damage, data_section
from thermodata_reader_mcap.container.definitions import Definitions
from thermodata_reader_mcap.container.message_batches import Batch, Key, take
from thermodata_reader_mcap.container.records import (
    CHANNEL,
    CHUNK,
    HEAD,
    HEADER,
    MESSAGE,
    MESSAGE_INDEX,
    PRIVATE,
    SCHEMA,
    Bytes,
    Record,
    ShortError,
    chunk_head,
    octets,
)

LATEST_NS = 9_000_000_000_000_000_000
_PIECE = 16 << 20  # of a chunk that is taken at a time
_LOOSE = 2000  # messages outside of chunks that are taken at a time


@dataclass(slots=True)
class Content:
    """What a walk has met so far. key: what a channel's messages are kept apart by, None where they are not wanted.
    counts: messages by channel id; undefined: those of ids that nothing defines; foreign: records by unknown kind.
    """

    name: str
    size: int
    definitions: Definitions = field(default_factory=Definitions)
    key: Key = lambda channel: channel
    batches: dict[Hashable, Batch] = field(default_factory=dict)
    counts: dict[int, int] = field(default_factory=dict)
    undefined: dict[int, int] = field(default_factory=dict)
    foreign: dict[int, int] = field(default_factory=dict)
    recordings: int = 0  # headers: more than one where files were joined
    pending: int = 0  # bytes of messages taken since the batches were emptied
    last_ns: int | None = None
    chunk: tuple[int, int] | None = None  # number and first byte of the one that is taken; None outside of any
    follow: Callable[[Bytes, npt.NDArray[np.int64]], None] | None = None  # sees all messages as they are taken

    def loss(self, start: int, stop: int, reason: str, from_ns: int | None = None, to_ns: int | None = None) -> Loss:
        """A loss of bytes of the file, dated by the chunk or by the last message before."""
        first = self.last_ns if from_ns is None else from_ns
        last = to_ns if to_ns is None or first is None or to_ns >= first else None
        place = f"bytes {start} to {stop}" if stop > start else f"byte {start}"
        return Loss(f"{self.name} {place}", first, last, min(1.0, (stop - start) / max(1, self.size)), reason)


def collect_messages(
    view: memoryview, content: Content, full: Callable[[], bool], wanted: Callable[[int], bool] | None = None
) -> Iterator[Loss | None]:
    """Walks the data section: messages go into the content's batches; yields None whenever full() says that these
    should be emptied, and each loss. wanted(k): whether to open the k-th chunk (default: all)."""
    number = -1
    waiting: tuple[Record, list[npt.NDArray[np.int64]]] | None = None  # a chunk, and the indexes behind it

    loose: list[int] = []  # messages outside of chunks
    for record in data_section(view):
        if isinstance(record, Record) and record.opcode == MESSAGE and not record.cut:
            if waiting is not None:
                yield from _chunk(view, waiting[0], content, number, waiting[1], full)
                waiting = None
            loose.append(record.start - HEAD.size)
            content.pending += record.stop - record.start
            if len(loose) >= _LOOSE or content.pending >= _PIECE:
                _take_messages(view, np.array(loose, np.int64), content)
                loose = []
                if full():
                    yield None
            continue
        if loose:
            _take_messages(view, np.array(loose, np.int64), content)
            loose = []
        if isinstance(record, Record) and record.opcode == MESSAGE_INDEX and not record.cut:
            if waiting is not None:
                entries = np.frombuffer(octets(view, record.start + 2, record.stop)[0], "<u8").reshape(-1, 2)
                waiting[1].append(entries[:, 1].astype(np.int64))
            continue
        if waiting is not None:
            yield from _chunk(view, waiting[0], content, number, waiting[1], full)
            waiting = None
        if isinstance(record, Damage):
            yield None
            yield content.loss(record.start, record.stop, record.reason)
        elif record.opcode == CHUNK:
            number += 1
            if wanted is None or wanted(number):
                waiting = (record, [])
        elif record.cut:
            yield None
            yield content.loss(record.start - HEAD.size, record.stop, "the file ends inside a record: it was cut")
        else:
            define(view[record.start : record.stop], record.opcode, content)
            if full():
                yield None
    if loose:
        _take_messages(view, np.array(loose, np.int64), content)
    if waiting is not None:
        yield from _chunk(view, waiting[0], content, number, waiting[1], full)


def _chunk(
    view: memoryview,
    record: Record,
    content: Content,
    number: int,
    index: list[npt.NDArray[np.int64]],
    full: Callable[[], bool],
) -> Iterator[Loss | None]:
    begin, stop, before = record.start - HEAD.size, record.stop, content.last_ns
    head = chunk_head(view, record)
    if head is None:
        yield None
        yield content.loss(begin, stop, f"chunk {number}: its header contradicts itself or is cut")
        return
    times = (head.start_ns, head.end_ns) if 0 < head.start_ns <= head.end_ns < LATEST_NS else (None, None)
    try:
        inner = records(view, head, record.cut)
    except ChunkError as error:
        yield None
        yield content.loss(begin, stop, f"chunk {number}: {error}", *times)
        return
    used, lost = 0, 0
    content.chunk = (number, begin)
    for part in chunk_parts(inner, [] if record.cut else index):
        if isinstance(part, Damage):
            if not record.cut or part.stop < len(inner):
                lost += part.stop - part.start
            continue
        used = part.stop
        for body, opcode in part.definitions:
            define(body, opcode, content)
        for at in _slices(part.messages):
            content.pending += int(at[-1] - at[0]) + len(inner) - int(part.messages[-1])
            _take_messages(inner, at, content)
            if full():
                yield None
    content.chunk = None
    if record.cut:
        missing = 1 - used / head.size if head.size else 0.0
        yield None
        yield content.loss(
            begin + round((stop - begin) * (1 - missing)),
            stop,
            f"chunk {number}: the file ends inside it; {100 * missing:.0f} % of the chunk is lost",
            content.last_ns if used else times[0] or before,
            times[1],
        )
    if lost:
        yield None
        yield content.loss(begin, stop, f"chunk {number}: {lost} of its {len(inner)} bytes are no records", *times)
    if full():
        yield None


def _slices(at: npt.NDArray[np.int64]) -> Iterator[npt.NDArray[np.int64]]:
    if at.size:
        for part in np.split(at, np.searchsorted(at, np.arange(at[0] + _PIECE, at[-1] + 1, _PIECE))):
            if part.size:
                yield part


def _take_messages(inner: Bytes, at: npt.NDArray[np.int64], content: Content) -> None:
    if content.follow is not None:
        content.follow(inner, at)
    log_ns = take(
        inner, at, content.definitions.channel, content.key, content.batches, content.counts, content.undefined
    )
    content.last_ns = int(log_ns[-1]) if log_ns[-1] < LATEST_NS else content.last_ns


def define(body: Bytes, opcode: int, content: Content) -> None:
    """Takes a record that is no message. One that is shorter than its kind defines nothing."""
    if opcode in (SCHEMA, CHANNEL):
        with suppress(ShortError):
            content.definitions.define(opcode, body)
    elif opcode == HEADER:
        content.recordings += 1
    elif opcode >= PRIVATE:
        content.foreign[opcode] = content.foreign.get(opcode, 0) + 1
