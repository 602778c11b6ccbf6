"""Ridge fits of the base and of each candidate beside it, and the errors of tests that are left out in turn.

All comes from products of columns a test, so that a fit without a test, or of another response, is a small solve.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from thermodata.plugin import Float1D, Float2D

from .asked import Candidates, FloatND


@dataclass(frozen=True, slots=True)
class Products:
    """A test each. base: shape (tests, k, k). cross: (tests, points, c, k). own: (tests, points, c, c). rows: (tests,),
    samples."""

    base: FloatND
    cross: FloatND
    own: FloatND
    rows: Float1D


@dataclass(frozen=True, slots=True)
class Series:
    """Products of one or more responses with these columns. base: (tests, k, s). own: (tests, points, c, s). energy:
    (tests, s), sum of squares."""

    base: FloatND
    own: FloatND
    energy: Float2D


P = TypeVar("P", Products, Series)


@dataclass(frozen=True, slots=True)
class Fit:
    """Of some tests. base: coefficients of the base alone, shape (k, s). own: of each candidate at each point, (points,
    c, s). pulled: what a coefficient of it takes off the base, (points, c, k). worth: log of the penalised likelihood
    that it adds, its prior included, (points, s). information: (points, c, c), precision of its coefficients."""

    base: Float2D
    own: FloatND
    pulled: FloatND
    worth: Float2D
    information: FloatND


@dataclass(frozen=True, slots=True)
class LeftOut:
    """Mean squares of each test that is left out, in the square of the response's unit. before: shape (tests, s), by
    the base. after: (tests, candidates, s), with each at its likeliest point. does: the same, of what it does there."""

    before: Float2D
    after: FloatND
    does: FloatND


def products(base: Float2D, bank: FloatND, parts: Sequence[slice]) -> Products:
    """base: (rows, k). bank: (rows, points, c). parts: the rows of each test."""
    return joined([_products(base[rows], bank[rows]) for rows in parts])


def _products(base: Float2D, bank: FloatND) -> Products:
    """Of one test."""
    by_point = bank.transpose(1, 2, 0)
    cross = (bank.reshape(len(bank), -1).T @ base).reshape(*bank.shape[1:], base.shape[1])
    own = by_point @ by_point.transpose(0, 2, 1)
    return Products((base.T @ base)[None], cross[None], own[None], np.array([float(len(base))]))


def joined(each: Sequence[P]) -> P:
    """Of several tests, one after the other."""
    kind = type(each[0])
    return kind(*(np.concatenate([getattr(one, f.name) for one in each]) for f in fields(kind)))


def series(base: Float2D, bank: FloatND, responses: Float2D, parts: Sequence[slice]) -> Series:
    """responses: shape (rows, s)."""
    flat = bank.reshape(len(bank), -1)
    return Series(
        np.stack([base[r].T @ responses[r] for r in parts]),
        np.stack([(flat[r].T @ responses[r]).reshape(*bank.shape[1:], -1) for r in parts]),
        np.stack([(responses[r] ** 2).sum(axis=0) for r in parts]),
    )


def fit(made: Products, of: Series, prior: Candidates, weight: Float1D, ridge: Float1D) -> Fit:
    """weight: of each test's rows, shape (tests,); 0 leaves one out. ridge: prior precision of the base, shape (k,)."""
    sure = np.linalg.inv(np.tensordot(weight, made.base, 1) + np.diag(ridge))
    cross, own = np.tensordot(weight, made.cross, 1), np.tensordot(weight, made.own, 1)
    to_base, to_own = np.tensordot(weight, of.base, 1), np.tensordot(weight, of.own, 1)
    pulled = cross @ sure
    left = own - pulled @ cross.transpose(0, 2, 1) + np.eye(own.shape[1])
    right = to_own - pulled @ to_base
    coefficients = np.linalg.solve(left, right)
    worth = 0.5 * (right * coefficients).sum(axis=1) + prior.prior[:, None]
    return Fit(sure @ to_base, coefficients, pulled, worth, left)


def left_out(made: Products, of: Series, prior: Candidates, weight: Float1D, ridge: Float1D) -> LeftOut:
    """Each test foretold by the others."""
    before, after, does = [], [], []
    for i, rows in enumerate(made.rows.tolist()):
        others = weight.copy()
        others[i] = 0.0
        found = fit(made, of, prior, others, ridge)
        chosen = likeliest(found.worth, prior)
        error, with_it, own = _errors(made, of, found, i)
        before.append(error / rows)
        after.append(np.take_along_axis(with_it, chosen, axis=0) / rows)
        does.append(np.take_along_axis(own, chosen, axis=0) / rows)
    return LeftOut(np.stack(before), np.stack(after), np.stack(does))


def likeliest(worth: Float2D, prior: Candidates) -> NDArray[np.int64]:
    """The point of each candidate, of all points, shape (candidates, s)."""
    found = [(rows := prior.of(number)).start + worth[rows].argmax(axis=0) for number in range(len(prior.each))]
    return np.stack(found)


def _errors(made: Products, of: Series, found: Fit, test: int) -> tuple[Float1D, Float2D, Float2D]:
    """Sums of squares in a test: of the base's error, shape (s,), of that with each point, and of what that does,
    (points, s)."""
    base, cross, own = made.base[test], made.cross[test], made.own[test]
    toward = of.base[test] - base @ found.base
    alone = of.energy[test] - (found.base * (of.base[test] + toward)).sum(axis=0)
    moved = of.own[test] - cross @ found.base - found.pulled @ toward
    both = cross @ found.pulled.transpose(0, 2, 1)
    beyond = own - both - both.transpose(0, 2, 1) + found.pulled @ base @ found.pulled.transpose(0, 2, 1)
    with_it = alone + (found.own * (beyond @ found.own - 2 * moved)).sum(axis=1)
    return alone, with_it, (found.own * (own @ found.own)).sum(axis=1)
