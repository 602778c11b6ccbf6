"""How rows of text lie, and what they give: typed columns, each row with the line that it stands in."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from thermodata.plugin import Int1D
from thermodata.reader.text.cells.values.column import Values

TIME = "time"  # a column of times as text: left as it stands


@dataclass(frozen=True, slots=True)
class Grid:
    """How rows lie. kinds: of each column: float64, int64, uint64, bool, str, TIME, or None for one that nobody wants;
    least: the fewest cells of a row (those that are missing are empty); exact: a row with empty cells behind its last
    column is none, for a delimiter too much may have shifted others; decimal_declared: see the policy of numbers;
    blank_rows: whether delimiters alone are a row (where rows are counted, one without values takes its time)."""

    delimiter: str
    decimal: str
    kinds: tuple[str | None, ...]
    quoted: bool = False
    least: int | None = None
    decimal_declared: bool = False
    exact: bool = False
    blank_rows: bool = False

    @property
    def width(self) -> int:
        return len(self.kinds)


@dataclass(frozen=True, slots=True)
class BadLine:
    """A line that is no row. line: 0-based in the file; cells: how many it has; text: its beginning."""

    line: int
    cells: int
    text: str
    size: int


@dataclass(frozen=True, slots=True)
class Rows:
    """line: of each row, 0-based in the file, rising, shape (n,). columns: what each wanted column holds; times: the
    cells of TIME columns as an Arrow array. nul: (line, how many bytes of zero) where such stood in or before a row.
    short: lines of the rows that have fewer cells than columns, shape (k,)."""

    line: Int1D
    columns: dict[int, Values]
    times: dict[int, Any]
    bad: tuple[BadLine, ...] = ()
    nul: tuple[tuple[int, int], ...] = ()
    short: Int1D = field(default_factory=lambda: np.empty(0, np.int64))

    @property
    def n(self) -> int:
        return int(self.line.size)

    def before(self, line: int) -> Rows:
        """What stands before a line of the file."""
        rows = self.take(np.flatnonzero(self.line < line))
        bad, nul = tuple(b for b in self.bad if b.line < line), tuple(n for n in self.nul if n[0] < line)
        return replace(rows, bad=bad, nul=nul)

    def take(self, which: Int1D) -> Rows:
        """Some rows, in this order. which: their numbers, shape (k,)."""
        import pyarrow as pa

        if which.size == self.n and (which[1:] > which[:-1]).all():
            return self
        place = np.full(self.n, -1, np.int64)
        place[which] = np.arange(which.size)
        columns = {
            i: Values(
                v.values[which],
                v.empty[which],
                v.over[which],
                tuple(sorted((int(place[r]), cell) for r, cell in v.odd if place[r] >= 0)),
            )
            for i, v in self.columns.items()
        }
        index = pa.array(which)
        times = {i: t.take(index) for i, t in self.times.items()}
        line = self.line[which]
        return replace(self, line=line, columns=columns, times=times, short=self.short[np.isin(self.short, line)])
