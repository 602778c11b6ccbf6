"""One variable of a MAT 5 file: numbers, text, cells and structs out of its elements."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from thermodata.plugin import Array
from thermodata_reader_table.mat.tree import (
    MAX_DEPTH,
    MAX_NODES,
    MAX_TEXT,
    Cells,
    Node,
    Numbers,
    Odd,
    Struct,
    Structs,
    Text,
    line,
)
from thermodata_reader_table.mat.version5.elements import MATRIX, UTF8, UTF16, UTF32, DamagedError, Element, element_at

_STORED = {1: "i1", 2: "u1", 3: "i2", 4: "u2", 5: "i4", 6: "u4", 7: "f4", 9: "f8", 12: "i8", 13: "u8"}
_CLASS = {
    6: "float64",
    7: "float32",
    8: "int8",
    9: "uint8",
    10: "int16",
    11: "uint16",
    12: "int32",
    13: "uint32",
    14: "int64",
    15: "uint64",
}


class MatrixParser:
    """The elements of one variable."""

    def __init__(self, data: memoryview, order: str) -> None:
        self.data, self.order, self.nodes = data, order, 0

    def elements(self, start: int, stop: int) -> Iterator[Element]:
        """The elements one after the other, up to `stop`. DamagedError."""
        at = start
        while at < stop:
            element = element_at(self.data, at, stop, self.order)
            yield element
            at = element.next

    def matrix(self, start: int, stop: int, depth: int) -> tuple[str, Node]:
        """A variable's name and content; depth: of cells and structs around it. DamagedError."""
        self.nodes += 1
        if depth > MAX_DEPTH or self.nodes > MAX_NODES:
            raise DamagedError("nested too deep" if depth > MAX_DEPTH else f"more than {MAX_NODES} parts")
        if start == stop:
            return "", self._empty()
        parts = self.elements(start, stop)
        flags = self._ints(self._next_element(parts), (5, 6), 2)
        kind, bits = int(flags[0]) & 0xFF, int(flags[0]) >> 8 & 0xFF
        if kind == 17:
            name, _, label = (self._latin(self._next_element(parts)) for _ in range(3))
            return name, Odd(label or "object")
        dims = [int(d) for d in self._ints(self._next_element(parts), (5,), None)]
        if len(dims) < 2 or min(dims) < 0:
            raise DamagedError(f"dimensions {dims[:4]}")
        name = self._latin(self._next_element(parts))
        count = int(np.prod(dims, dtype=object))
        if kind in _CLASS:
            return name, self._numbers(parts, dims, count, _CLASS[kind], bits)
        if kind == 4:
            return name, self._text(parts, dims, count)
        if kind == 1:
            return name, Cells(dims[0], count // dims[0] if dims[0] else 0, self._items(parts, count, depth))
        if kind in (2, 3):
            return name, self._struct(parts, count, depth, kind)
        return name, Odd({5: "sparse matrix", 16: "function_handle"}.get(kind, f"object of class {kind}"))

    def _next_element(self, parts: Iterator[Element]) -> Element:
        found = next(parts, None)
        if found is None:
            raise DamagedError("ends too early")
        return found

    def _empty(self) -> Numbers:
        return Numbers(0, 0, "float64", lambda f, a, i, j: np.zeros(0))

    def _array(self, element: Element) -> Array:
        stored = _STORED.get(element.kind)
        if stored is None:
            raise DamagedError(f"numbers of type {element.kind}")
        kind = np.dtype(self.order + stored)
        if (element.stop - element.start) % kind.itemsize:
            raise DamagedError(f"{element.stop - element.start} bytes of {stored}")
        found: Array = np.frombuffer(self.data, kind, (element.stop - element.start) // kind.itemsize, element.start)
        return found

    def _ints(self, element: Element, kinds: tuple[int, ...], count: int | None) -> Array:
        if element.kind not in kinds and element.kind not in (5, 6):
            raise DamagedError(f"an element of type {element.kind} in a variable's head")
        found = self._array(element)
        if (count is not None and found.size != count) or found.size > 64:
            raise DamagedError(f"{found.size} numbers in a variable's head")
        return found

    def _latin(self, element: Element) -> str:
        if element.kind not in (1, 2, UTF8) or element.stop - element.start > 4096:
            raise DamagedError(f"a name of type {element.kind}")
        raw = bytes(self.data[element.start : element.stop]).split(b"\0")[0]
        try:
            return raw.decode("utf-8")
        except UnicodeDecodeError:
            return raw.decode("cp1252", "backslashreplace")

    def _numbers(self, parts: Iterator[Element], dims: list[int], count: int, dtype: str, bits: int) -> Node:
        flat = self._array(self._next_element(parts))
        if flat.size != count:
            raise DamagedError(f"{flat.size} numbers for {'x'.join(map(str, dims))}")
        wide = np.dtype(dtype).kind == "f"
        # writers shorten what fits into a smaller type, and never the other way
        if (
            not np.can_cast(flat.dtype, np.dtype(dtype))
            or (not wide and flat.dtype.kind == "f")
            or (wide and flat.dtype.kind in "iu" and flat.dtype.itemsize > 4)
        ):
            raise DamagedError(f"{dtype} written as {flat.dtype.name}")
        if bits & 0x08:
            return Odd(f"complex {dtype}")
        if len(dims) > 2 and count not in (0, dims[0] * dims[1]):
            return Odd(f"{len(dims)}-dimensional {dtype}")
        if next(parts, None) is not None:
            raise DamagedError("more data than its dimensions say")
        # logical arrays are bytes of 0 and 1; on anything else the mark is damage, or of no weight
        kind = "bool" if bits & 0x02 and dtype == "uint8" and bool((flat <= 1).all()) else dtype
        table = flat.reshape((dims[0], dims[1]) if count else (0, 0), order="F")
        return Numbers(
            table.shape[0],
            table.shape[1],
            kind,
            lambda fixed, axis, start, stop: np.ascontiguousarray(
                table[start:stop, fixed] if axis == 0 else table[fixed, start:stop]
            ).astype(kind),
        )

    def _text(self, parts: Iterator[Element], dims: list[int], count: int) -> Text:
        found = next(parts, None)
        if found is None or not count:
            return Text(())
        if count > MAX_TEXT:
            raise DamagedError(f"{count} characters")
        raw = bytes(self.data[found.start : found.stop])
        endian = "le" if self.order == "<" else "be"
        codec = {
            1: "utf-8",
            2: "utf-8",
            UTF8: "utf-8",
            4: f"utf-16-{endian}",
            UTF16: f"utf-16-{endian}",
            UTF32: f"utf-32-{endian}",
        }.get(found.kind)
        if codec is None:
            raise DamagedError(f"text of type {found.kind}")
        try:
            letters = raw.decode(codec)
        except UnicodeDecodeError:
            if codec != "utf-8":
                raise DamagedError(f"text that is no {codec}") from None
            letters = raw.decode("cp1252", "backslashreplace")
        rows = dims[0]
        if rows == 1:
            return Text((line(letters),))
        if len(letters) != count:
            raise DamagedError(f"{len(letters)} characters for {'x'.join(map(str, dims))}")
        return Text(tuple(line(letters[i::rows]) for i in range(rows)))

    def _items(self, parts: Iterator[Element], count: int, depth: int) -> tuple[Node, ...]:
        found = []
        if count > MAX_NODES:
            raise DamagedError(f"{count} parts")
        for _ in range(count):
            element = self._next_element(parts)
            if element.kind != MATRIX:
                raise DamagedError(f"an element of type {element.kind} in a cell or struct")
            found.append(self.matrix(element.start, element.stop, depth + 1)[1])
        if next(parts, None) is not None:
            raise DamagedError("more parts than its dimensions say")
        return tuple(found)

    def _struct(self, parts: Iterator[Element], count: int, depth: int, kind: int) -> Node:
        if kind == 3:
            return Odd(self._latin(self._next_element(parts)) or "object")
        length = int(self._ints(self._next_element(parts), (5,), 1)[0])
        names_at = self._next_element(parts)
        raw = bytes(self.data[names_at.start : names_at.stop])
        if length < 1 or len(raw) % length or len(raw) > 1 << 22:
            raise DamagedError(f"field names of {length} bytes in {len(raw)}")
        names = [
            raw[i : i + length].split(b"\0")[0].decode("utf-8", "backslashreplace") for i in range(0, len(raw), length)
        ]
        items = self._items(parts, count * len(names), depth)
        each = len(names)
        if len(set(names)) < each:
            names = [n if n not in names[:i] else f"{n}#{i + 1}" for i, n in enumerate(names)]
        structs = tuple(Struct(dict(zip(names, items[i * each : (i + 1) * each], strict=True))) for i in range(count))
        return structs[0] if count == 1 else Structs(structs)
