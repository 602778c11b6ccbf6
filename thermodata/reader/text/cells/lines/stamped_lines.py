"""Lines before each of which a terminal wrote its clock, as lines of a table whose first cell is that:
`[2026-05-12 09:00:00.000] 1870,21.5` (Tera Term), `23:00:00.000 -> 1870,21.5` (Arduino)."""

from __future__ import annotations

import re
from collections.abc import Sequence

from thermodata.reader.text.cells.cell import is_number
from thermodata.reader.text.cells.lines.delimiter import BLANKS, fields, find_delimiter, parted

TIME = "time"  # what the first column is called where the lines have a header
_FEWEST, _NEARLY_ALL = 10, 0.95  # lines, and share of them
_CLOCK = r"\d{1,2}:\d\d(?::\d\d(?:[.,]\d{1,9})?)?"
_PREFIX = re.compile(
    rf"\s*(?:\[(?P<stamp>[^\[\]]{{0,24}}(?<!\d){_CLOCK}(?![\d:])[^\[\]]{{0,12}})\][ \t]?|"
    rf"(?P<clock>(?:[\d./-]{{6,10}} )?{_CLOCK}) -> )"
)


def stamped_by(lines: Sequence[str]) -> str:
    """What is to part the cells of such lines, the clock among them; '' where they are none, or nothing but words."""
    full = [line for line in lines if line.strip()]
    found = [(match, line) for line in full if (match := _PREFIX.match(line)) is not None]
    if len(found) < max(_FEWEST, _NEARLY_ALL * len(full)):
        return ""
    rests = [line[match.end() :] for match, line in found]
    delimiter = find_delimiter(rests) or "\t"
    rows = [_cells(rest, delimiter) for rest in rests]
    numbers = sum(bool(row) and all(is_number(c.strip()) or not c.strip() for c in row) for row in rows)
    return ("\t" if delimiter == BLANKS else delimiter) if 2 * numbers > len(rows) else ""


def with_stamp(line: str, delimiter: str) -> str:
    """Such a line with its clock as its first cell; a header, none of whose cells is a number, below a word for it, and
    what a program says of itself ('# fault', 'boot:') as it stands behind the clock."""
    match = _PREFIX.match(line)
    if match is None:
        return line
    rest = line[match.end() :]
    if delimiter == "\t" and "\t" not in rest:
        rest = parted(rest)
    cells = _cells(rest, delimiter)
    if rest.startswith("#") or not rest.strip():
        return rest
    if any(is_number(c.strip()) for c in cells):
        stamp = match["stamp"] or match["clock"]
        # '09:00:00,125': a comma is no cell's end there
        return f"{stamp.strip().replace(',', '.') if delimiter == ',' else stamp.strip()}{delimiter}{rest}"
    return rest if len(cells) == 1 else f"{TIME}{delimiter}{rest}"


def all_with_stamp(data: bytes, delimiter: str) -> bytes:
    """The same of whole lines in UTF-8, which keep their number."""
    lines = data.decode("utf-8", "surrogateescape").split("\n")
    return "\n".join(with_stamp(line, delimiter) for line in lines).encode("utf-8", "surrogateescape")


def _cells(rest: str, delimiter: str) -> list[str]:
    return fields(parted(rest), "\t") if delimiter == BLANKS else fields(rest, delimiter)
