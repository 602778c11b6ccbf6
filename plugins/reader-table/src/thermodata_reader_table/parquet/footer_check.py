"""Size statistics in the footer of a Parquet file, held against its schema before Arrow looks at them.

Arrow compares the lengths of their histograms with the levels of the column where it may not raise, and ends the
process where they differ. So this walks through the footer (Thrift's compact protocol; apache/parquet-format,
parquet.thrift) and knows no more of it than where those lists stand.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

_TRUE, _FALSE, _BYTE, _DOUBLE, _BINARY, _LIST, _SET, _MAP, _STRUCT = 1, 2, 3, 7, 8, 9, 10, 11, 12
_VARINTS = frozenset((4, 5, 6))
_DEEPEST = 32
# fields by their numbers in parquet.thrift
_ROW_GROUPS, _COLUMNS, _META_DATA, _SIZE_STATISTICS = 4, 1, 3, 16
_BYTES, _REPETITION, _DEFINITION = 1, 2, 3
# a footer of so many column chunks takes a second
_MOST_CHUNKS = 20_000

Fields = Callable[[int, int], bool]  # (number, type) -> whether the field was read


def check_size_statistics(path: Path, schema: Any) -> None:
    """ValueError where a histogram has not one count a level, or a column that holds no byte arrays tells their size.

    schema: of the open file (`pyarrow.parquet.ParquetSchema`). Of a footer that cannot be walked through to its end,
    the chunks up to there."""
    try:
        chunks = _Footer(_footer(path)).chunks()
    except (ValueError, OSError):
        return
    for number, (has_bytes, repetition, definition) in chunks:
        if number >= len(schema):
            return  # `check_types` tells
        column = schema.column(number)
        for what, size, level in (
            ("repetition", repetition, column.max_repetition_level),
            ("definition", definition, column.max_definition_level),
        ):
            if size and size != level + 1:  # an empty one is allowed
                raise ValueError(f"column {number} counts {size} {what} levels, its schema has {level + 1}")
        if has_bytes and column.physical_type != "BYTE_ARRAY":
            raise ValueError(f"column {number} tells the size of byte arrays, and is of {column.physical_type}")


def _footer(path: Path) -> bytes:
    with path.open("rb") as file:
        end = file.seek(0, os.SEEK_END)
        file.seek(end - 8)
        tail = file.read(8)
        size = int.from_bytes(tail[:4], "little")
        if tail[4:] != b"PAR1" or size > end - 8:
            raise ValueError("no footer")
        file.seek(end - 8 - size)
        return file.read(size)


class _Footer:
    """A walk through bytes in the compact protocol. IndexError where they end."""

    def __init__(self, data: bytes) -> None:
        self._data, self._at = data, 0

    def chunks(self) -> list[tuple[int, tuple[bool, int, int]]]:
        """(column, (whether it tells the bytes of byte arrays, length of the histogram of repetition levels, of
        definition levels)) of each column chunk that has size statistics."""
        found: list[tuple[int, tuple[bool, int, int]]] = []
        left = [_MOST_CHUNKS]

        def size_statistics(column: int) -> None:
            seen = {_BYTES: 0, _REPETITION: 0, _DEFINITION: 0}

            def field(number: int, kind: int) -> bool:
                if number == _BYTES:
                    seen[_BYTES] = 1
                elif number in seen and kind == _LIST:
                    seen[number] = self._each(lambda item, _: self._skip(item, 0))
                    return True
                return False

            self._struct(field)
            found.append((column, (bool(seen[_BYTES]), seen[_REPETITION], seen[_DEFINITION])))

        def inside(wanted: int, kind: int, read: Callable[[], object]) -> Fields:
            def field(number: int, own: int) -> bool:
                if number != wanted or own != kind:
                    return False
                read()
                return True

            return field

        def chunk(_: int, column: int) -> None:
            left[0] -= 1
            meta = inside(_SIZE_STATISTICS, _STRUCT, lambda: size_statistics(column))
            self._struct(inside(_META_DATA, _STRUCT, lambda: self._struct(meta)))
            if not left[0]:
                raise _EnoughError

        def group(_: int, __: int) -> None:
            self._struct(inside(_COLUMNS, _LIST, lambda: self._each(chunk)))

        # Arrow may take more than this walk can, and looks at the same chunks before
        with suppress(_EnoughError, IndexError, ValueError):
            self._struct(inside(_ROW_GROUPS, _LIST, lambda: self._each(group)))
        return found

    def _struct(self, field: Fields) -> None:
        """Reads a struct: each field by `field`, or past it."""
        number = 0
        while True:
            head = self._byte()
            if not head:
                return
            number = number + (head >> 4) if head >> 4 else self._signed()
            kind = head & 15
            if not field(number, kind):
                self._skip(kind, 0)

    def _each(self, read: Callable[[int, int], None]) -> int:
        """Reads a list: read(type, place) of each item; returns how many there are."""
        head = self._byte()
        size = head >> 4 if head >> 4 < 15 else self._varint()
        if size > len(self._data):
            raise IndexError
        for place in range(size):
            read(head & 15, place)
        return size

    def _skip(self, kind: int, depth: int) -> None:
        if depth > _DEEPEST:
            raise ValueError("too deep")
        if kind in _VARINTS:
            self._varint()
        elif kind == _BINARY:
            self._past(self._varint())
        elif kind == _STRUCT:
            while head := self._byte():
                if not head >> 4:
                    self._signed()
                if head & 15 not in (_TRUE, _FALSE):  # the value stands in the head
                    self._skip(head & 15, depth + 1)
        elif kind in (_LIST, _SET):
            self._each(lambda item, _: self._item(item, depth))
        elif kind == _MAP:
            size = self._varint()
            kinds = self._byte() if size else 0
            for _ in range(size):  # each takes a byte at least, so the bytes end first
                for item in (kinds >> 4, kinds & 15):
                    self._item(item, depth)
        elif kind == _BYTE:
            self._past(1)
        elif kind == _DOUBLE:
            self._past(8)
        elif kind not in (_TRUE, _FALSE):
            raise ValueError(f"no type {kind}")

    def _item(self, kind: int, depth: int) -> None:
        """Past an item of a list or map: there a truth value takes a byte."""
        if kind in (_TRUE, _FALSE):
            self._past(1)
        else:
            self._skip(kind, depth + 1)

    def _past(self, size: int) -> None:
        self._at += size
        if self._at > len(self._data):
            raise IndexError

    def _byte(self) -> int:
        value = self._data[self._at]
        self._at += 1
        return value

    def _varint(self) -> int:
        value = shift = 0
        while True:
            byte = self._byte()
            value |= (byte & 127) << shift
            if byte < 128:
                return value
            shift += 7
            if shift > 63:
                raise ValueError("a number of too many bytes")

    def _signed(self) -> int:
        value = self._varint()
        return (value >> 1) ^ -(value & 1)


class _EnoughError(Exception):
    """So many column chunks were looked at."""
