"""TwinCAT Scope exports: every row holds its own times; the EOF row or the announced end tells a cut one."""

from __future__ import annotations

import random

from tests.fuzz.formats.cnc_csv import common, edit_line
from tests.fuzz.harness import Mutation, Seed
from tests.fuzz.mutations import edit_parts, flip

READER = "cnc"
_START = 134_169_120_000_000_000


def _head(end: int, names: str, more: str = "", mark: str = "\t") -> str:
    text = (
        f"Name\tproject\nFile\tC:\\scope.csv\nStarttime of export\t{_START}\tMontag\nEndtime of export\t{_START + end}"
        f"\tMontag\n\n\n{names}\n{more}\n"
    )
    return text.replace("\t", mark)


def seeds() -> list[Seed]:
    full = _head(
        295_000,
        "Name\tfast\tName\tT\tdoor",
        "SymbolComment\t\tSymbolComment\tLager\t\nData-Type\tREAL32\tData-Type"
        "\tREAL64\tBIT\nSampleTime[ms]\t0,5\tSampleTime[ms]\t1\t1\nUnit\t(None)\tUnit\t°C (Temperature)\t(None)\n",
    )
    rows = "".join(f"{k / 2}\t{k / 8}\t" + (f"{k}\t{20 + k / 4}\t{k % 2}\n" if k < 30 else "\t\t\n") for k in range(60))
    short = "".join(f"{k};{k / 8};{k * 2};{k * k}\n" if k < 20 else f"{k};{k / 8}\n" for k in range(40)).replace(
        ".", ","
    )
    filled = "".join(f"{k}\t{k / 8}\t{k // 2 * 2}\t{k // 2}\n" for k in range(40))
    ticks = "".join(f"{_START + k * 10_000}\t{k}\n" for k in range(40))
    return [
        Seed("full.csv", (full + rows.replace(".", ",") + "EOF\n").encode()),
        Seed(
            "short.csv",
            (_head(390_000, "Name;a;Name;b", "SampleTime[ms];1;SampleTime[ms];2\n", ";") + short).encode(),
        ),
        Seed(
            "filled.csv",
            (_head(390_000, "Name\ta\tName\tb", "SampleTime[ms]\t1\tSampleTime[ms]\t2\n") + filled).encode(),
        ),
        Seed("ticks.csv", (_head(390_000, "Name\ta") + ticks + "EOF\n").encode()),
    ]


def mutate(seed: Seed, rng: random.Random) -> Mutation:
    if (found := common(seed.data, rng, rows=False)) is not None:
        # behind the announced end minus one sample nothing proves a file without EOF whole
        return found
    lines = seed.data.splitlines(keepends=True)
    mark = b";" if b";" in lines[0] else b"\t"
    first = next(k for k, line in enumerate(lines) if k > 6 and line[:1].isdigit())
    last = len(lines) - (lines[-1] == b"EOF\n")
    at, what = rng.randrange(first, last), rng.randrange(5)
    if what == 0:
        done, kind = edit_parts(lines[first:last], rng)
        return Mutation(b"".join([*lines[:first], *done, *lines[last:]]), f"row {kind}", True, False)
    if what == 1:
        lines[at], kind = edit_line(lines[at], rng, mark)
        return Mutation(b"".join(lines), f"row: {kind}", False, False)
    if what == 2:
        junk = rng.choice((b"\0" * 40 + b"\n", b"\n\n", b"garbage\n", lines[6], mark * 9 + b"\n"))
        return Mutation(b"".join([*lines[:at], junk, *lines[at:]]), "line inserted", False, False)
    head = rng.randrange(first)
    if what == 3:
        lines[head] = flip(lines[head], rng)
        return Mutation(b"".join(lines), "header flipped", True, True)
    done, kind = edit_parts(lines[:first], rng)
    return Mutation(b"".join([*done, *lines[first:]]), f"header line {kind}", False, True)
