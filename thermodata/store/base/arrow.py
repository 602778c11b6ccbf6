"""Between numpy and Arrow without copies, and without the second that pyarrow's own way takes to import pandas."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from thermodata.plugin import Array

if TYPE_CHECKING:
    import pyarrow as pa


def use_one_heap() -> None:
    """Lets Arrow take its memory where numpy takes it: what one gives back the other uses, and less stays resident."""
    import pyarrow as pa

    pool = pa.system_memory_pool()
    if pa.default_memory_pool().backend_name != pool.backend_name:
        pa.set_memory_pool(pool)


def to_arrow(values: Array, *, nan_is_null: bool = False) -> pa.Array:
    """A numeric, bool or text (object) column. nan_is_null: for SQL, whose means and counts leave NULL out."""
    import pyarrow as pa

    if values.dtype.kind in "OSU":
        return _text([None if v is None else str(v).encode() for v in values.tolist()])
    plain = np.ascontiguousarray(values, dtype=values.dtype.newbyteorder("="))
    if plain.dtype.kind == "b":
        return pa.Array.from_buffers(pa.bool_(), len(plain), [None, _bits(plain)])
    kind = pa.timestamp("ns") if plain.dtype.kind == "M" else pa.from_numpy_dtype(plain.dtype)
    valid = None
    if nan_is_null and plain.dtype.kind == "f":
        missing = np.isnan(plain)
        if missing.any():
            valid = _bits(~missing)
    return pa.Array.from_buffers(kind, len(plain), [valid, pa.py_buffer(plain.view(np.uint8))])


def _text(words: list[bytes | None]) -> pa.Array:
    import pyarrow as pa

    ends = np.cumsum([0, *(0 if w is None else len(w) for w in words)], dtype=np.int64)
    if ends[-1] >= 2**31:
        raise ValueError("a column of text over 2 GB in one block")
    valid = None if None not in words else _bits(np.array([w is not None for w in words]))
    data = pa.py_buffer(b"".join(w for w in words if w is not None))
    return pa.Array.from_buffers(pa.string(), len(words), [valid, pa.py_buffer(ends.astype(np.int32)), data])


def _bits(mask: Array) -> pa.Buffer:
    import pyarrow as pa

    return pa.py_buffer(np.packbits(mask, bitorder="little"))


def to_numpy(column: pa.ChunkedArray) -> Array:
    """The reverse: numbers in their own dtype (float64 with NaN where there are NULLs), text as object."""
    import pyarrow as pa

    if pa.types.is_string(column.type) or pa.types.is_large_string(column.type):
        text = np.empty(len(column), dtype=object)
        text[:] = column.to_pylist()
        return text
    if pa.types.is_boolean(column.type):
        return np.array(column.to_pylist(), dtype=object if column.null_count else bool)
    parts = [_chunk(c) for c in column.chunks]
    if not parts:
        return np.empty(0, dtype=_dtype(column.type))
    return parts[0] if len(parts) == 1 else np.concatenate(parts)


def _chunk(chunk: pa.Array) -> Array:
    n, start = len(chunk), chunk.offset
    values = np.frombuffer(
        chunk.buffers()[1], dtype=_dtype(chunk.type), count=n, offset=start * chunk.type.bit_width // 8
    )
    if chunk.null_count == 0:
        return values
    bits = np.unpackbits(np.frombuffer(chunk.buffers()[0], dtype=np.uint8), bitorder="little", count=start + n)
    numbers: Array = np.where(bits[start:].astype(bool), values.astype(np.float64), np.nan)
    return numbers


def _dtype(kind: pa.DataType) -> np.dtype[np.generic]:
    import pyarrow as pa

    if pa.types.is_timestamp(kind):
        return np.dtype("int64")
    return np.dtype({"halffloat": "float16", "float": "float32", "double": "float64"}.get(str(kind), str(kind)))
