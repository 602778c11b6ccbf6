"""Finds where rows stand in the bytes of a file, so that a check can double, swap or spoil one.

The kit knows no format: it takes a part of the file away and looks whether exactly one row is gone. Parts are the lines
of a text, and the records of one length of a plain binary file, which the bytes of its numbers show.
"""

from __future__ import annotations

import contextlib
import re
import struct
import tempfile
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from itertools import islice
from pathlib import Path
from typing import Any, NoReturn
from unittest import SkipTest

import numpy as np

from thermodata.plugin import Array, Source
from thermodata.testing.reader.case import Case, Data, equal, refused_or_read

TRIES = 200  # parts that are taken away in the search
LONGEST_RECORD = 256  # [bytes] of a binary file
_MARKS = (b";", b",", b"\t", b"|")
_FLOATS = ("<d", ">d", "<f", ">f")
_NUMBER = re.compile(rb"[-+]?\d+(?:[.,]\d+)?(?:[eE][-+]?\d+)?|[-+]?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?")
_BARE = (_NUMBER, re.compile(rb"[-+]?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?"))  # where a comma parts cells it is no mark

Part = tuple[int, int]
Arrange = Callable[[str, Array], Array]


@dataclass(frozen=True)
class Record:
    """content[first:last] holds row `rows[stream]` of each stream in rows. is_text: a line, with its end."""

    content: bytes
    first: int
    last: int
    rows: Mapping[str, int]
    is_text: bool

    @property
    def own(self) -> bytes:
        """Its bytes."""
        return self.content[self.first : self.last]

    @property
    def where(self) -> str:
        if self.is_text:
            return f"line {self.content.count(bytes([10]), 0, self.first) + 1}"
        return f"bytes {self.first} to {self.last}"

    @property
    def row_words(self) -> str:
        return ", ".join(f"row {row} of stream '{stream}'" for stream, row in self.rows.items())

    @property
    def is_json(self) -> bool:
        return self.own.lstrip()[:1] in (b"{", b"[")

    def replaced(self, by: bytes) -> bytes:
        """The file with other bytes in the record's place."""
        return self.content[: self.first] + by + self.content[self.last :]


@dataclass(frozen=True)
class Cell:
    """The bytes [first, last) of a record's own in which the value of a signal stands, as it is written."""

    record: Record
    stream: str
    name: str
    first: int
    last: int
    form: str  # "text", or struct's letters of a binary number

    @property
    def row(self) -> int:
        return self.record.rows[self.stream]

    @property
    def may_be_empty(self) -> bool:
        """Whether marks that are no blanks part the cell from its neighbours, so that an empty one is seen."""
        before, after = _letters_beside(self.record.own, self.first, self.last)
        return before in _MARKS and after in (*_MARKS, b"\r", b"\n")

    def replaced(self, by: bytes) -> bytes:
        """The file with other bytes in the cell's place."""
        own = self.record.own
        return self.record.replaced(own[: self.first] + by + own[self.last :])


def not_looked_at(why: str) -> NoReturn:
    """The check does not bear on this file: a test that is skipped, with the reason."""
    raise SkipTest(why)


def changed(case: Case, path: Path, source: Source, content: bytes, what: str) -> Data | None:
    """What the reader gives of a file of this name that holds `content`; None where it refuses it."""
    with tempfile.TemporaryDirectory() as folder:
        copy = Path(folder) / path.name
        copy.write_bytes(content)
        return refused_or_read(case, copy, source, what)


def two_records(case: Case, path: Path, source: Source, whole: Data) -> tuple[Record, Record]:
    """Two records that follow each other, about the middle of the file. Skips where none can be told."""
    content = path.read_bytes()
    is_text = not re.search(rb"[\0-\x08\x0e-\x1a]", content)
    pairs = _lines(content) if is_text else _records(content, whole)

    def record(part: Part) -> Record | None:
        data = None
        with contextlib.suppress(AssertionError):
            data = changed(case, path, source, content[: part[0]] + content[part[1] :], path.name)
        gone = None if data is None else _the_row_gone(whole, data)
        return None if gone is None else Record(content, *part, gone, is_text)

    for first, second in islice(pairs, TRIES):
        a = record(first)
        b = None if a is None else record(second)
        if a is not None and b is not None and b.rows == {stream: row + 1 for stream, row in a.rows.items()}:
            return a, b
    not_looked_at(
        f"{path.name}: no line or record of it can be taken away so that one row is gone, so the kit can't spoil one; "
        "give a text, or a file that is not compressed, where the format has one; else spoil rows in a test of your own"
    )


def cells(record: Record, whole: Data) -> Iterator[Cell]:
    """Where the numbers of a record stand, each in a cell of its own and once in the record."""
    find = _written_number if record.is_text else _packed_number
    for (stream, name), column in whole.values.items():
        if stream not in record.rows or column.dtype.kind not in "iuf":
            continue
        value = column[record.rows[stream]]
        found = find(record.own, value) if np.isfinite(value) and value != 0 else None
        if found is not None:
            yield Cell(record, stream, name, *found)


def without(rows: Mapping[str, int]) -> Arrange:
    """Each column without its stream's row."""
    return lambda stream, column: np.delete(column, rows[stream]) if stream in rows else column


def otherwise(whole: Data, data: Data, expected: Arrange) -> str | None:
    """The first difference of `data` from the whole file's columns, each as `expected(stream, column)` has it."""
    if whole.t_ns.keys() != data.t_ns.keys() or whole.values.keys() != data.values.keys():
        return f"streams and signals {sorted(data.values)}"
    for stream, t_ns in whole.t_ns.items():
        if not equal(expected(stream, t_ns), data.t_ns[stream]):
            return f"other times in stream '{stream}' ({data.t_ns[stream].size} rows)"
    for (stream, name), column in whole.values.items():
        if not equal(expected(stream, column), data.values[stream, name]):
            return f"other values in '{name}'"
    return None


def _the_row_gone(whole: Data, data: Data) -> dict[str, int] | None:
    """stream -> the row that is in `whole` and not in `data`; None where they differ otherwise."""
    gone = {}
    for stream, t_ns in whole.t_ns.items():
        if data.t_ns.get(stream, t_ns[:0]).size == t_ns.size - 1:
            gone[stream] = _first_other(t_ns, data.t_ns[stream]) if t_ns.size > 1 else 0
    return gone if gone and otherwise(whole, data, without(gone)) is None else None


def _first_other(whole: Array, fewer: Array) -> int:
    differs = whole[: fewer.size] != fewer
    return int(np.argmax(differs)) if differs.any() else int(fewer.size)


def _lines(content: bytes) -> Iterator[tuple[Part, Part]]:
    """Two neighbouring lines each, from the middle of the file outward."""
    ends = [match.end() for match in re.finditer(rb"\n", content)]
    lines = list(zip([0, *ends], ends, strict=False))[1:-1]
    for i in sorted(range(len(lines) - 1), key=lambda i: abs(i - len(lines) // 2)):
        yield lines[i], lines[i + 1]


def _records(content: bytes, whole: Data) -> Iterator[tuple[Part, Part]]:
    """Two neighbouring parts each, as long as two numbers of a column lie apart, wherever they may begin."""
    for (stream, _), column in whole.values.items():
        middle = whole.t_ns[stream].size // 2
        if column.dtype.kind != "f" or column.size < middle + 2:
            continue
        for form in _FLOATS:
            a, b = (_only_place(content, struct.pack(form, value)) for value in column[middle : middle + 2].tolist())
            if a is None or b is None or not 0 < b - a <= LONGEST_RECORD:
                continue
            for begin in range(a, max(-1, a - (b - a)), -1):
                yield (begin, begin + b - a), (begin + b - a, begin + 2 * (b - a))


def _only_place(content: bytes, wanted: bytes) -> int | None:
    return content.find(wanted) if content.count(wanted) == 1 else None


def _packed_number(own: bytes, value: Any) -> tuple[int, int, str] | None:
    for form in _FLOATS:
        at = _only_place(own, struct.pack(form, float(value)))
        if at is not None:
            return at, at + struct.calcsize(form), form
    return None


def _written_number(own: bytes, value: Any) -> tuple[int, int, str] | None:
    """Where the number stands between marks that part cells, and nowhere else."""
    for pattern in _BARE:
        found = [match.span() for match in pattern.finditer(own) if _is_value(match[0], float(value))]
        if len(found) == 1 and _stands_alone(own, *found[0]):
            return *found[0], "text"
    return None


def _is_value(written: bytes, value: float) -> bool:
    return bool(np.isclose(float(written.replace(b",", b".")), value, rtol=1e-6, atol=0))


def _stands_alone(own: bytes, first: int, last: int) -> bool:
    before, after = _letters_beside(own, first, last)
    apart = own[last : last + 1].isspace() and own[first - 1 : first].isspace()
    return apart or (before in (*_MARKS, b":", b"") and after in (*_MARKS, b"}", b"]", b"\r", b"\n"))


def _letters_beside(own: bytes, first: int, last: int) -> tuple[bytes, bytes]:
    """The letter before and behind a cell, past blanks and quotes."""
    return own[:first].rstrip(b" \"'")[-1:], own[last:].lstrip(b" \"'")[:1]
