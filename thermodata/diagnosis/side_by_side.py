"""The evidence of the known effects under many noises in turn: all tests of a thinned problem in one stack.

A search asks for hundreds of noises, of tests with a dozen rows each: what is done for each test by itself costs more
than its arithmetic. Shorter tests are filled up with rows that are known to be zero, which changes no product.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from thermodata.diagnosis.discrepancy import Noise, halved
from thermodata.diagnosis.problem import Problem
from thermodata.plugin import Float1D, Float2D

# Gram matrix of the known effects, their products with the response, its energy, log determinant of the covariance, and
# the rows that are left once the offsets are known
Products = tuple[Float2D, Float1D, float, float, int]
SHORT = 60  # rows
FAR_S = 1e18  # of a row that is filled up, from all others: nothing is shared with it


class SideBySide:
    """fits: whether it is of use: each test has one offset, and none is so long that its arithmetic is what costs."""

    def __init__(self, problem: Problem) -> None:
        blocks = problem.blocks
        longest = max(len(b.t_s) for b in blocks)
        self.fits = longest <= SHORT and all(len(np.unique(b.segment)) == 1 for b in blocks)
        self.rows = sum(len(b.t_s) - 1 for b in blocks)
        width = blocks[0].base.shape[1] + blocks[0].slack.shape[1] + 2
        self._distances: NDArray[np.float64] = np.full((len(blocks), longest, longest), FAR_S)
        # of each test: known effects, response, offset
        self._columns: NDArray[np.float64] = np.zeros((len(blocks), longest, width))
        self._real = np.zeros((len(blocks), longest), dtype=bool)
        for i, b in enumerate(blocks):
            m = len(b.t_s)
            self._distances[i, :m, :m] = np.abs(b.t_s[:, None] - b.t_s[None])
            self._columns[i, :m] = np.column_stack([b.base, b.slack, b.response, np.ones(m)])
            self._real[i, :m] = True

    def products(self, noise: Noise) -> Products:
        """Over all tests, offsets integrated out."""
        covariance = noise.slow**2 * np.exp(-self._distances / noise.tau_s)
        rows = np.arange(covariance.shape[1])
        covariance[:, rows, rows] = np.where(self._real, noise.slow**2 + noise.white**2, 1.0)
        factor = np.linalg.cholesky(covariance)
        white = np.linalg.solve(factor, self._columns)
        every = np.einsum("tmk,tml->tkl", white, white)
        offset = every[:, -1, -1]
        both = every[:, :-1, :-1] - every[:, :-1, -1:] * every[:, None, :-1, -1] / offset[:, None, None]
        total = both.sum(axis=0)
        logdet = 2 * float(np.log(factor[:, rows, rows]).sum()) + float(np.log(offset).sum())
        return total[:-1, :-1], total[:-1, -1], float(total[-1, -1]), logdet, self.rows


def log_evidence(gram: Float2D, cross: Float1D, energy: float, logdet: float, rows: int, precision: Float1D) -> float:
    """Of a response under a prior of the known effects, of which all products are given."""
    factor: Float2D = np.asarray(np.linalg.cholesky(gram + np.diag(precision)), dtype=np.float64)
    half = halved(factor, cross[:, None])[:, 0]
    of_prior = 2 * np.log(np.diag(factor)).sum() - np.log(precision).sum()
    return float(-0.5 * (energy - half @ half + of_prior + logdet + rows * np.log(2 * np.pi)))
