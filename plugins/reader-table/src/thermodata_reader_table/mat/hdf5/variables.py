"""MAT version 7.3: HDF5 with a MATLAB_class at each object, read in pieces by h5py."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from thermodata.errors import FormatError
from thermodata.plugin import Array, Loss
from thermodata_reader_table.mat.hdf5.check import Spans, check_found, check_size, check_stored
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
    Tree,
    line,
)

_NUMBERS = {"double": "float64", "single": "float32", "logical": "bool"}
_NUMBERS |= {f"{sign}int{bits}": f"{sign}int{bits}" for sign in ("", "u") for bits in (8, 16, 32, 64)}
_MOST, _LONGEST = 100, 500  # attributes of an array, and letters of one
_CACHE = 64 << 20  # a chunk is unpacked once, not once a block


@contextmanager
def damaged(where: str) -> Iterator[None]:
    """h5py raises many unrelated classes for a damaged file; all of them mean the same."""
    try:
        yield
    except (
        OSError,
        RuntimeError,
        ValueError,
        KeyError,
        TypeError,
        AttributeError,
        IndexError,
        OverflowError,
        UnicodeError,
        SystemError,
        NotImplementedError,
        RecursionError,
        ZeroDivisionError,
    ) as error:
        raise FormatError(
            "a damaged HDF5 file",
            where=where,
            got=(str(error).splitlines() or ["?"])[0][:200],
            hint="save it again, or with -v7",
        ) from None


@contextmanager
def opened(path: Path) -> Iterator[Tree]:
    """All variables of an open file; bulk is read on demand, as long as the file is open."""
    import h5py

    with damaged(path.name):
        file = h5py.File(path, "r", rdcc_nbytes=_CACHE, locking=False)
    try:
        yield _Walk(file, path.name).tree()
    finally:
        file.close()


class _Walk:
    """Objects of a file as nodes; each counted, so that references in a circle end."""

    def __init__(self, file: Any, where: str) -> None:
        self.file, self.where, self.nodes = file, where, 0
        self.spans = Spans()
        self.known: dict[Any, Node] = {}

    def tree(self) -> Tree:
        variables: dict[str, Node] = {}
        losses: list[Loss] = []
        with damaged(self.where):
            names = [str(n) for n in self.file if not str(n).startswith("#")]
        for name in names:
            try:
                with damaged(f"{self.where} variable '{name}'"):
                    variables[name] = self.node(_own_member(self.file, name), 0)
            except FormatError as error:
                losses.append(Loss(f"{self.where} variable '{name}'", reason=f"a damaged variable: {error.got}"))
        return Tree(variables, tuple(losses), True if not losses else None)

    def node(self, item: Any, depth: int) -> Node:
        import h5py

        # two references to one object are two names of it
        key = h5py.h5o.get_info(item.id).addr
        if key not in self.known:
            self.known[key] = self._new_node(item, depth)
        return self.known[key]

    def _new_node(self, item: Any, depth: int) -> Node:
        import h5py

        self.nodes += 1
        if isinstance(item, h5py.Dataset) and (item.external or item.is_virtual):
            raise ValueError("its values stand in another file, which is not read: save it with all that it holds")
        if depth > MAX_DEPTH or self.nodes > MAX_NODES:
            raise ValueError("nested too deep" if depth > MAX_DEPTH else f"more than {MAX_NODES} parts")
        kind = _text(item.attrs.get("MATLAB_class"))
        if "MATLAB_object_decode" in item.attrs and kind not in _NUMBERS and kind not in ("char", "cell", "struct"):
            if kind != "function_handle":
                return Odd(kind or "object")
            return Odd("function_handle")
        if "MATLAB_class" in item.attrs and kind not in _NUMBERS and kind not in ("char", "cell", "struct"):
            return Odd(f"class '{kind}'")
        if isinstance(item, h5py.Group):
            return self._struct(item, kind, depth)
        if not isinstance(item, h5py.Dataset):
            return Odd("HDF5 type")
        if "MATLAB_sparse" in item.attrs:
            return Odd("sparse matrix")
        if bool(item.attrs.get("MATLAB_empty", 0)):
            return Text(()) if kind == "char" else Cells(0, 0, ()) if kind == "cell" else _no_numbers()
        if item.dtype == h5py.ref_dtype:
            return self._cells(item, depth)
        if kind == "char":
            return _lines(item)
        return _numbers(item, kind, self.where, self.spans)

    def _struct(self, group: Any, kind: str, depth: int) -> Node:
        if "MATLAB_sparse" in group.attrs:
            return Odd("sparse matrix")
        if kind not in ("struct", ""):
            return Odd(kind)
        names = [str(n) for n in group]
        order = group.attrs.get("MATLAB_fields")
        if order is not None:
            wanted = [b"".join(bytes(c) for c in letters).decode("utf-8", "replace") for letters in order]
            names = [n for n in wanted if n in names] + [n for n in names if n not in wanted]
        fields = {n: _own_member(group, n) for n in names}
        if fields and all(_holds_references(f) and "MATLAB_class" not in f.attrs for f in fields.values()):
            columns = {n: self._cells(f, depth).items for n, f in fields.items()}
            if len({len(c) for c in columns.values()}) != 1:
                raise ValueError("fields of a struct array differ in count")
            return Structs(
                tuple(Struct(dict(zip(columns, row, strict=True))) for row in zip(*columns.values(), strict=True))
            )
        return Struct({n: self.node(f, depth + 1) for n, f in fields.items()})

    def _cells(self, item: Any, depth: int) -> Cells:
        if item.size > MAX_NODES:
            raise ValueError(f"{item.size} parts")
        check_size(item)
        check_found(item)
        shape = item.shape
        references = np.asarray(item[()]).ravel()  # C order of the turned shape is MATLAB's column by column
        rows = int(shape[-1]) if len(shape) else 1
        return Cells(
            rows,
            int(item.size) // rows if rows else 0,
            tuple(self.node(self.file[r], depth + 1) if r else _no_numbers() for r in references),
        )


def _own_member(group: Any, name: str) -> Any:
    """A member of a group. ValueError for a link into another file: what is read must stand in the bytes that the store
    knows by their hash, and in the campaign's folder."""
    import h5py

    if isinstance(group.get(name, getlink=True), h5py.ExternalLink):
        raise ValueError("a link into another file, which is not followed: save it with all that it holds")
    return group[name]


def _holds_references(item: Any) -> bool:
    import h5py

    return isinstance(item, h5py.Dataset) and item.dtype == h5py.ref_dtype


def _text(value: Any) -> str:
    return value.decode("utf-8", "replace") if isinstance(value, bytes) else "" if value is None else str(value)


def _no_numbers() -> Numbers:
    return Numbers(0, 0, "float64", lambda fixed, axis, start, stop: np.zeros(0))


def _lines(item: Any) -> Text:
    if item.size > MAX_TEXT:
        raise ValueError(f"{item.size} characters")
    check_size(item)
    check_found(item)
    codes = np.atleast_2d(np.asarray(item[()]))
    if codes.dtype.kind not in "iu":
        raise ValueError(f"text of type {codes.dtype}")
    table = codes.T if codes.ndim == 2 else codes.reshape(1, -1)
    return Text(tuple(line(row.astype("<u2").tobytes().decode("utf-16-le", "replace")) for row in table))


def _numbers(item: Any, kind: str, where: str, spans: Spans) -> Node:
    if item.dtype.kind not in "biuf":
        return Odd("complex array" if item.dtype.names == ("real", "imag") else f"array of {item.dtype}")
    dtype = _NUMBERS.get(kind, item.dtype.newbyteorder("=").name)
    shape = [int(n) for n in item.shape]
    if len(shape) > 2 and item.size != shape[-1] * shape[-2]:
        return Odd(f"{len(shape)}-dimensional {dtype}")
    if item.is_virtual or item.external:
        raise ValueError("its values stand in another file")
    check_stored(item, kind, spans)
    turned = [1] * (2 - len(shape)) + shape
    return Numbers(turned[-1], turned[-2], dtype, _loader(item, len(shape), dtype, where), _attributes(item))


def _attributes(item: Any) -> dict[str, str]:
    """Texts that another program than MATLAB put beside an array: {'units': 's since 1904-01-01'}."""
    names = [str(key) for key in list(item.attrs)[:_MOST] if not str(key).startswith("MATLAB_")]
    return {name: text[:_LONGEST] for name in names if (text := _attribute(item, name)) is not None}


def _attribute(item: Any, name: str) -> str | None:
    """A text beside an array, in UTF-8 or in Latin-1; None for another thing, and for what h5py has no type for."""
    try:
        value = item.attrs[name]
        if isinstance(value, str):  # letters that are no UTF-8 are kept as surrogates
            value = value.encode("utf-8", "surrogateescape")
    except (OSError, TypeError, ValueError):
        return None
    if not isinstance(value, bytes):
        return None
    try:
        return value.decode("utf-8")
    except UnicodeDecodeError:
        return value.decode("latin-1")


def _loader(item: Any, ndim: int, dtype: str, where: str) -> Callable[[int, int, int, int], Array]:
    front = (0,) * (ndim - 2)

    def load(fixed: int, axis: int, start: int, stop: int) -> Array:
        with damaged(f"{where} {item.name}"):
            if ndim == 0:
                found = np.asarray([item[()]])[start:stop]
            elif ndim == 1:
                found = item[start:stop] if axis == 0 else item[fixed : fixed + 1]
            else:
                found = item[(*front, fixed, slice(start, stop)) if axis == 0 else (*front, slice(start, stop), fixed)]
            got: Array = np.asarray(found).astype(dtype)
        return got

    return load
