"""Rows of delimited text cut line by line, where bytes, quotes or line ends are odd (typed.py)."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from thermodata.reader.text.cells.lines.delimiter import fields
from thermodata.reader.text.cells.values.arrow import text_array
from thermodata.reader.text.cells.values.column import Values, values_of
from thermodata.reader.text.rows.grid import TIME, BadLine, Grid, Rows

_MOST_LINES = 64  # of one cell in quotes
SHOWN = 200


@dataclass
class CutRows:
    """Rows that were cut by hand: their lines, and the cells of each column."""

    grid: Grid
    lines: list[int] = field(default_factory=list)
    short: list[int] = field(default_factory=list)
    columns: list[list[str]] = field(init=False)

    def __post_init__(self) -> None:
        self.columns = [[] for _ in self.grid.kinds]

    def add(self, line: int, cells: Sequence[str]) -> bool:
        """Takes a row; False where a line is none: empty cells behind its last column are nothing, and those that a row
        may lack are empty."""
        width = self.grid.width
        if len(cells) > width and not self.grid.exact and not any(c.strip() for c in cells[width:]):
            cells = cells[:width]
        if self.grid.least is not None and self.grid.least <= len(cells) < width:
            self.short.append(line)
            cells = [*cells, *[""] * (width - len(cells))]
        if len(cells) != width:
            return False
        self.lines.append(line)
        for column, cell in zip(self.columns, cells, strict=True):
            column.append(cell)
        return True


def line_by_line(data: bytes, line: int, grid: Grid) -> Rows:
    """All rows of whole lines in UTF-8, as `rows.parse` has them."""
    rows, bad, nul = CutRows(grid), list[BadLine](), list[tuple[int, int]]()
    for number, text in _records(data, line, grid):
        # what a power cut left before a row says nothing of it; inside, a cell that lost a part must not pass for whole
        bare = text.lstrip("\0").rstrip("\r")
        if "\0" in text:
            nul.append((number, text.count("\0")))
        record = _cells(bare, grid)
        if "\0" in bare:
            kinds = [*grid.kinds, *[None] * len(record)]
            record = [c.replace("\0", "") if kind == "str" else c for c, kind in zip(record, kinds, strict=False)]
        blank = not any(cell.strip() for cell in record)
        if blank and not (grid.blank_rows and len(record) > 1):
            continue
        if not rows.add(number, record) and not blank:
            size = len(text.encode("utf-8", "replace"))
            bad.append(BadLine(number, len(record), bare[:SHOWN], size))
    columns, times = converted(rows.columns, grid)
    lines, short = np.array(rows.lines, np.int64), np.array(rows.short, np.int64)
    return Rows(lines, columns, times, tuple(bad), tuple(nul), short)


def _cells(record: str, grid: Grid) -> list[str]:
    if "\n" not in record:
        return fields(record, grid.delimiter, grid.quoted)
    try:
        return next(csv.reader(io.StringIO(record), delimiter=grid.delimiter), [""])
    except csv.Error:
        return record.split(grid.delimiter)


def _records(data: bytes, line: int, grid: Grid) -> Iterator[tuple[int, str]]:
    """(number of its first line, text) of each record: a line, or the lines of a cell in quotes that goes over several.
    A quote that nothing closes is a character like any other."""
    lines = data.decode("utf-8", "replace").split("\n")[:-1]
    at = 0
    while at < len(lines):
        text, more = lines[at], 1
        if grid.quoted and text.count('"') % 2:
            for k in range(at + 1, min(len(lines), at + _MOST_LINES)):
                if lines[k].count('"') % 2:
                    joined = "\n".join(lines[at : k + 1])
                    if len(_cells(joined, grid)) == grid.width:
                        text, more = joined, k + 1 - at
                    break
        yield line + at, text
        at += more


def converted(cells_of: Sequence[Any], grid: Grid) -> tuple[dict[int, Values], dict[int, Any]]:
    """The values, and the texts of times, by column, of the cells of each column."""
    import pyarrow as pa

    columns: dict[int, Values] = {}
    times: dict[int, Any] = {}
    for i, kind in enumerate(grid.kinds):
        if kind is None:
            continue
        cells = cells_of[i] if isinstance(cells_of[i], pa.Array) else text_array(cells_of[i])
        if kind == TIME:
            times[i] = cells
        else:
            columns[i] = values_of(cells, kind, grid.decimal, grid.decimal_declared)
    return columns, times
