"""Columns of a query's answer as arrays."""

from __future__ import annotations

from typing import Any

import numpy as np

from thermodata.plugin import Float1D


def floats(column: Any) -> Float1D:
    """A column as DuckDB gives it to numpy, masked where it holds NULL, shape (n,); NaN there."""
    return np.ma.filled(np.ma.asarray(column).astype(np.float64), np.nan)
