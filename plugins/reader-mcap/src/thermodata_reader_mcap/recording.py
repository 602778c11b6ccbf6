"""A recording as signals and blocks: one stream a topic, times are log times."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from thermodata.plugin import Array, Block, Int1D, Loss, Recording, Signal, Source
from thermodata_reader_mcap.columns import Topic, columns
from thermodata_reader_mcap.content import LATEST_NS, Batch, Content, opened, walk
from thermodata_reader_mcap.decoders import UnsupportedError, decoder
from thermodata_reader_mcap.plan import Plan, plan, wanted_topic
from thermodata_reader_mcap.walk import is_complete

BATCH = 16 << 20
_NAMED = 20


def publish_name(topic: Topic) -> str:
    """The signal of a topic's publish times; another name where the messages have a field of this one."""
    name = f"{topic.name}.publish_time"
    return name if all(leaf.name != name for leaf in topic.leaves) else f"{name}#header"


def describe(path: Path, source: Source) -> Recording:
    """Topics and signals by samples of the file's chunks."""
    with opened(path) as view:
        found = plan(view, path.name, source)
        complete = is_complete(view)
    signals: list[Signal] = []
    for topic in {t.name: t for t in found.topics.values()}.values():
        signals += [Signal(leaf.name, topic.name, None, leaf.dtype) for leaf in topic.leaves]
        if topic.name in found.publish:
            signals.append(Signal(publish_name(topic), topic.name, "ns", "int64"))
    start = found.start_ns if signals and not found.relative else 0
    return Recording(tuple(signals), "relative" if found.relative else "absolute", start, complete, tuple(found.notes))


def blocks(path: Path, source: Source) -> Iterator[Block | Loss]:
    """The messages, topic by topic in batches of about 16 MB, and what is damaged."""
    with opened(path) as view:
        found = plan(view, path.name, source)
        writer = _Writer(Content(path.name, len(view)), found, source)
        batches = writer.batches
        for loss in walk(view, writer.content, batches, lambda: writer.content.pending >= BATCH):
            yield from writer.flush()
            if loss is not None:
                yield loss
        yield from writer.flush()
        yield from writer.rest()
        batches.clear()


@dataclass(slots=True)
class _Writer:
    content: Content
    plan: Plan
    source: Source
    batches: dict[int, Batch] = field(default_factory=dict)
    named: dict[str, int] = field(default_factory=dict)
    strangers: dict[int, int] = field(default_factory=dict)

    def __post_init__(self) -> None:
        shared: dict[str, Batch] = {}
        for number, topic in self.plan.topics.items():
            if topic.json:                                  # several publishers of one topic stay in order
                self.batches[number] = shared.setdefault(topic.name, Batch())

    def flush(self) -> Iterator[Block | Loss]:
        """The blocks of what was collected; empties the batches."""
        self.content.pending = 0
        done: set[int] = set()
        for number, batch in self.batches.items():
            if not batch.payloads or id(batch) in done:
                continue
            done.add(id(batch))
            payloads, (logs, publishes) = batch.payloads, batch.times()
            batch.payloads, batch.log_ns, batch.publish_ns = [], [], []
            topic = self._topic(number)
            if topic is None:
                self.strangers[number] = self.strangers.get(number, 0) + len(payloads)
                continue
            step = max(1, len(payloads) * BATCH // max(1, sum(map(len, payloads))))
            for at in range(0, len(payloads), step):
                part = slice(at, at + step)
                yield from self._blocks(topic, payloads[part], logs[part], publishes[part])

    def _topic(self, number: int) -> Topic | None:
        """What a channel's messages are; a channel that came late may belong to a topic that is known."""
        topic = self.plan.topics.get(number)
        channel = self.content.channels.get(number)
        if topic is not None or channel is None:
            return topic
        known = next((t for t in self.plan.topics.values() if t.name == channel.topic), None)
        if known is None:
            return None
        try:
            topic = replace(known, decode=decoder(channel), json=channel.encoding == "json")
        except UnsupportedError:
            return None
        self.plan.topics[number] = topic
        return topic

    def _blocks(self, topic: Topic, payloads: list[bytes], raw: Array, publish: Array) -> Iterator[Block | Loss]:
        late = raw >= LATEST_NS
        for part in columns(topic, payloads):
            kept = part.kept
            good = ~late[kept]
            t_ns: Int1D = raw[kept].astype(np.int64)
            values, flags = dict(part.values), dict(part.flags)
            if topic.name in self.plan.publish:
                values[publish_name(topic)] = publish[kept].astype(np.int64)
            if not good.all():
                t_ns, values, flags = t_ns[good], _only(values, good), _only(flags, good)
                yield from self._wrong(topic, int(kept[~good][0]), "", "a log time", "2262 or later", None)
            if t_ns.size:
                yield Block(topic.name, t_ns, values, flags or None)
            for k, name, expected, got in part.wrong:
                yield from self._wrong(topic, k, name, expected, got, None if late[k] else int(raw[k]))

    def _wrong(self, topic: Topic, place: int, name: str, expected: str, got: str, at: int | None) -> Iterator[Loss]:
        key = name or topic.name
        self.named[key] = self.named.get(key, 0) + 1
        stranger = expected.startswith("nothing")
        if self.named[key] > (1 if stranger else _NAMED):
            return
        where = f"{self.content.name} topic '{topic.name}'" + (f" field '{name}'" if name else "")
        reason = ("a field that the first look at the file did not meet; it is not read" if stranger
                  else f"expected {expected}, got {got}")
        yield Loss(where, at, at, None, reason)

    def rest(self) -> Iterator[Loss]:
        """What was only counted, and topics that cannot be read."""
        for key, count in self.named.items():
            if count > _NAMED:
                yield Loss(f"{self.content.name} '{key}'", reason=f"{count - _NAMED} more values that do not read")
        for number, count in self.strangers.items():
            channel = self.content.channels.get(number)
            if channel is None:
                yield Loss(f"{self.content.name} channel {number}",
                           reason=f"{count} messages of a channel that the file does not describe")
            elif wanted_topic(channel.topic, self.source):
                why = self.plan.unsupported.get(channel.topic, "the first look at the file did not meet it")
                yield Loss(f"{self.content.name} topic '{channel.topic}'", reason=f"{count} messages not read: {why}")


def _only(columns: dict[str, Array], good: Array) -> dict[str, Array]:
    return {name: values[good] for name, values in columns.items()}
