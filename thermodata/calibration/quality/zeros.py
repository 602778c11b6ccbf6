"""Rows in which a program writes 0 for all that it did not measure."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from thermodata.plugin import Array, Bool1D

_LEAP_K = 5.0  # by which a temperature comes to 0 or leaves it in one row; none at the freezing point does so
_FEWEST = 2  # channels of a row


def rows_of_zeros(numbers: Mapping[str, Array], temperatures: Mapping[str, Array], n: int) -> Bool1D:
    """Where all channels of numbers are exactly 0 at once, in stretches at an end of which a temperature leaps, shape
    (n,). temperatures: those of the numbers that are ones, in degC."""
    found: Bool1D = np.zeros(n, dtype=bool)
    if not temperatures or len(numbers) < _FEWEST:
        return found
    zero = np.all([values == 0 for values in numbers.values()], axis=0)
    if not zero.any():
        return found
    edges = np.flatnonzero(np.diff(np.concatenate([[False], zero, [False]])))
    for start, stop in edges.reshape(-1, 2).tolist():
        beside = [k for k in (start - 1, stop) if 0 <= k < n]
        if any(abs(float(t[k])) >= _LEAP_K for t in temperatures.values() for k in beside):
            found[start:stop] = True
    return found
