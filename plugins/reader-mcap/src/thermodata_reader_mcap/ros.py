"""ROS messages: cdr (ROS 2, by ros2msg or ros2idl) and ros1 (by ros1msg), decoded by the types of their schema."""

from __future__ import annotations

import struct
from dataclasses import dataclass, field
from typing import Any

from thermodata_reader_mcap.decoders import UnsupportedError
from thermodata_reader_mcap.definitions import Schema
from thermodata_reader_mcap.leaves import Hint
from thermodata_reader_mcap.ros_idl import idl_types
from thermodata_reader_mcap.ros_types import Field, LineError, Types, TypeTextError, is_struct, message_types
from thermodata_reader_mcap.seen import MOST_ELEMENTS, Path

FORMATS = {
    "?": "?",
    "i1": "b",
    "u1": "B",
    "i2": "h",
    "u2": "H",
    "i4": "i",
    "u4": "I",
    "i8": "q",
    "u8": "Q",
    "f4": "f",
    "f8": "d",
}
PADDING = 7  # bytes behind a message that writers leave


class PayloadError(Exception):
    """A payload that is none of the schema's messages."""


@dataclass(slots=True)
class Place:
    """Where in a payload a walk stands. order: "<" or ">". base: where alignment counts from; widest: the largest
    alignment (0: none, as ROS 1 stores)."""

    data: bytes
    at: int
    order: str
    base: int
    widest: int

    def align(self, size: int) -> None:
        size = min(size, self.widest)
        if size > 1:
            self.at += -(self.at - self.base) % size

    def take(self, size: int) -> int:
        """The next bytes' place; PayloadError where the payload ends before."""
        begin = self.at
        if size > len(self.data) - begin:
            raise PayloadError(f"ends {begin + size - len(self.data)} bytes early")
        self.at = begin + size
        return begin

    def length(self) -> int:
        """The length of what follows, which can't be more than there are bytes."""
        self.align(4)
        (n,) = struct.unpack_from(self.order + "I", self.data, self.take(4))
        if n > len(self.data) - self.at:
            raise PayloadError(f"a length of {n} in {len(self.data)} bytes")
        return int(n)


_KINDS = {0: (">", 8), 1: ("<", 8), 6: (">", 4), 7: ("<", 4)}  # CDR and plain CDR 2, big and little endian


def begin(payload: bytes, ros1: bool) -> Place:
    """The start of a payload. PayloadError: an encapsulation that is not plain."""
    if ros1:
        return Place(payload, 0, "<", 0, 0)
    if len(payload) < 4:
        raise PayloadError("shorter than its head")
    kind = _KINDS.get(payload[1]) if payload[0] == 0 else None
    if kind is None:
        raise PayloadError(f"encapsulation {payload[0]:02x}{payload[1]:02x} is not supported")
    return Place(payload, 4, kind[0], 4, kind[1])


@dataclass(slots=True)
class RosDecoder:
    """types: of the channel's messages. ros1: stored without head and alignment."""

    types: Types
    ros1: bool
    json: bool = False
    _hints: dict[Path, Hint | None] = field(default_factory=dict)

    def decode(self, payload: bytes) -> Any:
        place = begin(payload, self.ros1)
        message = self._struct(self.types.root, place)
        self.check_end(payload, place.at)
        return message

    def check_end(self, payload: bytes, at: int) -> None:
        """PayloadError where more stands behind a message than padding."""
        if len(payload) - at > PADDING and payload[at:].strip(b"\0"):
            raise PayloadError(f"{len(payload) - at} bytes more than the schema has")

    def _struct(self, name: str, place: Place) -> dict[str, Any]:
        fields = self.types.structs[name]
        if not fields and not self.ros1:
            place.take(1)  # ROS 2 stores one byte for an empty message
        return {f.name: self._field(f, place) for f in fields}

    def _field(self, f: Field, place: Place) -> Any:
        if f.fixed is None and not f.sequence:
            return self._one(f.kind, place)
        n = place.length() if f.sequence else f.fixed or 0
        letter = FORMATS.get(f.kind)
        if letter is None:
            return [self._one(f.kind, place) for _ in range(n)]
        if not n:
            return []
        size = struct.calcsize("=" + letter)
        place.align(size)
        at = place.take(n * size)
        if f.kind == "u1" and n > MOST_ELEMENTS:
            return place.data[at : at + n]
        return list(struct.unpack_from(f"{place.order}{n}{letter}", place.data, at))

    def _one(self, kind: str, place: Place) -> Any:
        if is_struct(kind):
            return self._struct(kind, place)
        if kind == "string":
            n = place.length()
            at = place.take(n)
            return place.data[at : at + n].removesuffix(b"\0").decode("utf-8", "backslashreplace")
        letter = FORMATS[kind]
        size = struct.calcsize("=" + letter)
        place.align(size)
        return struct.unpack_from(place.order + letter, place.data, place.take(size))[0]

    def hint(self, path: Path) -> Hint | None:
        if path not in self._hints:
            self._hints[path] = self._hint(path)
        return self._hints[path]

    def _hint(self, path: Path) -> Hint | None:
        kind = self.types.root
        for part in path:
            if isinstance(part, int):
                continue
            f = next((f for f in self.types.structs.get(kind, ()) if f.name == part), None)
            if f is None:
                return None
            kind = f.kind
        return (
            None
            if is_struct(kind)
            else Hint(
                {"?": "boolean", "string": "string", "u8": "uint64"}.get(
                    kind, "number" if kind[0] == "f" else "integer"
                )
            )
        )


def ros_decoder(encoding: str, schema: Schema) -> Any:
    """The decoder of a ROS schema: ours, or the package's where our parser does not read it. UnsupportedError."""
    try:
        text = schema.data.decode("utf-8", "replace")
        if schema.encoding == "ros2idl":
            types = idl_types(schema.name, text)
        else:
            types = message_types(schema.name, text, encoding == "ros1")
        if types.root not in types.structs:
            raise TypeTextError(f"the type {types.root} is not defined")
    except (TypeTextError, RecursionError) as error:
        if schema.encoding == "ros2msg" and encoding == "cdr" and isinstance(error, LineError):
            from thermodata_reader_mcap.ros_package import package_decoder

            theirs = package_decoder(schema)
            if theirs is not None:
                return theirs
        raise UnsupportedError(f"the schema '{schema.name}' does not read: {error}") from None
    from thermodata_reader_mcap.ros_columns import RosColumns

    return RosColumns(types, encoding == "ros1")
