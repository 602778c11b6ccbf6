"""MCAP with JSON messages."""

from __future__ import annotations

import json
import random

from mcap.writer import Writer

from tests.fuzz.formats.mcap_edit import T0, dialects
from tests.fuzz.formats.mcap_edit import mutate as structural
from tests.fuzz.harness import Mutation, Seed, Source
from tests.fuzz.mutations import cut, flip, insert

READER = "mcap"
STEP = 10_000_000


def _add(writer: Writer) -> None:
    schema = writer.register_schema(
        "axis",
        "jsonschema",
        json.dumps(
            {"type": "object", "properties": {"x": {"type": "number", "unit": "mm"}, "n": {"type": "integer"}}}
        ).encode(),
    )
    axis, temp = writer.register_channel("/axis", "json", schema), writer.register_channel("/temp", "json", 0)
    single, again = writer.register_channel("/single", "json", 0), writer.register_channel("/axis", "json", schema)
    for k in range(24):
        t = T0 + k * STEP
        writer.add_message(
            axis if k % 3 else again,
            t,
            json.dumps(
                {"x": k / 8, "n": 2**53 + k, "pos": {"y": -k, "on": k % 2 == 0}, "prog": f"MPF{k // 5}"}
            ).encode(),
            t,
        )
        writer.add_message(
            temp,
            t + 1,
            json.dumps({"T": [20 + k / 4, None, 21.5][: 1 + k % 3], "o": None if k % 4 else {"z": k}}).encode(),
            t - 5,
        )
        if k % 2:
            writer.add_message(single, t + 2, str(k / 2).encode(), t + 2)
    writer.add_metadata("machine", {"serial": "4711"})
    writer.add_attachment(T0, T0, "note.txt", "text/plain", b"hello")


def _relative(writer: Writer) -> None:
    one = writer.register_channel("/µ°", "json", 0)
    for k in range(30):
        writer.add_message(one, k * STEP, json.dumps({"v": k, "w": float("nan") if k == 7 else 0.5}).encode(), k * STEP)


def seeds() -> list[Seed]:
    """Every way to hold messages, and sources that choose topics and times."""
    chosen = Source(topics=("/a*",), options={"time": "publish_time"})
    return [*dialects("json", _add), *dialects("relative", _relative)[:3], *dialects("chosen", _add, chosen)[:2]]


def _payload(data: bytes, rng: random.Random) -> bytes:
    return rng.choice(
        (
            flip(data, rng),
            cut(data, rng),
            insert(data, rng),
            b"",
            b"{}",
            b"[]",
            b"null",
            b"[" * 3000,
            b'{"a":' * 2000,
            data + data,
            data.replace(b":", b": 1e999,", 1),
            data.replace(b"1", b"NaN"),
            data.replace(b'"', b"'"),
            b'{"x": 123456789012345678901234567890, "n": 1e5, "pos": 3}',
            b'{"x": "text", "T": {"a": 1}}',
            json.dumps({f"k{rng.randrange(1000)}": k for k in range(300)}).encode(),
            json.dumps({"T": list(range(1000))}).encode(),
            '{"x": "µ°"}'.encode("cp1252"),
            b'{"x": 1, "x": 2}',
        )
    )


def mutate(seed: Seed, rng: random.Random) -> Mutation:
    """A change of the file's structure, or of one message."""
    return structural(seed, rng, _payload)
