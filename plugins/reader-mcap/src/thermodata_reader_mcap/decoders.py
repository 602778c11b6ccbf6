"""Payloads as Python values, by the channel's encoding: json here, others by their own packages."""

from __future__ import annotations

import json
from collections.abc import Callable
from typing import Any

from thermodata_reader_mcap.content import Channel

_PACKAGES = {"cdr": "mcap-ros2-support", "protobuf": "mcap-protobuf-support"}
_DEPTH = 12


class UnsupportedError(Exception):
    """An encoding that nothing installed reads; the message says what would."""


def decoder(channel: Channel) -> Callable[[bytes], Any]:
    """The function from payload to Python values (dict, list, numbers, bool, text). UnsupportedError."""
    if channel.encoding == "json":
        return json.loads
    if channel.encoding == "cdr" and channel.schema is not None and channel.schema.encoding == "ros2msg":
        return _ros2(channel)
    if channel.encoding == "protobuf" and channel.schema is not None:
        return _protobuf(channel)
    schema = channel.schema.encoding if channel.schema is not None else "none"
    raise UnsupportedError(f"encoding '{channel.encoding}' with schema '{schema}' is not supported")


def _from(factory: Any, channel: Channel) -> Callable[[bytes], Any]:
    from mcap.records import Schema

    assert channel.schema is not None
    schema = Schema(id=1, name=channel.schema.name, encoding=channel.schema.encoding, data=channel.schema.data)
    made: Callable[[bytes], Any] | None = factory.decoder_for(channel.encoding, schema)
    if made is None:
        raise UnsupportedError(f"the schema '{channel.schema.name}' does not read")
    return made


def _ros2(channel: Channel) -> Callable[[bytes], Any]:
    try:
        from mcap_ros2.decoder import DecoderFactory
    except ImportError:
        raise UnsupportedError(_missing(channel.encoding)) from None
    try:
        made = _from(DecoderFactory(), channel)
    except UnsupportedError:
        raise
    except Exception as error:                              # its parser of message definitions
        raise UnsupportedError(f"the schema does not read: {type(error).__name__}: {error}") from None
    return lambda payload: _plain(made(payload))


def _protobuf(channel: Channel) -> Callable[[bytes], Any]:
    try:
        from mcap_protobuf.decoder import DecoderFactory
    except ImportError:
        raise UnsupportedError(_missing(channel.encoding)) from None
    try:
        made = _from(DecoderFactory(), channel)
    except UnsupportedError:
        raise
    except Exception as error:
        raise UnsupportedError(f"the schema does not read: {type(error).__name__}: {error}") from None
    return lambda payload: _message(made(payload))


def _missing(encoding: str) -> str:
    return f"encoding '{encoding}' needs the package {_PACKAGES[encoding]}: pip install {_PACKAGES[encoding]}"


def _plain(value: Any, depth: int = 0) -> Any:
    """A decoded ROS 2 message: objects with slots become dicts, bytes lists of numbers."""
    if depth > _DEPTH:
        return None
    if isinstance(value, bool | int | float | str) or value is None:
        return value
    if isinstance(value, bytes | bytearray | memoryview):
        return list(value)
    if isinstance(value, list | tuple):
        return [_plain(v, depth + 1) for v in value]
    if hasattr(value, "tolist"):
        return value.tolist()
    names = getattr(value, "__slots__", None) or list(vars(value))
    return {str(n): _plain(getattr(value, n), depth + 1) for n in names if not str(n).startswith("_")}


def _message(value: Any, depth: int = 0) -> Any:
    """A decoded protobuf message: fields by their own names, integers as integers (its JSON form has them as text)."""
    if depth > _DEPTH:
        return None
    if isinstance(value, bool | int | float | str) or value is None:
        return value
    if isinstance(value, bytes):
        return list(value)
    if hasattr(value, "DESCRIPTOR"):
        return {f.name: _message(getattr(value, f.name), depth + 1) for f in value.DESCRIPTOR.fields
                if f.message_type is None or _is_repeated(f) or value.HasField(f.name)}
    if hasattr(value, "items"):
        return {str(k): _message(v, depth + 1) for k, v in value.items()}
    return [_message(v, depth + 1) for v in value]


def _is_repeated(descriptor: Any) -> bool:
    repeated = getattr(descriptor, "is_repeated", None)
    return bool(repeated) if repeated is not None else descriptor.label == descriptor.LABEL_REPEATED
