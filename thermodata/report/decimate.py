"""Fewer points for a page: block means on the same uniform grid."""

from __future__ import annotations

import base64
from typing import Any

import numpy as np

from thermodata.plugin import Float1D

MOST_POINTS = 1200


def block_size(n: int, most: int = MOST_POINTS) -> int:
    """How many samples one drawn point stands for."""
    return max(1, -(-n // most))


def block_mean(values: Float1D, size: int) -> Float1D:
    """Means of blocks of `size` samples, shape (ceil(n / size),); NaN where a block holds no value."""
    if size <= 1:
        return np.asarray(values, dtype=np.float64)
    blocks = -(-len(values) // size)
    padded = np.full(blocks * size, np.nan)
    padded[: len(values)] = values
    table = padded.reshape(blocks, size)
    there = np.isfinite(table)
    count = there.sum(axis=1)
    total = np.where(there, table, 0.0).sum(axis=1)
    return np.asarray(np.divide(total, count, out=np.full(blocks, np.nan), where=count > 0))


def packed(values: Float1D) -> dict[str, Any]:
    """Plotly's typed array: float32 in base64, a third of the digits' size; NaN stays a gap."""
    raw = np.ascontiguousarray(values, dtype="<f4")
    made: dict[str, Any] = {"dtype": "f4", "bdata": base64.b64encode(raw.tobytes()).decode("ascii")}
    if raw.ndim == 2:
        made["shape"] = f"{raw.shape[0]}, {raw.shape[1]}"
    return made
