"""The clock of a recording: when it begins, and which times of its messages are the rows' own."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from thermodata.errors import FormatError
from thermodata_reader_mcap.container.definitions import Channel
from thermodata_reader_mcap.container.message_batches import Batch
from thermodata_reader_mcap.container.messages import LATEST_NS
from thermodata_reader_mcap.signals.found_topics import FoundTopics
from thermodata_reader_mcap.signals.options import LOG, PUBLISH, SCALES, Options
from thermodata_reader_mcap.signals.stamps.stamps_apart import first_stamp, publish_notes, stamps_note, unit_of

EARLIEST_NS = 10**17  # log times before 1973 count from the start of the recording


@dataclass(frozen=True, slots=True)
class Clock:
    """start_ns: the earliest time that was met, None where none was; relative: times count from the start of the
    recording."""

    start_ns: int | None
    relative: bool
    notes: list[str]


def recording_clock(chosen: Options, batches: dict[Channel, Batch], found: FoundTopics) -> Clock:
    """When the messages of the topics that are read begin, and whether that is a date."""
    used = [b for c, b in batches.items() if c.topic in found.topics]
    times = np.concatenate([np.empty(0, np.uint64), *(b.times()[chosen.time == PUBLISH] for b in used)])
    times = times[(times < LATEST_NS) & ((times > 0) | (chosen.time != PUBLISH))]  # none was published at 0
    relative = times.size > 0 and int(times.max()) < EARLIEST_NS
    start = int(times.min()) if times.size else None
    told = [
        n for name, topic in found.topics.items() if (n := stamps_note(topic, batches, found.decoders(name), relative))
    ]
    if relative:  # stamps that are declared may have the dates that the log times lack
        firsts = [first_stamp(chosen, batches, found.decoders(name)) for name in found.topics]
        dated = [ns for ns in firsts if ns is not None and ns >= EARLIEST_NS]
        relative, start = (False, min(dated)) if dated else (True, start)
    notes = ["log times count from the start of the recording"] if relative else []
    if chosen.time == LOG:
        notes += [*told, *([] if relative else publish_notes(used))]
    return Clock(start, relative, notes)


def time_signals(chosen: Options, batches: dict[Channel, Batch], found: FoundTopics) -> dict[str, str]:
    """Topic -> the time of its records that is a signal: the one that is not the rows' own, where it says more."""
    if chosen.time != LOG:
        return dict.fromkeys(found.topics, LOG)
    different = {c.topic for c, b in batches.items() if not _times_agree(b)}
    return {topic: PUBLISH for topic in found.topics if chosen.publish or topic in different}


def with_unit(chosen: Options, batches: dict[Channel, Batch], found: FoundTopics, name: str) -> Options:
    """The options with the unit of a declared time that is one number, where its size tells the unit. FormatError where
    it does not: all messages would stand at their log times."""
    path = chosen.stamp
    if path is None or chosen.scale is not None:
        return chosen
    fields = {leaf.path: leaf for topic in found.topics.values() for leaf in topic.leaves if leaf.dtype != "str"}
    if path not in fields:
        return chosen
    units = {
        unit_of(path, batches, found.decoders(name_of_topic))
        for name_of_topic, topic in found.topics.items()
        if any(leaf.path == path for leaf in topic.leaves)
    }
    unit = units.pop() if len(units) == 1 else None
    if unit is None:
        raise FormatError(
            f"the time '{chosen.time}' does not tell its unit",
            where=name,
            expected="numbers since 1970 in one of s, ms, us, ns",
            got=f"{fields[path].dtype} of another size, or of several",
            hint=f"declare options: {{time: {chosen.time}, time_unit: s}}, or ms, us, ns",
        )
    return replace(chosen, scale=SCALES[unit])


def _times_agree(batch: Batch) -> bool:
    """Whether its messages were published when they were logged."""
    log_ns, publish_ns = batch.times()
    return bool(np.array_equal(log_ns, publish_ns))
