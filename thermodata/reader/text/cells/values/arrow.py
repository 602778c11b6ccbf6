"""Arrow's columns as numpy arrays, straight from their buffers, and texts as such a column: Arrow's own ways import
pandas first, which takes longer than most files."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from thermodata.plugin import Array, Bool1D, Int1D


def _chunks(column: Any) -> list[Any]:
    return column.chunks if hasattr(column, "chunks") else [column]


def _bits(buffer: Any, chunk: Any) -> Bool1D:
    n, start = len(chunk), chunk.offset
    return np.unpackbits(np.frombuffer(buffer, np.uint8), bitorder="little", count=start + n)[start:].astype(bool)


def is_null(column: Any) -> Bool1D:
    """Which cells are null, shape (n,)."""
    parts = [
        ~_bits(chunk.buffers()[0], chunk) if chunk.null_count else np.zeros(len(chunk), bool)
        for chunk in _chunks(column)
    ]
    return np.concatenate(parts) if parts else np.zeros(0, bool)


def values(column: Any, dtype: str) -> Array:
    """Numbers or truth values, shape (n,), of Arrow's type of the same name; what is null holds anything."""
    out = np.zeros(len(column), dtype)
    at = 0
    for chunk in _chunks(column):
        n = len(chunk)
        buffer = chunk.buffers()[1]
        if n and buffer is not None:
            item = np.dtype(dtype).itemsize
            out[at : at + n] = (
                _bits(buffer, chunk) if dtype == "bool" else np.frombuffer(buffer, dtype, n, chunk.offset * item)
            )
        at += n
    return out


def codes(dictionary_array: Any) -> Int1D:
    """The index of each cell's word in its dictionary, shape (n,); the number of words where it is null."""
    indices = dictionary_array.indices
    found = values(indices, "int32").astype(np.int64)
    found[is_null(indices)] = len(dictionary_array.dictionary)
    return found


def text_array(cells: Sequence[str]) -> Any:
    """Cells as an Arrow array of strings. `pa.array` would do, but imports pandas where that is installed, as do
    `fill_null` and `to_numpy`: a second, and 50 MiB."""
    import pyarrow as pa

    joined = "".join(cells)
    lengths = map(len, cells) if joined.isascii() else (len(cell.encode("utf-8", "replace")) for cell in cells)
    ends = np.cumsum(np.fromiter(lengths, np.int64, len(cells)))
    offsets = np.concatenate(([0], ends)).astype(np.int32)
    data = joined.encode("utf-8", "replace")
    return pa.Array.from_buffers(pa.string(), len(cells), [None, pa.py_buffer(offsets), pa.py_buffer(data)])
