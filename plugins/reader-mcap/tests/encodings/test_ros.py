"""ROS messages: our decoder against the package mcap-ros2-support, byte order, schemas as msg, idl and ros1."""

from __future__ import annotations

import struct
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mcap_ros2._dynamic import serialize_dynamic
from thermodata_reader_mcap.container.definitions import Schema
from thermodata_reader_mcap.encodings.columns import Columns
from thermodata_reader_mcap.encodings.decoded_messages import columns as one_by_one
from thermodata_reader_mcap.encodings.ros.cdr import PayloadError
from thermodata_reader_mcap.encodings.ros.idl import idl_types
from thermodata_reader_mcap.encodings.ros.message_types import message_types
from thermodata_reader_mcap.encodings.ros.package import package_decoder
from thermodata_reader_mcap.encodings.ros.schemas import ros_decoder
from thermodata_reader_mcap.signals.survey.topic_discovery import discover

from thermodata.errors import FormatError
from thermodata.plugin import Source

T0 = 1_772_434_800_000_000_000
LINE = "=" * 80
MSG = f"""# a machine
std_msgs/Header header
float64 LIMIT=3.5
string GREETING=hello # no comment
bool on
float32[2] x      # [mm]
int16[] load
string<=20 prog "MPF" # default
Probe[<=4] probes
uint64 count 5
Empty nothing
{LINE}
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
{LINE}
MSG: lab_msgs/Probe
string id
float64 um
{LINE}
MSG: lab_msgs/Empty
"""
IDL = f"""{LINE}
IDL: lab_msgs/msg/Probe
module lab_msgs {{ module msg {{ struct Probe {{ string id; double um; }}; }}; }};
{LINE}
IDL: lab_msgs/msg/Machine
// generated
#include "std_msgs/msg/Header.idl"
module lab_msgs {{
  module msg {{
    typedef float float__2[2];
    enum Mode {{ IDLE, @verbatim(language="c", text="x(1)") RUN }};
    module Machine_Constants {{ const double LIMIT = 3.5; const string<5> GREETING = "a;b"; }};
    @verbatim (language="comment", text="a machine" "of a lab")
    struct Machine {{
      std_msgs::msg::Header header;
      boolean on;
      @unit (value="mm") float__2 x;
      sequence<int16> load;
      string<20> prog;
      sequence<lab_msgs::msg::Probe, 4> probes;
      @default (value=5)
      unsigned long long count;
      Empty nothing;
    }};
    struct Empty {{ uint8 structure_needs_at_least_one_member; }};
  }};
}};
{LINE}
IDL: std_msgs/msg/Header
module std_msgs {{ module msg {{ struct Header {{ builtin_interfaces::msg::Time stamp; string frame_id; }}; }}; }};
{LINE}
IDL: builtin_interfaces/msg/Time
module builtin_interfaces {{ module msg {{ struct Time {{ int32 sec; uint32 nanosec; }}; }}; }};
"""
SCHEMA = Schema("lab_msgs/msg/Machine", "ros2msg", MSG.encode())
IDL_SCHEMA = Schema("lab_msgs/msg/Machine", "ros2idl", IDL.encode())
ENCODE = serialize_dynamic("lab_msgs/msg/Machine", MSG)["lab_msgs/msg/Machine"]
texts = st.text(st.characters(exclude_categories=["Cs"], exclude_characters="\0"), max_size=6)
messages = st.fixed_dictionaries(
    {
        "header": st.fixed_dictionaries(
            {
                "stamp": st.fixed_dictionaries({"sec": st.integers(0, 2**31 - 1), "nanosec": st.integers(0, 10**9)}),
                "frame_id": texts,
            }
        ),
        "on": st.booleans(),
        "x": st.lists(st.floats(width=32, allow_nan=False), min_size=2, max_size=2),
        "load": st.lists(st.integers(-(2**15), 2**15 - 1), max_size=5),
        "prog": texts,
        "probes": st.lists(st.fixed_dictionaries({"id": texts, "um": st.floats(allow_nan=False)}), max_size=3),
        "count": st.integers(0, 2**64 - 1),
        "nothing": st.just({}),
    }
)


def message(k: int) -> dict[str, Any]:
    return {
        "header": {"stamp": {"sec": T0 // 10**9 + k, "nanosec": k}, "frame_id": "machine"},
        "on": k % 2 == 0,
        "x": [k / 8, -1.5],
        "load": list(range(k % 3)),
        "prog": f"MPF{k % 5}",
        "probes": [{"id": "a", "um": k / 4}] * (k % 2),
        "count": 2**63 + k,
        "nothing": {},
    }


@settings(deadline=None)
@given(messages)
def test_values_are_those_of_the_package(value: dict[str, Any]) -> None:
    payload = ENCODE(value)
    theirs = package_decoder(SCHEMA)
    assert theirs is not None
    assert ros_decoder("cdr", SCHEMA).decode(payload) == theirs.decode(payload) == value
    by_idl = ros_decoder("cdr", IDL_SCHEMA).decode(payload)
    assert {**by_idl, "nothing": {}} == value


def same(a: Columns, b: Columns) -> None:
    assert a.kept.tolist() == b.kept.tolist()
    assert a.values.keys() == b.values.keys()
    for name in a.values:
        np.testing.assert_array_equal(a.values[name], b.values[name])
        assert a.values[name].dtype == b.values[name].dtype
        none = np.zeros(a.kept.size, np.uint16)
        np.testing.assert_array_equal(a.flags.get(name, none), b.flags.get(name, none))
    assert {(w.message, w.name, w.expected) for w in a.wrong} == {(w.message, w.name, w.expected) for w in b.wrong}


@settings(deadline=None)
@given(st.lists(messages, min_size=1, max_size=4), st.lists(st.integers(0, 3), min_size=1, max_size=60), st.data())
def test_many_at_once_are_as_one_by_one(kinds: list[dict[str, Any]], order: list[int], data: st.DataObject) -> None:
    payloads = [ENCODE(kinds[k % len(kinds)]) for k in order]
    if data.draw(st.booleans()):
        place = data.draw(st.integers(0, len(payloads) - 1))
        kept = data.draw(st.integers(0, len(payloads[place])))
        payloads[place] = payloads[place][:kept] + data.draw(st.binary(max_size=9))
    decoder = ros_decoder("cdr", SCHEMA)
    topic = discover("/m", {"c": decoder}, {"c": payloads[::2]}, False, 1 << 20)[0]
    if topic is not None:
        same(decoder.columns(topic, payloads), one_by_one(topic, decoder.decode, payloads, 0))


def big_endian(value: dict[str, Any]) -> bytes:
    """The same message as a writer with the other byte order stores it."""
    out = bytearray()

    def put(letter: str, *values: Any) -> None:
        for one in values:
            out.extend(b"\0" * (-len(out) % struct.calcsize("=" + letter)))
            out.extend(struct.pack(">" + letter, one))

    def text(one: str) -> None:
        put("I", len(one.encode()) + 1)
        out.extend(one.encode() + b"\0")

    stamp = value["header"]["stamp"]
    put("i", stamp["sec"])
    put("I", stamp["nanosec"])
    text(value["header"]["frame_id"])
    put("?", value["on"])
    put("f", *value["x"])
    put("I", len(value["load"]))
    put("h", *value["load"])
    text(value["prog"])
    put("I", len(value["probes"]))
    for probe in value["probes"]:
        text(probe["id"])
        put("d", probe["um"])
    put("Q", value["count"])
    put("B", 0)
    return b"\0\0\0\0" + bytes(out)


@settings(deadline=None)
@given(messages)
def test_big_endian_messages_are_read(value: dict[str, Any]) -> None:
    assert ros_decoder("cdr", SCHEMA).decode(big_endian(value)) == value


@pytest.mark.parametrize("schema", [("ros2msg", MSG), ("ros2idl", IDL)])
def test_a_recording_in_both_byte_orders(tmp_path: Path, write: Any, read: Any, schema: tuple[str, str]) -> None:
    payloads = [ENCODE(message(k)) if k % 3 else big_endian(message(k)) for k in range(60)]
    path = write(
        tmp_path / "a.mcap",
        [("/m", T0 + 7 + k, p) for k, p in enumerate(payloads)],
        encoding="cdr",
        schema=("lab_msgs/msg/Machine", schema[0], schema[1].encode()),
    )
    recording, times, values, flags, losses = read(path, Source(options={"time": "header.stamp"}))
    assert not losses
    assert {s.name: s.dtype for s in recording.signals}["/m.count"] == "uint64"
    np.testing.assert_array_equal(times["/m"], T0 + np.arange(60) * 1_000_000_001)
    assert values["/m.count"] == [2**63 + k for k in range(60)]
    assert values["/m.prog"] == [f"MPF{k % 5}" for k in range(60)]
    np.testing.assert_array_equal(values["/m.probes.a.um"], [k / 4 if k % 2 else np.nan for k in range(60)])
    assert [f == 0 for f in flags["/m.load[1]"]] == [k % 3 == 2 for k in range(60)]


def test_ros1_messages_are_read(tmp_path: Path, write: Any, read: Any) -> None:
    text = (
        f"Header header\nchar c\nbyte b\nduration d\nfloat32[] x\n{LINE}\nMSG: std_msgs/Header\nuint32 seq\n"
        "time stamp\nstring frame_id\n"
    )
    payloads = [
        struct.pack("<IIII3sBbiiI2f", k, T0 // 10**9, k, 3, b"abc", 200, -1, -1, 5, 2, k / 8, 0.5) for k in range(30)
    ]
    path = write(
        tmp_path / "a.mcap",
        [("/m", T0 + k, p) for k, p in enumerate(payloads)],
        encoding="ros1",
        schema=("lab_msgs/M", "ros1msg", text.encode()),
    )
    _, times, values, _, losses = read(path, Source(options={"time": "header.stamp"}))
    assert not losses
    np.testing.assert_array_equal(times["/m"], T0 + np.arange(30))
    assert (values["/m.c"][0], values["/m.b"][0], values["/m.d.secs"][0]) == (200, -1, -1)
    np.testing.assert_array_equal(values["/m.x[0]"], np.arange(30) / 8)


def test_negative_durations_and_late_times_keep_their_sign() -> None:
    """The package reads both as unsigned."""
    text = b"builtin_interfaces/Duration d\nbuiltin_interfaces/Time t"
    decoder = ros_decoder("cdr", Schema("a/msg/A", "ros2msg", text))
    assert decoder.decode(b"\0\1\0\0" + struct.pack("<iIiI", -3, 5, -1, 6)) == {
        "d": {"sec": -3, "nanosec": 5},
        "t": {"sec": -1, "nanosec": 6},
    }


@pytest.mark.parametrize(
    ("payload", "words"),
    [
        (b"", "shorter"),
        (b"\0\3\0\0" + bytes(80), "encapsulation"),
        (ENCODE(message(4))[:-9], "early"),
        (ENCODE(message(4)) + b"x" * 20, "more than the schema"),
        (b"\0\1\0\0" + b"\xff" * 60, "a length of"),
    ],
)
def test_payloads_of_another_shape_are_refused(payload: bytes, words: str) -> None:
    with pytest.raises(PayloadError, match=words):
        ros_decoder("cdr", SCHEMA).decode(payload)


@pytest.mark.parametrize(
    "text", ["Missing x", "B b\n===\nMSG: a/B\nA x", "A x", "int32", "wstring w", f"B b\n{LINE}\nno name"]
)
def test_definitions_that_do_not_resolve_are_named(tmp_path: Path, write: Any, read: Any, text: str) -> None:
    path = write(
        tmp_path / "a.mcap", [("/m", T0, bytes(40))], encoding="cdr", schema=("a/msg/A", "ros2msg", text.encode())
    )
    with pytest.raises(FormatError, match="topic '/m' is not read: the schema 'a/msg/A' does not read"):
        read(path)


@settings(deadline=None)
@given(st.text(max_size=80))
def test_any_text_as_a_definition_parses_or_is_refused(text: str) -> None:
    from thermodata_reader_mcap.encodings.ros.message_types import TypeTextError

    for parse in (lambda: message_types("a/msg/A", text, False), lambda: idl_types("a/msg/A", "module a { " + text)):
        with suppress(TypeTextError):
            assert parse().root == "a/A"


def test_images_are_a_note_and_no_signals(tmp_path: Path, write: Any, read: Any) -> None:
    payload = b"\0\1\0\0" + struct.pack("<II", 3, 5000) + bytes(5000)
    path = write(
        tmp_path / "a.mcap",
        [("/m", T0 + k, payload) for k in range(20)],
        encoding="cdr",
        schema=("a/msg/A", "ros2msg", b"uint32 n\nuint8[] data"),
    )
    recording, _, values, _, losses = read(path)
    assert not losses
    assert set(values) == {"/m.n"}
    assert any("5000 bytes of binary data" in note for note in recording.notes)
