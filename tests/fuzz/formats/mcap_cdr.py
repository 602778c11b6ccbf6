"""MCAP with ROS messages: cdr by ros2msg and ros2idl in both byte orders, and ros1."""

from __future__ import annotations

import random
import struct

from mcap.writer import Writer

from tests.fuzz.formats.mcap_edit import T0, dialects
from tests.fuzz.formats.mcap_edit import mutate as structural
from tests.fuzz.harness import Mutation, Seed, Source
from tests.fuzz.mutations import cut, flip, insert

READER = "mcap"
STEP = 10_000_000
_LINE = "=" * 80
MSG = f"""std_msgs/Header header
float64 MAX=3.5
bool on
float32 x  # [mm]
uint8[3] raw
int16[] load
string<=20 prog
Probe[<=4] probes
uint64 count 5
{_LINE}
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
{_LINE}
MSG: lab_msgs/Probe
string id
float64 um
"""
IDL = f"""{_LINE}
IDL: lab_msgs/msg/Machine
#include "std_msgs/msg/Header.idl"
module lab_msgs {{ module msg {{
  typedef uint8 uint8__3[3];
  module Machine_Constants {{ const double MAX = 3.5; }};
  @verbatim (language="comment", text="a machine" "of a lab")
  struct Machine {{
    std_msgs::msg::Header header;
    boolean on;
    float x; // [mm]
    uint8__3 raw;
    sequence<int16> load;
    string<20> prog;
    sequence<lab_msgs::msg::Probe, 4> probes;
    @default (value=5) uint64 count;
  }};
}}; }};
{_LINE}
IDL: lab_msgs/msg/Probe
module lab_msgs {{ module msg {{ struct Probe {{ string id; double um; }}; }}; }};
{_LINE}
IDL: std_msgs/msg/Header
module std_msgs {{ module msg {{ struct Header {{ builtin_interfaces::msg::Time stamp; string frame_id; }}; }}; }};
{_LINE}
IDL: builtin_interfaces/msg/Time
module builtin_interfaces {{ module msg {{ struct Time {{ int32 sec; uint32 nanosec; }}; }}; }};
"""
MSG1 = (
    MSG.replace("builtin_interfaces/Time", "time")
    .replace("string<=20", "string")
    .replace("[<=4]", "[]")
    .replace("uint64 count 5", "uint64 count")
    .replace("std_msgs/Header header", "Header header")
    .replace("time stamp", "uint32 seq\ntime stamp")
)


class Cdr:
    """Writes values one after the other. order: "<" or ">"; aligned: as cdr, not as ros1."""

    def __init__(self, order: str, aligned: bool) -> None:
        self.order, self.aligned, self.data = order, aligned, bytearray()

    def put(self, letter: str, *values: object) -> None:
        size = struct.calcsize("=" + letter)
        for value in values:
            if self.aligned:
                self.data += b"\0" * (-len(self.data) % size)
            self.data += struct.pack(self.order + letter, value)

    def text(self, value: str) -> None:
        data = value.encode() + (b"\0" if self.aligned else b"")
        self.put("I", len(data))
        self.data += data

    def done(self) -> bytes:
        return (bytes([0, 1 if self.order == "<" else 0, 0, 0]) if self.aligned else b"") + bytes(self.data)


def message(k: int, order: str = "<", ros1: bool = False) -> bytes:
    """The k-th message of the schemas above."""
    c = Cdr(order, not ros1)
    t = T0 + k * STEP
    if ros1:
        c.put("I", k)
    c.put("I" if ros1 else "i", t // 10**9)
    c.put("I", t % 10**9)
    c.text("machine")
    c.put("?", k % 2 == 0)
    c.put("f", k / 8)
    c.put("B", k, 255, 0)
    c.put("I", k % 4)
    c.put("h", *(-j for j in range(k % 4)))
    c.text(f"MPF{k // 5}")
    c.put("I", k % 3)
    for j in range(k % 3):
        c.text("ab"[j])
        c.put("d", k / 4 + j)
    c.put("Q", 2**63 + k)
    return c.done()


def _msg(writer: Writer) -> None:
    schema = writer.register_schema("lab_msgs/msg/Machine", "ros2msg", MSG.encode())
    first, second = writer.register_channel("/machine", "cdr", schema), writer.register_channel("/other", "cdr", schema)
    for k in range(26):
        t = T0 + k * STEP
        writer.add_message(first if k % 5 else second, t, message(k, "<" if k % 7 else ">"), t - 7)


def _idl(writer: Writer) -> None:
    schema = writer.register_schema("lab_msgs/msg/Machine", "ros2idl", IDL.encode())
    one = writer.register_channel("/idl", "cdr", schema)
    for k in range(22):
        writer.add_message(one, T0 + k * STEP, message(k), T0 + k * STEP)


def _ros1(writer: Writer) -> None:
    schema = writer.register_schema("lab_msgs/Machine", "ros1msg", MSG1.encode())
    one = writer.register_channel("/ros1", "ros1", schema)
    for k in range(22):
        writer.add_message(one, T0 + k * STEP, message(k, ros1=True), T0 + k * STEP)


def seeds() -> list[Seed]:
    """Every way to hold messages, each kind of schema, and the header's stamp as time."""
    stamp = Source(options={"time": "header.stamp"})
    return [
        *dialects("cdr", _msg),
        *dialects("idl", _idl)[:3],
        *dialects("ros1", _ros1)[:3],
        *dialects("stamp", _msg, stamp)[:2],
    ]


def _payload(data: bytes, rng: random.Random) -> bytes:
    return rng.choice(
        (
            flip(data, rng),
            cut(data, rng),
            insert(data, rng),
            b"",
            data + data,
            data[:4],
            b"\0\1\0\0",
            b"\0\3" + data[2:],
            b"\0\7" + data[2:],
            data[:20] + b"\xff\xff\xff\xff" + data[24:],
        )
    )


def mutate(seed: Seed, rng: random.Random) -> Mutation:
    """A change of the file's structure, or of one message."""
    return structural(seed, rng, _payload)
