"""Tables of numbers in text: a whole part at once through Arrow; where one does not read, halves of it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from thermodata.plugin import Array

_SMALL = 4096
EMPTY = ("", "NaN", "nan", "-nan", "-nan(ind)", "1.#QNAN", "-1.#IND", "UNAVAILABLE")


@dataclass(frozen=True, slots=True)
class Numbers:
    """Columns of consecutive rows; a blank cell is NaN, or False in `there` where the dtype has no NaN."""

    columns: tuple[Array, ...]
    there: tuple[Array, ...]


@dataclass(frozen=True, slots=True)
class BadLine:
    """A line that does not read; line: 0-based in the file."""

    line: int
    text: str


@dataclass(frozen=True, slots=True)
class Grid:
    """How rows of numbers are written. dtypes: one a column."""

    delimiter: str
    decimal: str
    dtypes: Sequence[str]

    def parts(self, data: bytes, line: int) -> Iterator[Numbers | BadLine]:
        """The numbers of whole lines of text, and each line that is none."""
        if not data.strip():
            return
        try:
            yield self._numbers(data)
            return
        except ValueError:
            pass
        cut = data.find(b"\n", len(data) // 2) + 1
        if not 0 < cut < len(data) or len(data) < _SMALL:
            cut = data.find(b"\n") + 1                      # few lines: one by one
        if not 0 < cut < len(data):
            yield BadLine(line, data.decode("utf-8", "replace").rstrip("\r\n"))
            return
        yield from self.parts(data[:cut], line)
        yield from self.parts(data[cut:], line + data.count(b"\n", 0, cut))

    def _numbers(self, data: bytes) -> Numbers:
        """ValueError (Arrow's is one) where a cell or a row is not as it should be."""
        import pyarrow as pa
        import pyarrow.csv as pc

        if b"\0" in data:
            raise ValueError("NUL bytes")
        names = [str(k) for k in range(len(self.dtypes))]
        table = pc.read_csv(
            pa.BufferReader(data), pc.ReadOptions(column_names=names),
            pc.ParseOptions(delimiter=self.delimiter, quote_char=False),
            pc.ConvertOptions(column_types={n: pa.type_for_alias(k) for n, k in zip(names, self.dtypes, strict=True)},
                              null_values=list(EMPTY), decimal_point=self.decimal,
                              true_values=["1", "True", "TRUE", "true"], false_values=["0", "False", "FALSE", "false"]))
        columns, there = [], []
        for name, kind in zip(names, self.dtypes, strict=True):
            column = table.column(name)
            there.append(np.ones(len(column), bool) if not column.null_count else column.is_valid().to_numpy())
            if kind != "float64" and column.null_count:
                column = column.fill_null(False if kind == "bool" else 0)
            columns.append(column.to_numpy().astype(kind, copy=False))
        return Numbers(tuple(columns), tuple(there))
