"""What moves beside the air of a hall: what its sensors say, and any constant, are taken out."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from thermodata.plugin import Float2D

ALIKE = 1e-3  # of the largest: directions of the air that differ by less are one


def beside_air(columns: Sequence[Float2D], air: Float2D) -> list[Float2D]:
    """Each of shape (m, ...) as before. air: shape (m, sensors)."""
    if not len(air):
        return list(columns)
    known = np.column_stack([np.ones(len(air)), air - air.mean(axis=0)])
    size = np.linalg.norm(known, axis=0)
    directions, singular, _ = np.linalg.svd(known[:, size > 0] / size[size > 0], full_matrices=False)
    q = directions[:, singular > ALIKE * singular[0]]
    return [np.asarray(c - q @ (q.T @ c)) for c in columns]
