"""Sinumerik Trace as CSV: time in seconds, then signals named by their paths (`/Nck/!SD/... [u1; 1]`)."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from thermodata.errors import FormatError
from thermodata.plugin import Block, Loss, Recording, Signal, Source
from thermodata.reader.text import clean
from thermodata_reader_cnc.chunks import chunks, sample
from thermodata_reader_cnc.halves import BadLine, Grid
from thermodata_reader_cnc.layout import fields
from thermodata_reader_cnc.losses import Losses

STREAM = "trace"
_PATH = re.compile(r"[/+](?:Nck|Channel|Bag|Tool|DriveVsa|Hmi)/", re.IGNORECASE)
_NUMBER = re.compile(r"^[+-]?(?:\d+(?:[.,]\d*)?|[.,]\d+)(?:[eE][+-]?\d+)?$")
_MOST_ROWS = 2000
_TIME = re.compile(r"^(time|zeit|t)\b", re.IGNORECASE)


@dataclass(frozen=True, slots=True)
class Header:
    """first: 0-based line of the first data. time: its column. names: '' for columns that are none."""

    first: int
    delimiter: str
    time: int
    names: tuple[str, ...]
    width: int
    decimal: str


def find(lines: Sequence[str]) -> Header | None:
    """The header among the first lines, or None: a row of names, or a block of rows, one a signal, before the data."""
    for row, line in enumerate(lines[:_MOST_ROWS]):
        if not _PATH.search(line):
            continue
        delimiter = max(",;\t", key=re.sub(r"\[[^\]]*\]", "", line).count)
        names = [clean(c) for c in fields(line, delimiter, True)]
        many = sum(_PATH.search(name) is not None for name in names)
        if many == 1 and sum(_PATH.search(text) is not None for text in lines[row + 1 : row + _MOST_ROWS]) > 0:
            return _block(lines, row, delimiter)
        data = [text for text in lines[row + 1 : row + 200] if _is_data(text, delimiter)]
        if len(names) < 2 or (len(lines) > row + 3 and not data):
            continue
        width = _width(data, delimiter) if data else len(names)
        if width < len(names) - 1:
            continue
        return _made(names, row + 1, delimiter, width, data)
    return None


def _width(data: Sequence[str], delimiter: str) -> int:
    return Counter(text.count(delimiter) + 1 for text in data).most_common(1)[0][0]


def _is_data(line: str, delimiter: str) -> bool:
    cells = [c.strip().strip('"') for c in line.split(delimiter)]
    return bool(_NUMBER.match(cells[0])) and all(not c or _NUMBER.match(c) for c in cells)


def _block(lines: Sequence[str], row: int, delimiter: str) -> Header | None:
    """A block of one row a signal: the columns behind the time in its order, or by the ids (f1, f2, ...) of a row of
    names before the data."""
    first = next(
        (
            k
            for k in range(row, min(len(lines), row + _MOST_ROWS))
            if _is_data(lines[k], delimiter) and lines[k].count(delimiter)
        ),
        None,
    )
    if first is None:
        return None
    by_id: dict[str, str] = {}
    paths: list[str] = []
    last = row
    for number, line in enumerate(lines[row:first], row):
        cells = [clean(c) for c in fields(line, delimiter, True)]
        path = next((c for c in cells if _PATH.search(c)), None)
        if path is not None:
            paths.append(path)
            last = number
            by_id.update({c: path for c in cells if re.fullmatch(r"[fs]\d+", c)})
    data = [text for text in lines[first : first + 200] if _is_data(text, delimiter)]
    width = _width(data, delimiter)
    for number in range(last + 1, first):  # a damaged row of data is no row of names
        cells = [clean(c) for c in fields(lines[number], delimiter, True)]
        if cells[0][:1] in "0123456789+-." and cells[0] and not any(c in by_id or _TIME.match(c) for c in cells):
            first = number
            break
    columns = [clean(c) for c in fields(lines[first - 1], delimiter, True)]
    if len(columns) >= width - 1 and any(c in by_id for c in columns):
        names = [by_id.get(c, c) for c in columns]
    elif len(paths) in (width - 1, width - 2):  # a last delimiter makes one more
        names = ["time", *paths]
    else:
        return None
    return _made(names, first, delimiter, width, data)


def _made(names: list[str], first: int, delimiter: str, width: int, data: Sequence[str]) -> Header:
    seen: dict[str, int] = {}
    for k, name in enumerate(names):
        seen[name] = seen.get(name, 0) + 1
        names[k] = name if seen[name] == 1 or not name else f"{name}#{seen[name]}"
    time = next((k for k, name in enumerate(names) if _TIME.match(name)), 0)
    decimal = "," if delimiter != "," and any("," in text for text in data) else "."
    width = max(width, len(names))
    return Header(first, delimiter, time, tuple((names + [""] * width)[:width]), width, decimal)


def claims(lines: Sequence[str]) -> str | None:
    """The reason for claiming lines of text, or None."""
    return None if find(lines) is None else "Sinumerik Trace CSV: a column named by a path such as /Nck/..."


def _header(path: Path, source: Source) -> tuple[Header, str, bool]:
    first = sample(path, source.encoding)
    header = find(first.head[:-1] if first.whole and not first.ends_with_newline else first.head)
    if header is None:
        raise FormatError(
            "no header of a trace",
            where=path.name,
            expected="columns named /Nck/... or /Channel/...",
            got=first.head[0][:80] if first.head else "nothing",
        )
    return header, first.encoding, first.ends_with_newline


def describe(path: Path, source: Source) -> Recording:
    """Signals of a trace, by its header; times are relative."""
    header, _, whole = _header(path, source)
    names = [n for k, n in enumerate(header.names) if n and k != header.time]
    return Recording(tuple(Signal(n, STREAM) for n in names), "relative", 0, None if whole else False)


def blocks(path: Path, source: Source) -> Iterator[Block | Loss]:
    """The rows in chunks of the file, and lines that do not read."""
    header, encoding, _ = _header(path, source)
    grid = Grid(header.delimiter, header.decimal, ["float64"] * header.width)
    losses = Losses(path.name, max(1, path.stat().st_size))
    for chunk in chunks(path, encoding):
        data, line = chunk.data, chunk.line
        while line < header.first and data:
            cut = data.find(b"\n") + 1 or len(data)
            data, line = data[cut:], line + 1
        if chunk.last and data and not data.endswith(b"\n"):
            cut = data.rfind(b"\n") + 1
            losses.add(line + data.count(b"\n"), "the last row has no line end and may be cut", len(data) - cut, 0)
            data = data[:cut]
        last = np.empty(0, np.int64)
        for part in grid.parts(data.replace(b'"', b""), line):
            if isinstance(part, BadLine):
                if part.text.strip():
                    losses.add(
                        part.line, f"expected {header.width} numbers, got '{part.text[:80]}'", len(part.text), last.size
                    )
                continue
            good = np.abs(part.columns[header.time]) < 9e9  # NaN is not
            if not good.all():
                losses.add(line, f"{int((~good).sum())} rows without a time, or with one that is none", 0, last.size)
            if not good.any():
                continue
            last = np.round(part.columns[header.time][good] * 1e9).astype(np.int64)
            yield Block(
                STREAM, last, {n: part.columns[k][good] for k, n in enumerate(header.names) if n and k != header.time}
            )
        yield from losses.dated(last)
    yield from losses.rest()
