"""Schemas and channels as a walk meets them. One id may get another meaning later (joined or damaged files): what
came before keeps the old one."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from thermodata_reader_mcap.container.records import CHANNEL, SCHEMA, Bytes, octets, text, text_map, u16


@dataclass(frozen=True, slots=True)
class Schema:
    """A schema record: the type's name, the language of its definition, and the definition."""

    name: str
    encoding: str
    data: bytes


@dataclass(frozen=True, slots=True)
class Channel:
    """What a channel's messages are. number: its id in the file; metadata: its own pairs of texts."""

    number: int
    topic: str
    encoding: str
    schema: Schema | None
    metadata: tuple[tuple[str, str], ...] = ()


@dataclass(slots=True)
class Definitions:
    """The meaning of ids at the place that a walk has reached. spare: what the file's summary says, for ids whose
    definition is lost."""

    schemas: dict[int, Schema] = field(default_factory=dict)
    channels: dict[int, Channel] = field(default_factory=dict)
    spare: Mapping[int, Channel] = field(default_factory=dict)
    met: dict[Channel, None] = field(default_factory=dict)

    def channel(self, number: int) -> Channel | None:
        """The channel of an id; None where nothing defines it."""
        found = self.channels.get(number)
        if found is None and number in self.spare:
            found = self.spare[number]
            self._meet(found)
        return found

    def changes(self, opcode: int, body: Bytes) -> bool:
        """Whether a definition gives an id that is in use another meaning. ShortError."""
        if opcode != CHANNEL:
            return False
        found = self._channel(body)
        old = self.channels.get(found.number)
        return old is not None and old != found

    def define(self, opcode: int, body: Bytes) -> None:
        """Takes a definition. ShortError."""
        if opcode == SCHEMA:
            number, schema = parsed_schema(body)
            if number:
                self.schemas[number] = schema
        elif opcode == CHANNEL:
            self._meet(self._channel(body))

    def _channel(self, body: Bytes) -> Channel:
        return parsed_channel(body, self.schemas)

    def _meet(self, channel: Channel) -> None:
        self.channels[channel.number] = channel
        self.met.setdefault(channel)


def parsed_schema(body: Bytes) -> tuple[int, Schema]:
    """A schema record's id and content. ShortError."""
    number, at = u16(body, 0, len(body))
    name, at = text(body, at, len(body))
    encoding, at = text(body, at, len(body))
    data, _ = octets(body, at, len(body))
    return number, Schema(name, encoding, bytes(data))


def parsed_channel(body: Bytes, schemas: Mapping[int, Schema]) -> Channel:
    """A channel record's content. ShortError."""
    number, at = u16(body, 0, len(body))
    schema, at = u16(body, at, len(body))
    topic, at = text(body, at, len(body))
    encoding, at = text(body, at, len(body))
    metadata, _ = text_map(body, at, len(body))
    return Channel(number, topic or f"channel {number}", encoding, schemas.get(schema), tuple(metadata.items()))
