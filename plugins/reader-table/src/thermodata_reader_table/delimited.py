"""Delimited text: CSV and its like, in two passes of bounded memory: the times of all rows, then their values."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path
from typing import Any

from thermodata.errors import FormatError
from thermodata.plugin import Block, Loss, Recording, Signal, Source
from thermodata.reader.text import decimal_mark, decode_head, file_encoding, last_line_is_whole
from thermodata_reader_table import text_fast as fast
from thermodata_reader_table import text_rows as rows
from thermodata_reader_table.cells import is_number
from thermodata_reader_table.layout import Layout, find, one_clock
from thermodata_reader_table.text_rows import Sheet

DELIMITERS = (";", "\t", ",", "|")
_HEAD_BYTES = 256 * 1024
_HEAD_LINES = 500
_ENDS = re.compile("\r\n|\n|\r")  # str.splitlines takes more for line ends than any program that wrote a table
_TEXT_NAME = ("comment", "note", "alarm", "message", "text", "label", "remark", "bemerk", "pozn", "hinweis")


def split(line: str, delimiter: str) -> list[str]:
    """Cells of a line, quotes honoured."""
    if '"' not in line:
        return [c.strip() for c in line.split(delimiter)]
    import csv

    return [c.strip() for c in next(csv.reader([line], delimiter=delimiter), [])]


def find_delimiter(lines: list[str]) -> str | None:
    """The delimiter by which most lines have the same number of cells, two or more; ';' and tab before ',',
    which may be a decimal mark."""
    if lines and lines[0].lower().startswith("sep=") and len(lines[0].strip()) == 5:
        return lines[0].strip()[-1]
    body = [line for line in lines if line.strip()]
    body = body[len(body) // 3 :][-100:]  # preamble has other lengths
    best: tuple[float, str] | None = None
    for delimiter in DELIMITERS:
        counts = [len(split(line, delimiter)) for line in body]
        common = max(set(counts), key=counts.count) if counts else 0
        share = counts.count(common) / len(counts) if counts else 0.0
        if common >= 2 and share > 0.6 and (best is None or share > best[0] + 0.2):
            best = (share, delimiter)
    return best[1] if best else None


def head_rows(text: str, declared: str | None) -> tuple[str, list[list[str]]] | None:
    """(delimiter, rows) of a file's first text; a last line without an end, which may be cut, is left out."""
    lines = _ENDS.split(text)
    if len(lines) > 2 or not lines[-1]:
        lines.pop()  # empty, or a line without an end, which may be cut
    lines = lines[:_HEAD_LINES]
    delimiter = declared or find_delimiter(lines)
    if delimiter is None:
        return None
    return delimiter, [split(line, delimiter) for line in lines]


def open_sheet(path: Path, source: Source) -> Sheet:
    """The layout of a file from its first 256 KiB; the encoding from all of it. Describing and reading follow each
    other, so the last ones are kept."""
    status = path.stat()
    return _open(_Asked(path, source, (str(path.resolve()), status.st_mtime_ns, status.st_size, repr(source))))


@dataclass(frozen=True)
class _Asked:
    path: Path = field(compare=False)
    source: Source = field(compare=False)
    key: tuple[Any, ...]


@lru_cache(maxsize=4)
def _open(asked: _Asked) -> Sheet:
    path, source = asked.path, asked.source
    said: Mapping[str, Any] = source.table or {}
    encoding, note = file_encoding(path, source.encoding)
    with path.open("rb") as file:
        data = file.read(_HEAD_BYTES)
    if not data:
        raise FormatError("an empty file", where=path.name, expected="a table")
    text = (
        data.decode(encoding, "replace")
        if source.encoding or encoding.startswith("utf-16")
        else (decode_head(data) if encoding.startswith("utf-8") else data.decode(encoding))
    )
    text = (text or "").lstrip("\ufeff")
    found = head_rows(text, said.get("delimiter"))
    if found is None:
        raise FormatError(
            "no delimiter gives lines of equal length",
            where=path.name,
            expected="; tab , or |",
            hint="declare table: {delimiter: ...}",
        )
    delimiter, rows_of = found
    if rows_of and len(rows_of[0]) <= 2 and text[:4].lower() == "sep=":
        rows_of[0] = [""]
    cut = _cut(path, encoding, delimiter)
    layout = find(rows_of, said, path.name)
    width = len(layout.names)
    body = [r + [""] * (width - len(r)) for r in rows_of[layout.first :]]
    numbers = [c for r in body for i, c in enumerate(r[:width]) if i not in layout.dated]
    decimal = said.get("decimal") or (decimal_mark(numbers) if delimiter != "," else _quoted_mark(numbers)) or "."
    kinds = tuple(_kind(layout, i, [r[i] for r in body]) for i in range(width))
    notes = [*([note] if note else []), *layout.notes]
    usual = Counter(len(r) for r in rows_of[layout.first :] if any(r)).most_common(1)
    return Sheet(
        encoding,
        delimiter,
        decimal,
        layout,
        kinds,
        '"' in text,
        tuple(notes),
        cut,
        usual[0][0] if usual else width,
        tuple(tuple(r[:width]) for r in body if any(r)),
    )


def _quoted_mark(cells: list[str]) -> str:
    """The decimal mark where commas part the cells: one inside of quotes ("20,5") is a decimal comma unless each such
    cell may be a number with marks between thousands ("8,000")."""
    commas = [c for c in cells if re.match(r"^[+-]?\d+,\d+$", c)]
    grouped = all(re.match(r"^[+-]?[1-9]\d{0,2}(,\d{3})+$", c) for c in commas)
    return "." if grouped or any(re.match(r"^[+-]?\d*\.\d+$", c) for c in cells) else ","


def _kind(layout: Layout, column: int, cells: list[str]) -> str:
    filled = [c for c in cells if c.strip().lower() not in rows.EMPTY]
    if not filled:
        named = layout.names[column].lower()
        return "str" if layout.units[column] is None and any(w in named for w in _TEXT_NAME) else "float64"
    good = sum(is_number(c) or c.strip().lower() in ("true", "false", "inf", "-inf") for c in filled)
    return "float64" if good * 2 > len(filled) else "str"


def _cut(path: Path, encoding: str, delimiter: str) -> str | None:
    """Why the last line may not be whole, or None."""
    with path.open("rb") as file:
        start = file.read(2)
        file.seek(max(0, (path.stat().st_size - 65536) // 2 * 2))
        tail = file.read()
    if encoding.startswith("utf-16"):
        if len(tail) % 2:
            return "the file ends inside a character"
        big = encoding == "utf-16-be" or (encoding == "utf-16" and start == b"\xfe\xff")
        text = tail.decode("utf-16-be" if big else "utf-16-le", "replace")
    else:
        text = tail.decode("utf-8" if encoding.startswith("utf-8") else encoding, "replace")
    if text.endswith(("\n", "\r")) or "\n" not in text:
        return None
    lines = _ENDS.split(text)
    if len(lines) < 2 or last_line_is_whole(lines[-1], lines[-2], delimiter):
        return None
    return "the last line has no end and is shorter than the one before: it is cut"


def describe(path: Path, source: Source) -> Recording:
    sheet = open_sheet(path, source)
    layout = sheet.layout
    signals = tuple(
        Signal(layout.names[i], group.stream, layout.units[i], sheet.kinds[i])
        for group in layout.groups
        for i in group.columns
    )
    first = rows.first_times(path, sheet, source)
    notes = dict.fromkeys([*sheet.notes, *(note for f in first for note in f.notes)])
    clock, start_ns = one_clock(first, layout.groups, path.name)
    return Recording(
        signals, clock, start_ns, False if sheet.cut else None, (*notes, sheet.cut) if sheet.cut else tuple(notes)
    )


def blocks(path: Path, source: Source) -> Iterator[Block | Loss]:
    """The rows as fast as they read; from the first that does not fit the plain way on, with every care."""
    sheet = open_sheet(path, source)
    tally = rows.Tally()
    if fast.suits(sheet):
        try:
            yield from fast.blocks(path, sheet, source, tally)
        except fast.UnsuitableError:
            yield from rows.blocks(path, sheet, source, tally)
    else:
        yield from rows.blocks(path, sheet, source, tally)
    yield from tally.losses(path, sheet)
