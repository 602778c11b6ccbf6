"""Where a row stands in a recording: which message of its topic, in which chunk, at which byte, with which log time."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from thermodata.plugin import Block, Int1D, Loss, Source
from thermodata_reader_mcap.container.mapped_file import opened
from thermodata_reader_mcap.container.message_batches import U64, Batch
from thermodata_reader_mcap.container.messages import Content, collect_messages
from thermodata_reader_mcap.container.records import HEAD, MESSAGE_HEAD, Bytes
from thermodata_reader_mcap.encodings.columns import Columns
from thermodata_reader_mcap.encodings.topic import Topic
from thermodata_reader_mcap.signals.blocks import BATCH, Job, Writer
from thermodata_reader_mcap.signals.plan import Plan, content, plan, wanted_topic
from thermodata_reader_mcap.signals.samples.batches_of_samples import parted


def locate(path: Path, source: Source, stream: str, row: int) -> str | None:
    """`message 812, chunk 3 (at byte 123456), byte 789 of its records, log_time ...` of a row (counted from 0) of a
    topic; None where that can't be told."""
    with opened(path) as view:
        found = plan(view, path.name, source)
        # a stream is a topic, or what one sensor sent on it
        sent = ((t, name) for t, one in found.series.items() for name, made in one.streams.items() if made == stream)
        topic, sender = next(sent, (stream, None))
        asked = _TopicRow(topic, sender, row)
        number = _message(view, content(view, path.name, found.summary), found, source, asked)
        if number is None:
            return None
        met = content(view, path.name, found.summary)
        met.key = lambda channel: None
        seen = _MessageCounter(met, topic, number)
        met.follow = seen.take
        for _ in collect_messages(view, met, lambda: True):
            if seen.found is not None:
                break
        return seen.found


@dataclass(frozen=True, slots=True)
class _TopicRow:
    """A row of a topic, from 0. sender: whose rows are counted, None for all."""

    topic: str
    sender: str | None
    row: int


def _message(view: memoryview, met: Content, found: Plan, source: Source, asked: _TopicRow) -> int | None:
    """The number of a row's message in its topic, from 0: messages that do not read are no rows."""
    topic, sender, row = asked.topic, asked.sender, asked.row
    met.key = lambda channel: channel.topic if channel.topic == topic and wanted_topic(topic, source) else None
    writer = _Counting(met, found, source)
    done = 0
    for _ in (*collect_messages(view, met, lambda: met.pending >= BATCH), None):
        for item in writer.flush():
            if not isinstance(item, Block):
                continue
            every = np.arange(item.t_ns.size)
            rows = every if sender is None else found.series[topic].rows(item).get(sender, every[:0])
            if row < done + rows.size:
                if writer.numbers is None:
                    return None
                number = int(writer.numbers[rows[row - done]])
                return int(np.concatenate(writer.origins)[number]) if writer.origins else number
            done += rows.size
    return None


@dataclass(slots=True)
class _Counting(Writer):
    """Knows the numbers, in their topic, of the messages that became the last block; None where some were left
    out for their time."""

    numbers: Int1D | None = None
    origins: list[Int1D] = field(default_factory=list)  # of samples: the message that each came in
    messages: int = 0
    base: int = 0
    size: int = 0

    def _samples_apart(self, topic: Topic, batch: Batch) -> Batch:
        found = parted(batch, self.plan.samples[topic.name])
        self.origins.append(found.origin + self.messages)
        self.messages += len(batch.payloads)
        return found.batch

    def _ahead(self, jobs: list[Job]) -> Iterator[tuple[Job, list[Columns]]]:
        for job in jobs:
            self.base, self.size = self.base + self.size, len(job[1].payloads[job[2]])
            yield job, self._columns(job)

    def _blocks(self, topic: Topic, part: Columns, logs: U64, publishes: U64) -> Iterator[Block | Loss]:
        for item in Writer._blocks(self, topic, part, logs, publishes):
            if isinstance(item, Block):
                self.numbers = part.kept + self.base if item.t_ns.size == part.kept.size else None
            yield item


@dataclass(slots=True)
class _MessageCounter:
    """Counts a topic's messages as they are met, up to the wanted one."""

    content: Content
    topic: str
    wanted: int
    found: str | None = None
    count: int = 0

    def take(self, inner: Bytes, at: Int1D) -> None:
        """Sees the messages whose records begin at these places."""
        if self.found is not None:
            return
        heads = np.lib.stride_tricks.sliding_window_view(np.frombuffer(inner, np.uint8), HEAD.size + MESSAGE_HEAD)[at]
        numbers = np.ascontiguousarray(heads[:, 9:11]).view("<u2")[:, 0]
        wanted = [
            n
            for n in np.unique(numbers).tolist()
            if (channel := self.content.definitions.channel(n)) is not None and channel.topic == self.topic
        ]
        mine = np.flatnonzero(np.isin(numbers, wanted))
        if self.wanted < self.count + mine.size:
            which = int(mine[self.wanted - self.count])
            log_ns = int(np.ascontiguousarray(heads[which, 15:23]).view("<u8")[0])
            byte, chunk = int(at[which]), self.content.chunk
            where = (
                f"byte {byte}"
                if chunk is None
                else f"chunk {chunk[0] + 1} (at byte {chunk[1]}), byte {byte} of its records"
            )
            self.found = f"message {self.wanted + 1}, {where}, log_time {log_ns}"
        self.count += int(mine.size)
