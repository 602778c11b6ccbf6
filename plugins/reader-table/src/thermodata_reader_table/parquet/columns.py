"""Columns of Arrow as arrays of numpy."""

from __future__ import annotations

from typing import Any

import numpy as np

from thermodata.plugin import Array, Int1D
from thermodata.reader.times.zone import NAT


def numbers(column: Any) -> Array:
    """A column as float64, shape (n,); NaN where a value is missing."""
    import pyarrow as pa

    return np.asarray(column.cast(pa.float64()).to_numpy(), np.float64)


def nanoseconds(column: Any) -> Int1D:
    """Nanoseconds of timestamps or durations; NAT where there is none."""
    import pyarrow as pa

    found: Int1D = column.cast(pa.int64()).fill_null(int(NAT)).to_numpy().astype(np.int64)
    return found


def values_of(column: Any, dtype: str) -> Array:
    """A column in the dtype that its signal has, shape (n,)."""
    if dtype == "float64":
        return numbers(column)
    if dtype == "str":
        return np.array(["" if v is None else str(v) for v in column.to_pylist()], object)
    return np.asarray(column.to_numpy(zero_copy_only=False)).astype(dtype)
