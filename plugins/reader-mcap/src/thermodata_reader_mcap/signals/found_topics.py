"""What is read of each topic of a recording: its signals, and how its messages decode."""

from __future__ import annotations

from dataclasses import dataclass, field

from thermodata.plugin import Source
from thermodata_reader_mcap.container.definitions import Channel
from thermodata_reader_mcap.container.message_batches import Batch
from thermodata_reader_mcap.encodings.decoder import Decoder
from thermodata_reader_mcap.encodings.topic import Topic
from thermodata_reader_mcap.signals.options import Options
from thermodata_reader_mcap.signals.survey.chunk_survey import WHOLE
from thermodata_reader_mcap.signals.survey.topic_discovery import by_name, discover, readers
from thermodata_reader_mcap.signals.units.units_of_channels import UnitsOfChannels


@dataclass(slots=True)
class FoundTopics:
    """topics: by name; readers: how each channel's messages decode; unsupported: topic -> why it is not read; sent: in
    which units channels send."""

    topics: dict[str, Topic] = field(default_factory=dict)
    readers: dict[Channel, Decoder] = field(default_factory=dict)
    unsupported: dict[str, str] = field(default_factory=dict)
    sent: UnitsOfChannels = field(default_factory=UnitsOfChannels)
    notes: list[str] = field(default_factory=list)

    def decoders(self, topic: str) -> dict[Channel, Decoder]:
        """Those of a topic's channels."""
        return {c: decoder for c, decoder in self.readers.items() if c.topic == topic}


def find_topics(batches: dict[Channel, Batch], chosen: Options, source: Source, whole: bool) -> FoundTopics:
    """What is read of each topic, by its messages: its signals and how they decode, or why it is not. whole: the
    batches hold all messages."""
    by_topic: dict[str, list[Channel]] = {}
    for channel, batch in batches.items():
        if batch.payloads:
            by_topic.setdefault(channel.topic, []).append(channel)
    result = FoundTopics()
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


def _empty(made: dict[Channel, Decoder], samples: dict[Channel, list[bytes]]) -> bool:
    """Whether the first messages all decode: where no signal came of them, they hold nothing."""
    for channel, one in made.items():
        for payload in samples[channel][:3]:
            try:
                one.decode(payload)
            except Exception:  # whatever a decoder raises: it does not decode
                return False
    return True
