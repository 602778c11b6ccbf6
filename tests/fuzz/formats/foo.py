"""An example of a format's module, and what the harness itself is tested with: the FOO logger of the README, with a
last line that proves the file complete. Its own reader, so that broken twins of it can be made."""

from __future__ import annotations

import random
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from tests.fuzz.harness import Mutation, Seed
from tests.fuzz.mutations import cut, edit_parts, insert
from thermodata.errors import FormatError
from thermodata.plugin import Block, Head, Loss, Recording, Signal, Source


class Foo:
    """'FOO1 <name> <unit> <rows>', then lines '<seconds> <value>;' with as many rows as the header says."""

    name = "foo"

    def sniff(self, head: Head) -> str | None:
        return "starts with FOO1" if head.start.startswith(b"FOO1 ") else None

    def describe(self, path: Path, source: Source) -> Recording:
        words, _, whole = self.parse(path)
        return Recording((Signal(words[1], "foo", words[2]),), "relative", complete=whole)

    def blocks(self, path: Path, source: Source) -> Iterator[Block | Loss]:
        words, rows, whole = self.parse(path)
        t, v = (np.array(c) for c in zip(*rows, strict=True)) if rows else (np.empty(0), np.empty(0))
        yield Block("foo", np.rint(t * 1e9).astype(np.int64), {words[1]: v.astype(np.float64)})
        if not whole:
            yield Loss("rows", reason=f"{len(rows)} good rows, the header says {words[3]}")

    def parse(self, path: Path) -> tuple[list[str], list[tuple[float, float]], bool]:
        head, *lines = path.read_text("utf-8", "surrogateescape").split("\n")
        words = head.split()
        if len(words) != 4 or words[0] != "FOO1" or not words[3].isdecimal() or not head.isprintable():
            raise FormatError("not a FOO log", where=path.name, got=ascii(head[:40]))
        rows = []
        for line in lines:
            try:
                t, v = map(float, line.removesuffix(";").split())
            except ValueError:
                continue
            if line.endswith(";") and abs(t) < 1e9:
                rows.append((t, v))
        return words, rows, len(rows) == int(words[3]) == len({t for t, _ in rows}) and lines[len(rows) :] == [""]


READER: type = Foo


def seeds() -> list[Seed]:
    rows = "".join(f"{i / 2:.1f} {20 + i / 8:.3f};\n" for i in range(40))
    return [Seed("a.foo", b"FOO1 T degC 40\n" + rows.encode())]


def mutate(seed: Seed, rng: random.Random) -> Mutation:
    lines = seed.data.splitlines(keepends=True)
    kind = rng.choice(("cut", "line", "junk", "count", "value"))
    if kind == "cut":
        return Mutation(cut(seed.data, rng), kind, False, False)
    if kind == "line":
        edited, what = edit_parts(lines, rng, 1)
        return Mutation(b"".join(edited), f"line {what}", what == "swapped", False)
    if kind == "junk":
        at = rng.randrange(len(lines) + 1)
        place = sum(map(len, lines[:at]))
        return Mutation(insert(seed.data, rng, place), "junk between lines", False, False)
    if kind == "count":
        other = b" %d\n" % rng.randrange(10 ** rng.randint(1, 12))
        return Mutation(seed.data.replace(b" 40\n", other), kind, False, False)
    at = rng.randrange(1, len(lines))
    lines[at] = b"%d %d;\n" % (rng.randrange(100), rng.randrange(100))
    return Mutation(b"".join(lines), "value", False, True)
