"""Long tables of OPC UA and SIMATIC loggers: as with every log of changes, a row that is gone changes what is held."""

from __future__ import annotations

import random

from tests.fuzz.formats.cnc_csv import common, edit_line
from tests.fuzz.harness import Mutation, Seed, Source
from tests.fuzz.mutations import edit_parts, flip

READER = "cnc"


def seeds() -> list[Seed]:
    classic = "DateTime,TagName,TagVal,TagQuality\n" + "".join(
        f"2026-03-02 08:00:{k:02d},T{k % 3},{20 + k / 8},{0 if k == 7 else 192}\n" for k in range(50)
    )
    ua = "NodeId;SourceTimestamp;ServerTimestamp;Value;StatusCode\n" + "".join(
        f"ns=2;2026-03-02T08:00:{k:02d}.5Z;2026-03-02T08:00:{k:02d}.6Z;{k},25;{'0x80340000' if k == 9 else 0}\n"
        for k in range(50)
    )
    by_tag = "SourceTimestamp,TagName,Value\n" + "".join(
        f"2026-03-02T08:00:{k:02d}Z,{tag},{k}\n" for tag in ("a", "b", "c") for k in range(30)
    )
    simatic = '"VarName";"TimeString";"VarValue";"Validity";"Time_ms"\n' + "".join(
        f'"T{k % 2}";"13.03.2026 11:02:{k:02d}";{k},50;1;46094460322,81\n' for k in range(50)
    )
    zone = Source(timezone="Europe/Prague")
    return [
        Seed("classic.csv", classic.encode(), zone),
        Seed("ua.csv", ua.encode()),
        Seed("by_tag.csv", by_tag.encode()),
        Seed("simatic.csv", simatic.encode(), zone),
    ]


def mutate(seed: Seed, rng: random.Random) -> Mutation:
    if (found := common(seed.data, rng)) is not None:
        return found
    lines = seed.data.splitlines(keepends=True)
    at = rng.randrange(1, len(lines))
    what = rng.randrange(4)
    if what == 0:
        done, kind = edit_parts(lines, rng, 1)
        return Mutation(b"".join(done), f"row {kind}", True, True)
    if what == 1:
        lines[at], kind = edit_line(lines[at], rng, b";" if b";" in lines[0] else b",")
        return Mutation(b"".join(lines), f"row: {kind}", False, True)
    if what == 2:
        junk = rng.choice((b"\0" * 40 + b"\n", b"\n\n", b"garbage\n", lines[0], b'"\n', b";;;;\n"))
        return Mutation(b"".join([*lines[:at], junk, *lines[at:]]), "line inserted", False, junk == b'"\n')
    lines[0] = flip(lines[0], rng)
    return Mutation(b"".join(lines), "header changed", True, True)
