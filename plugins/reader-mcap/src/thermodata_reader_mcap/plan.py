"""The first look at a recording: its topics and their signals, by samples of its chunks."""

from __future__ import annotations

import struct
from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from fnmatch import fnmatchcase

import numpy as np

from thermodata.errors import FormatError
from thermodata.plugin import Source
from thermodata_reader_mcap.columns import Topic
from thermodata_reader_mcap.content import LATEST_NS, Batch, Channel, Content, walk
from thermodata_reader_mcap.decoders import UnsupportedError, decoder
from thermodata_reader_mcap.leaves import find_leaves, json_schema
from thermodata_reader_mcap.walk import CHUNK, MESSAGE_INDEX, Damage, chunk_head, data_section

WHOLE = 8 << 20          # uncompressed bytes that are looked at completely
_SEARCHED = 64 << 20     # the same, of a file whose chunks do not say which topics they hold
_DECODED = 1 << 20       # payload bytes of a topic that are decoded for its signals
EARLIEST_NS = 10**17     # log times before 1973 count from the start of the recording


@dataclass(slots=True)
class Plan:
    """topics: channel -> what its messages are. publish: topics whose publish times differ from the log times."""

    topics: dict[int, Topic]
    publish: frozenset[str]
    unsupported: dict[str, str]
    start_ns: int | None
    relative: bool
    notes: list[str]


@dataclass(slots=True)
class _Chunks:
    sizes: list[int] = field(default_factory=list)
    channels: list[set[int]] = field(default_factory=list)


def _survey(view: memoryview) -> _Chunks:
    """Sizes of the chunks and the channels that the indexes behind them name, without opening any."""
    found = _Chunks()
    for record in data_section(view):
        if isinstance(record, Damage):
            continue
        if record.opcode == CHUNK:
            head = chunk_head(view, record)
            found.sizes.append(head.size if head is not None else 0)
            found.channels.append(set())
        elif record.opcode == MESSAGE_INDEX and found.channels and not record.cut and record.stop - record.start >= 6:
            channel, size = struct.unpack_from("<HI", view, record.start)
            if size:
                found.channels[-1].add(channel)
    return found


def _chosen(chunks: _Chunks) -> set[int] | None:
    """Which chunks to open; None for all."""
    total, count = sum(chunks.sizes), len(chunks.sizes)
    if total <= WHOLE:
        return None
    if not all(chunks.channels):
        if total <= _SEARCHED:
            return None
        return {0, 1, count - 1, *(count * k // 16 for k in range(16))}
    chosen = {0, count - 1, *(count * k // 6 for k in range(6))}
    for channel in set().union(*chunks.channels):
        places = [k for k, inside in enumerate(chunks.channels) if channel in inside]
        chosen |= {places[0], places[-1]}
    return chosen


def wanted_topic(topic: str, source: Source) -> bool:
    """Whether a source's topics ask for this one; `*` stands for anything, no topics for all."""
    return not source.topics or any(t == topic or fnmatchcase(topic, t) for t in source.topics)


def plan(view: memoryview, name: str, source: Source) -> Plan:
    """The topics of a recording. FormatError: a declared topic is missing, or no topic can be read."""
    chunks = _survey(view)
    chosen = _chosen(chunks)
    content, batches = Content(name, len(view)), dict[int, Batch]()
    wanted, whole = None if chosen is None else chosen.__contains__, chosen is None
    for _ in walk(view, content, batches, lambda: content.pending >= WHOLE, wanted):
        if not chunks.sizes and content.pending >= WHOLE:   # messages outside of chunks: their head must do
            whole = False
            break
    topics: dict[int, Topic] = {}
    publish, unsupported, notes = set(), dict[str, str](), list[str]()
    by_topic: dict[str, list[int]] = {}
    for number, channel in content.channels.items():
        if wanted_topic(channel.topic, source):
            by_topic.setdefault(channel.topic, []).append(number)
    _refuse_missing(source, content.channels.values(), name)
    for topic, numbers in by_topic.items():
        filled = [n for n in numbers if batches.get(n) and batches[n].payloads]
        if not filled:
            continue
        made, problem = _topic(topic, {n: content.channels[n] for n in filled}, batches, whole, notes)
        if problem:
            unsupported[topic] = problem
        topics.update(made)
        if made and any(_differ(batches[n]) for n in filled):
            publish.add(topic)
    if unsupported and not topics:
        listed = "; ".join(f"{t}: {why}" for t, why in unsupported.items())
        raise FormatError("no topic of this recording can be read", where=name,
                          expected="json, cdr or protobuf messages", got=listed)
    notes += [f"topic '{t}' is not read: {why}" for t, why in unsupported.items()]
    if content.attachments:
        notes.append(f"{content.attachments} attachments are not read")
    times = np.concatenate([np.empty(0, np.uint64), *(batches[n].times()[0] for n in topics)])
    times = times[times < LATEST_NS]
    relative = times.size > 0 and int(times.max()) < EARLIEST_NS
    if relative:
        notes.append("log times count from the start of the recording")
    return Plan(topics, frozenset(publish), unsupported, int(times.min()) if times.size else None, relative, notes)


def _differ(batch: Batch) -> bool:
    log_ns, publish_ns = batch.times()
    return not np.array_equal(log_ns, publish_ns)


def _refuse_missing(source: Source, channels: Iterable[Channel], name: str) -> None:
    present = sorted({c.topic for c in channels})
    for wanted in source.topics:
        if not any(t == wanted or fnmatchcase(t, wanted) for t in present):
            raise FormatError(f"no topic '{wanted}'", where=name, expected=", ".join(present) or "the file has none",
                              got=wanted)


def _topic(name: str, channels: dict[int, Channel], batches: dict[int, Batch], all_seen: bool,
           notes: list[str]) -> tuple[dict[int, Topic], str | None]:
    """Channel -> topic for one topic's channels, and why one of them cannot be read."""
    made: dict[int, Topic] = {}
    problem = None
    messages, exact, schema = [], all_seen, None
    for number, channel in channels.items():
        try:
            decode = decoder(channel)
        except UnsupportedError as error:
            problem = str(error)
            continue
        sampled, whole = _decoded(decode, batches[number].payloads)
        messages += sampled
        exact &= whole
        if channel.schema is not None and channel.schema.encoding == "jsonschema":
            schema = schema or json_schema(channel.schema.data)
        made[number] = Topic(name, (), decode, channel.encoding == "json")
    objects = sum(isinstance(m, dict) for m in messages)
    wrapped = objects * 2 < len(messages)
    kept = [m for m in messages if isinstance(m, dict) != wrapped]
    leaves, more = find_leaves(name, kept, schema, exact)
    notes += more
    if not leaves:
        return {}, problem or ("no message decodes" if not messages else None)
    return {n: replace(t, leaves=leaves, wrapped=wrapped) for n, t in made.items()}, problem


def _decoded(decode: object, payloads: list[bytes]) -> tuple[list[object], bool]:
    """Sampled messages as Python values, and whether they are all."""
    size = sum(map(len, payloads))
    step = 1 if size <= _DECODED else -(-4 * size // _DECODED)
    result = []
    for payload in [*payloads[::step], *(payloads[-1:] if step > 1 else [])]:
        try:
            result.append(decode(payload))  # type: ignore[operator]
        except Exception:                                   # counted and named when it is read
            continue
    return result, step == 1
