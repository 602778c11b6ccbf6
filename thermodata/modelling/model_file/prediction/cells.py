"""A CSV file that another program or a spreadsheet wrote, as cells: whatever parts them, with its encoding found, and
never a row of another width taken for one of the header's."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from thermodata.errors import FormatError, SpecError
from thermodata.reader.text import decimal_mark, decode
from thermodata.reader.text.cells.lines.delimiter import DELIMITERS, fields, shown
from thermodata.reader.text.cells.values.number import to_bool, to_float


@dataclass(frozen=True)
class Cells:
    """header: the names of the columns, at line `at`; rows: (line in the file, cells) of those that are not blank, each
    of as many cells as the header or fewer, or of more that are empty."""

    header: tuple[str, ...]
    at: int
    rows: tuple[tuple[int, list[str]], ...]


@dataclass(frozen=True)
class Numbers:
    """How a file writes its numbers. decimal: '.' or ','; seen: the line of the first that has one, None where none
    has."""

    decimal: str = "."
    seen: int | None = None

    def value(self, text: str) -> float | None:
        """By the policy that all texts are read by; None for what is no number, a truth value among them."""
        value = to_float(text, self.decimal)
        return None if value in (0.0, 1.0) and to_bool(text) is not None else value

    def expected(self) -> str:
        if self.seen is None:
            return "a finite number"
        return f"a finite number with a decimal {'point' if self.decimal == '.' else 'comma'}, as at line {self.seen}"


def read_cells(path: Path) -> Cells:
    """SpecError with the line of what is no table: a quote that is never closed, a zero byte, a row that is wider than
    the header. OSError where the file can't be opened."""
    text = _text(path)
    records = _records(text, path)
    at, header = next(records, (1, []))
    rows = []
    for line, cells in records:
        if len(cells) > len(header):
            _refuse_wider(cells, header, f"{path}:{line}")
        rows.append((line, cells))
    return Cells(tuple(header), at, tuple(rows))


def numbers_of(cells: Iterable[tuple[int, str]]) -> Numbers:
    """cells: (line, text) of all numbers of a file. The first that has a fraction says which mark all have."""
    some = ((line, text) for line, text in cells if not text.isdigit())
    return next((Numbers(mark, line) for line, text in some if (mark := decimal_mark([text]))), Numbers())


def _text(path: Path) -> str:
    try:
        text, _, _ = decode(path.read_bytes())
    except FormatError as error:
        raise SpecError(
            "the prediction file cannot be read as text",
            where=f"{path}, {error.where}" if error.where else str(path),
            expected=error.expected,
            got=error.got,
            hint="save it as UTF-8",
        ) from None
    if (zero := text.find("\0")) >= 0:
        raise SpecError(
            "the prediction file holds a zero byte",
            where=f"{path}:{text.count(chr(10), 0, zero) + 1}",
            expected="text",
            got="a byte 0: a file that was not written to its end, or none of text",
            hint="write the file again",
        )
    return text


def _records(text: str, path: Path) -> Iterator[tuple[int, list[str]]]:
    """(line where it begins, cells) of each row that is not blank; Excel's 'sep=;' is none."""
    first = next((line for line in text.splitlines() if line.strip()), "")
    told = first.strip().lower().startswith("sep=") and len(first.strip()) == len("sep=;")
    delimiter = first.strip()[-1] if told else max(DELIMITERS, key=lambda d: len(fields(first, d)))
    records = csv.reader(io.StringIO(text, newline=""), delimiter=delimiter, strict=True)
    while True:
        line = records.line_num + 1
        try:
            cells = next(records, None)
        except csv.Error as error:
            raise SpecError(
                "the row is none of a CSV file",
                where=f"{path}:{line}",
                expected=f"cells parted by {shown(delimiter, False)}, each quote closed in its cell",
                got=str(error),
                hint="write the row again, without the quote or with one more",
            ) from None
        if cells is None:
            return
        if any(map(str.strip, cells)) and not (told and line == 1):
            yield line, cells


def _refuse_wider(cells: Sequence[str], header: Sequence[str], where: str) -> None:
    if any(map(str.strip, cells[len(header) :])):
        raise SpecError(
            "the row has more cells than the header",
            where=where,
            expected=f"{len(header)}: {', '.join(header)}",
            got=f"{len(cells)}: {', '.join(cells)}",
            hint="a decimal comma parts a number in two where commas part the cells: write decimal points, or part the "
            "cells by semicolons",
        )
