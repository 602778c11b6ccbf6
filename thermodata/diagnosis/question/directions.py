"""The evidence of the known effects under many noises in turn, at the cost of one weighted product each.

A search asks for hundreds of noises and few memories of the slow one. For one memory all its sizes share directions:
with an orthonormal basis K of what the free columns of a test leave (its offsets, a warm start), and the correlation R
of its slow noise,

    K'RK = V diag(l) V',    U = K V,    cov(U'y) = diag(slow^2 l + white^2)

So columns are turned once a memory, U'X, and each noise only weighs their rows: the restricted likelihood
[patterson1971] of all tests in one product, whatever their length and however many offsets they have. Directions are
those of the samples and offsets, and stay the same beside whatever is known.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from thermodata.diagnosis.question.discrepancy import Noise, cholesky, distances, free_of, halved
from thermodata.diagnosis.question.problem import Problem
from thermodata.plugin import Float1D, Float2D

# Gram matrix of the known effects, their products with the response, its energy, log determinant of the covariance, and
# the rows that are left once the offsets are known
Products = tuple[Float2D, Float1D, float, float, int]


@dataclass(frozen=True, slots=True)
class Directions:
    """Of one memory. turn: a test each, U', shape (rows that offsets leave, m). size: of the slow noise along each, all
    tests one after the other, for a slow noise of 1."""

    turn: tuple[Float2D, ...]
    size: Float1D


class Weighted:
    """All tests of a problem, under one noise after the other."""

    def __init__(self, problem: Problem) -> None:
        self._problem = problem
        self._columns = [np.column_stack([b.base, b.slack, b.response]) for b in problem.blocks]
        self._turned: dict[float, tuple[Float2D, Float1D]] = {}

    def products(self, noise: Noise) -> Products:
        """Over all tests, offsets integrated out."""
        turned, size = self._columns_along(noise.tau_s)
        variance = noise.slow**2 * size + noise.white**2
        total = turned.T @ (turned / variance[:, None])
        logdet = float(np.log(variance).sum()) + _bases_left(self._problem)[1]
        return total[:-1, :-1], total[:-1, -1], float(total[-1, -1]), logdet, len(size)

    def _columns_along(self, tau_s: float) -> tuple[Float2D, Float1D]:
        """Columns along the directions of a memory, and the size of the slow noise there."""
        if tau_s not in self._turned:
            found = directions(self._problem, tau_s)
            turned = [turn @ c for turn, c in zip(found.turn, self._columns, strict=True)]
            self._turned[tau_s] = np.concatenate(turned), found.size
        return self._turned[tau_s]


def directions(problem: Problem, tau_s: float) -> Directions:
    """Kept with the problem: the same samples are asked again beside other effects."""
    kept = problem.kept.setdefault("directions", {})
    key = round(float(np.log(tau_s)), 9)
    if key not in kept:
        # tests of the same samples and offsets, such as all of one plan, have the same
        made: dict[tuple[bytes, bytes], tuple[Float2D, Float1D]] = {}
        found = []
        for i, (block, free) in enumerate(zip(problem.blocks, _bases_left(problem)[0], strict=True)):
            samples = block.t_s.tobytes(), free.tobytes()
            if samples not in made:
                correlation = np.exp(-distances(problem, i) / tau_s)
                values, vectors = np.linalg.eigh(free.T @ correlation @ free)
                made[samples] = np.ascontiguousarray((free @ vectors).T), np.maximum(values, 0.0)
            found.append(made[samples])
        kept[key] = Directions(tuple(turn for turn, _ in found), np.concatenate([size for _, size in found]))
    directions: Directions = kept[key]
    return directions


def _bases_left(problem: Problem) -> tuple[list[Float2D], float]:
    """(a test each, an orthonormal basis of what its free columns leave, shape (m, m - columns), and the log
    determinant of their Gram matrices, of all tests)."""
    kept = problem.kept.setdefault("free", {})
    if "left" not in kept:
        members = [free_of(b) for b in problem.blocks]
        bases = [np.linalg.qr(m, mode="complete")[0][:, m.shape[1] :] for m in members]
        kept["left"] = bases, float(sum(np.linalg.slogdet(m.T @ m)[1] for m in members))
    found: tuple[list[Float2D], float] = kept["left"]
    return found


def log_evidence(gram: Float2D, cross: Float1D, energy: float, logdet: float, rows: int, precision: Float1D) -> float:
    """Of a response under a prior of the known effects, of which all products are given."""
    factor = cholesky(gram + np.diag(precision))
    half = halved(factor, cross[:, None])[:, 0]
    of_prior = 2 * np.log(factor.diagonal()).sum() - np.log(precision).sum()
    return float(-0.5 * (energy - half @ half + of_prior + logdet + rows * np.log(2 * np.pi)))
