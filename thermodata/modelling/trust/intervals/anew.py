"""All others fitted anew where one parameter is held beside its optimum, from slopes that are known there.

Each value of a profile is a small fit, and a search that asks for its slopes at every step spends most of its time on
them. Beside the optimum they are nearly those of the optimum: a Gauss-Newton step with these, and after each step the
slopes corrected by what the step has shown [broyden1965].
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from thermodata.modelling.least_squares.search import Problem
from thermodata.plugin import Array, Float1D, Float2D

STEPS = 8  # after which a search does better
LEAST = 0.5  # of the fall that slopes foretell, where they hold
STEP = 1e-5  # of a parameter's range, for its slope
ONE = 1e-12  # of the most power of a direction: below, columns are one


@dataclass(frozen=True)
class Refit:
    """x: where the others end, shape (k,); residual: there, shape (n,)."""

    x: Float1D
    residual: Float1D


def fit_anew(problem: Problem, x: Float1D, slopes: Float2D, enough: float) -> Refit | None:
    """From a point near the optimum of a problem, within its bounds; None where STEPS do not lead there. slopes: of
    the prediction to what the problem searches, its gains as they are, shape (n, k); enough: fall of the squared error,
    as a share of it, that no step is taken for."""
    low, high = problem.box()
    residual = problem.residual(x)
    slopes = -_beside(_free_columns(problem, x), slopes)  # of the residual, once the gains are solved
    as_told, own = True, False  # whether the last step brought what slopes foretold; whether these are of this point
    for _ in range(STEPS):
        square = float(residual @ residual)
        step = _step(slopes, residual, low - x, high - x)
        foretold = residual + slopes @ step
        fall = square - float(foretold @ foretold)
        if fall <= enough * square and (as_told or own):
            return Refit(x, residual)
        if not as_told:
            if own:
                return None
            slopes, own = _slopes(problem, x, residual), True
            as_told = True
            continue
        there = problem.residual(x + step)
        fell = square - float(there @ there)
        as_told = fell >= LEAST * fall
        if as_told:
            slopes = slopes + np.outer((there - foretold) / float(step @ step), step)
        if fell > 0:
            x, residual, own = x + step, there, False
    return None


def _slopes(problem: Problem, x: Float1D, residual: Float1D) -> Float2D:
    """Of the residual at a point, one difference each; shape (n, k)."""
    low, high = problem.box()
    columns = []
    for i in range(len(x)):
        delta = STEP * (high[i] - low[i]) * (1.0 if x[i] < (low[i] + high[i]) / 2 else -1.0)
        trial = x.copy()
        trial[i] += delta
        columns.append((problem.residual(trial) - residual) / delta if delta else np.zeros(len(residual)))
    return np.column_stack(columns)


def could_fall(problem: Problem, x: Float1D, residual: Float1D, slopes: Float2D) -> float:
    """By how much the squared error falls if the others are fitted anew from a point, as far as slopes tell."""
    low, high = problem.box()
    slopes = -_beside(_free_columns(problem, x), slopes)
    foretold = residual + slopes @ _step(slopes, residual, low - x, high - x)
    return max(0.0, float(residual @ residual) - float(foretold @ foretold))


def _free_columns(problem: Problem, x: Float1D) -> Float2D:
    return problem.matrix(x)[:, problem.low < problem.high]


def _beside(columns: Float2D, slopes: Float2D) -> Float2D:
    """What of the slopes no gain can take up."""
    if not columns.shape[1] or not slopes.shape[1]:
        return slopes
    return np.asarray(slopes - columns @ _solved(columns, slopes))


def _solved(columns: Float2D, target: Array) -> Array:
    """Least squares by the Gram matrix: of a step it is enough, and samples may be a million."""
    size = np.sqrt(np.sum(columns**2, axis=0))
    size[size == 0] = 1.0
    gram = (columns.T @ columns) / np.outer(size, size)
    cross = ((columns.T @ target).T / size).T
    return np.asarray(((np.linalg.pinv(gram, rcond=ONE, hermitian=True) @ cross).T / size).T)


def _step(slopes: Float2D, residual: Float1D, low: Float1D, high: Float1D) -> Float1D:
    """The step to the least squared error within bounds; who would leave them stays at its bound."""
    step = np.zeros(slopes.shape[1])
    free = np.ones(len(step), bool)
    while free.any():
        left = residual + slopes[:, ~free] @ step[~free]
        step[free] = -_solved(slopes[:, free], left)
        out = free & ((step < low) | (step > high))
        if not out.any():
            break
        step = np.clip(step, low, high)
        free &= ~out
    return step
