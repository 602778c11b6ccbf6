"""The decoder of a protobuf schema: a FileDescriptorSet, with Google's own types where it leaves them out."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from thermodata_reader_mcap.container.definitions import Schema
from thermodata_reader_mcap.encodings.decoder import UnsupportedError
from thermodata_reader_mcap.encodings.protobuf.decoder import ProtobufDecoder

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
