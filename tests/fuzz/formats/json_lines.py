"""Lines of JSON. A line that is gone changes what is held behind it, which no reader can see; one that is no longer
whole must be told."""

from __future__ import annotations

import random

from tests.fuzz.formats.cnc_csv import common, edit_line
from tests.fuzz.harness import Mutation, Seed
from tests.fuzz.mutations import edit_parts

READER = "cnc"


def seeds() -> list[Seed]:
    stamps = [f"2026-03-02T08:00:{k:02d}Z" for k in range(40)]
    topics = "".join(f'{{"ts":"{t}","topic":"shop/T{k % 3}","value":{20 + k / 8}}}\n' for k, t in enumerate(stamps))
    flat = "".join(f'{{"time":"{t}","T1":{20 + k / 8},"T2":21.5,"mode":"AUTO"}}\n' for k, t in enumerate(stamps))
    point = '{{"id":"{}","val":{},"ts":"{}","qc":3}}'
    edge = "".join(
        f'{{"seq":{k},"vals":[{point.format(101, f"{k}.5", t)},{point.format(102, k % 2, t)}]}}\n'
        for k, t in enumerate(stamps)
    )
    return [Seed("topics.jsonl", topics.encode()), Seed("flat.jsonl", flat.encode()), Seed("edge.jsonl", edge.encode())]


def mutate(seed: Seed, rng: random.Random) -> Mutation:
    if (found := common(seed.data, rng)) is not None:
        return found
    lines = seed.data.splitlines(keepends=True)
    at = rng.randrange(len(lines))
    what = rng.randrange(4)
    if what == 0:
        done, kind = edit_parts(lines, rng)
        return Mutation(b"".join(done), f"line {kind}", True, True)
    if what == 1:
        lines[at], kind = edit_line(lines[at], rng, b",")
        return Mutation(b"".join(lines), f"line: {kind}", False, True)
    if what == 2:
        junk = rng.choice(
            (b"\0" * 40 + b"\n", b"\n\n", b"garbage\n", b"{}\n", b"[" * 4000 + b"\n", b'{"a":' * 300 + b"\n")
        )
        return Mutation(b"".join([*lines[:at], junk, *lines[at:]]), "line inserted", False, False)
    lines[at] = lines[at].rstrip(b"\n") + rng.choice((b"\r\n", b" \n", b",\n"))
    return Mutation(b"".join(lines), "line end changed", False, True)
