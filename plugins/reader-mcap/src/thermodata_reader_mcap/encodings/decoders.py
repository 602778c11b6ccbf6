"""What reads the payloads of a channel, by its encoding, and many of them as columns."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from thermodata_reader_mcap.container.definitions import Channel
from thermodata_reader_mcap.encodings import decoded_messages
from thermodata_reader_mcap.encodings.columns import Columns
from thermodata_reader_mcap.encodings.decoder import Decoder, UnsupportedError
from thermodata_reader_mcap.encodings.json import arrow
from thermodata_reader_mcap.encodings.json.decoder import JsonDecoder, json_schema
from thermodata_reader_mcap.encodings.topic import Topic


def decoder(channel: Channel, enums: str = "number") -> Decoder:
    """What reads a channel's messages. enums: whether protobuf's enumerations are numbers or labels.
    UnsupportedError."""
    schema = channel.schema
    if channel.encoding == "json":
        told = schema is not None and schema.encoding == "jsonschema"
        return JsonDecoder(json_schema(schema.data) if told and schema is not None else None)
    if (
        channel.encoding in ("cdr", "ros1")
        and schema is not None
        and schema.encoding in ("ros2msg", "ros2idl", "ros1msg")
    ):
        from thermodata_reader_mcap.encodings.ros.schemas import ros_decoder

        made: Decoder = ros_decoder(channel.encoding, schema)
        return made
    if channel.encoding == "protobuf" and schema is not None and schema.encoding == "protobuf":
        from thermodata_reader_mcap.encodings.protobuf.schemas import protobuf_decoder

        return protobuf_decoder(schema, enums)
    named = f"schema '{schema.encoding}'" if schema is not None else "no schema"
    raise UnsupportedError(f"encoding '{channel.encoding or '(none)'}' with {named} is not supported")


def columns(topic: Topic, decoder: Decoder, payloads: Sequence[bytes]) -> Iterator[Columns]:
    """The payloads as columns, in order; the places in `kept` and `wrong` count from the first one."""
    if not payloads:
        return
    if decoder.json:
        recoded = getattr(decoder, "encoding", None) is not None
        yield from arrow.columns(topic, [_utf8(decoder, p) for p in payloads] if recoded else payloads, 0)
        return
    many = getattr(decoder, "columns", None)
    if many is not None:
        yield many(topic, payloads)
        return
    yield decoded_messages.columns(topic, decoder.decode, payloads, 0)


def _utf8(decoder: Any, payload: bytes) -> bytes:
    try:
        text: bytes = decoder.text(payload)
    except UnicodeDecodeError:
        return payload
    return text
