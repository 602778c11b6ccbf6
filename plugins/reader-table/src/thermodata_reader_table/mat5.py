"""MAT version 5 (MATLAB's -v6 and -v7): elements with a tag each, a variable packed by zlib where the writer liked.

Read here rather than by scipy.io, which holds whole variables in memory and trusts their counts: lengths are checked
against the bytes that are there before anything is made, and long variables are unpacked to a file. What stands in
plain arrays equals scipy's, which the tests compare on every file that scipy ships.
Format: MathWorks, "MAT-File Format", R2024b, chapter 1.
"""

from __future__ import annotations

import mmap
import struct
import tempfile
import zlib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from thermodata.errors import FormatError
from thermodata.plugin import Array, Loss
from thermodata_reader_table.mat_tree import (
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
    Tree,
    refusal,
)

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
_MATRIX, _PACKED, _UTF8, _UTF16, _UTF32 = 14, 15, 16, 17, 18
_IN_MEMORY = 32 << 20  # longer variables are unpacked to a temporary file
MAX_UNPACKED = 6 << 30


class _DamagedError(Exception):
    """Something in a variable does not add up; says what."""


@dataclass(frozen=True, slots=True)
class _Element:
    kind: int
    start: int
    stop: int
    next: int


def read(path: Path) -> Tree:
    """All variables; bulk stays where it is until it is asked for. FormatError: not a MAT 5 file."""
    with path.open("rb") as file:
        size = path.stat().st_size
        if size < 128:
            raise FormatError("the file ends inside its header", where=path.name, expected="128 bytes", got=str(size))
        data = memoryview(mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ))
    mark = bytes(data[126:128])
    if mark not in (b"IM", b"MI"):
        raise FormatError(
            "not a MAT file of version 5", where=f"{path.name} byte 126", expected="byte order IM or MI", got=repr(mark)
        )
    order = "<" if mark == b"IM" else ">"
    (version,) = struct.unpack(f"{order}H", data[124:126])
    if version != 0x0100:
        raise FormatError(
            "not a MAT file of version 5", where=f"{path.name} byte 124", expected="version 0x0100", got=hex(version)
        )
    variables: dict[str, Node] = {}
    losses: list[Loss] = []
    at, cut, budget = 128, False, [MAX_UNPACKED]
    while at < size:
        where = f"{path.name} byte {at}"
        try:
            element = _element(data, at, size, order, padded=False)
        except _DamagedError as error:
            losses.append(Loss(where, None, None, min(1.0, (size - at) / size), f"{error}: what follows is lost"))
            cut = True
            break
        try:
            found = _variable(data, element, order, budget)
        except _DamagedError as error:
            losses.append(Loss(where, None, None, (element.next - at) / size, f"a damaged variable: {error}"))
            found = None
        at = element.next
        if found is None:
            continue
        name, node = found
        if name in variables:
            losses.append(Loss(where, None, None, None, f"a second variable '{name}': the first is kept"))
            continue
        variables[name] = node
    return Tree(variables, tuple(losses), False if cut else None)


def _variable(data: memoryview, element: _Element, order: str, budget: list[int]) -> tuple[str, Node] | None:
    start, stop = element.start, element.stop
    if element.kind == _PACKED:
        data = _unpacked(data[start:stop], budget)
        inner = _element(data, 0, len(data), order)
        if inner.kind != _MATRIX:
            raise _DamagedError(f"holds an element of type {inner.kind}")
        if inner.next < len(data):
            raise _DamagedError(f"has {len(data) - inner.next} bytes behind its end")
        start, stop = inner.start, inner.stop
    elif element.kind != _MATRIX:
        raise _DamagedError(f"element of type {element.kind} where a variable belongs")
    if start == stop:
        raise _DamagedError("is empty")
    name, node = _Parser(data, order).matrix(start, stop, 0)
    # the nameless last one is MATLAB's own store for objects
    return (name, node) if name else None


def _unpacked(packed: memoryview, budget: list[int]) -> memoryview:
    """A zlib stream, whole and with its checksum right."""
    unpack = zlib.decompressobj()
    kept, spill, total = bytearray(), None, 0
    try:
        for at in range(0, len(packed), 1 << 18):
            raw = bytes(packed[at : at + (1 << 18)])
            while raw:
                part = unpack.decompress(raw, 1 << 20)
                raw = unpack.unconsumed_tail
                total += len(part)
                if total > budget[0]:
                    raise _DamagedError(f"unpacks to more than {MAX_UNPACKED >> 30} GiB")
                kept += part
                if len(kept) > _IN_MEMORY:
                    # lives as long as the arrays that look into it
                    spill = spill or tempfile.TemporaryFile()  # noqa: SIM115 - closed below
                    spill.write(kept)
                    kept = bytearray()
            if unpack.eof:
                break
    except zlib.error as error:
        raise _DamagedError(f"does not unpack ({error})") from None
    if not unpack.eof:
        raise _DamagedError("its packed data end too early")
    budget[0] -= total
    if spill is None:
        return memoryview(bytes(kept))
    with spill:
        spill.write(kept)
        spill.flush()
        return memoryview(mmap.mmap(spill.fileno(), 0, access=mmap.ACCESS_READ))


def _element(data: memoryview, at: int, stop: int, order: str, *, padded: bool = True) -> _Element:
    """The element at a place; raises _DamagedError where it passes `stop`."""
    if at + 8 > stop:
        raise _DamagedError("ends inside an element's tag")
    kind, size = struct.unpack_from(f"{order}II", data, at)
    if kind >> 16:
        size, kind = kind >> 16, kind & 0xFFFF
        if size > 4:
            raise _DamagedError(f"a short element of {size} bytes")
        return _Element(kind, at + 4, at + 4 + size, at + 8)
    end = at + 8 + size
    if end > stop:
        raise _DamagedError(f"an element of {size} bytes where {stop - at - 8} are left")
    after = end if kind == _PACKED or not padded else min(stop, (end + 7) // 8 * 8)
    return _Element(kind, at + 8, end, after)


class _Parser:
    """The elements of one variable."""

    def __init__(self, data: memoryview, order: str) -> None:
        self.data, self.order, self.nodes = data, order, 0

    def elements(self, start: int, stop: int) -> Iterator[_Element]:
        at = start
        while at < stop:
            element = _element(self.data, at, stop, self.order)
            yield element
            at = element.next

    def matrix(self, start: int, stop: int, depth: int) -> tuple[str, Node]:
        self.nodes += 1
        if depth > MAX_DEPTH or self.nodes > MAX_NODES:
            raise _DamagedError("nested too deep" if depth > MAX_DEPTH else f"more than {MAX_NODES} parts")
        if start == stop:
            return "", self._empty()
        parts = self.elements(start, stop)
        flags = self._ints(self._next(parts), (5, 6), 2)
        kind, bits = int(flags[0]) & 0xFF, int(flags[0]) >> 8 & 0xFF
        if kind == 17:
            name, _, label = (self._latin(self._next(parts)) for _ in range(3))
            return name, Odd(label or "object")
        dims = [int(d) for d in self._ints(self._next(parts), (5,), None)]
        if len(dims) < 2 or min(dims) < 0:
            raise _DamagedError(f"dimensions {dims[:4]}")
        name = self._latin(self._next(parts))
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

    def _next(self, parts: Iterator[_Element]) -> _Element:
        found = next(parts, None)
        if found is None:
            raise _DamagedError("ends too early")
        return found

    def _empty(self) -> Numbers:
        return Numbers(0, 0, "float64", lambda f, a, i, j: np.zeros(0))

    def _array(self, element: _Element) -> Array:
        stored = _STORED.get(element.kind)
        if stored is None:
            raise _DamagedError(f"numbers of type {element.kind}")
        kind = np.dtype(self.order + stored)
        if (element.stop - element.start) % kind.itemsize:
            raise _DamagedError(f"{element.stop - element.start} bytes of {stored}")
        found: Array = np.frombuffer(self.data, kind, (element.stop - element.start) // kind.itemsize, element.start)
        return found

    def _ints(self, element: _Element, kinds: tuple[int, ...], count: int | None) -> Array:
        if element.kind not in kinds and element.kind not in (5, 6):
            raise _DamagedError(f"an element of type {element.kind} in a variable's head")
        found = self._array(element)
        if (count is not None and found.size != count) or found.size > 64:
            raise _DamagedError(f"{found.size} numbers in a variable's head")
        return found

    def _latin(self, element: _Element) -> str:
        if element.kind not in (1, 2, _UTF8) or element.stop - element.start > 4096:
            raise _DamagedError(f"a name of type {element.kind}")
        raw = bytes(self.data[element.start : element.stop]).split(b"\0")[0]
        try:
            return raw.decode("utf-8")
        except UnicodeDecodeError:
            return raw.decode("cp1252", "backslashreplace")

    def _numbers(self, parts: Iterator[_Element], dims: list[int], count: int, dtype: str, bits: int) -> Node:
        flat = self._array(self._next(parts))
        if flat.size != count:
            raise _DamagedError(f"{flat.size} numbers for {'x'.join(map(str, dims))}")
        wide = np.dtype(dtype).kind == "f"
        # writers shorten what fits into a smaller type, and never the other way
        if (
            not np.can_cast(flat.dtype, np.dtype(dtype))
            or (not wide and flat.dtype.kind == "f")
            or (wide and flat.dtype.kind in "iu" and flat.dtype.itemsize > 4)
        ):
            raise _DamagedError(f"{dtype} written as {flat.dtype.name}")
        if bits & 0x08:
            return Odd(f"complex {dtype}")
        if len(dims) > 2 and count not in (0, dims[0] * dims[1]):
            return Odd(f"{len(dims)}-dimensional {dtype}")
        if next(parts, None) is not None:
            raise _DamagedError("more data than its dimensions say")
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

    def _text(self, parts: Iterator[_Element], dims: list[int], count: int) -> Text:
        found = next(parts, None)
        if found is None or not count:
            return Text(())
        if count > MAX_TEXT:
            raise _DamagedError(f"{count} characters")
        raw = bytes(self.data[found.start : found.stop])
        endian = "le" if self.order == "<" else "be"
        codec = {
            1: "utf-8",
            2: "utf-8",
            _UTF8: "utf-8",
            4: f"utf-16-{endian}",
            _UTF16: f"utf-16-{endian}",
            _UTF32: f"utf-32-{endian}",
        }.get(found.kind)
        if codec is None:
            raise _DamagedError(f"text of type {found.kind}")
        try:
            letters = raw.decode(codec)
        except UnicodeDecodeError:
            if codec != "utf-8":
                raise _DamagedError(f"text that is no {codec}") from None
            letters = raw.decode("cp1252", "backslashreplace")
        rows = dims[0]
        if rows == 1:
            return Text((letters.rstrip(),))
        if len(letters) != count:
            raise _DamagedError(f"{len(letters)} characters for {'x'.join(map(str, dims))}")
        return Text(tuple(letters[i::rows].rstrip() for i in range(rows)))

    def _items(self, parts: Iterator[_Element], count: int, depth: int) -> tuple[Node, ...]:
        found = []
        if count > MAX_NODES:
            raise _DamagedError(f"{count} parts")
        for _ in range(count):
            element = self._next(parts)
            if element.kind != _MATRIX:
                raise _DamagedError(f"an element of type {element.kind} in a cell or struct")
            found.append(self.matrix(element.start, element.stop, depth + 1)[1])
        if next(parts, None) is not None:
            raise _DamagedError("more parts than its dimensions say")
        return tuple(found)

    def _struct(self, parts: Iterator[_Element], count: int, depth: int, kind: int) -> Node:
        if kind == 3:
            return Odd(self._latin(self._next(parts)) or "object")
        length = int(self._ints(self._next(parts), (5,), 1)[0])
        names_at = self._next(parts)
        raw = bytes(self.data[names_at.start : names_at.stop])
        if length < 1 or len(raw) % length or len(raw) > 1 << 22:
            raise _DamagedError(f"field names of {length} bytes in {len(raw)}")
        names = [
            raw[i : i + length].split(b"\0")[0].decode("utf-8", "backslashreplace") for i in range(0, len(raw), length)
        ]
        items = self._items(parts, count * len(names), depth)
        each = len(names)
        if len(set(names)) < each:
            names = [n if n not in names[:i] else f"{n}#{i + 1}" for i, n in enumerate(names)]
        structs = tuple(Struct(dict(zip(names, items[i * each : (i + 1) * each], strict=True))) for i in range(count))
        return structs[0] if count == 1 else Structs(structs)


def odd_variables(tree: Tree, where: str) -> list[Loss]:
    """A loss for each variable that holds an object."""
    return [
        Loss(f"{where} variable '{name}'", None, None, None, refusal(node.kind))
        for name, node in tree.variables.items()
        if isinstance(node, Odd) and node.kind != "function_handle"
    ]
