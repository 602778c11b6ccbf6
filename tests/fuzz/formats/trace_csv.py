"""Sinumerik Trace CSV: rows with their own time, and no count."""

from __future__ import annotations

import random

from tests.fuzz.formats.cnc_csv import common, edit_line
from tests.fuzz.harness import Mutation, Seed
from tests.fuzz.mutations import edit_parts, flip

READER = "cnc"


def seeds() -> list[Seed]:
    one = "time,+/Nck/!SD/nckServoDataActCurr32 [u1; 1],+/Channel/!RP/rpa [u1; 15]\n" + "".join(
        f"{k * 0.002:.3f},{k / 8},{k}\n" for k in range(60)
    )
    block = (
        "id, key, name\nf1, s1, /Nck/!SEMA/cmdContrPos [u1  1]\nf2, s2, /Nck/!SD/nckServoDataActCurr64 [u1  1]\n\n"
        "time, f1, f2\n" + "".join(f"{k * 0.002:.6f}, {k / 8}, {k * k}\n" for k in range(60))
    )
    comma = one.replace(",", ";").replace(".", ",").replace("[u1; ", "[u1, ")
    return [Seed("one.csv", one.encode()), Seed("block.csv", block.encode()), Seed("comma.csv", comma.encode())]


def mutate(seed: Seed, rng: random.Random) -> Mutation:
    if (found := common(seed.data, rng)) is not None:
        return found
    lines = seed.data.splitlines(keepends=True)
    first = next(k for k, line in enumerate(lines) if line[:1].isdigit())
    at, what = rng.randrange(first, len(lines)), rng.randrange(4)
    if what == 0:
        done, kind = edit_parts(lines, rng, first)
        return Mutation(b"".join(done), f"row {kind}", True, False)
    if what == 1:
        lines[at], kind = edit_line(lines[at], rng, b";" if seed.name == "comma.csv" else b",")
        return Mutation(b"".join(lines), f"row: {kind}", False, False)
    if what == 2:
        junk = rng.choice((b"\0" * 40 + b"\n", b"\n\n", b"garbage\n", lines[0], b",,,,\n"))
        return Mutation(b"".join([*lines[:at], junk, *lines[at:]]), "line inserted", False, False)
    head = rng.randrange(first)
    lines[head] = flip(lines[head], rng)
    return Mutation(b"".join(lines), "header flipped", True, True)
