"""Leave one test out: how much better an unseen test is predicted with a candidate than without.

All by Gram matrices a test, so that a candidate costs a few small solves; the same solves serve the real
residual (column 0) and its surrogates (columns 1...), all folds and all grid points. A candidate's nonlinear
parameters are chosen on the training tests of each fold, never on the test that is left out.
"""

from __future__ import annotations

from collections.abc import Sequence
from copy import copy
from dataclasses import dataclass
from typing import NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from thermodata.plugin import Float1D, Float2D

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Fold:
    """One test left out: the base model refitted on the others. inverse: of the training Gram matrix (k, k)."""

    inverse: Float2D
    theta: Float2D
    sse: Float1D


@dataclass(frozen=True, slots=True)
class Folds:
    """Several folds, stacked: shapes (n, k, k), (n, k, 1 + surrogates) and (n, 1 + surrogates)."""

    inverse: Array
    theta: Array
    sse: Float2D

    @classmethod
    def of(cls, folds: Sequence[Fold]) -> Self:
        return cls(*(np.stack([getattr(f, name) for f in folds]) for name in ("inverse", "theta", "sse")))


class Moments(NamedTuple):
    """Products a test of a candidate's columns at every grid point: with themselves, shape (tests, points, c, c),
    with the base, (tests, points, c, k), and with residual and surrogates, (tests, points, c, 1 + surrogates)."""

    cc: Array
    cb: Array
    cr: Array


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
        self.width = self.gram.shape[1]
        self.both = [np.hstack([b, r]) for b, r in zip(self.base, self.residuals, strict=True)]
        self.total = self._fold(None)
        self.folds = [self._fold(i) for i in range(self.n)]
        self.whole, self.each = Folds.of([self.total]), Folds.of(self.folds)
        self.unseen = self.cross - self.gram @ self.each.theta

    def without_surrogates(self) -> Self:
        """The same for the residuals alone."""
        alone = copy(self)
        alone.residuals, alone.cross = [r[:, :1] for r in self.residuals], self.cross[..., :1]
        alone.energy, alone.unseen = self.energy[:, :1], self.unseen[..., :1]
        alone.both = [both[:, : self.width + 1] for both in self.both]
        alone.total, *alone.folds = (Fold(f.inverse, f.theta[:, :1], f.sse[:1]) for f in (self.total, *self.folds))
        alone.whole, alone.each = Folds.of([alone.total]), Folds.of(alone.folds)
        return alone

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
        moments = self._moments(grid)
        after = self._left_out(moments, priors)
        whole = Moments(*(m.sum(axis=0, keepdims=True) for m in moments))
        gains, reductions = self._gain(self.whole, whole, priors)[:2]
        return Drop(self.before, after, int(np.argmax(reductions[0, :, 0])), gains[0, :, :, 0])

    def _moments(self, grid: Sequence[Sequence[Float2D]]) -> Moments:
        """Products of all grid points at once: one large product a test costs a third of one for each point."""
        cc, cb, cr = [], [], []
        for i, both in enumerate(self.both):
            columns = np.stack([point[i] for point in grid], axis=1)
            m, points, c = columns.shape
            by_point = columns.transpose(1, 0, 2)
            cc.append(by_point.transpose(0, 2, 1) @ by_point)
            cross = (columns.reshape(m, points * c).T @ both).reshape(points, c, -1)
            cb.append(cross[..., : self.width])
            cr.append(cross[..., self.width :])
        return Moments(np.stack(cc), np.stack(cb), np.stack(cr))

    def _gain(self, folds: Folds, seen: Moments, priors: Priors) -> tuple[Array, Array, Array]:
        """Of the tests that a fold has seen. Gains, shape (folds, points, c, 1 + surrogates); the fall of the
        training error, shape (folds, points, 1 + surrogates); what the base does of each column, (folds, points, k, c).
        """
        cc, cb, cr = seen
        u = folds.inverse[:, None] @ np.swapaxes(cb, -1, -2)
        d = cc - cb @ u + np.diag(self.noise_var / priors.spread**2)
        e = cr - _times(cb, folds.theta)
        gain = np.linalg.solve(d, e)
        gain = np.clip(gain, priors.lower[:, None], priors.upper[:, None])
        reduction = np.einsum("npcs,npcs->nps", gain, 2 * e - d @ gain)
        return gain, reduction, u

    def _left_out(self, moments: Moments, priors: Priors) -> Float2D:
        """Squared error of each test where the others choose the grid point and the gains, (tests, 1 + surrogates)."""
        seen = Moments(*(_of_the_others(m) for m in moments))
        gain, reduction, u = self._gain(self.each, seen, priors)
        cc, cb, cr = moments
        by_base = np.swapaxes(u, -1, -2)
        h = cr - _times(cb, self.each.theta) - _times(by_base, self.unseen)
        shared = cb @ u
        q = cc - shared - np.swapaxes(shared, -1, -2) + by_base @ self.gram[:, None] @ u
        sse = self.each.sse[:, None] - np.einsum("npcs,npcs->nps", gain, 2 * h - q @ gain)
        reduction = np.where(np.isnan(reduction), -np.inf, reduction)
        best = np.argmax(reduction, axis=1)[:, None]
        useful = np.take_along_axis(reduction, best, axis=1)[:, 0] > -np.inf
        chosen = np.where(useful, np.take_along_axis(sse, best, axis=1)[:, 0], self.each.sse)
        return np.maximum(chosen, 0.0)


def _times(columns: Array, coefficients: Array) -> Array:
    """(n, points, c, k) times (n, k, s): one product for each n, whatever the number of points."""
    n, points, c, k = columns.shape
    product: Array = columns.reshape(n, points * c, k) @ coefficients
    return product.reshape(n, points, c, -1)


def _of_the_others(moments: Array) -> Array:
    """Sums over all tests but each, shape like moments. Never the sum of all less its own: where one test has nearly
    all, rounding would be what is left."""
    result = np.zeros_like(moments)
    np.cumsum(moments[:-1], axis=0, out=result[1:])
    result[:-1] += np.cumsum(moments[:0:-1], axis=0)[::-1]
    return result
