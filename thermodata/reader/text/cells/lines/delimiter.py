"""What stands between the cells of a line, and the cells themselves."""

from __future__ import annotations

import csv
import re
from collections import Counter
from collections.abc import Sequence

from thermodata.reader.text.cells.cell import is_number, is_stamp
from thermodata.reader.text.cells.time_forms.clock_pattern import is_half
from thermodata.reader.text.cells.time_forms.zone_words import is_zone

DELIMITERS = (";", "\t", ",", "|")
BLANKS = " "  # as many as there are, tabs among them: columns that stand below each other
_WORDS = {"tab": "\t", "\\t": "\t", "semicolon": ";", "comma": ",", "space": BLANKS, "blank": BLANKS, "blanks": BLANKS}
_LOOKED_AT = 500
# 'Date,Time,T1' of Studio 5000: "3/1/2026","08:30:10;123","21.5"
_MILLISECONDS = re.compile(r'(,"?\d{1,2}:\d{2}:\d{2});(?=\d{3}"?,)')
_BETWEEN = re.compile(r"[ \t]+(?![\[(])")  # a unit in brackets belongs to the name before it
_BETWEEN_BYTES = re.compile(rb"[ \t]+(?![\[(])")
# a cell in quotes keeps its blanks; '2" probe' is none
_QUOTED = re.compile(r'(?<![^ \t])"[^"\t]*"(?![^ \t\r])|[ \t]+(?![\[(])')
_MARGINS = re.compile(rb"^[ \t]+|[ \t]+(?=\r?$)", re.MULTILINE)
_NUMBERS, _ALIKE = 0.8, 0.9  # of the cells of a table that blanks part, and of its lines


def declared(delimiter: str) -> str:
    """The delimiter that a campaign file names: itself, or one of the words tab, semicolon, comma, blanks."""
    return _WORDS.get(delimiter, delimiter)


def shown(delimiter: str, blanks: bool) -> str:
    """A delimiter as messages show it. blanks: any number of them stands for it."""
    return "blanks" if blanks else {",": "','", "\t": "a tab"}.get(delimiter, f"'{delimiter}'")


def fields(line: str, delimiter: str, quoted: bool = True) -> list[str]:
    """The cells of one line; a quote that is never closed is a character like any other."""
    if not quoted or '"' not in line or line.count('"') % 2:
        return line.split(delimiter)
    try:
        return next(csv.reader([line], delimiter=delimiter), [""])
    except csv.Error:  # a cell of more than 128 KiB, a stray carriage return
        return line.split(delimiter)


def parted(line: str) -> str:
    """A line whose cells blanks part, with a tab between them."""
    bare = line.strip(" \t")
    if '"' not in bare:
        return _BETWEEN.sub("\t", bare)
    return _QUOTED.sub(lambda found: found[0] if found[0][0] == '"' else "\t", bare)


def parted_bytes(data: bytes) -> bytes:
    """The same of whole lines in UTF-8, which keep their ends and their number."""
    bare = _MARGINS.sub(b"", data)
    if b'"' not in bare:
        return _BETWEEN_BYTES.sub(b"\t", bare)
    return "\n".join(map(parted, bare.decode("utf-8", "surrogateescape").split("\n"))).encode(
        "utf-8", "surrogateescape"
    )


def find_delimiter(lines: Sequence[str]) -> str | None:
    """The delimiter by which most of the last lines have equally many cells, two or more; None where there is none.

    ';' and tabs stand before ',', which may be a decimal mark; a first line 'sep=;' (Excel's) decides. Blanks part
    cells where nothing else does and nearly all of these are numbers or times.
    """
    if lines and lines[0].lower().startswith("sep=") and len(lines[0].strip()) == 5:
        return lines[0].strip()[-1]
    body = [_MILLISECONDS.sub(r"\1.", line) for line in lines if line.strip()]
    body = body[len(body) // 3 :][-_LOOKED_AT:]  # preamble has other lengths
    best: tuple[float, str] | None = None
    for delimiter in DELIMITERS:
        counts = Counter(len(fields(line, delimiter)) for line in body)
        common, many = counts.most_common(1)[0] if counts else (0, 0)
        share = many / len(body) if body else 0.0
        if common >= 2 and share >= 0.5 and (best is None or share > best[0] + 0.2):
            best = (share, delimiter)
    if best is None or best[1] == ",":
        return BLANKS if _blanks_part(body, best is not None) else best[1] if best else None
    return best[1]


def _blanks_part(body: Sequence[str], commas: bool) -> bool:
    """Whether blanks stand between the cells of lines. commas: beside commas, which are decimal marks then."""
    rows = [[c.strip('"') for c in parted(line).split("\t")] for line in body[-100:]]
    common, many = Counter(map(len, rows)).most_common(1)[0] if rows else (0, 0)
    if common < 2 or many < _ALIKE * len(rows):
        return False
    cells = [c for row in rows if len(row) == common for c in row]
    # '2025-10-25 22:00:00,0': a comma after a time of day parts it from a value, more often than it begins a fraction
    if commas and not all(is_number(c) for c in cells if "," in c):
        return False
    told = sum(is_number(c) or is_stamp(c) or is_half(c) or is_zone(c) for c in cells)
    return told >= (1.0 if commas else _NUMBERS) * len(cells)
