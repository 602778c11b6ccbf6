"""The footer of a Parquet file, held against what the format says of it before Arrow looks at it.

Arrow compares the lengths of the histograms in size statistics with the levels of the column where it may not raise,
and ends the process where they differ. So this walks through the footer (Thrift's compact protocol;
apache/parquet-format, parquet.thrift) and knows no more of it than where lists stand and what they hold: Arrow reads
the items of those by what the format says, whatever type the list itself tells of them, and a walk that went by the
latter would be lost in a damaged one.
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
# a footer of so many column chunks takes a second
_MOST_CHUNKS = 20_000

Place = tuple[int, ...]  # numbers of fields in parquet.thrift, from the footer's own inwards; items stand at their list

_COLUMNS: Place = (4, 1)
_META_DATA: Place = (*_COLUMNS, 3)
_SIZES: Place = (*_META_DATA, 16)
_BYTES, _REPETITION, _DEFINITION = (*_SIZES, 1), (*_SIZES, 2), (*_SIZES, 3)
_STRUCTS, _WORDS = frozenset((_STRUCT,)), frozenset((_BINARY,))
_ITEMS: dict[Place, frozenset[int]] = {
    (2,): _STRUCTS,  # schema
    (4,): _STRUCTS,  # row groups
    (5,): _STRUCTS,  # keys and values
    (7,): _STRUCTS,  # orders of columns
    (4, 4): _STRUCTS,  # sorting columns
    _COLUMNS: _STRUCTS,
    (*_COLUMNS, 8, 2, 1): _WORDS,  # path of an encrypted column
    (*_META_DATA, 2): _VARINTS,  # encodings
    (*_META_DATA, 3): _WORDS,  # path in the schema
    (*_META_DATA, 8): _STRUCTS,  # keys and values
    (*_META_DATA, 13): _STRUCTS,  # statistics of encodings
    (*_META_DATA, 17, 2): _VARINTS,  # kinds of geometry
    _REPETITION: _VARINTS,
    _DEFINITION: _VARINTS,
}


def check_footer(path: Path, schema: Any) -> None:
    """ValueError where the footer is not what the format says, a histogram has not one count a level, or a column that
    holds no byte arrays tells their size.

    schema: of the open file (`pyarrow.parquet.ParquetSchema`). Beyond 20,000 column chunks nothing is looked at."""
    walk = _Walk(_footer(path))
    try:
        with suppress(_EnoughError):
            walk.fields((), 0)
    except IndexError:
        raise ValueError("its footer ends within a field") from None
    _check_sizes(walk.sizes, schema)


def _check_sizes(sizes: list[tuple[int, dict[Place, int]]], schema: Any) -> None:
    for number, told in sizes:
        if number >= len(schema):
            return  # `check_types` tells
        column = schema.column(number)
        for what, place, level in (
            ("repetition", _REPETITION, column.max_repetition_level),
            ("definition", _DEFINITION, column.max_definition_level),
        ):
            size = told.get(place)
            if size and size != level + 1:  # an empty one is allowed
                raise ValueError(f"column {number} counts {size} {what} levels, its schema has {level + 1}")
        if _BYTES in told and column.physical_type != "BYTE_ARRAY":
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


class _Walk:
    """A walk through bytes in the compact protocol. IndexError where they end.

    sizes: of each column chunk that has size statistics, its column, and what they tell: at the place of a histogram
    its length."""

    def __init__(self, data: bytes) -> None:
        self._data, self._at = data, 0
        self._column, self._left = 0, _MOST_CHUNKS
        self.sizes: list[tuple[int, dict[Place, int]]] = []

    def fields(self, place: Place, depth: int) -> None:
        """Past a struct."""
        if place == _SIZES:
            self.sizes.append((self._column, {}))
        number = 0
        while head := self._byte():
            number = number + (head >> 4) if head >> 4 else self._signed_varint()
            if head & 15 not in (_TRUE, _FALSE):  # the value stands in the head
                self._value(head & 15, (*place, number), depth)

    def _value(self, kind: int, place: Place, depth: int) -> None:
        if depth > _DEEPEST:
            raise ValueError("its footer is nested too deep")
        if kind not in _PAST:
            raise ValueError(f"its footer has a field of type {kind}, which there is not")
        _PAST[kind](self, place, depth)

    def _number(self, place: Place, _depth: int) -> None:
        self._varint()
        if place == _BYTES:
            self._note_size(place, 1)

    def _words(self, _place: Place, _depth: int) -> None:
        self._past(self._varint())

    def _struct(self, place: Place, depth: int) -> None:
        self.fields(place, depth + 1)

    def _map(self, place: Place, depth: int) -> None:
        size = self._varint()
        kinds = self._byte() if size else 0
        for _ in range(size):  # each takes a byte at least, so the bytes end first
            for item in (kinds >> 4, kinds & 15):
                self._value(item, place, depth + 1)

    def _one_byte(self, _place: Place, _depth: int) -> None:
        self._past(1)

    def _eight_bytes(self, _place: Place, _depth: int) -> None:
        self._past(8)

    def _list(self, place: Place, depth: int) -> None:
        head = self._byte()
        size = head >> 4 if head >> 4 < 15 else self._varint()
        if size > len(self._data):
            raise IndexError
        expected = _ITEMS.get(place)
        if size and expected is not None and head & 15 not in expected:
            where = ".".join(map(str, place))
            raise ValueError(f"the list in field {where} of its footer has items of type {head & 15}")
        if place in (_REPETITION, _DEFINITION):
            self._note_size(place, size)
        for item in range(size):
            if place == _COLUMNS:
                self._column = item
            self._value(head & 15, place, depth + 1)
            if place == _COLUMNS:
                self._left -= 1
                if not self._left:
                    raise _EnoughError

    def _note_size(self, place: Place, size: int) -> None:
        if self.sizes:
            self.sizes[-1][1][place] = size

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
                raise ValueError("its footer has a number of too many bytes")

    def _signed_varint(self) -> int:
        value = self._varint()
        return (value >> 1) ^ -(value & 1)


# how to go past a value of each type of the protocol
_PAST: dict[int, Callable[[_Walk, Place, int], None]] = {
    **dict.fromkeys((_TRUE, _FALSE, _BYTE), _Walk._one_byte),
    **dict.fromkeys(_VARINTS, _Walk._number),
    _DOUBLE: _Walk._eight_bytes,
    _BINARY: _Walk._words,
    **dict.fromkeys((_LIST, _SET), _Walk._list),
    _MAP: _Walk._map,
    _STRUCT: _Walk._struct,
}


class _EnoughError(Exception):
    """So many column chunks were looked at."""
