"""Least squares with sources that never fall below zero, a block of them a test, and coefficients that all tests share.

    minimise  sum_i |r_i - A_i q_i - X_i c|^2 + q_i' L_i q_i + c' P c      over q_i >= 0 and c

The normal equations are blocks with a border, so that a step costs one small solve a test however many tests there are.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from thermodata.plugin import Float1D, Float2D

Array = NDArray[np.float64]

STEPS = 60
HALVINGS = 25
TOLERANCE = 1e-7  # of the gradient, against its largest value at zero


@dataclass(frozen=True, slots=True)
class Normal:
    """Products of all tests, padded to one number n of bins: gram A'A (tests, n, n), cross A'X (tests, n, k), aim A'r
    (tests, n), shared X'X + P (k, k), shared_aim X'r (k,). there: (tests, n), False where a test has no such bin."""

    gram: Array
    cross: Array
    aim: Float2D
    shared: Float2D
    shared_aim: Float1D
    there: NDArray[np.bool_]


@dataclass(frozen=True, slots=True)
class Solution:
    """source: shape (tests, n). known: shape (k,)."""

    source: Float2D
    known: Float1D


def solve(normal: Normal, penalty: Array, start: Solution | None = None, *, one_way: bool = True) -> Solution:
    """penalty: L, shape (tests, n, n). one_way: whether sources must not fall below zero.

    A projected Newton method [bertsekas1982]: bins at zero whose gradient keeps them there are left out of the step.
    """
    n = normal.gram.shape[1]
    matrix = normal.gram + penalty
    # a bin that nothing measures needs a value; as little as this says zero and moves no other
    matrix[:, np.arange(n), np.arange(n)] += 1e-10 * max(float(matrix.max(initial=0.0)), 1e-300)
    q = np.zeros_like(normal.aim) if start is None else start.source
    c = np.zeros_like(normal.shared_aim) if start is None else start.known
    largest = max(float(np.abs(normal.aim).max(initial=0.0)), 1e-300)
    height = _objective(normal, matrix, q, c)
    for _ in range(STEPS):
        slope = (matrix @ q[..., None])[..., 0] + normal.cross @ c - normal.aim
        if one_way:
            q = np.where((q <= 1e-8 * q.max(initial=0.0)) & (slope > 0), 0.0, q)
        free = normal.there & ((q > 0) | (slope < -1e-9 * largest)) if one_way else normal.there
        of_known = normal.shared @ c + np.einsum("tnk,tn->k", normal.cross, q) - normal.shared_aim
        steepest = max(float(np.abs(slope[free]).max(initial=0.0)), float(np.abs(of_known).max(initial=0.0)))
        if steepest < TOLERANCE * largest:
            break
        aim_q, aim_c = _newton(normal, matrix, free)
        share = 1.0
        for _ in range(HALVINGS):
            moved = q + share * (aim_q - q)
            q_new, c_new = np.maximum(moved, 0.0) if one_way else moved, c + share * (aim_c - c)
            lower = _objective(normal, matrix, q_new, c_new)
            if lower < height - 1e-14 * abs(height):
                break
            share /= 2
        else:
            break
        q, c, height = q_new, c_new, lower
    return Solution(q, c)


def _newton(normal: Normal, matrix: Array, free: NDArray[np.bool_]) -> tuple[Float2D, Float1D]:
    """The minimum over the free bins and the shared coefficients; all other bins are zero."""
    both = free[:, :, None] & free[:, None, :]
    reduced = np.where(both, matrix, 0.0)
    diagonal = np.arange(matrix.shape[1])
    reduced[:, diagonal, diagonal] = np.where(free, reduced[:, diagonal, diagonal], 1.0)
    right = np.concatenate([normal.aim[..., None], normal.cross], axis=2) * free[..., None]
    solved = np.linalg.solve(reduced, right)
    own, by_known = solved[..., 0], solved[..., 1:]
    border = normal.shared - np.einsum("tnk,tnj->kj", normal.cross, by_known)
    c: Float1D = np.linalg.solve(border, normal.shared_aim - np.einsum("tnk,tn->k", normal.cross, own))
    return own - by_known @ c, c


def _objective(normal: Normal, matrix: Array, q: Float2D, c: Float1D) -> float:
    """Half of what is minimised, less half of sum |r|^2."""
    pull = (matrix @ q[..., None])[..., 0] / 2 + normal.cross @ c - normal.aim
    return float(np.sum(q * pull) + c @ (normal.shared @ c / 2 - normal.shared_aim))
