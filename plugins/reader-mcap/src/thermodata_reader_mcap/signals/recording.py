"""A recording as signals and blocks: one stream a topic, times are log times unless another is asked for."""

from __future__ import annotations

import zlib
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from threading import Lock

from thermodata.plugin import Block, Loss, Recording, Signal, Source
from thermodata.reader.signals.by_place import BY_PLACE
from thermodata.reader.signals.taken_apart import TakenApart
from thermodata.reader.text.names.unit_column import in_one_unit
from thermodata_reader_mcap.container.mapped_file import opened
from thermodata_reader_mcap.container.messages import collect_messages
from thermodata_reader_mcap.container.summary import Summary
from thermodata_reader_mcap.encodings.field_paths import path_name
from thermodata_reader_mcap.encodings.topic import Leaf, time_name
from thermodata_reader_mcap.signals.blocks import BATCH, Writer
from thermodata_reader_mcap.signals.plan import Plan, content, plan, wanted_topic

_CRC_STEP = 16 << 20
_KEPT = 2  # first looks that are remembered
_LONGEST = 200  # of a channel's own texts that become properties of its signals
_PLANS: dict[tuple[object, ...], Plan] = {}
_LOCK = Lock()


def describe(path: Path, source: Source) -> Recording:
    """Topics and signals by samples of the file's chunks."""
    with opened(path) as view:
        found = plan(view, path.name, source)
        with _LOCK:
            _PLANS[_key(view, path, source)] = found
            while len(_PLANS) > _KEPT:
                _PLANS.pop(next(iter(_PLANS)))
    signals: list[Signal] = []
    told = _properties(found)
    for topic in found.topics.values():
        properties = told.get(topic.name, {})
        mine = [
            Signal(
                leaf.name,
                topic.name,
                leaf.unit,
                leaf.dtype,
                None,
                {**properties, **dict(leaf.properties), **_place(found, topic.name, leaf)},
            )
            for leaf in topic.leaves
        ]
        if topic.name in found.stamped:
            mine.append(Signal(time_name(topic, found.stamped[topic.name]), topic.name, "ns", "int64"))
        series = found.series.get(topic.name)
        signals += mine if series is None else series.signals(mine)
    start = None if found.relative else found.start_ns if signals else 0
    return Recording(
        tuple(signals), "relative" if found.relative else "absolute", start, found.complete, tuple(found.notes)
    )


def _place(found: Plan, topic: str, leaf: Leaf) -> dict[str, str]:
    """Of an element that goes by its name, the signal that it is by its place, where it had one."""
    naming = found.naming.get(topic)
    path = None if naming is None else naming.place(leaf.path)
    return {} if path is None else {BY_PLACE: path_name(topic, path)}


def _key(view: memoryview, path: Path, source: Source) -> tuple[object, ...]:
    stat = path.stat()
    return str(path.absolute()), stat.st_size, stat.st_mtime_ns, stat.st_ino, bytes(view[-64:]), repr(source)


def _plan_of_describe(view: memoryview, path: Path, source: Source) -> Plan:
    """The first look at a file that describe took just before, or a new one."""
    with _LOCK:
        found = _PLANS.pop(_key(view, path, source), None)
    return plan(view, path.name, source) if found is None else found


def _properties(found: Plan) -> dict[str, dict[str, str]]:
    """By topic: the schema's name and the channel's own pairs."""
    result: dict[str, dict[str, str]] = {}
    for channel in found.readers:
        mine = result.setdefault(channel.topic, {})
        mine |= {key: value for key, value in channel.metadata if len(value) <= _LONGEST}
        if channel.schema is not None and channel.schema.name:
            mine["schema"] = channel.schema.name
    return result


def blocks(path: Path, source: Source) -> Iterator[Block | Loss]:
    """The messages, topic by topic in batches of about 16 MB, and what is damaged."""
    with opened(path) as view:
        found = _plan_of_describe(view, path, source)
        met = content(view, path.name, found.summary)
        met.key = lambda channel: channel.topic if wanted_topic(channel.topic, source) else None
        with ThreadPoolExecutor(2) as pool:
            writer = Writer(met, found, source, pool)
            apart = [TakenApart(one, f"{path.name} topic '{topic}'") for topic, one in found.series.items()]
            whole = True
            for loss in collect_messages(view, met, lambda: met.pending >= BATCH):
                yield from _senders_apart(_in_one_unit(writer.flush(), found, path.name), apart)
                if loss is not None:
                    whole = False
                    yield loss
            yield from _senders_apart(_in_one_unit(writer.flush(), found, path.name), apart)
            for one in apart:
                yield from one.rest()
            if whole and met.recordings < 2:
                yield from _contradictions(view, found.summary, writer)
            yield from writer.rest()
            met.batches.clear()


def _in_one_unit(items: Iterator[Block | Loss], found: Plan, where: str) -> Iterator[Block | Loss]:
    """The same with the values of each field whose messages say its unit in one unit."""
    for said in found.units:
        items = in_one_unit(items, said, where, whole=True)
    return items


def _senders_apart(items: Iterator[Block | Loss], apart: Sequence[TakenApart]) -> Iterator[Block | Loss]:
    """Blocks of topics on which several sensors send, taken apart; all else as it is."""
    by_topic = {one.series.stream: one for one in apart}
    for item in items:
        one = by_topic.get(item.stream) if isinstance(item, Block) else None
        yield from (item,) if one is None else one.split(item)


def _contradictions(view: memoryview, said: Summary, writer: Writer) -> Iterator[Loss]:
    """What the end of the file knows of its data, where the data themselves showed no damage."""
    counts = writer.content.counts
    name = writer.content.name
    missing = False
    if said.counts is not None:
        for number, wanted in said.counts.items():
            got = counts.get(number, 0)
            channel = writer.content.definitions.channel(number)
            topic = f"topic '{channel.topic}'" if channel is not None else f"channel {number}"
            if got < wanted:
                missing = True
                yield Loss(
                    f"{name} {topic}",
                    fraction=(wanted - got) / wanted,
                    reason=f"{wanted - got} of its {wanted} messages are not in the file",
                )
    got = sum(counts.values())
    if not missing and said.total is not None and got < said.total:
        missing = True
        yield Loss(
            name,
            fraction=(said.total - got) / said.total,
            reason=f"{said.total - got} of {said.total} messages are not in the file",
        )
    if said.data_crc and not missing:
        crc = 0
        for at in range(0, said.data_end, _CRC_STEP):
            crc = zlib.crc32(view[at : min(at + _CRC_STEP, said.data_end)], crc)
        if crc != said.data_crc:
            yield Loss(name, reason="the checksum of the whole file differs: some value or time in it may be wrong")
