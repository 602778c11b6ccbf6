"""TNCscope recordings: counts in the header and a first column that counts the rows tell what is missing."""

from __future__ import annotations

import random
import re

from tests.fuzz.formats.cnc_csv import ABSURD, common, edit_line
from tests.fuzz.harness import Mutation, Seed, Source
from tests.fuzz.mutations import edit_parts

READER = "cnc"


def _curve(name: str, axis: str, count: int, cycle: int) -> str:
    return (
        f"%[CURVE]\r\n%CHANNELTYPE={name}\r\n%AXISTYPE={axis}\r\n%DIMENSION=mm\r\n%COUNT={count}\r\n"
        f"%CYCLETIME={cycle}\r\n%\r\n"
    )


def seeds() -> list[Seed]:
    start = "%[GLOBAL]\r\n%DATE=02.03.2026\r\n%TIME=09:00:00\r\n%\r\n"
    head = (
        _curve("s actual", "X", 60, 3000) + _curve("v act.", "X", 60, 3000) + _curve("T", "S", 30, 6000) + "%[DATA]\r\n"
    )
    counted = start + head + "".join(f"{k * 3000};{k / 8:.3f};{k * k};{k if k < 30 else ''};\r\n" for k in range(60))
    plain = start + head + "".join(f"{k / 8:.3f};{k * k};{k if k < 30 else ''}\r\n" for k in range(60))
    zone = Source(timezone="Europe/Prague")
    return [Seed("counted.sco", counted.encode(), zone), Seed("plain.sco", plain.encode(), zone)]


def mutate(seed: Seed, rng: random.Random) -> Mutation:
    if (found := common(seed.data, rng, rows=False)) is not None:
        return found
    lines = seed.data.splitlines(keepends=True)
    first = lines.index(b"%[DATA]\r\n") + 1
    counted, what = seed.name == "counted.sco", rng.randrange(5)
    if what == 0:
        done, kind = edit_parts(lines, rng, first)
        # without a counting column a moved row cannot be told from a measured one
        return Mutation(b"".join(done), f"row {kind}", False, not counted)
    at = rng.randrange(first, len(lines))
    if what == 1:
        lines[at], kind = edit_line(lines[at], rng, b";")
        return Mutation(b"".join(lines), f"row: {kind}", False, False)
    if what == 2:
        junk = rng.choice((b"\0" * 40 + b"\r\n", b"\r\n", b"garbage\r\n", b"%\r\n", b"%[CURVE]\r\n", b";;;;\r\n"))
        return Mutation(b"".join([*lines[:at], junk, *lines[at:]]), "line inserted", False, not counted)
    if what == 3:
        head = rng.randrange(first)
        key, mark, _ = lines[head].partition(b"=")
        if mark:
            lines[head] = key + mark + rng.choice(ABSURD) + b"\r\n"
        return Mutation(
            b"".join(lines), "header value replaced", False, bool(re.search(rb"CYCLE|DATE|TIME|TYPE|COUNT", key))
        )
    done, kind = edit_parts(lines[:first], rng)
    return Mutation(b"".join([*done, *lines[first:]]), f"header line {kind}", False, True)
