"""Leave one test out: how much better an unseen test is predicted with a candidate than without.

All by Gram matrices a test, so that a candidate costs a few small solves; the same solves serve the real
residual (column 0) and its surrogates (columns 1...). A candidate's nonlinear parameters are chosen on the
training tests of each fold, never on the test that is left out.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from thermodata.plugin import Float1D, Float2D


@dataclass(frozen=True, slots=True)
class Fold:
    """One test left out: the base model refitted on the others. inverse: of the training Gram matrix (k, k)."""

    inverse: Float2D
    theta: Float2D
    sse: Float1D


@dataclass(frozen=True, slots=True)
class Drop:
    """before, after: shape (tests, 1 + surrogates), squared error of each left-out test. best: the grid point
    that the whole data choose; gains: shape (grid points, c)."""

    before: Float2D
    after: Float2D
    best: int
    gains: Float2D

    @property
    def gain(self) -> Float1D:
        result: Float1D = self.gains[self.best]
        return result

    @property
    def relative(self) -> Float1D:
        """Shape (1 + surrogates,): 1 - after / before, summed over tests."""
        result: Float1D = 1.0 - self.after.sum(axis=0) / np.maximum(self.before.sum(axis=0), 1e-300)
        return result


@dataclass(frozen=True, slots=True)
class Priors:
    """Of a candidate's gains, shapes (c,): standard deviation (infinite: free), and bounds."""

    spread: Float1D
    lower: Float1D
    upper: Float1D


class Engine:
    """The base model and residuals of all tests; scores candidates against them.

    base: a test's columns (m, k). residuals: a test's (m, 1 + surrogates). noise_var: variance of the residual,
    the scale of the priors: a gain is drawn to 0 as if measured once with its largest plausible magnitude.
    price: shape (k,), 1 / (prior standard deviation)^2 of each base column's coefficient, 0 where it is free.
    """

    def __init__(self, base: Sequence[Float2D], residuals: Sequence[Float2D], noise_var: float, price: Float1D) -> None:
        self.price = np.diag(price * noise_var)
        self.base, self.residuals, self.noise_var = list(base), list(residuals), noise_var
        self.n = len(self.base)
        self.gram = np.stack([b.T @ b for b in self.base])
        self.cross = np.stack([b.T @ r for b, r in zip(self.base, self.residuals, strict=True)])
        self.energy = np.stack([np.einsum("ij,ij->j", r, r) for r in self.residuals])
        self.total = self._fold(None)
        self.folds = [self._fold(i) for i in range(self.n)]

    def _fold(self, left_out: int | None) -> Fold:
        keep = [i for i in range(self.n) if i != left_out]
        gram, cross = self.gram[keep].sum(axis=0), self.cross[keep].sum(axis=0)
        scale = np.trace(self.gram.sum(axis=0)) / max(1, gram.shape[0])
        # columns that a fold's training tests do not excite must not blow up in the test that is left out
        inverse = np.linalg.pinv(
            gram + self.price + 1e-6 * np.diag(np.diag(self.gram.sum(axis=0)) + 1e-12 * scale), hermitian=True
        )
        theta = inverse @ cross
        rows = keep if left_out is None else [left_out]
        sse = np.zeros(self.energy.shape[1])
        for i in rows:
            sse += (
                self.energy[i]
                - 2 * np.einsum("ij,ij->j", theta, self.cross[i])
                + np.einsum("ij,ij->j", theta, self.gram[i] @ theta)
            )
        return Fold(inverse, theta, sse)

    @property
    def before(self) -> Float2D:
        return np.stack([fold.sse for fold in self.folds])

    def score(self, grid: Sequence[Sequence[Float2D]], priors: Priors) -> Drop:
        """grid: for each grid point, a test's candidate columns (m, c)."""
        points = [self._moments(columns) for columns in grid]
        after = np.stack([self._left_out(i, points, priors) for i in range(self.n)])
        gains, reductions = zip(*(self._gain(self.total, p, None, priors) for p in points), strict=True)
        best = int(np.argmax([r[0] for r in reductions]))
        return Drop(self.before, after, best, np.stack([g[:, 0] for g in gains]))

    def _moments(self, columns: Sequence[Float2D]) -> tuple[Float2D, Float2D, Float2D]:
        cc = np.stack([c.T @ c for c in columns])
        bc = np.stack([b.T @ c for b, c in zip(self.base, columns, strict=True)])
        cr = np.stack([c.T @ r for c, r in zip(columns, self.residuals, strict=True)])
        return cc, bc, cr

    def _gain(
        self, fold: Fold, moments: tuple[Float2D, Float2D, Float2D], left_out: int | None, priors: Priors
    ) -> tuple[Float2D, Float1D]:
        """Gains, shape (c, 1 + surrogates), and the fall of the training error, shape (1 + surrogates,)."""
        keep = [i for i in range(self.n) if i != left_out]
        cc, bc, cr = (m[keep].sum(axis=0) for m in moments)
        u = fold.inverse @ bc
        d = cc - bc.T @ u + np.diag(self.noise_var / priors.spread**2)
        e = cr - bc.T @ fold.theta
        gain = np.linalg.solve(d, e)
        gain = np.clip(gain, priors.lower[:, None], priors.upper[:, None])
        reduction = 2 * np.einsum("ij,ij->j", gain, e) - np.einsum("ij,ij->j", gain, d @ gain)
        return gain, reduction

    def _left_out(self, i: int, points: Sequence[tuple[Float2D, Float2D, Float2D]], priors: Priors) -> Float1D:
        fold = self.folds[i]
        best = np.full(self.energy.shape[1], -np.inf)
        chosen = fold.sse.copy()
        for moments in points:
            gain, reduction = self._gain(fold, moments, i, priors)
            cc, bc, cr = moments
            u = fold.inverse @ (bc.sum(axis=0) - bc[i])
            h = cr[i] - bc[i].T @ fold.theta - u.T @ (self.cross[i] - self.gram[i] @ fold.theta)
            q = cc[i] - bc[i].T @ u - u.T @ bc[i] + u.T @ self.gram[i] @ u
            sse = fold.sse - 2 * np.einsum("ij,ij->j", gain, h) + np.einsum("ij,ij->j", gain, q @ gain)
            better = reduction > best
            best = np.where(better, reduction, best)
            chosen = np.where(better, sse, chosen)
        return np.maximum(chosen, 0.0)
