"""Protobuf messages, by Google's own package: fields by their names, integers as integers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from thermodata_reader_mcap.columns import Columns, Topic
from thermodata_reader_mcap.decoders import UnsupportedError
from thermodata_reader_mcap.definitions import Schema
from thermodata_reader_mcap.leaves import Hint
from thermodata_reader_mcap.seen import MOST_DEPTH, MOST_ELEMENTS, Path

_GOOGLE = frozenset(
    f"google/protobuf/{name}.proto"
    for name in (
        "any",
        "api",
        "descriptor",
        "duration",
        "empty",
        "field_mask",
        "source_context",
        "struct",
        "timestamp",
        "type",
        "wrappers",
    )
)


@dataclass(slots=True)
class ProtobufDecoder:
    """message: the class that reads a payload. labels: enumerations as text."""

    message: Any
    labels: bool
    json: bool = False
    _plans: dict[str, list[tuple[str, Any]]] = field(default_factory=dict)

    def decode(self, payload: bytes) -> Any:
        return self._plain(self.message.FromString(payload), 0)

    def columns(self, topic: Topic, payloads: Sequence[bytes]) -> Columns:
        """Many payloads at once."""
        from thermodata_reader_mcap import protobuf_columns

        return protobuf_columns.columns(self, topic, payloads)

    def _plain(self, message: Any, depth: int) -> Any:
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
            return self._plain
        if f.enum_type is not None and self.labels:
            names = {v.number: v.name for v in f.enum_type.values}
            return lambda v, d: names.get(v, str(v))
        if f.type == f.TYPE_BYTES:
            return lambda v, d: list(v) if len(v) <= MOST_ELEMENTS else v
        return lambda v, d: v

    def hint(self, path: Path) -> Hint | None:
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


def protobuf_decoder(schema: Schema, enums: str) -> ProtobufDecoder:
    """The decoder of a FileDescriptorSet. UnsupportedError: the package is missing, or the schema does not read."""
    try:
        from google.protobuf.descriptor_pb2 import FileDescriptorSet  # type: ignore[import-untyped]
        from google.protobuf.descriptor_pool import DescriptorPool  # type: ignore[import-untyped]
        from google.protobuf.message_factory import GetMessageClass  # type: ignore[import-untyped]
    except ImportError:
        raise UnsupportedError("encoding 'protobuf' needs the package protobuf: pip install protobuf") from None
    try:
        files = {f.name: f for f in FileDescriptorSet.FromString(schema.data).file}
        pool = DescriptorPool()
        for each in _in_order(files, _well_known(files)):
            pool.Add(each)
        descriptor = pool.FindMessageTypeByName(schema.name.lstrip("."))
    except Exception as error:  # the package's own errors are of many kinds
        raise UnsupportedError(
            f"the schema '{schema.name}' does not read: {type(error).__name__}: {str(error).strip()[:120]}"
        ) from None
    return ProtobufDecoder(GetMessageClass(descriptor), enums == "label")


def _well_known(files: Mapping[str, Any]) -> dict[str, Any]:
    """Google's own types that a schema uses but does not hold."""
    from importlib import import_module

    from google.protobuf.descriptor_pb2 import FileDescriptorProto

    found: dict[str, Any] = {}
    wanted = [d for f in files.values() for d in f.dependency]
    while wanted:
        name = wanted.pop()
        if name in files or name in found or name not in _GOOGLE:
            continue
        module = import_module(name.removesuffix(".proto").replace("/", ".") + "_pb2")
        found[name] = FileDescriptorProto.FromString(module.DESCRIPTOR.serialized_pb)
        wanted += found[name].dependency
    return found


def _in_order(files: Mapping[str, Any], known: Mapping[str, Any]) -> list[Any]:
    """The files, each behind those that it depends on."""
    every, done, order = {**known, **files}, set[str](), list[Any]()
    waiting = list(every)
    while waiting:
        name = waiting[-1]
        missing = [d for d in every[name].dependency if d in every and d not in done] if name not in done else []
        if missing and len(waiting) < 10 * len(every) + 10:
            waiting += missing
            continue
        waiting.pop()
        if name not in done:
            done.add(name)
            order.append(every[name])
    return order


def is_map(f: Any) -> bool:
    """Whether a field is a map: stored as repeated pairs."""
    return f.message_type is not None and bool(f.message_type.GetOptions().map_entry)


def is_repeated(f: Any) -> bool:
    """Whether a field is an array (or a map)."""
    repeated = getattr(f, "is_repeated", None)
    return bool(repeated) if repeated is not None else f.label == f.LABEL_REPEATED
