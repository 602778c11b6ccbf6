"""MDF 3 and 4: blocks, links, lengths, counters, data types, conversions, packed data. Needs asammdf."""

from __future__ import annotations

import datetime as dt
import random
import struct
import tempfile
from functools import lru_cache
from pathlib import Path

import numpy as np

from tests.fuzz.harness import Mutation, Seed, Source
from tests.fuzz.mutations import cut, flip, insert

READER = "table"
_PRAGUE = Source(timezone="Europe/Prague")
_N = 60


@lru_cache(maxsize=1)
def _seeds() -> tuple[Seed, ...]:
    from asammdf import MDF, Signal

    made = []
    for version, compression in (("4.10", 0), ("4.11", 2), ("3.30", 0)):
        t = np.arange(_N) * 0.1
        wave = np.sin(t)
        invalid = np.zeros(_N, bool)
        invalid[5:9] = True
        more = {"invalidation_bits": invalid} if version >= "4" else {}
        signals = [
            Signal(wave * 40, t, name="T1", unit="degC", comment="front"),
            Signal((wave * 1000).astype("<i2"), t, name="probe", unit="um", conversion={"a": 0.01, "b": -1.0}, **more),
            Signal(
                (np.arange(_N) % 2).astype("u1"),
                t,
                name="state",
                conversion={"val_0": 0, "text_0": b"off", "val_1": 1, "text_1": b"on"},
            ),
            Signal((wave * 9).astype("<f4"), t, name="load", unit="%"),
        ]
        if version >= "4":
            signals.append(Signal(np.array([b"idle", b"cut"] * (_N // 2)), t, name="mode", encoding="utf-8"))
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / ("x.mf4" if version >= "4" else "x.mdf")
            with MDF(version=version) as mdf:
                mdf.start_time = dt.datetime(2026, 3, 1, 8, tzinfo=dt.UTC)
                mdf.append(signals)
                mdf.append([Signal(np.arange(9, dtype=">u4"), np.arange(9) * 1.0, name="n", unit="rpm")])
                mdf.save(path, overwrite=True, compression=compression)
            made.append(Seed(f"{version}{path.suffix}", path.read_bytes(), _PRAGUE))
    return tuple(made)


def seeds() -> list[Seed]:
    return list(_seeds())


@lru_cache(maxsize=8)
def _blocks(data: bytes) -> tuple[tuple[int, int, int, bytes], ...]:
    """(start, length, links, id) of the blocks of an MDF 4 file."""
    found, at = [], 64
    while (at := data.find(b"##", at)) >= 0:
        if at % 8 == 0 and at + 24 <= len(data):
            length, links = struct.unpack("<QQ", data[at + 8 : at + 24])
            if 24 <= length <= len(data) - at and links < 100:
                found.append((at, length, links, data[at : at + 4]))
        at += 2
    return tuple(found)


def mutate(seed: Seed, rng: random.Random) -> Mutation:
    data = seed.data
    what = rng.choice(("cut", "flip", "flip", "link", "link", "length", "body", "body", "head", "junk", "data"))
    if what == "cut":
        return Mutation(cut(data, rng), "cut", False, False)
    if what == "head":
        return Mutation(flip(data, rng, 0, 64), "identification", False, True)
    if what == "junk":
        return Mutation(insert(data, rng), "junk", False, True)
    if seed.name.endswith(".mdf"):
        at = rng.randrange(64, len(data))
        return Mutation(flip(data, rng, at, at + 1, 1), "byte of version 3", False, True)
    blocks = _blocks(data)
    changed = bytearray(data)
    start, length, links, kind = rng.choice(blocks)
    name = kind[2:].decode()
    huge = rng.choice(
        (0, 1, 64, 2**31, 2**63, 2**64 - 1, len(data), rng.randrange(len(data) // 8) * 8, rng.choice(blocks)[0])
    )
    if what == "link" and links:
        struct.pack_into("<Q", changed, start + 24 + 8 * rng.randrange(links), huge)
        # a link to another whole block of the right kind is an honest link
        return Mutation(bytes(changed), f"link of {name}", False, True)
    if what == "length":
        struct.pack_into("<Q", changed, start + rng.choice((8, 16)), huge)
        return Mutation(bytes(changed), f"length of {name}", False, kind in (b"##TX", b"##MD"))
    if what == "data":
        start, length, links, kind = next(b for b in blocks if b[3] in (b"##DT", b"##DZ"))
        at = start + 24 + rng.randrange(max(1, length - 24))
        changed[at] = rng.randrange(256)
        return Mutation(bytes(changed), f"byte of {kind[2:].decode()}", False, True)
    body = start + 24 + 8 * links
    if what == "body" and body < start + length:
        at = rng.randrange(body, start + length)
        changed[at] = rng.randrange(256)
        # types, offsets, factors and names say what values mean
        return Mutation(bytes(changed), f"body of {name}", False, True)
    changed[start + rng.randrange(24)] = rng.randrange(256)
    return Mutation(bytes(changed), f"head of {name}", False, kind in (b"##TX", b"##MD"))
