"""Values that somebody sets, as against those that a sensor reads."""

from __future__ import annotations

import numpy as np

from thermodata.plugin import Float1D

_ROUND = 25  # of the largest value, set ones are multiples of no less than such a part


def are_set(x: Float1D) -> bool:
    """Whether values >= 0 are multiples of one that is no small part of the largest: 0, 2000, 4500; not 5.23, 5.31.
    x: shape (n,), n > 0."""
    largest = float(x.max())
    parts = x[:, None] / largest * np.arange(1, _ROUND + 1) if largest > 0 else np.zeros((1, 1))
    return bool((np.abs(parts - np.rint(parts)) < 1e-6).all(axis=0).any())
