"""Protobuf messages, by Google's own package: fields by their names, integers as integers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

from thermodata_reader_mcap.encodings.columns import Columns
from thermodata_reader_mcap.encodings.field_paths import MOST_DEPTH, MOST_ELEMENTS, Path
from thermodata_reader_mcap.encodings.protobuf.columns import message_columns
from thermodata_reader_mcap.encodings.protobuf.fields import is_map, is_repeated
from thermodata_reader_mcap.encodings.topic import Hint, Topic


@dataclass(slots=True)
class ProtobufDecoder:
    """message: the class that reads a payload. labels: enumerations as text."""

    message: Any
    labels: bool
    json: bool = False
    _plans: dict[str, list[tuple[str, Any]]] = field(default_factory=dict)

    def decode(self, payload: bytes) -> Any:
        """A payload as Python values; the package's own errors where it is no such message."""
        return self._as_mapping(self.message.FromString(payload), 0)

    def columns(self, topic: Topic, payloads: Sequence[bytes]) -> Columns:
        """Many payloads at once."""
        return message_columns(self, topic, payloads)

    def _as_mapping(self, message: Any, depth: int) -> Any:
        """Fields that have no value are None; a oneof has one field with a value at most."""
        if depth > MOST_DEPTH:
            return {}
        descriptor = message.DESCRIPTOR
        plan = self._plans.get(descriptor.full_name)
        if plan is None:
            plan = self._plans[descriptor.full_name] = [(f.name, self._reader(f)) for f in descriptor.fields]
        return {name: read(message, depth + 1) for name, read in plan}

    def _reader(self, f: Any) -> Any:
        """How one field is read: a function of the message and the depth."""
        name = f.name
        if is_map(f):
            one = self._value(f.message_type.fields_by_name["value"])
            return lambda m, d: {str(k): one(v, d) for k, v in getattr(m, name).items()}
        one = self._value(f)
        if is_repeated(f):
            return lambda m, d: [one(v, d) for v in getattr(m, name)]
        if f.has_presence and not f.has_default_value:
            return lambda m, d: one(getattr(m, name), d) if m.HasField(name) else None
        return lambda m, d: one(getattr(m, name), d)

    def _value(self, f: Any) -> Any:
        if f.message_type is not None:
            return self._as_mapping
        if f.enum_type is not None and self.labels:
            names = {v.number: v.name for v in f.enum_type.values}
            return lambda v, d: names.get(v, str(v))
        if f.type == f.TYPE_BYTES:
            return lambda v, d: list(v) if len(v) <= MOST_ELEMENTS else v
        return lambda v, d: v

    def hint(self, path: Path) -> Hint | None:
        """What the descriptor says of a path; None where it has no such field."""
        message, f = self.message.DESCRIPTOR, None
        for part in path:
            if isinstance(part, int):
                continue
            if f is not None and is_map(f):
                f = f.message_type.fields_by_name["value"]
                message = f.message_type
                continue
            f = message.fields_by_name.get(part) if message is not None else None
            if f is None:
                return None
            message = f.message_type
        return None if f is None else self._hint(f)

    def _hint(self, f: Any) -> Hint:
        if is_map(f):
            f = f.message_type.fields_by_name["value"]
        if f.enum_type is not None:
            labels = ", ".join(f"{v.number} {v.name}" for v in f.enum_type.values)
            return Hint("string" if self.labels else "integer", None, (("labels", labels),))
        kind = {
            f.CPPTYPE_UINT64: "uint64",
            f.CPPTYPE_DOUBLE: "number",
            f.CPPTYPE_FLOAT: "number",
            f.CPPTYPE_BOOL: "boolean",
            f.CPPTYPE_STRING: "string",
        }.get(f.cpp_type, "integer")
        return Hint("integer" if f.type == f.TYPE_BYTES else kind)
