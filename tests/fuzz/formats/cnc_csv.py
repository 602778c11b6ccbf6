"""A control's plain CSV: dialects of three languages. Rows carry their own time and the format has no count, so that
whole rows may be gone; a row of another width, a cut, or what stands between rows must be told."""

from __future__ import annotations

import random
import re

from tests.fuzz.harness import Mutation, Seed, Source
from tests.fuzz.mutations import cut, edit_parts, flip, insert

READER = "cnc"
_ZONE = Source(timezone="Europe/Prague")
ABSURD = (
    b"0",
    b"-1",
    b"1e12",
    b"1e308",
    b"999999999999",
    b"NaN",
    b"inf",
    b"",
    b"0x1F",
    b"9" * 400,
    "١٢٣".encode(),
    b"'; DROP TABLE x;--",
    b"4294967296",
    b"1.5.5",
)


def seeds() -> list[Seed]:
    german = "Datum;Uhrzeit;Drehzahl;T_Lager;Tür;Programm\n;;[U/min];[°C];;\n" + "".join(
        f"02.03.2026;08:{k:02d}:00;{1000 + k};{20 + k / 8:.3f};{'EIN' if k % 3 else 'AUS'};P{k // 5}\n".replace(
            ".", ",", 0
        )
        for k in range(40)
    )
    german = re.sub(r"(\d+)\.(\d{3});", r"\1,\2;", german)
    czech = "Čas\tOtáčky (1/min)\tTeplota vřetene (°C)\n" + "".join(
        f"2.3.2026 8:{k:02d}:30,5\t{k * 10}\t{21 + k / 4:.2f}\n".replace(".25", ",25") for k in range(30)
    )
    czech = re.sub(r"\t(\d+)\.(\d\d)\n", r"\t\1,\2\n", czech)
    english = "Machine log\nSerial: 138\n\nTimestamp,Spindle speed [rpm],Alarm,Load [%]\n" + "".join(
        f'03/{13 + k // 12:02d}/2026 {k % 12 or 12}:15:00 AM,{k}.5,"door, left",{"" if k % 4 else k}\n'
        for k in range(30)
    )
    zoned = (
        "time;ms;a;ok\n"
        + "".join(f"2026-03-02T08:00:{k:02d}Z;{k * 7};{k}e-3;{'TRUE' if k % 2 else 'FALSE'}\n" for k in range(30))
        + "time;ms;a;ok\n"
        + "2026-03-02T08:01:00Z;0;1;TRUE\n"
    )
    relative = "Zeit [s];Kraft [N];n\n" + "".join(f"{k / 4:.2f};{k / 3:.4f};{k}\n".replace(".", ",") for k in range(30))
    return [
        Seed("german.csv", german.encode("cp1252"), _ZONE),
        Seed("czech.txt", czech.encode("cp1250"), _ZONE),
        Seed("english.csv", english.encode(), _ZONE),
        Seed("zoned.csv", ("\ufeff" + zoned).encode()),
        Seed("relative.csv", relative.encode()),
        Seed("wide.csv", german.encode("utf-16"), _ZONE),
    ]


def edit_line(line: bytes, rng: random.Random, mark: bytes) -> tuple[bytes, str]:
    """A row with a cell more or less."""
    places = [m.start() for m in re.finditer(re.escape(mark), line)]
    if places and rng.random() < 0.5:
        at = rng.choice(places)
        return line[:at] + line[at + len(mark) :], "delimiter dropped"
    at = rng.choice(places) if places else 0
    return line[:at] + mark + line[at:], "delimiter doubled"


def common(data: bytes, rng: random.Random, rows: bool = True) -> Mutation | None:
    """Mutations of any text, a third of the time: cut, flipped bytes, junk, a number replaced, something huge.
    rows: a file of the first rows is an honest one."""
    what = rng.randrange(14)
    if what == 0:
        part = cut(data, rng)
        at_line_end = data[len(part) : len(part) + 1] in (b"\n", b"\r", b"") or part.endswith(b"\n")
        return Mutation(part, "cut", rows and at_line_end, False)
    if what == 1:
        return Mutation(flip(data, rng), "bytes flipped", False, True)
    if what == 2:
        return Mutation(insert(data, rng), "junk inserted", False, True)
    if what == 3:
        numbers = list(re.finditer(rb"\d+(?:\.\d+)?", data))
        m = rng.choice(numbers)
        return Mutation(data[: m.start()] + rng.choice(ABSURD) + data[m.end() :], "number replaced", False, True)
    if what == 4:
        at = rng.randrange(len(data))
        big = rng.choice(
            (b"x" * 300_000, b";" * 100_000, b"\0" * 200_000, b"\n" * 100_000, b"<" * 50_000, b'"' * 99_999)
        )
        return Mutation(data[:at] + big + data[at:], "huge", False, True)
    return None


def mutate(seed: Seed, rng: random.Random) -> Mutation:
    wide = seed.data.startswith(b"\xff\xfe")
    if (found := common(seed.data, rng)) is not None:
        return Mutation(found.data, found.kind, wide or found.well_formed, found.values_touched)
    if wide:
        return Mutation(cut(seed.data, rng), "cut", True, False)
    lines = seed.data.splitlines(keepends=True)
    first = next(k for k, line in enumerate(lines) if re.match(rb"[\d\"]", line))
    mark = max((b";", b"\t", b","), key=lines[-1].count)
    what = rng.randrange(5)
    if what == 0:
        done, kind = edit_parts(lines, rng, first)
        return Mutation(b"".join(done), f"row {kind}", True, False)
    at = rng.randrange(first, len(lines))
    if what == 1:
        lines[at], kind = edit_line(lines[at], rng, mark)
        return Mutation(b"".join(lines), f"row: {kind}", False, b'"' in lines[at])
    if what == 2:
        junk = rng.choice(
            (b"\0" * 40 + b"\n", b"\n\n", b"Summe;;;;\n", b"garbage\n", lines[first - 1], b"\x1a\n", mark * 5 + b"\n")
        )
        return Mutation(b"".join([*lines[:at], junk, *lines[at:]]), "line inserted", False, False)
    if what == 3:
        lines[at] = lines[at].rstrip(b"\r\n") + rng.choice((b"\r\n", b"\r", b" \n", b""))
        return Mutation(b"".join(lines), "line end changed", False, False)
    head = rng.randrange(first)
    lines[head] = rng.choice(
        (b"", lines[head][::-1].replace(b"\n", b"") + b"\n", flip(lines[head], rng), lines[head] + lines[head])
    )
    return Mutation(b"".join(lines), "header changed", True, False)
