"""Delimited text: delimiters, decimal marks, header and units rows, dates, quotes, encodings, damaged lines."""

from __future__ import annotations

import random

from tests.fuzz.harness import Mutation, Seed, Source
from tests.fuzz.mutations import cut, edit_parts, flip, insert

READER = "table"
_PRAGUE = Source(timezone="Europe/Prague")
_COLUMN = Source(table={"header_rows": 0, "time": {"column": 1, "unit": "s"}})
_N = 40


def _rows(delimiter: str, decimal: str, time: str) -> list[str]:
    rows = []
    for i in range(_N):
        stamp = {
            "iso": f"2026-03-01 08:{i:02}:00.125",
            "german": f"1.3.2026 {8 + i // 30}:{i % 30 * 2:02}:00",
            "us": f"03/14/2026 08:{i:02}:00 AM",
            "seconds": f"{i * 0.5:.1f}",
            "minutes": f"{i * 0.25:.2f}",
            "zone": f"2026-03-01T08:{i:02}:00+01:00",
            "two": f"2026-03-01{delimiter}08:{i:02}:00",
            "clock": f"08:{i:02}:00",
            "unix": f"{1_770_000_000 + i}.5",
        }[time]
        values = [f"{20 + i / 8:.3f}", f"{-i * 1.25:.2f}", f"{100 * i}"]
        if decimal == ",":
            values = [v.replace(".", ",") for v in values]
            stamp = stamp.replace(".", ",") if time in ("seconds", "minutes", "unix") else stamp
        rows.append(delimiter.join([stamp, *values]))
    return rows


def seeds() -> list[Seed]:
    def text(head: str, rows: list[str], end: str = "\n") -> str:
        return head.replace("\n", end) + "".join(r + end for r in rows)

    states = ["idle", "cut", "stop"]
    noted = [f"{r};{states[i % 3]};{'' if i % 4 else 'ok'}" for i, r in enumerate(_rows(";", ",", "seconds"))]
    return [
        Seed("iso.csv", text("time,T1 [degC],dZ [um],n [rpm]\n", _rows(",", ".", "iso")).encode(), _PRAGUE),
        Seed(
            "german.csv",
            text(
                "Prüfstand 138\nBediener;Novák\n\nDatum;Temp;Weg;Drehzahl\n;°C;µm;U/min\n",
                _rows(";", ",", "german"),
                "\r\n",
            ).encode("cp1252"),
            _PRAGUE,
        ),
        Seed("us.csv", text("Date,T1,dZ,n\n", _rows(",", ".", "us")).encode(), _PRAGUE),
        Seed("seconds.csv", text("Čas [s];T1;dZ;n;stav;poznámka\n", noted).encode("cp1250"), _PRAGUE),
        Seed("minutes.txt", text("time (min)\tT1\tdZ\tn\n", _rows("\t", ".", "minutes")).encode("utf-16"), _PRAGUE),
        Seed("zone.csv", text("timestamp;T1;dZ;n\n", _rows(";", ".", "zone")).encode("utf-8-sig"), _PRAGUE),
        Seed("two.csv", text("date;time;T1;dZ;n\n", _rows(";", ".", "two")).encode(), _PRAGUE),
        Seed("clock.csv", text("Uhrzeit;T1;dZ;n\n", _rows(";", ",", "clock")).encode(), _PRAGUE),
        Seed("bare.csv", text("", _rows(";", ",", "seconds")).encode("utf-8-sig"), _COLUMN),
        Seed("unix.csv", text("timestamp,T1,dZ,n\n", _rows(",", ".", "unix")).encode(), _PRAGUE),
        Seed(
            "quoted.csv",
            text(
                '"time [s]","T1 (degC)","dZ","n"\n',
                ['"' + r.replace(";", '","') + '"' for r in _rows(";", ".", "seconds")],
            ).encode(),
        ),
        Seed("blanks.txt", text("time_s T1 dZ n\n", [f"{r} " for r in _rows(" ", ".", "seconds")]).encode()),
        Seed("sep.csv", text("sep=;\ntime [s];T1;dZ;n\n", _rows(";", ",", "seconds"), "\r\n").encode()),
    ]


def whole_of(data: bytes) -> bytes:
    """The delimiter of a seed."""
    return max((b";", b",", b"\t"), key=data.count) if b" dZ " not in data else b" "


def mutate(seed: Seed, rng: random.Random) -> Mutation:
    data = seed.data
    end = b"\n\0" if seed.name == "minutes.txt" else b"\n"
    lines = data.split(end)
    parts = [line + end for line in lines[:-1]] + ([lines[-1]] if lines[-1] else [])
    first = len(parts) - _N
    what = rng.choice(
        (
            "cut",
            "lines",
            "lines",
            "cell",
            "cell",
            "junk line",
            "flip head",
            "flip data",
            "junk",
            "nul",
            "end",
            "long",
            "short",
            "delimiter",
            "encoding",
        )
    )
    if what == "cut":
        left = cut(data, rng)
        # a last line that lacks nothing but its end is whole
        return Mutation(left, "cut", left.endswith(end) or data[len(left) :].startswith((end, b"\r", b"\n")), False)
    if what == "lines":
        edited, how = edit_parts(parts, rng, first)
        # a clock without a date counts from its first row
        return Mutation(b"".join(edited), f"line {how}", True, seed.name == "clock.csv")
    row = rng.randrange(first, len(parts))
    if what == "flip head":
        at = rng.randrange(max(1, sum(map(len, parts[:first]))))
        return Mutation(flip(data, rng, at, at + 1, 1), "header byte", True, True)
    if what == "flip data":
        return Mutation(flip(data, rng, sum(map(len, parts[:first])), None), "data bytes", False, True)
    if what == "junk":
        return Mutation(insert(data, rng), "junk", False, True)
    if what == "delimiter":
        other = rng.choice((b",", b";", b"\t", b"|"))
        return Mutation(data.replace(rng.choice((b",", b";", b"\t")), other), "delimiter changed", False, True)
    if what == "encoding":
        parts[row] = rng.choice((b"\xff\xfe", b"\xe9", b"\x81", "ž".encode())) + parts[row]
        return Mutation(b"".join(parts), "foreign letters before a line", False, True)
    if seed.name == "minutes.txt":
        parts[row] = parts[row].replace(b"\t\0", b"", 1)
        return Mutation(b"".join(parts), "delimiter dropped", False, True)
    if what == "nul":
        parts.insert(row, b"\0" * rng.choice((1, 16, 512)) + rng.choice((b"", b"\n")))
        return Mutation(b"".join(parts), "NULs between lines", False, False)
    if what == "junk line":
        junk = rng.choice(
            (
                b"# comment\n",
                b"\n",
                b"   \n",
                b"EOF\n",
                b";;;;;;\n",
                b"LOST CONNECTION\n",
                b'"\n',
                b"Datum;Temp\n",
                b"\x1a\n",
                b"=== restart ===\n",
                ",".join("9" * 30).encode() + b"\n",
            )
        )
        parts.insert(row, junk)
        return Mutation(b"".join(parts), "line of junk", junk.strip() == b"", False)
    if what == "long":
        more = rng.choice((b";1", b",1,2,3", b";" * 40, b"\t7"))
        parts[row] = parts[row].rstrip(b"\r\n") + more + b"\n"
        # what does not delimit is a part of the last cell
        return Mutation(b"".join(parts), "line too long", False, more[:1] not in whole_of(data))
    if what == "short":
        whole = parts[row]
        parts[row] = whole[: rng.randrange(len(whole))] + b"\n"
        # all cells are there: a value that is shorter is a value; blanks behind the last cell part nothing
        full = len(parts[row].split()) == len(whole.split())
        full = full and all(parts[row].count(d) == whole.count(d) for d in (b";", b",", b"\t"))
        return Mutation(b"".join(parts), "line too short", full or not parts[row].strip(), full)
    if what == "end":
        mark = rng.choice((b"\r\n", b"\r", b"\n\n", b"\n\r"))
        other = data.replace(b"\r\n", b"\n").replace(b"\n", mark)
        return Mutation(other, "line ends changed", False, False)
    delimiter = next(d for d in (b"\t", b";", b",", b" ") if d in parts[row])
    cells = parts[row].rstrip(b"\r\n").split(delimiter)
    i = rng.randrange(len(cells))
    new = rng.choice(
        (
            b"",
            b"---",
            b"n/a",
            b"ERR",
            b"1e999",
            b"-inf",
            b"nan",
            b"#DIV/0!",
            b"1_000",
            b"0x10",
            b'"',
            b"1 234,5",
            b"99.99.9999 99:99:99",
            b"2026-13-45 00:00:00",
            "²".encode(),
            b"TRUE",
        )
    )
    quotes = cells[i].startswith(b'"')
    cells[i] = b'"' + new + b'"' if quotes else new
    parts[row] = delimiter.join(cells) + b"\n"
    known = new in (b"", b"1e999", b"-inf", b"1 234,5", b"nan", b"---", b"n/a", b"TRUE")
    worded = seed.name == "seconds.csv" and i > 3
    return Mutation(b"".join(parts), "cell replaced", known, known or worded)
