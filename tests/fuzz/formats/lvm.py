"""LVM: every variant of the text format, line by line and cell by cell."""

from __future__ import annotations

import random
from collections.abc import Sequence

from tests.fuzz.harness import Mutation, Seed, Source
from tests.fuzz.mutations import cut, edit_parts, flip, insert

READER = "crio"
MARK = "***End_of_Header***"
TIME_KEYS = ("Date", "Time", "X0", "Delta_X", "X_Dimension")
PRAGUE = Source(timezone="Europe/Prague")


def _file(columns: str, several: str = "No", separator: str = "Tab", decimal: str | None = ".", **more: str) -> str:
    head = {
        "Writer_Version": "2",
        "Reader_Version": "2",
        "Separator": separator,
        "Decimal_Separator": decimal or "",
        "Multi_Headings": several,
        "X_Columns": columns,
        "Time_Pref": "Absolute",
        "Operator": "měřič",
        "Date": "2026/03/01",
        "Time": "08:00:00.25",
        **more,
    }
    if decimal is None:
        head["Writer_Version"] = "0.92"
        del head["Decimal_Separator"]
    return "LabVIEW Measurement\t\n" + "".join(f"{k}\t{v}\n" for k, v in head.items()) + f"{MARK}\t\n\t\n"


def _packet(
    names: Sequence[str], samples: Sequence[int], *, multi: bool = False, hour: int = 8, unit: str = "degC"
) -> str:
    gap = "\t\t" if multi else "\t"
    keys = {
        "Samples": list(map(str, samples)),
        "Date": ["2026/03/01"] * len(names),
        "Time": [f"{hour:02}:00:00.5"] * len(names),
        "Y_Unit_Label": [unit] * len(names),
        "X_Dimension": ["Time"] * len(names),
        "X0": ["0.0000000000000000E+0"] * len(names),
        "Delta_X": ["0.500000"] * len(names),
    }
    title = "".join(f"X_Value\t{n}\t" for n in names) if multi else "X_Value\t" + "".join(f"{n}\t" for n in names)
    return (
        f"Channels\t{len(names)}\n"
        + "".join(f"{k}\t{gap.join(v)}\t\n" for k, v in keys.items())
        + f"{MARK}\t\t\n{title}Comment\n"
    )


def _rows(rng: random.Random, n: int, channels: int, x: str, start: float = 0.0, words: bool = False) -> str:
    found = []
    for i in range(n):
        t = f"{start + i / 2:.6f}"
        v = [f"{rng.uniform(-90, 90):.6f}" for _ in range(channels)]
        cells = (
            [c for pair in zip([t] * channels, v, strict=True) for c in pair]
            if x == "Multi"
            else [t if x == "One" else "", *v]
        )
        found.append("\t".join(cells) + ("\tLOST COMMUNICATION" if words and i % 9 == 4 else "") + "\n")
    return "".join(found)


def _all() -> dict[str, bytes]:
    rng = random.Random(11)
    two, three = ["T1", "dZ (µm)"], ["a", "b", "c"]
    since_1904 = 3_855_000_000.0
    text = {
        "no": _file("No") + _packet(two, [40, 40]) + _rows(rng, 40, 2, "No"),
        "one": _file("One") + _packet(three, [1, 1, 1]) + _rows(rng, 40, 3, "One", words=True),
        "seconds": _file("One") + _packet(two, [1, 1]) + _rows(rng, 40, 2, "One", since_1904),
        "multi": _file("Multi") + _packet(three, [30, 30, 30], multi=True) + _rows(rng, 30, 3, "Multi"),
        "several": _file("No", "Yes")
        + "".join(
            _packet(two if k % 2 else three, [12] * (2 if k % 2 else 3), hour=8 + k)
            + _rows(rng, 12, 2 if k % 2 else 3, "No")
            + "\n"
            for k in range(4)
        ),
        "old": _file("One", "Yes", decimal=None)
        + "".join(_packet(two, [15, 15], hour=9 + k) + _rows(rng, 15, 2, "One") for k in range(2)),
        "special": _file("One").replace(MARK, "***Start_Special***\nx\t1\n***End_Special***\n" + MARK, 1)
        + "Notes\tonly for Dev0\n"
        + _packet(two, [1, 1])
        + _rows(rng, 30, 2, "One"),
    }
    text["german"] = text["one"].replace(".", ",")
    text["comma"] = text["one"].replace("Separator\tTab", "Separator\tComma").replace("\t", ",")
    found = {f"{name}.lvm": body.encode() for name, body in text.items()}
    found["crlf.lvm"] = text["no"].replace("\n", "\r\n").encode("cp1250")
    return found


FILES = _all()
VALUES = (b"", b"0", b"-1", b"99999999999", b"No", b"Multi", b"1e99", b"2026/13/45", b"25:61:00", b"Comma", b",")
JUNK = ("\0" * 40, "xyz", "1e999", "--", "NaN", "1.5.2", "12:30", "µm", "\t", "\t\t1\t2", "9" * 400, "1,5")


def seeds() -> list[Seed]:
    return [Seed(name, data, PRAGUE) for name, data in FILES.items()]


def mutate(seed: Seed, rng: random.Random) -> Mutation:
    lines = seed.data.splitlines(keepends=True)
    rows = _row_lines(lines)
    kind = rng.choices(
        ("cut", "row", "header line", "header value", "cell", "junk", "bytes", "nul"), (3, 4, 3, 4, 4, 3, 2, 1)
    )[0]
    if kind == "cut":
        data = cut(seed.data, rng)
        # whole rows of a file that announces no number of rows are an honest file; so is a last line without its end,
        # and one that ends behind a packet
        counted = seed.name in ("no.lvm", "crlf.lvm", "multi.lvm", "several.lvm", "old.lvm")
        between = seed.data[len(data) :].lstrip().startswith(b"Channels")
        return Mutation(data, kind, not counted or between, False)
    if kind == "row":
        return _row(seed, lines, rows, rng)
    if kind in ("header line", "header value"):
        return _header(seed, lines, [i for i in range(len(lines)) if i not in rows], rng, kind)
    if kind == "cell":
        return _cell(seed, lines, rng.choice(rows), rng)
    if kind == "junk":
        at = rng.randrange(len(lines) + 1)
        return Mutation(insert(seed.data, rng, sum(map(len, lines[:at]))), "junk between lines", False, False)
    if kind == "nul":
        at = rng.randrange(len(seed.data))
        many = rng.randrange(1, 600)
        return Mutation(seed.data[:at] + bytes(many) + seed.data[at + many :], "zeroed block", False, False)
    return Mutation(flip(seed.data, rng), "bytes", False, True)


def _row_lines(lines: list[bytes]) -> list[int]:
    """Numbers of the lines that are rows."""
    found, inside = [], False
    for i, line in enumerate(lines):
        if line.startswith(b"X_Value"):
            inside = True
        elif line[:1].isalpha() or line.startswith(b"*"):
            inside = False
        elif inside and line.strip():
            found.append(i)
    return found


def _row(seed: Seed, lines: list[bytes], rows: list[int], rng: random.Random) -> Mutation:
    """Rows dropped, doubled, swapped: where rows are counted, others get other times; with an X column they keep
    them."""
    first = rows[0]
    part, what = edit_parts(lines[: rows[-1] + 1], rng, first)
    counted = seed.name in ("no.lvm", "several.lvm", "crlf.lvm")
    return Mutation(b"".join(part + lines[rows[-1] + 1 :]), f"row {what}", True, counted or seed.name == "old.lvm")


def _header(seed: Seed, lines: list[bytes], headers: list[int], rng: random.Random, kind: str) -> Mutation:
    at = rng.choice(headers)
    name = lines[at].split(b"\t")[0].split(b",")[0].decode("utf-8", "replace")
    if kind == "header line":
        what = rng.choice(("dropped", "doubled", "swapped"))
        other = rng.choice(headers)
        edited = list(lines)
        if what == "dropped":
            del edited[at]
        elif what == "doubled":
            edited.insert(at, edited[at])
        else:
            edited[at], edited[other] = edited[other], edited[at]
        names = {name, lines[other].split(b"\t")[0].decode("utf-8", "replace") if what == "swapped" else name}
        # a heading's own date and time stand before those of the file; either may be all that there is
        harmless = bool(names & {"Date", "Time", "Operator", "Notes", "Y_Unit_Label"})
        return Mutation(b"".join(edited), f"header line {what}", harmless, harmless)
    line = lines[at].rstrip(b"\r\n")
    start = len(name) if rng.random() < 0.8 else 0
    changed = (
        flip(line, rng, start, None, 2)
        if rng.random() < 0.6 or start == 0
        else line[:start] + rng.choice((b"\t", b",")) + rng.choice(VALUES)
    )
    touched = name in TIME_KEYS or name.startswith("X_Value") or b"\n" in changed[len(name) :] or b"\r" in changed
    return Mutation(
        b"".join([*lines[:at], changed + lines[at][len(line) :], *lines[at + 1 :]]),
        f"value of {name}" if len(name) < 20 and name.isascii() and name.strip() else kind,
        name.startswith("X_Value"),
        touched,
    )


def _cell(seed: Seed, lines: list[bytes], at: int, rng: random.Random) -> Mutation:
    """A cell dropped, doubled, emptied, or replaced by what is no number."""
    separator = b"," if seed.name == "comma.lvm" else b"\t"
    end = b"\r\n" if lines[at].endswith(b"\r\n") else b"\n"
    cells = lines[at].rstrip(b"\r\n").split(separator)
    i = rng.randrange(len(cells))
    what = rng.choice(("dropped", "doubled", "emptied", "junk"))
    if what == "dropped":
        del cells[i]
    elif what == "doubled":
        cells.insert(i, cells[i])
    elif what == "emptied":
        cells[i] = b""
    else:
        cells[i] = rng.choice(JUNK).encode()
    # the free text behind the numbers may be anything, and so may a number that is one; a row of which the text
    # says that nothing was measured is flagged already
    blank = what == "emptied" or (what == "junk" and cells[i].strip() in (b"", b"--"))
    anything = (b"LOST" in lines[at] and (blank or i == len(lines[at].split(separator)) - 1)) or (
        what == "junk" and cells[i] in (b"1,5", b"NaN")
    )
    return Mutation(
        b"".join([*lines[:at], separator.join(cells) + end, *lines[at + 1 :]]), f"cell {what}", anything, anything
    )
