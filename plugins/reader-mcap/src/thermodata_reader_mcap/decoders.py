"""What reads the payloads of a channel, by its encoding: json here, ROS and protobuf beside."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from thermodata_reader_mcap.columns import Decoder
from thermodata_reader_mcap.definitions import Channel
from thermodata_reader_mcap.json_text import loads
from thermodata_reader_mcap.leaves import Declared, Hint
from thermodata_reader_mcap.seen import Path

_UNIT_KEYS = ("unit", "units", "x-unit", "x-units")


class UnsupportedError(Exception):
    """An encoding or a schema that nothing here reads; the message says what."""


@dataclass(slots=True)
class JsonDecoder:
    """JSON, with or without a JSON Schema. encoding: of its text, where that is not UTF-8."""

    schema: Any
    encoding: str | None = None
    json: bool = True

    def decode(self, payload: bytes) -> Any:
        return loads(self.text(payload))

    def text(self, payload: bytes) -> bytes:
        """The payload in UTF-8."""
        return payload if self.encoding is None else payload.decode(self.encoding).encode()

    def hint(self, path: Path) -> Hint | None:
        node = self.schema
        for part in path:
            if not isinstance(node, Mapping):
                return None
            inner = node.get("items") if isinstance(part, int) else node.get("properties")
            node = inner if isinstance(part, int) else inner.get(part) if isinstance(inner, Mapping) else None
        if not isinstance(node, Mapping):
            return None
        kind = node.get("type")
        if isinstance(kind, list):
            kind = next((k for k in kind if k != "null"), None)
        unit = next((node[k] for k in _UNIT_KEYS if isinstance(node.get(k), str)), None)
        said = node.get("description")
        return Hint(
            kind if isinstance(kind, str) else None, unit, (("description", said),) if isinstance(said, str) else ()
        )


def decoder(channel: Channel, enums: str = "number") -> Decoder:
    """What reads a channel's messages. enums: whether protobuf's enumerations are numbers or labels.
    UnsupportedError."""
    schema = channel.schema
    if channel.encoding == "json":
        told = schema is not None and schema.encoding == "jsonschema"
        return JsonDecoder(_json_schema(schema.data) if told and schema is not None else None)
    if (
        channel.encoding in ("cdr", "ros1")
        and schema is not None
        and schema.encoding in ("ros2msg", "ros2idl", "ros1msg")
    ):
        from thermodata_reader_mcap.ros import ros_decoder

        made: Decoder = ros_decoder(channel.encoding, schema)
        return made
    if channel.encoding == "protobuf" and schema is not None and schema.encoding == "protobuf":
        from thermodata_reader_mcap.protobuf import protobuf_decoder

        return protobuf_decoder(schema, enums)
    named = f"schema '{schema.encoding}'" if schema is not None else "no schema"
    raise UnsupportedError(f"encoding '{channel.encoding or '(none)'}' with {named} is not supported")


def hints(made: Decoder) -> Declared:
    """What a decoder's schema says of a path."""
    found: Declared = getattr(made, "hint", lambda path: None)
    return found


def _json_schema(data: bytes) -> Any:
    try:
        return json.loads(data) if data.strip() else None
    except (ValueError, RecursionError):
        return None
