"""Rows of delimited text as typed columns, each with the line that it stands in.

A part of whole lines is parsed by Arrow at once, as the types that the columns should have. Where a cell is none of its
kind, the part is parsed as text, and each cell judged by the policy of `number`; where bytes, quotes or line ends are
odd, it is taken line by line. All three ways give the same rows for what they can read.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from thermodata.plugin import Int1D
from thermodata.reader.text.cells.lines.delimiter import fields
from thermodata.reader.text.cells.values import arrow
from thermodata.reader.text.cells.values.arrow import text_array
from thermodata.reader.text.cells.values.column import Values
from thermodata.reader.text.cells.values.no_value import null_words
from thermodata.reader.text.cells.values.number import EXACT
from thermodata.reader.text.cells.values.quotes import clean
from thermodata.reader.text.file.lines import count
from thermodata.reader.text.rows.grid import TIME, BadLine, Grid, Rows
from thermodata.reader.text.rows.odd_rows import SHOWN, CutRows, converted, line_by_line

_SLACK_CELLS = 10_000  # delimiters of a part beyond what its lines should have


def parse(data: bytes, line: int, grid: Grid) -> Rows:
    """All rows of whole lines in UTF-8. line: the number of the first, 0-based in the file. Empty lines are none."""
    if not data or data.isspace():
        nuls = ((line, data.count(b"\0")),) if b"\0" in data else ()
        return Rows(np.empty(0, np.int64), *converted([[] for _ in grid.kinds], grid), nul=nuls)
    if not data.endswith(b"\n"):
        data += b"\n"
    return _typed(data, line, grid) or _as_text(data, line, grid) or line_by_line(data, line, grid)


# ---- by Arrow ------------------------------------------------------------------------------------


def _odd_bytes(data: bytes, grid: Grid, lines: int) -> bool:
    """Whether a parser would see other lines or cells than an editor shows: bytes of zero, a carriage return alone (an
    end of a row for Arrow), a quote that stays open, or one line of so many cells that room is made for all. lines: how
    many they are."""
    return (
        b"\0" in data
        or (b"\r" in data and count(data, b"\r") != data.count(b"\r\n"))
        or (grid.quoted and count(data, b'"') % 2 == 1)
        or count(data, grid.delimiter.encode()) > (grid.width - 1) * (lines + 1) + _SLACK_CELLS
    )


def _read_table(data: bytes, grid: Grid, width: int, kinds: dict[str, Any], invalid: list[Any] | None) -> Any:
    """The table of the wanted columns; ArrowInvalid where it is none. invalid: takes rows of another width."""
    import pyarrow as pa
    import pyarrow.csv as pc

    def skip(row: Any) -> str:
        assert invalid is not None
        invalid.append(row)
        return "skip"

    return pc.read_csv(
        pa.BufferReader(data),
        # the handler tells a row's number where there is one thread only
        pc.ReadOptions(column_names=[str(i) for i in range(width)], block_size=1 << 20, use_threads=invalid is None),
        pc.ParseOptions(
            delimiter=grid.delimiter,
            quote_char='"' if grid.quoted else False,
            ignore_empty_lines=False,
            invalid_row_handler=None if invalid is None else skip,
        ),
        pc.ConvertOptions(
            column_types=kinds,
            include_columns=list(kinds),
            null_values=list(null_words()),
            strings_can_be_null=False,
            true_values=["TRUE", "True", "true", "WAHR", "Wahr", "wahr"],
            false_values=["FALSE", "False", "false", "FALSCH", "Falsch", "falsch"],
            decimal_point=grid.decimal,
            check_utf8=False,
        ),
    )


def _typed(data: bytes, line: int, grid: Grid) -> Rows | None:
    """The part where each line is a row, and each cell of its column's kind or empty."""
    import pyarrow as pa

    many = count(data, b"\n")
    if _odd_bytes(data, grid, many):
        return None
    width = data[: data.find(b"\n")].count(grid.delimiter.encode()) + 1
    if not (grid.width if grid.least is None else grid.least) <= width <= grid.width:
        return None
    text = pa.dictionary(pa.int32(), pa.string())
    kinds: dict[str, Any] = {
        str(i): pa.string() if kind == TIME else text if kind == "str" else pa.type_for_alias(kind)
        for i, kind in enumerate(grid.kinds[:width])
        if kind is not None
    }
    try:
        table = _read_table(data, grid, width, kinds, None)
    except pa.ArrowInvalid:
        return None
    if table.num_rows != many:
        return None
    columns: dict[int, Values] = {}
    for i, kind in enumerate(grid.kinds):
        if kind is None or kind == TIME:
            continue
        if i >= width:
            columns[i] = _empty_column(table.num_rows, kind)
            continue
        values = _arrow_values(table.column(str(i)), kind)
        if values is None:
            return None
        columns[i] = values
    times = {
        i: table.column(str(i)) if i < width else pa.array([""] * table.num_rows)
        for i, kind in enumerate(grid.kinds)
        if kind == TIME
    }
    lines = np.arange(line, line + table.num_rows, dtype=np.int64)
    rows = Rows(lines, columns, times, short=lines if width < grid.width else lines[:0])
    # an empty line is a cell without a value in every column
    if any(i < width and grid.kinds[i] != "str" and not values.empty.any() for i, values in columns.items()):
        return rows
    return _without_empty_lines(rows, data, line) if grid.blank_rows else _without_empty_cells(rows)


def _arrow_values(column: Any, kind: str) -> Values | None:
    """A parsed column; None where a number needs a second look (too large, or an integer that was rounded). Taken from
    Arrow's buffers, for its own ways import pandas first."""
    if kind == "str":
        return _shared_texts(column)
    none = np.zeros(len(column), bool)
    values = arrow.values(column, kind)
    empty = none
    if column.null_count:
        empty = arrow.is_null(column)
        values[empty] = np.nan if kind == "float64" else 0
    if kind == "float64" and values.size:
        with np.errstate(invalid="ignore"):
            if np.fmax.reduce(values) >= EXACT or np.fmin.reduce(values) <= -EXACT:
                return None
    return Values(values, empty, none)


def _shared_texts(column: Any) -> Values:
    none = np.zeros(len(column), bool)
    parts = []
    for chunk in column.chunks:
        words = np.array([*((clean(w) or None) for w in chunk.dictionary.to_pylist()), None], object)
        parts.append(words[arrow.codes(chunk)])
    return Values(np.concatenate(parts) if parts else np.empty(0, object), none, none)


def _empty_column(n: int, kind: str) -> Values:
    """A column that no row has."""
    dtype, none = np.dtype(object if kind == "str" else kind), np.zeros(n, bool)
    nothing = None if kind == "str" else np.nan if dtype.kind == "f" else 0
    return Values(np.full(n, nothing, dtype), none if kind == "str" else np.ones(n, bool), none)


def _without_empty_cells(rows: Rows) -> Rows:
    """Without the rows in which no cell holds anything."""
    import pyarrow.compute as pc

    blank = np.ones(rows.n, bool)
    for values in rows.columns.values():
        words = values.values
        blank &= values.empty if words.dtype != object else np.fromiter((w is None for w in words), bool, words.size)
    for cells in rows.times.values():
        if blank.any():
            blank &= arrow.values(pc.equal(pc.utf8_trim_whitespace(cells.fill_null("")), ""), "bool")
    return rows.take(np.flatnonzero(~blank)) if blank.any() else rows


def _without_empty_lines(rows: Rows, data: bytes, line: int) -> Rows:
    """Without the rows that Arrow makes of lines that hold nothing at all. line: the number of the first."""
    letters = np.frombuffer(data, np.uint8)
    ends = np.flatnonzero(letters == 10)
    starts = np.concatenate(([0], ends[:-1] + 1))
    size = ends - starts
    blank = (size == 0) | ((size == 1) & (letters[starts] == 13))
    return rows.take(np.flatnonzero(~blank[rows.line - line])) if blank.any() else rows


def _as_text(data: bytes, line: int, grid: Grid) -> Rows | None:
    """The part where some lines are no rows, or some cells none of their kind; None where lines cannot be told."""
    import pyarrow as pa

    many = count(data, b"\n")
    if _odd_bytes(data, grid, many):
        return None
    invalid: list[Any] = []
    wanted = [i for i, kind in enumerate(grid.kinds) if kind is not None]
    width = _common_width(data, grid)
    try:
        table = _read_table(data, grid, width, {str(i): pa.string() for i in wanted if i < width}, invalid)
    except pa.ArrowInvalid:
        return None
    if table.num_rows + len(invalid) != many or any("\n" in row.text for row in invalid):
        return None  # a cell in quotes goes over lines
    side, bad = CutRows(grid), list[BadLine]()
    numbers = np.array([row.number - 1 for row in invalid], np.int64)
    for row in invalid:
        cells = fields(row.text.rstrip("\r"), grid.delimiter, grid.quoted)
        fits = side.add(line + row.number - 1, cells)
        if not fits and any(cell.strip() for cell in cells):
            size = len(row.text.encode())
            bad.append(BadLine(line + row.number - 1, row.actual_columns, row.text[:SHOWN].rstrip("\r"), size))
    lines = np.delete(np.arange(line, line + table.num_rows + len(invalid), dtype=np.int64), numbers)
    cells_of: list[Any] = [None] * grid.width
    for i in wanted:
        column = table.column(str(i)).combine_chunks() if i < width else pa.nulls(table.num_rows, pa.string())
        cells_of[i] = pa.concat_arrays([*_arrays(column), text_array(side.columns[i])])
    columns, times = converted(cells_of, grid)
    lines = np.concatenate([lines, np.array(side.lines, np.int64)])
    short = np.array(side.short, np.int64)
    if width < grid.width:
        short = np.union1d(short, lines[: table.num_rows])
    rows = Rows(lines, columns, times, tuple(bad), short=short)
    order = np.argsort(rows.line, kind="stable")
    taken = rows.take(order) if side.lines else rows
    if grid.blank_rows:
        return _without_empty_lines(taken, data, line)
    return _without_empty_rows(taken, cells_of, order)


def _common_width(data: bytes, grid: Grid) -> int:
    """How many cells most rows have, by the mean: where rows may be shorter, most may lack the same cells."""
    if grid.least is None:
        return grid.width
    mean = round(count(data, grid.delimiter.encode()) / count(data, b"\n")) + 1
    return min(max(mean, grid.least), grid.width)


def _arrays(column: Any) -> list[Any]:
    """What combine_chunks() gives in any version of Arrow, as plain arrays."""
    return list(column.chunks) if hasattr(column, "chunks") else [column]


def _without_empty_rows(rows: Rows, cells_of: Sequence[Any], order: Int1D) -> Rows:
    """Without the rows that hold nothing: empty lines, and delimiters alone."""
    import pyarrow.compute as pc

    blank = np.ones(rows.n, bool)
    for cells in cells_of:
        if cells is None or not blank.any():
            continue
        blank &= arrow.values(pc.equal(pc.utf8_trim_whitespace(cells.fill_null("")), ""), "bool")
    return rows.take(np.flatnonzero(~blank[order])) if blank.any() else rows
