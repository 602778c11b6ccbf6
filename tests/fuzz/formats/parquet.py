"""Parquet: footer, page headers, lengths, packed pages, row groups; with checksums of pages and without."""

from __future__ import annotations

import io
import random
import struct
from functools import lru_cache

import numpy as np

from tests.fuzz.harness import Mutation, Seed, Source
from tests.fuzz.mutations import cut, flip, insert

READER = "table"
_PRAGUE = Source(timezone="Europe/Prague")
_N = 60


@lru_cache(maxsize=1)
def _seeds() -> tuple[Seed, ...]:
    import pyarrow as pa
    import pyarrow.parquet as pq

    wave = np.sin(np.arange(_N) * 0.5)
    columns = {
        "T1 [degC]": wave * 40,
        "n": (wave * 1000).astype(np.int32),
        "door": wave > 0,
        "mode": pa.array(["idle", "cut", None] * (_N // 3)).dictionary_encode(),
        "load": pa.array(np.where(wave > 0.9, np.nan, wave).astype(np.float32)),
    }
    when = np.datetime64("2026-03-01T08:00:00", "ms") + np.arange(_N) * np.timedelta64(500, "ms")
    times = {
        "local": pa.array(when),
        "utc": pa.array(when, pa.timestamp("us", "UTC")),
        "seconds": pa.array(np.arange(_N) * 0.5),
    }
    made = []
    for name, time in times.items():
        for packed in ("NONE", "zstd"):
            out = io.BytesIO()
            called = "time [s]" if name == "seconds" else "time"
            pq.write_table(pa.table({called: time, **columns}), out, row_group_size=25, compression=packed)
            made.append(Seed(f"{name}_{packed}.parquet", out.getvalue(), _PRAGUE))
    out = io.BytesIO()
    nested = pa.table(
        {"time": times["utc"], "probe": pa.StructArray.from_arrays([pa.array(wave), pa.array(wave * 2)], ["X", "Y"])}
    )
    pq.write_table(nested, out)
    made.append(Seed("nested.parquet", out.getvalue(), _PRAGUE))
    out = io.BytesIO()
    pq.write_table(pa.table({"time": times["utc"], **columns}), out, row_group_size=25, write_page_checksum=True)
    return (*made, Seed("checked.parquet", out.getvalue(), _PRAGUE))


def seeds() -> list[Seed]:
    return list(_seeds())


def mutate(seed: Seed, rng: random.Random) -> Mutation:
    data = seed.data
    footer = struct.unpack("<I", data[-8:-4])[0]
    start = len(data) - 8 - footer
    what = rng.choice(("cut", "footer", "footer", "footer", "length", "magic", "pages", "junk", "drop", "text"))
    if what == "cut":
        return Mutation(cut(data, rng), "cut", False, False)
    if what == "footer":
        # the footer has no checksum: types, units, offsets and names in it say what the values mean
        return Mutation(flip(data, rng, start, len(data) - 8, 2), "footer bytes", False, True)
    if what == "length":
        huge = struct.pack("<I", rng.choice((0, 1, 2**31, 2**32 - 1, len(data), footer + 1, footer - 1)))
        return Mutation(data[:-8] + huge + data[-4:], "footer length", False, True)
    if what == "magic":
        return Mutation(flip(flip(data, rng, len(data) - 4, None), rng, 0, 4), "magic", False, False)
    if what == "pages":
        return Mutation(flip(data, rng, 4, start), "page bytes", False, True)
    if what == "junk":
        return Mutation(insert(data, rng, rng.randrange(4, start)), "junk in pages", False, True)
    if what == "drop":
        at = rng.randrange(4, start)
        return Mutation(data[:at] + data[at + rng.choice((1, 8, 64)) :], "bytes dropped", False, True)
    at = rng.randrange(start, len(data) - 8)
    return Mutation(
        data[:at] + bytes((data[at] ^ (1 << rng.randrange(8)),)) + data[at + 1 :], "footer bit", False, True
    )
