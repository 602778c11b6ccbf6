"""MAT version 5 (MATLAB's -v6 and -v7): elements with a tag each, a variable packed by zlib where the writer liked.

Read here rather than by scipy.io, which holds whole variables in memory and trusts their counts: lengths are checked
against the bytes that are there before anything is made, and long variables are unpacked to a file. What stands in
plain arrays equals scipy's, which the tests compare on every file that scipy ships.
Format: MathWorks, "MAT-File Format", R2024b, chapter 1.
"""

from __future__ import annotations

import mmap
import struct
from pathlib import Path

from thermodata.errors import FormatError
from thermodata.plugin import Loss
from thermodata_reader_table.mat.tree import Node, Tree
from thermodata_reader_table.mat.version5.elements import (
    MATRIX,
    MAX_UNPACKED,
    PACKED,
    DamagedError,
    Element,
    element_at,
    unpacked,
)
from thermodata_reader_table.mat.version5.matrices import MatrixParser

_HEADER = 128  # bytes
_VERSION = 0x0100


def read(path: Path) -> Tree:
    """All variables; bulk stays where it is until it is asked for. FormatError: not a MAT 5 file."""
    data = _mapped(path)
    order = _byte_order(data, path.name)
    variables: dict[str, Node] = {}
    losses: list[Loss] = []
    at, size, budget = _HEADER, len(data), [MAX_UNPACKED]
    while at < size:
        where = f"{path.name} byte {at}"
        try:
            element = element_at(data, at, size, order, padded=False)
        except DamagedError as error:
            losses.append(Loss(where, None, None, min(1.0, (size - at) / size), f"{error}: what follows is lost"))
            return Tree(variables, tuple(losses), False)
        begin, at = at, element.next
        try:
            found = _variable(data, element, order, budget)
        except DamagedError as error:
            lost = (at - begin) / size
            losses.append(Loss(where, None, None, lost, f"a damaged variable: {error}"))
            continue
        if found is None:
            continue
        name, node = found
        if name in variables:
            losses.append(Loss(where, reason=f"a second variable '{name}': the first is kept"))
        else:
            variables[name] = node
    return Tree(variables, tuple(losses), None)


def _mapped(path: Path) -> memoryview:
    with path.open("rb") as file:
        size = path.stat().st_size
        if size < _HEADER:
            raise FormatError(
                "the file ends inside its header",
                where=path.name,
                expected=f"{_HEADER} bytes",
                got=str(size),
                hint="copy it anew from where it was saved",
            )
        return memoryview(mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ))


def _byte_order(data: memoryview, name: str) -> str:
    """'<' or '>', by the end of the header. FormatError where it is of another version. name: of the file."""
    order = {b"IM": "<", b"MI": ">"}.get(bytes(data[126:128]))
    if order is None:
        raise _of_another_version(f"{name} byte 126", "byte order IM or MI", repr(bytes(data[126:128])))
    (version,) = struct.unpack(f"{order}H", data[124:126])
    if version != _VERSION:
        raise _of_another_version(f"{name} byte 124", f"version {_VERSION:#06x}", hex(version))
    return order


def _of_another_version(where: str, expected: str, got: str) -> FormatError:
    hint = 'save it anew in MATLAB: save(name, "-v7.3")'
    return FormatError("not a MAT file of version 5", where=where, expected=expected, got=got, hint=hint)


def _variable(data: memoryview, element: Element, order: str, budget: list[int]) -> tuple[str, Node] | None:
    start, stop = element.start, element.stop
    if element.kind == PACKED:
        data = unpacked(data[start:stop], budget)
        inner = element_at(data, 0, len(data), order)
        if inner.kind != MATRIX:
            raise DamagedError(f"holds an element of type {inner.kind}")
        if inner.next < len(data):
            raise DamagedError(f"has {len(data) - inner.next} bytes behind its end")
        start, stop = inner.start, inner.stop
    elif element.kind != MATRIX:
        raise DamagedError(f"element of type {element.kind} where a variable belongs")
    if start == stop:
        raise DamagedError("is empty")
    name, node = MatrixParser(data, order).matrix(start, stop, 0)
    # the nameless last one is MATLAB's own store for objects
    return (name, node) if name else None
