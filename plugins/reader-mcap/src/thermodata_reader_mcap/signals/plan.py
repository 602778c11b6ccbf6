"""The first look at a recording: its topics and their signals, by samples of its chunks."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from fnmatch import fnmatchcase

from thermodata.errors import FormatError
from thermodata.plugin import Source
from thermodata.reader.signals.row_units import UnitColumn
from thermodata.reader.signals.series import Declaration, Series
from thermodata_reader_mcap.container.attachments import extras
from thermodata_reader_mcap.container.data_section import is_complete
from thermodata_reader_mcap.container.definitions import Channel, Definitions
from thermodata_reader_mcap.container.message_batches import Batch
from thermodata_reader_mcap.container.messages import Content, collect_messages
from thermodata_reader_mcap.container.summary import Summary, summary
from thermodata_reader_mcap.encodings.decoder import Decoder
from thermodata_reader_mcap.encodings.field_paths import Path
from thermodata_reader_mcap.encodings.named_elements import NamedDecoder, Naming
from thermodata_reader_mcap.encodings.topic import Topic, time_name
from thermodata_reader_mcap.signals.found_topics import FoundTopics, find_topics
from thermodata_reader_mcap.signals.options import LOG, Options, options
from thermodata_reader_mcap.signals.recording_clock import recording_clock, time_signals, with_unit
from thermodata_reader_mcap.signals.samples.batches_of_samples import Samples, parted
from thermodata_reader_mcap.signals.samples.find_samples import find_samples
from thermodata_reader_mcap.signals.several_senders import senders
from thermodata_reader_mcap.signals.survey.chunk_survey import WHOLE, Chunks, chosen_of, survey
from thermodata_reader_mcap.signals.units.units_in_messages import units_said
from thermodata_reader_mcap.signals.units.units_of_channels import UnitsOfChannels


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
    found = find_topics(batches, chosen, source, walk.whole)
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
    chosen = with_unit(chosen, batches, found, name)
    clock = recording_clock(chosen, batches, found)
    notes += clock.notes
    stamped = time_signals(chosen, batches, found)
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


def _senders(
    found: FoundTopics, batches: dict[Channel, Batch], stamped: dict[str, str], declared: Declaration
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


def _refuse_missing(source: Source, channels: Iterable[Channel], name: str) -> None:
    present = sorted({c.topic for c in channels})
    for wanted in source.topics:
        if not any(t == wanted or fnmatchcase(t, wanted) for t in present):
            raise FormatError(
                f"no topic '{wanted}'", where=name, expected=", ".join(present) or "the file has none", got=wanted
            )
