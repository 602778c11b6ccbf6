"""Plain LabVIEW text: rows of numbers between tabs, with seconds since 1904, seconds from a start, or no time."""

from __future__ import annotations

import random

from tests.fuzz.harness import Mutation, Seed, Source
from tests.fuzz.mutations import cut, edit_parts, flip, insert

READER = "crio"
START = 3_855_000_000
JUNK = (b"\0" * 40, b"xyz", b"1e999", b"--", b"1.5.2", b"12:30", b"\xc2\xb5m", b"\t\t1\t2", b"9" * 400, b"0x1F")


def _rows(rng: random.Random, n: int, form: str, channels: int = 2, last: bool = False) -> str:
    found = []
    for i in range(n):
        v = [f"{rng.uniform(-90, 90):.6f}" for _ in range(channels)]
        t = {"1904": f"{START + i / 4:.6f}", "seconds": f"{i / 10:.6f}", "none": ""}[form]
        cells = [c for c in ([*v, t] if last else [t, *v]) if c]
        found.append("\t".join(cells) + "\n")
    return "".join(found)


def _all() -> dict[str, bytes]:
    rng = random.Random(12)
    text = {
        "bare.txt": _rows(rng, 50, "1904"),
        "names.txt": "Time\tT1 [degC]\tdZ (µm)\n" + _rows(rng, 50, "1904"),
        "title.txt": "Warm-up test\n\nTime\tT1\tdZ\n" + _rows(rng, 50, "1904"),
        "last.txt": "T1\tdZ\tTimestamp\n" + _rows(rng, 50, "1904", last=True),
        "comment.txt": "Time\tT1\tdZ\tComment\n"
        + "".join(
            line + ("\tLOST COMMUNICATION" if i % 9 == 4 else "\t") + "\n"
            for i, line in enumerate(_rows(rng, 50, "1904").splitlines())
        ),
        "relative.lvm": _rows(rng, 50, "seconds"),
        "none.lvm": _rows(rng, 50, "none", 3),
    }
    text["german.txt"] = text["names.txt"].replace(".", ",")
    found = {name: body.encode() for name, body in text.items()}
    found["crlf.txt"] = text["names.txt"].replace("\n", "\r\n").encode("cp1252")
    return found


FILES = _all()


def seeds() -> list[Seed]:
    counted = Source(options={"increment": "1 s"})
    return [Seed(name, data, counted if name == "none.lvm" else Source()) for name, data in FILES.items()]


def mutate(seed: Seed, rng: random.Random) -> Mutation:
    lines = seed.data.splitlines(keepends=True)
    first = next(
        i
        for i, line in enumerate(lines)
        if line[:1].isdigit() or line[:1] == b"-" or b"." in line[:12] or b"," in line[:12]
    )
    kind = rng.choices(("cut", "row", "header", "cell", "junk", "bytes", "nul"), (3, 3, 2, 5, 3, 2, 1))[0]
    counted = seed.name == "none.lvm"
    if kind == "cut":
        # a file of rows that ends behind a row is an honest file
        return Mutation(cut(seed.data, rng), kind, True, False)
    if kind == "row":
        edited, what = edit_parts(lines, rng, first)
        return Mutation(b"".join(edited), f"row {what}", True, counted or (what == "swapped" and seed.name[0] == "r"))
    if kind == "header":
        if not first:
            return Mutation(b"T\tx\ty\n" + seed.data, "header added", True, seed.name.endswith(".lvm"))
        at = rng.randrange(first)
        changed = flip(lines[at], rng, 0, None, 2) if rng.random() < 0.6 else b""
        return Mutation(b"".join([*lines[:at], changed, *lines[at + 1 :]]), kind, True, True)
    if kind == "cell":
        return _cell(seed, lines, rng.randrange(first, len(lines)), rng)
    if kind == "junk":
        at = rng.randrange(first, len(lines) + 1)
        return Mutation(insert(seed.data, rng, sum(map(len, lines[:at]))), "junk between lines", False, False)
    if kind == "nul":
        at, many = rng.randrange(len(seed.data)), rng.randrange(1, 600)
        return Mutation(seed.data[:at] + bytes(many) + seed.data[at + many :], "zeroed block", False, False)
    return Mutation(flip(seed.data, rng), "bytes", False, True)


def _cell(seed: Seed, lines: list[bytes], at: int, rng: random.Random) -> Mutation:
    end = b"\r\n" if lines[at].endswith(b"\r\n") else b"\n"
    cells = lines[at].rstrip(b"\r\n").split(b"\t")
    i = rng.randrange(len(cells))
    what = rng.choice(("dropped", "doubled", "emptied", "junk"))
    free = seed.name == "comment.txt" and (i == 3 or b"LOST" in lines[at])
    if what == "dropped":
        del cells[i]
    elif what == "doubled":
        cells.insert(i, cells[i])
    elif what == "emptied":
        cells[i] = b""
    else:
        cells[i] = rng.choice(JUNK)
    return Mutation(b"".join([*lines[:at], b"\t".join(cells) + end, *lines[at + 1 :]]), f"cell {what}", free, free)
