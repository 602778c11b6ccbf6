"""Noise of all tests as one chain: the factor of its covariance, and columns in units of it.

Slow noise is a chain: B with 1 on and -exp(-dt / tau) below its diagonal makes white noise of it, so that B cov B'
has three diagonals only, its Cholesky factor C two, and B^-1 C is the factor of cov itself. Whitening passes the rows
of all tests once ([rue2005], ch. 2): between two tests nothing is left of the slow noise.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg.lapack import dpbtrf, dtbtrs

from thermodata.plugin import Float1D, Float2D

WIDE = 400  # columns from which on it costs less to take samples one by one
MANY = 8  # tests from which on few columns are taken sample by sample, those of all tests at once


@dataclass(frozen=True, slots=True)
class Chain:
    """Factor L = B^-1 C of the covariance of all tests, one after the other. carried: what is left of the slow noise
    from one sample to the next, shape (rows - 1,). factor: C, its diagonal and the one below, shape (2, rows). sizes:
    rows of each test."""

    carried: Float1D
    factor: Float2D
    sizes: tuple[int, ...]

    @property
    def logdet(self) -> float:
        """Log determinant of the covariance: B has the determinant 1."""
        return 2 * float(np.log(self.factor[0]).sum())

    def part(self, first: int, last: int) -> Chain:
        """Of the tests from the first to the last of these."""
        begin, end = sum(self.sizes[:first]), sum(self.sizes[: last + 1])
        return Chain(self.carried[begin : end - 1], self.factor[:, begin:end], self.sizes[first : last + 1])

    def halved(self, columns: Float2D) -> Float2D:
        """L^-1 times columns, shape (rows, k)."""
        if not columns.size:
            return columns
        if columns.shape[1] >= WIDE:
            return self._sample_by_sample(columns)
        at_once = len(self.sizes) * columns.shape[1] >= WIDE and self._are_many_alike
        steps = np.array(columns, dtype=np.float64, order="C" if at_once else "F")
        steps[1:] -= self.carried[:, None] * columns[:-1]
        if at_once:
            return self._test_beside_test(steps)
        return sound(*dtbtrs(self.factor, steps, uplo="L", overwrite_b=1))

    @property
    def _are_many_alike(self) -> bool:
        """Whether there are many tests, about as long as each other."""
        return len(self.sizes) >= MANY and max(self.sizes) * len(self.sizes) <= 2 * sum(self.sizes)

    def _test_beside_test(self, steps: Float2D) -> Float2D:
        """C^-1 times what every sample adds, shape (rows, k): each sample of all tests at once, for no test knows of
        another. To the last digit what LAPACK gives."""
        many, sizes = steps.shape[1], np.array(self.sizes)
        starts = np.cumsum(sizes) - sizes
        # beyond its end the last sample of a test stands again, and is not looked at
        at = starts + np.minimum(np.arange(sizes.max())[:, None], sizes - 1)
        own, below = (np.repeat(row[at], many, axis=1) for row in self.factor)
        side_by_side = steps[at]
        rows, part = side_by_side.reshape(len(at), -1), np.empty(own.shape[1])
        rows[0] /= own[0]
        for i in range(1, len(rows)):
            rows[i] -= np.multiply(rows[i - 1], below[i - 1], out=part)
            rows[i] /= own[i]
        test = np.repeat(np.arange(len(sizes)), sizes)
        found: Float2D = np.empty(steps.shape, order="F")
        found[:] = side_by_side[np.arange(len(steps)) - starts[test], test]
        return found

    def _sample_by_sample(self, columns: Float2D) -> Float2D:
        """The same for many columns, each sample of all at once: LAPACK takes one column after the other, in which each
        sample waits for the one before."""
        own = 1.0 / self.factor[0]
        of_last, of_found = -self.carried * own[1:], -self.factor[1, :-1] * own[1:]
        part, found = np.empty(columns.shape[1]), np.asarray(columns * own[:, None])
        found[1:] += columns[:-1] * of_last[:, None]
        before = found[0]
        for row, share in zip(found[1:], of_found.tolist(), strict=True):
            row += np.multiply(before, share, out=part)
            before = row
        return found


def chain_of(tests: Sequence[Float1D], white: float, slow: float, tau_s: float) -> Chain:
    """tests: times of the samples of each, rising, shape (m,) [s]. white, slow: standard deviations, in one unit.
    tau_s: memory of the slow noise [s]."""
    t_s = np.concatenate(tests)
    apart = np.diff(t_s) / tau_s
    apart[np.cumsum([len(t) for t in tests])[:-1] - 1] = np.inf
    carried = np.exp(-apart)
    band = np.zeros((2, len(t_s)))  # B cov B': the diagonal, and the one below
    band[0] = white**2
    band[0, 0] += slow**2
    band[0, 1:] += (white * carried) ** 2 - slow**2 * np.expm1(-2 * apart)
    band[1, :-1] = -carried * white**2
    return Chain(carried, sound(*dpbtrf(band, lower=1)), tuple(len(t) for t in tests))


def sound(solution: Float2D, info: int) -> Float2D:
    """What LAPACK gives, where it says that it could: LinAlgError where it could not."""
    if info:
        raise np.linalg.LinAlgError("a covariance is singular")
    return np.asarray(solution, dtype=np.float64)
