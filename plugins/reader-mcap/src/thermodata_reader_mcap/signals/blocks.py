"""Batches of messages as blocks, and what in them does not read."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator, Sequence
from concurrent.futures import Executor, Future
from dataclasses import dataclass, field

import numpy as np

from thermodata.plugin import Array, Block, Int1D, Loss, Source
from thermodata.schema.flag import Flag
from thermodata.schema.words.sentences import counted
from thermodata_reader_mcap.container.definitions import Channel
from thermodata_reader_mcap.container.message_batches import U64, Batch
from thermodata_reader_mcap.container.messages import LATEST_NS, Content
from thermodata_reader_mcap.encodings.columns import MISSING, Columns, Wrong, merged
from thermodata_reader_mcap.encodings.decoder import Decoder, UnsupportedError
from thermodata_reader_mcap.encodings.decoders import columns, decoder
from thermodata_reader_mcap.encodings.named_elements import NamedDecoder
from thermodata_reader_mcap.encodings.topic import Topic, time_name
from thermodata_reader_mcap.signals.options import LOG, PUBLISH
from thermodata_reader_mcap.signals.plan import Plan, wanted_topic
from thermodata_reader_mcap.signals.samples.batches_of_samples import parted
from thermodata_reader_mcap.signals.stamps.header_stamps import stamps
from thermodata_reader_mcap.signals.units.units_of_channels import OtherUnit, in_units_of_topic

BATCH = 16 << 20  # bytes of messages that are collected,
PART = 2 << 20  # and that become columns at a time
_AHEAD = 3
Job = tuple[Topic, Batch, slice, U64, U64]
_NAMED = 20
_SUSPECT = np.uint16(Flag.CLOCK_SUSPECT)


@dataclass(slots=True)
class _Tally:
    """Values of one signal or topic that do not read, or a field that is none of the signals."""

    topic: str
    count: int = 0
    first_ns: int | None = None
    last_ns: int | None = None

    def add(self, at: int | None) -> None:
        self.count += 1
        if at is not None:
            self.first_ns = at if self.first_ns is None else min(at, self.first_ns)
            self.last_ns = at if self.last_ns is None else max(at, self.last_ns)


@dataclass(slots=True)
class Writer:
    """Makes blocks of a content's batches, as planned. pool: threads that parse."""

    content: Content
    plan: Plan
    source: Source
    pool: Executor | None = None
    _wrong: dict[str, _Tally] = field(default_factory=dict)
    _new: dict[str, _Tally] = field(default_factory=dict)
    _unread: dict[str, int] = field(default_factory=dict)
    _why: dict[str, str] = field(default_factory=dict)

    def flush(self) -> Iterator[Block | Loss]:
        """The blocks of what was collected; empties the batches."""
        self.content.pending = 0
        jobs: list[Job] = []
        batches, self.content.batches = self.content.batches, {}
        for name, batch in batches.items():
            topic = self.plan.topics.get(str(name))
            if topic is not None and topic.name in self.plan.samples:
                batch = self._samples_apart(topic, batch)
            logs, publishes = batch.times()
            for channel, places in batch.places().items():
                if topic is None or self._reader(channel) is None:
                    self._unread[channel.topic] = self._unread.get(channel.topic, 0) + len(places)
            if topic is None:
                continue
            size = sum(map(len, batch.payloads))
            step = max(1, len(batch.payloads) * PART // max(1, size))
            jobs += [
                (topic, batch, slice(at, at + step), logs, publishes) for at in range(0, len(batch.payloads), step)
            ]
        for (topic, _, part, logs, publishes), made in self._ahead(jobs):
            for each in made:
                yield from self._blocks(topic, each, logs[part], publishes[part])

    def _samples_apart(self, topic: Topic, batch: Batch) -> Batch:
        """Each sample of the batch's messages as a message."""
        return parted(batch, self.plan.samples[topic.name]).batch

    def _ahead(self, jobs: list[Job]) -> Iterator[tuple[Job, list[Columns]]]:
        """The columns of each job, in order; a few are parsed at the same time, for the parsers leave the
        interpreter alone meanwhile."""
        if len(jobs) < 2 or self.pool is None:
            yield from ((job, self._columns(job)) for job in jobs)
            return
        waiting: deque[tuple[Job, Future[list[Columns]]]] = deque()
        for job in jobs:
            waiting.append((job, self.pool.submit(self._columns, job)))
            if len(waiting) > _AHEAD:
                first, future = waiting.popleft()
                yield first, future.result()
        for first, future in waiting:
            yield first, future.result()

    def _reader(self, channel: Channel) -> Decoder | None:
        """How a channel's messages decode; one that came late may belong to a topic that is known."""
        made = self.plan.readers.get(channel)
        if made is None and channel.topic not in self._why:
            try:
                made = decoder(channel, self.plan.options.enums)
                if channel.topic in self.plan.naming:
                    made = NamedDecoder(made, self.plan.naming[channel.topic])
                self.plan.readers[channel] = made
            except UnsupportedError as error:
                self._why[channel.topic] = str(error)
        return made

    def _columns(self, job: Job) -> list[Columns]:
        topic, batch, part, _, _ = job
        payloads = batch.payloads[part]
        if len(batch.members) == 1:
            made = self._reader(next(iter(batch.members)))
            return [] if made is None else self._columns_of_channel(topic, next(iter(batch.members)), made, payloads)
        kinds = np.concatenate(batch.kinds)[part]
        groups: dict[int, tuple[Decoder, Channel, list[int]]] = {}
        for channel, kind in batch.members.items():
            made = self._reader(channel)
            if made is not None:
                same = next(
                    (
                        k
                        for k, (other, first, _) in groups.items()
                        if (other is made or (other.json and made.json and _text(other) == _text(made)))
                        and self._other_units(topic, first, other) == self._other_units(topic, channel, made)
                    ),
                    kind,
                )
                groups.setdefault(same, (made, channel, []))[2].append(kind)
        parts: dict[int, list[Columns]] = {}
        places: dict[int, Int1D] = {}
        for key, (made, channel, members) in groups.items():
            mine = np.flatnonzero(np.isin(kinds, members))
            if mine.size:
                places[key] = mine
                parts[key] = self._columns_of_channel(topic, channel, made, [payloads[k] for k in mine.tolist()])
        return [merged(parts, places)] if parts else []

    def _other_units(self, topic: Topic, channel: Channel, made: Decoder) -> tuple[OtherUnit, ...]:
        return self.plan.sent.others(channel, made, topic)

    def _columns_of_channel(
        self, topic: Topic, channel: Channel, made: Decoder, payloads: Sequence[bytes]
    ) -> list[Columns]:
        """Messages of one channel as columns, in the units of the topic."""
        others = self._other_units(topic, channel, made)
        return [in_units_of_topic(part, others) for part in columns(topic, made, payloads)]

    def _blocks(self, topic: Topic, part: Columns, logs: U64, publishes: U64) -> Iterator[Block | Loss]:
        kept, kind = part.kept, self.plan.options.time
        values, flags = dict(part.values), dict(part.flags)
        raw, other = (publishes, logs) if kind == PUBLISH else (logs, publishes)
        t, suspect = raw[kept], np.zeros(kept.size, bool)
        if kind not in (LOG, PUBLISH):
            t, suspect = stamps(topic, self.plan.options, part.values, part.flags, t)
        late = t >= LATEST_NS
        if topic.name in self.plan.stamped:
            shown = logs[kept] if kind != LOG else other[kept]
            name, beyond = time_name(topic, self.plan.stamped[topic.name]), shown >= LATEST_NS
            values[name] = np.where(beyond, 0, shown).astype(np.int64)
            if beyond.any():
                flags[name] = beyond * MISSING
                yield from self._tell_wrong(topic, Wrong(int(kept[beyond][0]), name, "a time", "2262 or later"), logs)
        elif kind == LOG and not np.array_equal(logs[kept], publishes[kept]):
            yield from self._tell_wrong(topic, Wrong(int(kept[0]), time_name(topic, PUBLISH), None, ""), logs)
        if suspect.any():
            for name in values:
                flags[name] = flags.get(name, np.zeros(kept.size, np.uint16)) | (suspect * _SUSPECT)
            got = f"none in {int(suspect.sum())} messages; their log time stands for it"
            yield from self._tell_wrong(topic, Wrong(int(kept[suspect][0]), "", f"a time in {kind}", got), logs)
        t_ns: Int1D = np.where(late, 0, t).astype(np.int64)
        if late.any():
            good = ~late
            got = f"later ones in {int(late.sum())} messages, which are not read"
            yield from self._tell_wrong(topic, Wrong(int(kept[late][0]), "", "a time before 2262", got), logs)
            t_ns, values, flags = t_ns[good], _rows_of(values, good), _rows_of(flags, good)
        if t_ns.size:
            yield Block(topic.name, t_ns, values, flags or None)
        for wrong in part.wrong:
            yield from self._tell_wrong(topic, wrong, logs)

    def _tell_wrong(self, topic: Topic, wrong: Wrong, logs: U64) -> Iterator[Loss]:
        at = int(logs[wrong.message]) if logs[wrong.message] < LATEST_NS else None
        if wrong.expected is None:
            self._new.setdefault(wrong.name, _Tally(topic.name)).add(at)
            return
        key = wrong.name or topic.name
        tally = self._wrong.setdefault(key, _Tally(topic.name))
        tally.add(at)
        if tally.count <= _NAMED:
            where = f"{self.content.name} topic '{topic.name}'" + (f" field '{wrong.name}'" if wrong.name else "")
            yield Loss(where, at, at, None, f"expected {wrong.expected}, got {wrong.got}")
        if tally.count == _NAMED:
            tally.first_ns = tally.last_ns = None

    def rest(self) -> Iterator[Loss]:
        """What was only counted, and topics that cannot be read."""
        name = self.content.name
        for key, tally in self._wrong.items():
            if tally.count > _NAMED:
                yield Loss(
                    f"{name} '{key}'",
                    tally.first_ns,
                    tally.last_ns,
                    None,
                    f"{counted(tally.count - _NAMED, 'more value', 'that does', 'that do')} not read",
                )
        for count, (key, tally) in enumerate(self._new.items()):
            if count == _NAMED:
                yield Loss(
                    name,
                    reason=f"{len(self._new) - _NAMED} more fields that the first look at the file did "
                    "not meet; they are not read",
                )
                break
            yield Loss(
                f"{name} topic '{tally.topic}' field '{key}'",
                tally.first_ns,
                tally.last_ns,
                None,
                "publish times that differ from the log times, which the first look at the file did not meet; "
                "set options: {publish_time: true}"
                if key.endswith(f".{PUBLISH}")
                else "a field that the first look at the file did not meet; it is not read",
            )
        for topic, n in self._unread.items():
            if wanted_topic(topic, self.source):
                why = (
                    self._why.get(topic)
                    or self.plan.unsupported.get(topic)
                    or "the first look at the file did not meet it"
                )
                yield Loss(f"{name} topic '{topic}'", reason=f"{n} messages not read: {why}")
        for number, n in self.content.undefined.items():
            yield Loss(f"{name} channel {number}", reason=f"{n} messages of a channel that the file does not describe")
        for opcode, n in self.content.foreign.items():
            if n:
                yield Loss(
                    name, reason=f"{n} records of kind 0x{opcode:02x}, which only their writer knows, are not read"
                )


def _text(one: Decoder) -> object:
    return getattr(one, "encoding", None)


def _rows_of(every: dict[str, Array], good: Array) -> dict[str, Array]:
    return {name: values[good] for name, values in every.items()}
