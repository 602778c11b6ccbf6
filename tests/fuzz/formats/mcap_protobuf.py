"""MCAP with protobuf messages: nested, repeated, maps, oneofs, enumerations, timestamps."""

from __future__ import annotations

import random
from typing import Any

from google.protobuf import timestamp_pb2
from google.protobuf.descriptor_pb2 import FieldDescriptorProto, FileDescriptorProto, FileDescriptorSet
from google.protobuf.descriptor_pool import DescriptorPool
from google.protobuf.message_factory import GetMessageClass
from mcap.writer import Writer

from tests.fuzz.formats.mcap_edit import T0, dialects
from tests.fuzz.formats.mcap_edit import mutate as structural
from tests.fuzz.harness import Mutation, Seed, Source
from tests.fuzz.mutations import cut, flip, insert

READER = "mcap"
STEP = 10_000_000
_F = FieldDescriptorProto


def _files() -> FileDescriptorSet:
    stamp = FileDescriptorProto.FromString(timestamp_pb2.DESCRIPTOR.serialized_pb)
    own = FileDescriptorProto(name="machine.proto", package="lab", syntax="proto3", dependency=[stamp.name])
    state = own.enum_type.add(name="State")
    for number, name in enumerate(("IDLE", "RUN", "FAULT")):
        state.value.add(name=name, number=number)
    probe = own.message_type.add(name="Probe")
    probe.field.add(name="id", number=1, type=_F.TYPE_STRING, label=_F.LABEL_OPTIONAL)
    probe.field.add(name="um", number=2, type=_F.TYPE_FLOAT, label=_F.LABEL_OPTIONAL)
    main = own.message_type.add(name="Machine")
    main.oneof_decl.add(name="value")
    entry = main.nested_type.add(name="TempsEntry")
    entry.options.map_entry = True
    entry.field.add(name="key", number=1, type=_F.TYPE_STRING, label=_F.LABEL_OPTIONAL)
    entry.field.add(name="value", number=2, type=_F.TYPE_DOUBLE, label=_F.LABEL_OPTIONAL)
    for name, number, kind, extra in (
        ("stamp", 1, _F.TYPE_MESSAGE, {"type_name": ".google.protobuf.Timestamp"}),
        ("x", 2, _F.TYPE_DOUBLE, {}),
        ("count", 3, _F.TYPE_UINT64, {}),
        ("n", 4, _F.TYPE_SINT32, {}),
        ("on", 5, _F.TYPE_BOOL, {}),
        ("state", 6, _F.TYPE_ENUM, {"type_name": ".lab.State"}),
        ("raw", 7, _F.TYPE_BYTES, {}),
        ("speed", 8, _F.TYPE_DOUBLE, {"oneof_index": 0}),
        ("error", 9, _F.TYPE_STRING, {"oneof_index": 0}),
    ):
        main.field.add(name=name, number=number, type=kind, label=_F.LABEL_OPTIONAL, **extra)
    for name, number, kind, extra in (
        ("probes", 10, _F.TYPE_MESSAGE, {"type_name": ".lab.Probe"}),
        ("load", 11, _F.TYPE_INT32, {}),
        ("temps", 12, _F.TYPE_MESSAGE, {"type_name": ".lab.Machine.TempsEntry"}),
    ):
        main.field.add(name=name, number=number, type=kind, label=_F.LABEL_REPEATED, **extra)
    return FileDescriptorSet(file=[own, stamp])


def _class() -> tuple[Any, bytes]:
    files, pool = _files(), DescriptorPool()
    for each in reversed(files.file):
        pool.Add(each)
    return GetMessageClass(pool.FindMessageTypeByName("lab.Machine")), files.SerializeToString()


def _add(writer: Writer) -> None:
    machine, schema = _class()
    number = writer.register_schema("lab.Machine", "protobuf", schema)
    first, second = (
        writer.register_channel("/machine", "protobuf", number),
        writer.register_channel("/other", "protobuf", number),
    )
    for k in range(24):
        t = T0 + k * STEP
        m = machine(
            x=k / 8,
            count=2**63 + k,
            n=-k,
            on=k % 2 == 0,
            state=k % 3,
            raw=bytes([k, 255]),
            probes=[{"id": "a", "um": k / 4}, {"id": "b", "um": 1.5}][: 1 + k % 2],
            load=range(k % 4),
            temps={"front": 20 + k / 4},
        )
        m.stamp.FromNanoseconds(t - 1000)
        if k % 3:
            m.speed = k / 2
        else:
            m.error = "E4711"
        writer.add_message(first if k % 4 else second, t, m.SerializeToString(), t - 7)


def seeds() -> list[Seed]:
    """Every way to hold messages, and the options that change what is read."""
    labels = Source(options={"enums": "label", "time": "stamp"})
    return [*dialects("proto", _add), *dialects("labels", _add, labels)[:2]]


def _payload(data: bytes, rng: random.Random) -> bytes:
    return rng.choice(
        (
            flip(data, rng),
            cut(data, rng),
            insert(data, rng),
            b"",
            data + data,
            data + b"\x0a\xff\xff\xff",
            b"\x52" * 40,
            bytes([0x5A, 0x80, 0x08]) + b"\1" * 1024,
            b"\x3a\x80\x10" + b"x" * 2048,
        )
    )


def mutate(seed: Seed, rng: random.Random) -> Mutation:
    """A change of the file's structure, or of one message."""
    return structural(seed, rng, _payload)
