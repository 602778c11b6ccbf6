"""Columns of a parsed text as arrays: numbers, text that shares its strings, and what is missing."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from thermodata.plugin import Array, Int1D
from thermodata.schema.flag import Flag

if TYPE_CHECKING:
    import pyarrow as pa

MISSING = np.uint16(Flag.NOT_MEASURING)  # no NaN in integers and booleans: 0, and not valid


def relative_ns(values: Array, unit_ns: int) -> Int1D:
    """Numbers of a unit as nanoseconds, without the noise of a float product where the whole part is large."""
    whole = np.floor(values)
    return whole.astype(np.int64) * unit_ns + np.round((values - whole) * unit_ns).astype(np.int64)


def to_numpy(column: pa.ChunkedArray, dtype: str) -> tuple[Array, Array | None]:
    """A column's values, and the flags of cells that are missing where the dtype has no NaN."""
    if dtype == "str":
        return _text(column), None
    if dtype == "float64" or not column.null_count:
        return column.to_numpy().astype(dtype, copy=False), None
    flags = column.is_null().to_numpy().astype(np.uint16) * MISSING
    return column.fill_null(False if dtype == "bool" else 0).to_numpy().astype(dtype, copy=False), flags


def _text(column: pa.ChunkedArray) -> Array:
    """Text as objects that share their strings; blank cells are None."""
    parts = []
    for chunk in column.chunks:
        words = np.array([*(w.strip().strip('"').strip() or None for w in chunk.dictionary.to_pylist()), None], object)
        parts.append(words[chunk.indices.fill_null(len(words) - 1).to_numpy(zero_copy_only=False)])
    return np.concatenate(parts) if parts else np.empty(0, object)
