"""Gains from Gram matrices: linear least squares, bounded where a sign or a value is given."""

from __future__ import annotations

import numpy as np

from thermodata.plugin import Float1D, Float2D

RIDGE = 1e-10  # relative; keeps equal columns from giving gains of 1e9 and their opposites


def solve_gains(gram: Float2D, cross: Float1D, lower: Float1D, upper: Float1D) -> Float1D:
    """Minimises g'Gg - 2c'g within [lower, upper]; lower == upper holds a gain. Shapes (m, m), (m,), (m,)."""
    gains = np.where(lower == upper, lower, 0.0)
    free = (lower != upper) & (gram.diagonal() > 0)
    if not free.any():
        return gains
    if free.all():  # nearly always, and asked some thousand times a fit
        own, right, low, high = gram, cross, lower, upper
    else:
        own, right = gram[np.ix_(free, free)], cross[free] - gram[np.ix_(free, ~free)] @ gains[~free]
        low, high = lower[free], upper[free]
    scale = 1.0 / np.sqrt(own.diagonal())
    inner = own * (scale[:, None] * scale)
    inner.flat[:: len(inner) + 1] += RIDGE
    right = right * scale
    solved = np.linalg.solve(inner, right) * scale
    if (solved < low).any() or (solved > high).any():
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
