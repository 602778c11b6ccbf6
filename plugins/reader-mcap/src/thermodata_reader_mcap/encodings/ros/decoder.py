"""ROS messages, cdr or as ROS 1 stores them, decoded one by one by the types of their schema."""

from __future__ import annotations

import struct
from dataclasses import dataclass, field
from typing import Any

from thermodata_reader_mcap.encodings.field_paths import MOST_ELEMENTS, Path
from thermodata_reader_mcap.encodings.ros.cdr import FORMATS, PADDING, Cursor, PayloadError, begin
from thermodata_reader_mcap.encodings.ros.message_types import Field, Types, is_struct
from thermodata_reader_mcap.encodings.topic import Hint


@dataclass(slots=True)
class RosDecoder:
    """types: of the channel's messages. ros1: stored without head and alignment."""

    types: Types
    ros1: bool
    json: bool = False
    _hints: dict[Path, Hint | None] = field(default_factory=dict)

    def decode(self, payload: bytes) -> Any:
        """A payload as Python values. PayloadError: it is none of the schema's messages."""
        cursor = begin(payload, self.ros1)
        message = self._struct(self.types.root, cursor)
        self.check_end(payload, cursor.at)
        return message

    def check_end(self, payload: bytes, at: int) -> None:
        """PayloadError where more stands behind a message than padding."""
        if len(payload) - at > PADDING and payload[at:].strip(b"\0"):
            raise PayloadError(f"{len(payload) - at} bytes more than the schema has")

    def _struct(self, name: str, cursor: Cursor) -> dict[str, Any]:
        fields = self.types.structs[name]
        if not fields and not self.ros1:
            cursor.take(1)  # ROS 2 stores one byte for an empty message
        return {f.name: self._field(f, cursor) for f in fields}

    def _field(self, f: Field, cursor: Cursor) -> Any:
        if f.fixed is None and not f.sequence:
            return self._value(f.kind, cursor)
        n = cursor.length() if f.sequence else f.fixed or 0
        letter = FORMATS.get(f.kind)
        if letter is None:
            return [self._value(f.kind, cursor) for _ in range(n)]
        if not n:
            return []
        size = struct.calcsize("=" + letter)
        cursor.align(size)
        at = cursor.take(n * size)
        if f.kind == "u1" and n > MOST_ELEMENTS:
            return cursor.data[at : at + n]
        return list(struct.unpack_from(f"{cursor.order}{n}{letter}", cursor.data, at))

    def _value(self, kind: str, cursor: Cursor) -> Any:
        if is_struct(kind):
            return self._struct(kind, cursor)
        if kind == "string":
            n = cursor.length()
            at = cursor.take(n)
            return cursor.data[at : at + n].removesuffix(b"\0").decode("utf-8", "backslashreplace")
        letter = FORMATS[kind]
        size = struct.calcsize("=" + letter)
        cursor.align(size)
        return struct.unpack_from(cursor.order + letter, cursor.data, cursor.take(size))[0]

    def hint(self, path: Path) -> Hint | None:
        """What the definition says of a path; None where it has no such field."""
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
