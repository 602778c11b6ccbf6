"""Gains from Gram matrices: linear least squares, bounded where a sign or a value is given."""

from __future__ import annotations

import numpy as np

from thermodata.plugin import Float1D, Float2D

RIDGE = 1e-10  # relative; keeps equal columns from giving gains of 1e9 and their opposites


def solve_gains(gram: Float2D, cross: Float1D, lower: Float1D, upper: Float1D) -> Float1D:
    """Minimises g'Gg - 2c'g within [lower, upper]; lower == upper holds a gain. Shapes (m, m), (m,), (m,)."""
    gains = np.where(lower == upper, lower, 0.0)
    free = (lower != upper) & (np.diag(gram) > 0)
    if not free.any():
        return gains
    scale = 1.0 / np.sqrt(np.diag(gram)[free])
    inner = gram[np.ix_(free, free)] * np.outer(scale, scale)
    inner[np.diag_indices_from(inner)] += RIDGE
    right = (cross[free] - gram[np.ix_(free, ~free)] @ gains[~free]) * scale
    solved = np.linalg.solve(inner, right) * scale
    low, high = lower[free], upper[free]
    if np.any(solved < low) or np.any(solved > high):
        from scipy.optimize import lsq_linear

        root = np.linalg.cholesky(inner + RIDGE * np.eye(len(inner))).T
        target = np.linalg.solve(root.T, right)
        solution = lsq_linear(root, target, bounds=(low / scale, high / scale), method="bvls")
        solved = np.clip(solution.x * scale, low, high)
    gains[free] = solved
    return gains


def squared_error(total: float, gram: Float2D, cross: Float1D, gains: Float1D) -> float:
    """||y - X g||^2 from y'y, X'X and X'y."""
    return max(0.0, float(total - 2.0 * cross @ gains + gains @ gram @ gains))
