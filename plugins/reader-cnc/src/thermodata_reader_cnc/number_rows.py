"""Tables in which a row counts as a whole: every cell is a number or empty, else the line is no row.

So it is where a row is one sample of all signals that a control took together; `thermodata.reader.text.rows.typed` says
what a number is.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from thermodata.plugin import Array, Block, Bool1D, Int1D
from thermodata.reader.text.file.lines import split_last_line
from thermodata.reader.text.rows.grid import BadLine, Grid
from thermodata.reader.text.rows.typed import parse
from thermodata.schema.flag import Flag

_SHOWN = 200  # characters of a line that is no row


@dataclass(frozen=True, slots=True)
class NumberRows:
    """line: of each row, 0-based in the file, shape (n,). columns: their values; empty: where a cell holds none; over:
    where it says overload; all of shape (n,). bad: the lines that are no rows."""

    line: Int1D
    columns: tuple[Array, ...]
    empty: tuple[Bool1D, ...]
    over: tuple[Bool1D, ...]
    bad: tuple[BadLine, ...]

    @property
    def n(self) -> int:
        return int(self.line.size)

    def before(self, line: int) -> int:
        """How many rows stand before a line."""
        return int(np.searchsorted(self.line, line))

    def block(self, stream: str, t_ns: Int1D, names: Mapping[str, int], which: Bool1D | slice) -> Block:
        """Rows as a block. names: signal -> its column; which: the rows, as a mask or a slice."""
        values = {name: self.columns[k][which] for name, k in names.items()}
        over = {name: self.over[k][which] for name, k in names.items()}
        flags = {name: mask * np.uint16(Flag.SATURATED) for name, mask in over.items() if mask.any()}
        return Block(stream, t_ns, values, flags or None, self.line[which] + 1)


def number_rows(data: bytes, line: int, delimiter: str, decimal: str, dtypes: Sequence[str]) -> NumberRows:
    """The rows of whole lines. line: the number of the first, 0-based; dtypes: float64, int64, uint64 or bool, one a
    column. A quote is no part of a cell."""
    bits = [k for k, dtype in enumerate(dtypes) if dtype == "bool"]  # written as 0 and 1, or as TRUE and FALSE
    kinds = tuple("float64" if dtype == "bool" else dtype for dtype in dtypes)
    data = data.replace(b'"', b"")
    rows = parse(data, line, Grid(delimiter, decimal, kinds, exact=True))
    columns = [rows.columns[k] for k in range(len(kinds))]
    whole = np.ones(rows.n, bool)
    for column in columns:
        whole[[row for row, _ in column.odd]] = False
    for k in bits:
        whole &= columns[k].empty | (columns[k].values == 0) | (columns[k].values == 1)
    nul = np.array([number for number, _ in rows.nul], np.int64)
    whole &= ~np.isin(rows.line, nul)
    bad = rows.bad
    if not whole.all() or nul.size:
        bad = _with_lines(rows.bad, sorted({*rows.line[~whole].tolist(), *nul.tolist()}), data, line)
    which = everywhere(whole)
    values = [c.values[which] for c in columns]
    for k in bits:
        values[k] = np.nan_to_num(values[k]) == 1
    empty, over = tuple(c.empty[which] for c in columns), tuple(c.over[which] for c in columns)
    return NumberRows(rows.line[which], tuple(values), empty, over, bad)


def everywhere(mask: Bool1D) -> Bool1D | slice:
    """A mask, or a slice where it is true everywhere: an array that is taken by it is not copied."""
    return slice(None) if mask.all() else mask


def _with_lines(bad: Sequence[BadLine], more: Sequence[int], data: bytes, line: int) -> tuple[BadLine, ...]:
    """The bad lines, in order, and others of the same text."""
    lines, known = data.split(b"\n"), {each.line for each in bad}
    added = []
    for number in more:
        if number not in known:
            text = lines[number - line].rstrip(b"\r")
            added.append(BadLine(number, 0, text[:_SHOWN].decode("utf-8", "replace"), len(text)))
    return tuple(sorted([*bad, *added], key=lambda each: each.line))


def without_end(data: bytes, mark: bytes) -> tuple[bytes, bytes]:
    """(whole lines of a part of a file, what stands behind them), without the mark that ends the rows, alone in a
    line."""
    lines, tail = split_last_line(data)
    rows, last = split_last_line(lines.rstrip(b"\r\n"))
    return (rows if last.strip() == mark else lines), (b"" if tail.strip() in (b"", mark) else tail)
