"""SHDR logs. A line that is gone or moved changes what is held behind it, which no reader can see; a line that is no
longer whole must be told."""

from __future__ import annotations

import random

from tests.fuzz.formats.cnc_csv import common, edit_line
from tests.fuzz.harness import Mutation, Seed
from tests.fuzz.mutations import edit_parts

READER = "cnc"


def seeds() -> list[Seed]:
    plain = "* adapterVersion: 2\n" + "".join(
        f"2026-03-02T08:00:{k:02d}.5000000Z|S1speed|{k * 100}|Xpos|{k / 8}|mode|{'AUTO' if k % 2 else 'MDI'}\n"
        + (
            f"2026-03-02T08:00:{k:02d}.600Z|servo|{'FAULT|E17|1|HIGH|hot' if k % 3 else 'NORMAL||||'}\n"
            if k % 4 == 0
            else ""
        )
        for k in range(40)
    )
    special = (
        "2026-03-02T08:00:00Z@100|load|5|path|1 2 3\n|load|6\n2026-03-02T08:00:01Z|acc|3|100|1 2 3\n"
        "2026-03-02T08:00:02Z|@ASSET@|1|Part|--multiline--AB\n<Part>|x|1</Part>\n--multiline--AB\n"
        '2026-03-02T08:00:03Z|note|17|a message\n2026-03-02T08:00:04Z|text|"a \\| b"|load|UNAVAILABLE\n'
        "2026-03-02T08:00:05Z|acc|3|100|4 5 6\n2026-03-02T08:00:06Z|load|7|path|4 5 6\n"
    )
    offset = "".join(f"{k * 100}.5|Xpos|{k / 4}|mode|{'A' if k % 3 else 'B'}\n" for k in range(40))
    return [
        Seed("plain.txt", plain.encode()),
        Seed("special.txt", special.encode()),
        Seed("offset.txt", offset.encode()),
    ]


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
        lines[at], kind = edit_line(lines[at], rng, b"|")
        return Mutation(b"".join(lines), f"line: {kind}", False, True)
    if what == 2:
        junk = rng.choice(
            (b"\0" * 40 + b"\n", b"\n\n", b"garbage\n", b"* PONG 1000\n", b"|\n", b"||||\n", b"\xff\xfe|\n")
        )
        if seed.name == "special.txt" and 3 <= at <= 5:
            at = 3
        return Mutation(b"".join([*lines[:at], junk, *lines[at:]]), "line inserted", False, False)
    lines[at] = lines[at].rstrip(b"\n") + rng.choice((b"\r\n", b"\r", b" \n", b""))
    return Mutation(b"".join(lines), "line end changed", False, True)
