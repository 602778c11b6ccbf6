"""Protobuf messages by real FileDescriptorSets: every kind of field, and what a message leaves out."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from google.protobuf import timestamp_pb2
from google.protobuf.descriptor_pb2 import FieldDescriptorProto as Field
from google.protobuf.descriptor_pb2 import FileDescriptorProto, FileDescriptorSet
from google.protobuf.descriptor_pool import DescriptorPool
from google.protobuf.json_format import MessageToDict
from google.protobuf.message_factory import GetMessageClass
from hypothesis import given, settings
from hypothesis import strategies as st
from thermodata_reader_mcap.container.definitions import Schema
from thermodata_reader_mcap.encodings.decoded_messages import columns as one_by_one
from thermodata_reader_mcap.encodings.protobuf.schemas import protobuf_decoder
from thermodata_reader_mcap.signals.survey.topic_discovery import discover

from thermodata.errors import FormatError
from thermodata.plugin import Source

T0 = 1_772_434_800_000_000_000
STAMP = FileDescriptorProto.FromString(timestamp_pb2.DESCRIPTOR.serialized_pb)
KINDS = {
    "double": Field.TYPE_DOUBLE,
    "float": Field.TYPE_FLOAT,
    "int32": Field.TYPE_INT32,
    "int64": Field.TYPE_INT64,
    "uint32": Field.TYPE_UINT32,
    "uint64": Field.TYPE_UINT64,
    "sint64": Field.TYPE_SINT64,
    "fixed64": Field.TYPE_FIXED64,
    "sfixed32": Field.TYPE_SFIXED32,
    "bool": Field.TYPE_BOOL,
    "string": Field.TYPE_STRING,
    "bytes": Field.TYPE_BYTES,
}


def machine_files() -> FileDescriptorSet:
    """The set as protoc writes it; here the file that depends comes first."""
    own = FileDescriptorProto(name="lab.proto", package="lab", syntax="proto3", dependency=[STAMP.name])
    state = own.enum_type.add(name="State")
    for number, name in enumerate(("IDLE", "RUN")):
        state.value.add(name=name, number=number)
    probe = own.message_type.add(name="Probe")
    probe.field.add(name="um", number=1, type=Field.TYPE_DOUBLE, label=Field.LABEL_OPTIONAL)
    main = own.message_type.add(name="Machine")
    inner = main.nested_type.add(name="TempsEntry")
    inner.options.map_entry = True
    inner.field.add(name="key", number=1, type=Field.TYPE_STRING, label=Field.LABEL_OPTIONAL)
    inner.field.add(name="value", number=2, type=Field.TYPE_DOUBLE, label=Field.LABEL_OPTIONAL)
    main.oneof_decl.add(name="reading")
    main.oneof_decl.add(name="_maybe")
    one, many = Field.LABEL_OPTIONAL, Field.LABEL_REPEATED
    for number, (name, kind, label, more) in enumerate(
        (
            ("stamp", Field.TYPE_MESSAGE, one, {"type_name": ".google.protobuf.Timestamp"}),
            ("x", Field.TYPE_DOUBLE, one, {}),
            ("n", Field.TYPE_INT32, one, {}),
            ("state", Field.TYPE_ENUM, one, {"type_name": ".lab.State"}),
            ("speed", Field.TYPE_DOUBLE, one, {"oneof_index": 0}),
            ("error", Field.TYPE_STRING, one, {"oneof_index": 0}),
            ("maybe", Field.TYPE_INT32, one, {"oneof_index": 1, "proto3_optional": True}),
            ("probes", Field.TYPE_MESSAGE, many, {"type_name": ".lab.Probe"}),
            ("load", Field.TYPE_FLOAT, many, {}),
            ("temps", Field.TYPE_MESSAGE, many, {"type_name": ".lab.Machine.TempsEntry"}),
            ("big", Field.TYPE_UINT64, one, {}),
            ("data", Field.TYPE_BYTES, one, {}),
        ),
        1,
    ):
        main.field.add(name=name, number=number, type=kind, label=label, **more)
    return FileDescriptorSet(file=[own, STAMP])


def message_class(files: FileDescriptorSet, name: str) -> Any:
    pool = DescriptorPool()
    for each in reversed(files.file):
        pool.Add(each)
    return GetMessageClass(pool.FindMessageTypeByName(name))


def machines(n: int) -> list[bytes]:
    machine = message_class(machine_files(), "lab.Machine")
    found = []
    for k in range(n):
        m = machine(
            x=k / 8,
            n=-k,
            state=k % 2,
            probes=[{"um": k / 4}] * (k % 3),
            load=[0.5] * (k % 2),
            temps={"front": 20 + k / 4},
            big=2**63 + k,
            data=b"ab",
        )
        m.stamp.FromNanoseconds(T0 + k)
        if k % 4 == 0:
            m.error = f"E{k}"
        else:
            m.speed = k / 2
        if k == 5:
            m.maybe = 0
        found.append(m.SerializeToString())
    return found


def test_every_kind_of_field(tmp_path: Path, write: Any, read: Any) -> None:
    path = write(
        tmp_path / "a.mcap",
        [("/m", T0 + k, data) for k, data in enumerate(machines(40))],
        encoding="protobuf",
        schema=("lab.Machine", "protobuf", machine_files().SerializeToString()),
    )
    recording, _, values, flags, losses = read(path)
    assert not losses
    assert {s.name: s.dtype for s in recording.signals} == {
        "/m.stamp.seconds": "int64",
        "/m.stamp.nanos": "int64",
        "/m.x": "float64",
        "/m.n": "int64",
        "/m.state": "int64",
        "/m.speed": "float64",
        "/m.error": "str",
        "/m.maybe": "int64",
        "/m.probes[0].um": "float64",
        "/m.probes[1].um": "float64",
        "/m.load[0]": "float64",
        "/m.temps.front": "float64",
        "/m.big": "uint64",
        "/m.data[0]": "int64",
        "/m.data[1]": "int64",
    }
    k = np.arange(40)
    np.testing.assert_array_equal(values["/m.x"], k / 8)
    np.testing.assert_array_equal(values["/m.speed"], np.where(k % 4, k / 2, np.nan))  # a oneof: not 0, missing
    assert values["/m.error"] == [f"E{j}" if j % 4 == 0 else None for j in range(40)]
    np.testing.assert_array_equal(values["/m.probes[1].um"], np.where(k % 3 == 2, k / 4, np.nan))
    np.testing.assert_array_equal(values["/m.load[0]"], np.where(k % 2, 0.5, np.nan))
    assert values["/m.big"] == [2**63 + j for j in range(40)]
    assert [f == 0 for f in flags["/m.maybe"]] == [j == 5 for j in range(40)]  # set to 0 is not unset
    assert [s * 10**9 + n for s, n in zip(values["/m.stamp.seconds"], values["/m.stamp.nanos"], strict=True)] == [
        T0 + j for j in range(40)
    ]
    assert {s.name: dict(s.properties) for s in recording.signals}["/m.state"]["labels"] == "0 IDLE, 1 RUN"


def test_enumerations_are_labels_where_asked_and_the_stamp_is_the_time(tmp_path: Path, write: Any, read: Any) -> None:
    path = write(
        tmp_path / "a.mcap",
        [("/m", T0 + 99 + k, data) for k, data in enumerate(machines(20))],
        encoding="protobuf",
        schema=("lab.Machine", "protobuf", machine_files().SerializeToString()),
    )
    _, times, values, _, losses = read(path, Source(options={"enums": "label", "time": "stamp"}))
    assert not losses
    assert values["/m.state"][:3] == ["IDLE", "RUN", "IDLE"]
    np.testing.assert_array_equal(times["/m"], T0 + np.arange(20))


def test_googles_own_types_may_be_missing_from_the_set(tmp_path: Path, write: Any, read: Any) -> None:
    files = machine_files()
    del files.file[1]
    path = write(
        tmp_path / "a.mcap",
        [("/m", T0, machines(1)[0])],
        encoding="protobuf",
        schema=("lab.Machine", "protobuf", files.SerializeToString()),
    )
    assert read(path)[2]["/m.stamp.seconds"] == [T0 // 10**9]


def test_long_binary_data_are_a_note_and_no_signals(tmp_path: Path, write: Any, read: Any) -> None:
    machine = message_class(machine_files(), "lab.Machine")
    path = write(
        tmp_path / "a.mcap",
        [("/m", T0 + k, machine(x=k, data=bytes(5000)).SerializeToString()) for k in range(5)],
        encoding="protobuf",
        schema=("lab.Machine", "protobuf", machine_files().SerializeToString()),
    )
    recording, _, values, _, losses = read(path)
    assert not losses
    assert not any("data[" in name for name in values)
    assert "/m.data holds up to 5000 bytes of binary data; they are not read" in recording.notes


@pytest.mark.parametrize(("name", "data"), [("lab.Machine", b"\xff\xff"), ("lab.Nothing", None), ("lab.Machine", b"")])
def test_a_schema_that_does_not_read_is_named(
    tmp_path: Path, write: Any, name: str, data: bytes | None, read: Any
) -> None:
    stored = machine_files().SerializeToString() if data is None else data
    path = write(tmp_path / "a.mcap", [("/m", T0, b"\x11")], encoding="protobuf", schema=(name, "protobuf", stored))
    with pytest.raises(FormatError, match=f"the schema '{name}' does not read"):
        read(path)


def test_payloads_that_do_not_parse_are_lost_by_name(tmp_path: Path, write: Any, read: Any) -> None:
    payloads = machines(30)
    payloads[7] = payloads[7][:-1]
    path = write(
        tmp_path / "a.mcap",
        [("/m", T0 + k, data) for k, data in enumerate(payloads)],
        encoding="protobuf",
        schema=("lab.Machine", "protobuf", machine_files().SerializeToString()),
    )
    _, times, _, _, losses = read(path)
    assert times["/m"].size == 29
    assert [loss.from_ns for loss in losses] == [T0 + 7]


VALUES = {
    "double": st.floats(allow_nan=False, allow_infinity=False),
    "bool": st.booleans(),
    "float": st.floats(width=32, allow_nan=False, allow_infinity=False),
    "string": st.text(max_size=8),
    "bytes": st.binary(max_size=5),
    "int32": st.integers(-(2**31), 2**31 - 1),
    "sfixed32": st.integers(-(2**31), 2**31 - 1),
    "int64": st.integers(-(2**63), 2**63 - 1),
    "sint64": st.integers(-(2**63), 2**63 - 1),
    "uint32": st.integers(0, 2**32 - 1),
    "uint64": st.integers(0, 2**64 - 1),
    "fixed64": st.integers(0, 2**64 - 1),
}


@settings(deadline=None)
@given(st.lists(st.sampled_from(sorted(KINDS)), min_size=1, max_size=6), st.data())
def test_values_are_those_of_the_package(kinds: list[str], data: st.DataObject) -> None:
    own = FileDescriptorProto(name="x.proto", package="x", syntax="proto3")
    message = own.message_type.add(name="X")
    for k, kind in enumerate(kinds):
        label = Field.LABEL_REPEATED if data.draw(st.booleans()) else Field.LABEL_OPTIONAL
        message.field.add(name=f"f{k}", number=k + 1, type=KINDS[kind], label=label)
    files = FileDescriptorSet(file=[own])
    made = message_class(files, "x.X")()
    expected: dict[str, Any] = {}
    for k, kind in enumerate(kinds):
        many = message.field[k].label == Field.LABEL_REPEATED
        value = data.draw(st.lists(VALUES[kind], max_size=3) if many else VALUES[kind])
        if many:
            getattr(made, f"f{k}").extend(value)
        else:
            setattr(made, f"f{k}", value)
        plain = [list(v) if isinstance(v, bytes) else v for v in value] if many else value
        expected[f"f{k}"] = list(plain) if isinstance(plain, bytes) else plain
    decoder = protobuf_decoder(Schema("x.X", "protobuf", files.SerializeToString()), "number")
    got = decoder.decode(made.SerializeToString())
    assert got == expected
    assert set(MessageToDict(made, preserving_proto_field_name=True)) <= set(got)


@settings(deadline=None)
@given(st.lists(st.integers(0, 60), min_size=1, max_size=40), st.data())
def test_many_at_once_are_as_one_by_one(order: list[int], data: st.DataObject) -> None:
    every = machines(61)
    payloads = [every[k] for k in order]
    if data.draw(st.booleans()):
        place = data.draw(st.integers(0, len(payloads) - 1))
        kept = data.draw(st.integers(0, len(payloads[place])))
        tail = data.draw(st.sampled_from([b"", b"\x09", b"\x62\x03abc", b"\x38\x05"]))
        payloads[place] = payloads[place][:kept] + tail
    enums = data.draw(st.sampled_from(["number", "label"]))
    decoder = protobuf_decoder(Schema("lab.Machine", "protobuf", machine_files().SerializeToString()), enums)
    topic = discover("/m", {"c": decoder}, {"c": payloads[:: data.draw(st.integers(1, 3))]}, False, 1 << 20)[0]
    if topic is None:
        return
    a, b = decoder.columns(topic, payloads), one_by_one(topic, decoder.decode, payloads, 0)
    assert a.kept.tolist() == b.kept.tolist()
    assert a.values.keys() == b.values.keys()
    for name in a.values:
        np.testing.assert_array_equal(a.values[name], b.values[name])
        assert a.values[name].dtype == b.values[name].dtype
    assert {k: v.tolist() for k, v in a.flags.items()} == {k: v.tolist() for k, v in b.flags.items()}
    assert a.wrong == b.wrong
