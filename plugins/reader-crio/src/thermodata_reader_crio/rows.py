"""Rows of delimited numbers to arrays: pyarrow's parser for all that is regular, cell by cell for what is not."""

from __future__ import annotations

import re
from collections import Counter
from dataclasses import dataclass
from typing import Any

import numpy as np

from thermodata.plugin import Array, Bool1D, Float1D, Int1D

_NUMBER = re.compile(rb"^[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?$")
_WORDS = {
    b"nan": np.nan,
    b"-nan": np.nan,
    b"+nan": np.nan,
    b"inf": np.inf,
    b"+inf": np.inf,
    b"-inf": -np.inf,
    b"infinity": np.inf,
    b"-infinity": -np.inf,
    b"+infinity": np.inf,
}
_SMALL = 4096  # bytes below which starting a parser costs more than it saves
_CELLWISE = 64 * 1024  # a damaged part is halved down to this size, so that little of it is read slowly


@dataclass(frozen=True)
class Grid:
    """How rows lie. numeric: number of columns of numbers, from the first on; text: whether one of free text may
    follow; least: cells that a row has at least."""

    delimiter: bytes
    decimal: bytes
    numeric: int
    text: bool
    least: int


@dataclass(frozen=True)
class Rows:
    """numbers: one array a column, shape (n,), NaN where a cell is empty or no number; text: shape (n,), bytes or
    None, and None where no row has any; line: line of each row, counted from 0, shape (n,); wrong: cells that are no
    number, as (row, column); bad: lines that are no rows at all; whole: whether every cell holds a number."""

    numbers: list[Float1D]
    text: Array | None
    line: Int1D
    wrong: list[tuple[int, int]]
    bad: list[int]
    whole: bool = False

    @property
    def n(self) -> int:
        return int(self.line.size)


def parse(data: bytes, grid: Grid) -> Rows:
    """All rows of some lines. A line with another number of cells than a row may have is bad; empty lines are
    none; a cell that is no number spoils itself only."""
    if len(data) >= _SMALL:
        fast = _fast(data, grid)
        if fast is not None:
            return fast
        if len(data) > _CELLWISE:
            middle = data.rfind(b"\n", 0, len(data) // 2) + 1
            if 0 < middle < len(data):
                return _joined(parse(data[:middle], grid), parse(data[middle:], grid), data[:middle].count(b"\n"))
    return _slow(data, grid)


def _joined(a: Rows, b: Rows, lines: int) -> Rows:
    text = (
        None
        if a.text is None and b.text is None
        else np.concatenate([np.full(r.n, None, object) if r.text is None else r.text for r in (a, b)])
    )
    return Rows(
        [np.concatenate(pair) for pair in zip(a.numbers, b.numbers, strict=True)],
        text,
        np.concatenate([a.line, b.line + lines]),
        a.wrong + [(r + a.n, c) for r, c in b.wrong],
        a.bad + [i + lines for i in b.bad],
    )


# ---- the fast way --------------------------------------------------------------------------------


def _fast(data: bytes, grid: Grid) -> Rows | None:
    """None where the lines are not all alike, or hold what is no number."""
    import pyarrow as pa
    import pyarrow.csv as pc

    first = data[: data.find(b"\n")].rstrip(b"\r")
    cells = first.count(grid.delimiter) + 1
    if b"\0" in data or not grid.least <= cells <= grid.numeric + grid.text or not first.strip():
        return None
    # Arrow would end a row at a lone CR; and it makes a row of an empty line, which only one column hides
    if b"\r" in data and data.count(b"\r") != data.count(b"\r\n"):
        return None
    if cells == 1 and (b"\n\n" in data or b"\n\r" in data):
        return None
    names = [str(i) for i in range(cells)]
    kinds = {name: pa.float64() if i < grid.numeric else pa.binary() for i, name in enumerate(names)}
    try:
        table = pc.read_csv(
            pa.BufferReader(data),
            read_options=pc.ReadOptions(column_names=names, block_size=1 << 20),
            parse_options=pc.ParseOptions(
                delimiter=grid.delimiter.decode(), quote_char=False, ignore_empty_lines=False
            ),
            convert_options=pc.ConvertOptions(
                column_types=kinds,
                null_values=[""],
                strings_can_be_null=True,
                decimal_point=grid.decimal.decode(),
                check_utf8=False,
            ),
        )
    except pa.ArrowInvalid:
        return None
    numbers = [_numpy(table.column(i)) if i < cells else np.full(table.num_rows, np.nan) for i in range(grid.numeric)]
    if any(np.isinf(c).any() for c in numbers if np.isinf(c.sum()) or np.isnan(c.sum())):
        return None  # a number too large for a double, or Inf itself
    if table.num_rows > 1 and cells == 1 and np.isnan(numbers[0]).any():
        return None  # an empty line is an empty cell where there is one column
    text = None
    if cells > grid.numeric:
        text = _texts(table.column(grid.numeric))
    whole = (
        cells >= grid.numeric
        and all(table.column(i).null_count == 0 for i in range(grid.numeric))
        and not any(np.isnan(c[0]) or np.isnan(c.sum()) for c in numbers)
    )
    return Rows(numbers, text, np.arange(table.num_rows, dtype=np.int64), [], [], whole)


def _numpy(column: Any) -> Float1D:
    """float64 of a pyarrow column; its own way imports pandas first, which takes a second."""
    out = np.empty(len(column), np.float64)
    at = 0
    for chunk in column.chunks:
        n = len(chunk)
        values = np.frombuffer(chunk.buffers()[1], np.float64, n, chunk.offset * 8)
        out[at : at + n] = values
        if chunk.null_count:
            bits = np.unpackbits(np.frombuffer(chunk.buffers()[0], np.uint8), bitorder="little", count=chunk.offset + n)
            out[at : at + n][bits[chunk.offset :] == 0] = np.nan
        at += n
    return out


def _texts(column: Any) -> Array | None:
    """Cells of free text as bytes, None for an empty one; None where all are empty. Few of them differ."""
    if column.null_count == len(column):
        return None
    coded = column.combine_chunks().dictionary_encode()
    words = np.array([*coded.dictionary.to_pylist(), None], object)
    codes = coded.indices.fill_null(len(words) - 1).to_numpy()
    found: Array = words[codes]
    return found


# ---- the slow way --------------------------------------------------------------------------------


def _slow(data: bytes, grid: Grid) -> Rows:
    lines = data.split(b"\n")
    if lines and not lines[-1]:
        lines.pop()
    cells = [line.rstrip(b"\r").split(grid.delimiter) for line in lines]
    counts = Counter(len(row) for row in cells)
    kept: list[int] = []
    bad: list[int] = []
    for i, row in enumerate(cells):
        if len(row) == 1 and not row[0].strip():
            continue
        # more cells than a row has, but for an empty one behind a last delimiter
        if len(row) == grid.numeric + grid.text + 1 and not row[-1].strip():
            row = cells[i] = row[:-1]
        if grid.least <= len(row) <= grid.numeric + grid.text:
            kept.append(i)
        elif any(cell.strip() for cell in row) or counts[len(row)] > 1:
            bad.append(i)
    wrong: list[tuple[int, int]] = []
    numbers = []
    for c in range(grid.numeric):
        values = np.empty(len(kept))
        for r, i in enumerate(kept):
            cell = cells[i][c].strip() if c < len(cells[i]) else b""
            value = number(cell, grid.decimal)
            if value is None:
                wrong.append((r, c))
                value = np.nan
            values[r] = value
        numbers.append(values)
    text = None
    if grid.text and any(len(cells[i]) > grid.numeric for i in kept):
        text = np.array(
            [cells[i][grid.numeric] or None if len(cells[i]) > grid.numeric else None for i in kept], object
        )
    return Rows(numbers, text, np.array(kept, np.int64), sorted(wrong), bad)


def number(cell: bytes, decimal: bytes = b".") -> float | None:
    """The number in a cell; NaN for an empty one, None for what is none."""
    if not cell:
        return np.nan
    if decimal == b",":
        if b"." in cell:
            return None
        cell = cell.replace(b",", b".")
    if _NUMBER.match(cell):
        value = float(cell)
        return value if np.isfinite(value) else None  # 1e999
    return _WORDS.get(cell.lower())


def mask(n: int, rows: list[int]) -> Bool1D:
    """True at some rows, shape (n,)."""
    found = np.zeros(n, bool)
    found[rows] = True
    return found
