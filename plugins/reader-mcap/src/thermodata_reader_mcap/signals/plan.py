"""The first look at a recording: its topics and their signals, by samples of its chunks."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from fnmatch import fnmatchcase

import numpy as np

from thermodata.errors import FormatError
from thermodata.plugin import Source
from thermodata.reader.signals.row_units import UnitColumn
from thermodata.reader.signals.series import Declaration, Series
from thermodata_reader_mcap.container.attachments import extras
from thermodata_reader_mcap.container.data_section import is_complete
from thermodata_reader_mcap.container.definitions import Channel, Definitions
from thermodata_reader_mcap.container.message_batches import Batch
from thermodata_reader_mcap.container.messages import LATEST_NS, Content, collect_messages
from thermodata_reader_mcap.container.summary import Summary, summary
from thermodata_reader_mcap.encodings.decoder import Decoder
from thermodata_reader_mcap.encodings.field_paths import Path
from thermodata_reader_mcap.encodings.named_elements import NamedDecoder, Naming
from thermodata_reader_mcap.encodings.topic import Topic, time_name
from thermodata_reader_mcap.signals.options import LOG, PUBLISH, SCALES, Options, options
from thermodata_reader_mcap.signals.samples.batches_of_samples import Samples, parted
from thermodata_reader_mcap.signals.samples.find_samples import find_samples
from thermodata_reader_mcap.signals.several_senders import senders
from thermodata_reader_mcap.signals.stamps.stamps_apart import first_stamp, rushed, stamps_note, unit_of
from thermodata_reader_mcap.signals.survey.chunk_survey import WHOLE, Chunks, chosen_of, survey
from thermodata_reader_mcap.signals.survey.topic_discovery import by_name, discover, readers
from thermodata_reader_mcap.signals.units.units_in_messages import units_said
from thermodata_reader_mcap.signals.units.units_of_channels import UnitsOfChannels

EARLIEST_NS = 10**17  # log times before 1973 count from the start of the recording


@dataclass(slots=True)
class Plan:
    """topics: by name; readers: how each channel's messages decode. stamped: the times that are signals, by topic
    ("log_time", "publish_time"). units: which fields say those of others, message by message; sent: in which units
    channels send. samples: of topics whose messages hold several each. series: of topics on which several sensors send.
    complete: whether the file ends well and nothing in it is seen to be damaged."""

    options: Options
    summary: Summary
    topics: dict[str, Topic]
    readers: dict[Channel, Decoder]
    unsupported: dict[str, str]
    stamped: dict[str, str]
    series: dict[str, Series]
    naming: dict[str, Naming]
    units: tuple[UnitColumn, ...]
    sent: UnitsOfChannels
    samples: dict[str, tuple[Samples, ...]]
    start_ns: int | None
    relative: bool
    complete: bool
    notes: list[str]


def wanted_topic(topic: str, source: Source) -> bool:
    """Whether a source's topics ask for this one; `*` stands for anything, no topics for all."""
    return not source.topics or any(t == topic or fnmatchcase(topic, t) for t in source.topics)


def content(view: memoryview, name: str, said: Summary) -> Content:
    """An empty content for a walk."""
    return Content(name, len(view), Definitions(spare=said.channels))


def plan(view: memoryview, name: str, source: Source) -> Plan:
    """The topics of a recording. FormatError: a declared topic is missing, or no topic can be read."""
    chosen, said, chunks = options(source), summary(view), survey(view)
    walk = _walk_messages(view, name, source, said, chunks)
    _refuse_missing(source, [*walk.channels, *said.channels.values()], name)
    notes = extras(view, chunks.extras)
    if said.damaged:
        notes.append("the summary at the end of the file is damaged; it was not needed")
    batches = walk.batches
    samples: dict[str, tuple[Samples, ...]] = {}
    if chosen.time == LOG:  # else it is declared when each message was
        samples, more = find_samples(batches)
        notes += more
        batches = {c: parted(b, samples[c.topic]).batch if c.topic in samples else b for c, b in batches.items()}
    found = _topics(batches, chosen, source, walk.whole)
    notes += found.notes
    unread = [f"topic '{t}' is not read: {why}" for t, why in found.unsupported.items()]
    if unread and not found.topics:
        raise FormatError(
            "no topic of this recording can be read",
            where=name,
            got="; ".join(unread),
            expected="messages in json, cdr, ros1 or protobuf with their schemas",
            hint="record the topics in one of these, or write their signals as CSV or Parquet",
        )
    chosen = _with_unit(chosen, batches, found, name)
    clock = _clock(chosen, batches, found)
    notes += clock.notes
    stamped = _time_signals(chosen, batches, found)
    series, more = _senders(found, batches, stamped, chosen.series)
    notes += more
    times = {chosen.stamp} if chosen.stamp is not None else set[Path]()
    bare = {name: topic for name, topic in found.topics.items() if name not in series}
    said_by_rows = units_said(bare, found.readers, batches, times)
    found.topics |= said_by_rows.topics
    notes += said_by_rows.notes
    found.sent.leave([one.of for one in said_by_rows.columns])
    notes += filter(None, (found.sent.note(topic, found.decoders(name)) for name, topic in found.topics.items()))
    return Plan(
        options=chosen,
        summary=said,
        topics=found.topics,
        readers=found.readers,
        unsupported=found.unsupported,
        stamped=stamped,
        series=series,
        naming={c.topic: one.naming for c, one in found.readers.items() if isinstance(one, NamedDecoder)},
        units=said_by_rows.columns,
        sent=found.sent,
        samples=samples,
        start_ns=clock.start_ns,
        relative=clock.relative,
        complete=is_complete(view) and not walk.damaged,
        notes=[*notes, *unread],
    )


@dataclass(frozen=True, slots=True)
class _Walk:
    """What a first walk through some chunks met. channels: all of them, wanted or not; batches: messages of wanted
    channels; whole: whether no chunk was left out; damaged: something in them is."""

    channels: tuple[Channel, ...]
    batches: dict[Channel, Batch]
    whole: bool
    damaged: bool


def _walk_messages(view: memoryview, name: str, source: Source, said: Summary, chunks: Chunks) -> _Walk:
    chosen = chosen_of(chunks)
    met = content(view, name, said)
    met.key = lambda channel: channel if wanted_topic(channel.topic, source) else None
    whole, damaged = chosen is None, chunks.damaged
    wanted = None if chosen is None else chosen.__contains__
    for loss in collect_messages(view, met, lambda: met.pending >= WHOLE, wanted):
        damaged |= loss is not None
        if not chunks.sizes and met.pending >= WHOLE:  # messages outside of chunks: their head must do
            whole = False
            break
    batches = {key: batch for key, batch in met.batches.items() if isinstance(key, Channel)}
    return _Walk(tuple(met.definitions.met), batches, whole, damaged)


@dataclass(slots=True)
class _FoundTopics:
    topics: dict[str, Topic] = field(default_factory=dict)
    readers: dict[Channel, Decoder] = field(default_factory=dict)
    unsupported: dict[str, str] = field(default_factory=dict)
    sent: UnitsOfChannels = field(default_factory=UnitsOfChannels)
    notes: list[str] = field(default_factory=list)

    def decoders(self, topic: str) -> dict[Channel, Decoder]:
        """Those of a topic's channels."""
        return {c: decoder for c, decoder in self.readers.items() if c.topic == topic}


@dataclass(frozen=True, slots=True)
class _Clock:
    """start_ns: the earliest time that was met, None where none was; relative: times count from the start of the
    recording."""

    start_ns: int | None
    relative: bool
    notes: list[str]


def _clock(chosen: Options, batches: dict[Channel, Batch], found: _FoundTopics) -> _Clock:
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
        notes += [*told, *([] if relative else rushed(used))]
    return _Clock(start, relative, notes)


def _time_signals(chosen: Options, batches: dict[Channel, Batch], found: _FoundTopics) -> dict[str, str]:
    """Topic -> the time of its records that is a signal: the one that is not the rows' own, where it says more."""
    if chosen.time != LOG:
        return dict.fromkeys(found.topics, LOG)
    different = {c.topic for c, b in batches.items() if not _times_agree(b)}
    return {topic: PUBLISH for topic in found.topics if chosen.publish or topic in different}


def _topics(batches: dict[Channel, Batch], chosen: Options, source: Source, whole: bool) -> _FoundTopics:
    """What is read of each topic, by its messages: its signals and how they decode, or why it is not. whole: the
    batches hold all messages."""
    by_topic: dict[str, list[Channel]] = {}
    for channel, batch in batches.items():
        if batch.payloads:
            by_topic.setdefault(channel.topic, []).append(channel)
    result = _FoundTopics()
    budget = max((WHOLE if whole else WHOLE // 2) // max(1, len(by_topic)), 1 << 16)
    for topic, channels in by_topic.items():
        samples = {c: batches[c].payloads for c in channels}
        made, problems, notes = readers(channels, samples, chosen, source.encoding)
        result.notes += notes
        made = by_name(made, samples)
        found, notes = discover(topic, made, samples, whole, budget) if made else (None, [])
        result.notes += notes
        if problems:
            result.unsupported[topic] = "; ".join(dict.fromkeys(problems.values()))
        if found is not None:
            result.topics[topic] = result.sent.settle(found, made)
            result.readers.update(made)
        elif not problems:
            result.unsupported[topic] = "no message decodes" if not _empty(made, samples) else "its messages are empty"
    return result


def _senders(
    found: _FoundTopics, batches: dict[Channel, Batch], stamped: dict[str, str], declared: Declaration
) -> tuple[dict[str, Series], list[str]]:
    """How topics are taken apart on which several sensors send; notes."""
    declared.check([leaf.name for topic in found.topics.values() for leaf in topic.leaves])
    series: dict[str, Series] = {}
    notes: list[str] = []
    for name, topic in found.topics.items():
        made = {c: decoder for c, decoder in found.decoders(name).items() if c in batches}
        taken = {*found.topics, *(stream for one in series.values() for stream in one.streams.values())}
        times = {time_name(topic, stamped[name])} if name in stamped else set()
        one = senders(topic, batches, made, taken, times, declared)
        notes += [f"topic '{name}': {note}" for note in one.notes]
        if one.series is not None:
            series[name] = one.series
    return series, notes


def _with_unit(chosen: Options, batches: dict[Channel, Batch], found: _FoundTopics, name: str) -> Options:
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


def _empty(made: dict[Channel, Decoder], samples: dict[Channel, list[bytes]]) -> bool:
    """Whether the first messages all decode: where no signal came of them, they hold nothing."""
    for channel, one in made.items():
        for payload in samples[channel][:3]:
            try:
                one.decode(payload)
            except Exception:  # whatever a decoder raises: it does not decode
                return False
    return True


def _times_agree(batch: Batch) -> bool:
    """Whether its messages were published when they were logged."""
    log_ns, publish_ns = batch.times()
    return bool(np.array_equal(log_ns, publish_ns))


def _refuse_missing(source: Source, channels: Iterable[Channel], name: str) -> None:
    present = sorted({c.topic for c in channels})
    for wanted in source.topics:
        if not any(t == wanted or fnmatchcase(t, wanted) for t in present):
            raise FormatError(
                f"no topic '{wanted}'", where=name, expected=", ".join(present) or "the file has none", got=wanted
            )
