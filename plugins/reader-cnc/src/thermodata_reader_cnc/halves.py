"""Tables of numbers in text: a whole part at once through Arrow; where one does not read, halves of it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from thermodata.plugin import Array

_SHOWN = 200  # bytes of a line that does not read
EMPTY = ("", "NaN", "nan", "-nan", "-nan(ind)", "1.#QNAN", "-1.#IND", "UNAVAILABLE")


def odd_lines(data: bytes, delimiter: str, width: int) -> bool:
    """Whether text holds so many cells that a line of it must be far too wide: a parser would make room for all."""
    return data.count(delimiter.encode()) > (width - 1) * (data.count(b"\n") + 1) + 10_000


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
        found = self._tried(data)
        if found is not None:
            yield found
            return
        # runs of lines with the right number of cells, and the lines between them
        run: list[bytes] = []
        first = line
        for number, text in enumerate(data.split(b"\n"), line):
            if text.count(self.delimiter.encode()) == len(self.dtypes) - 1 and b"\0" not in text:
                run.append(text)
                continue
            yield from self._halves(run, first)
            run, first = [], number + 1
            if text.strip():
                yield BadLine(number, text[:_SHOWN].decode("utf-8", "replace").rstrip("\r\n"))
        yield from self._halves(run, first)

    def _halves(self, lines: list[bytes], line: int) -> Iterator[Numbers | BadLine]:
        if not lines:
            return
        found = self._tried(b"\n".join(lines) + b"\n")
        if found is not None:
            yield found
        elif len(lines) == 1:
            if lines[0].strip():
                yield BadLine(line, lines[0][:_SHOWN].decode("utf-8", "replace").rstrip("\r\n"))
        else:
            half = len(lines) // 2
            yield from self._halves(lines[:half], line)
            yield from self._halves(lines[half:], line + half)

    def _tried(self, data: bytes) -> Numbers | None:
        """The numbers of lines that all read; None where one does not."""
        if b"\0" in data or odd_lines(data, self.delimiter, len(self.dtypes)):
            return None
        try:
            return self._numbers(data)
        except ValueError:  # Arrow's is one
            return None

    def _numbers(self, data: bytes) -> Numbers:
        """ValueError where a cell or a row is not as it should be."""
        import pyarrow as pa
        import pyarrow.csv as pc

        names = [str(k) for k in range(len(self.dtypes))]
        table = pc.read_csv(
            pa.BufferReader(data),
            pc.ReadOptions(column_names=names),
            pc.ParseOptions(delimiter=self.delimiter, quote_char=False),
            pc.ConvertOptions(
                column_types={n: pa.type_for_alias(k) for n, k in zip(names, self.dtypes, strict=True)},
                null_values=list(EMPTY),
                decimal_point=self.decimal,
                true_values=["1", "True", "TRUE", "true"],
                false_values=["0", "False", "FALSE", "false"],
            ),
        )
        columns, there = [], []
        for name, kind in zip(names, self.dtypes, strict=True):
            column = table.column(name)
            there.append(np.ones(len(column), bool) if not column.null_count else column.is_valid().to_numpy())
            if kind != "float64" and column.null_count:
                column = column.fill_null(False if kind == "bool" else 0)
            columns.append(column.to_numpy().astype(kind, copy=False))
        return Numbers(tuple(columns), tuple(there))
