"""How much more likely a candidate makes the measured response, its gains and its time constant integrated out.

    log BF = log p(y | known effects, candidate, noise) - log p(y | known effects, noise)

At each point of the candidate's grid and each size of its prior this is closed, for all is Gaussian: with the whitened
columns C, what the known effects explain taken out, M = C'C and b = C'y,

    log BF = b' (D^-1 + M)^-1 b / 2 - log|I + D M| / 2,    D the prior variances

and points and sizes are averaged by their prior. A candidate with more to choose from pays for it by itself
[mackay1992]. All comes from products a test, so that leaving one out costs a small solve.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from thermodata.diagnosis.candidates.basis import basis
from thermodata.diagnosis.candidates.candidate_effect import CandidateEffect
from thermodata.diagnosis.candidates.of_library import UNNAMED
from thermodata.diagnosis.question.discrepancy import halved
from thermodata.diagnosis.question.known import FloatND, Known, others_of_each, solved
from thermodata.diagnosis.question.problem import Problem
from thermodata.modelling.terms.rms import rms
from thermodata.plugin import Float1D, Float2D, Int1D, Param

# prior standard deviations of a contribution, as multiples of the response: from what can hardly be seen to what is
# balanced by another effect
SIZES = np.array([0.03, 0.1, 0.3, 1.0, 3.0])
# how much of it may act faster or slower than its time constant (prior standard deviation)
SPREAD = 0.5
# a gain beyond what the effect can plausibly do is not cut off: ten times costs 1.3 in log evidence
BEYOND = 0.25
AT_ONCE = 1600  # columns of candidates that are whitened at once


@dataclass(frozen=True, slots=True)
class Columns:
    """A candidate's columns, scaled so that a coefficient of 1 is as large as the response. whole: of all tests, one
    after the other, shape (rows, points, c): own columns, then how they differ where the effect acts faster and slower.
    scale: shape (points, gains), gain of a coefficient of 1. width: shape (c,), prior standard deviation at size 1.
    prior: shape (points, sizes), log probability. sides: of a difference of two temperatures, a plain lag of each."""

    candidate: CandidateEffect
    points: list[dict[str, float]]
    whole: FloatND
    scale: Float2D
    width: Float1D
    prior: Float2D
    sides: tuple[Columns, ...] = ()

    @property
    def gains(self) -> int:
        """How many gains the candidate has."""
        return int(self.scale.shape[1])

    @property
    def on_a_line(self) -> bool:
        """Whether its points differ in one parameter only: then each one's neighbours stand beside it."""
        return len({name for p in self.points for name, value in p.items() if value != self.points[0][name]}) == 1

    def does(self, weighed: Weighed) -> Float1D:
        """At its likeliest time constant and size, shape (rows,)."""
        return np.asarray(self.whole[:, weighed.best[0]] @ weighed.coefficients)


@dataclass(frozen=True, slots=True)
class Moments:
    """Products a test: shapes (tests, points, c, c), with the known effects (tests, points, c, k) and with the response
    (tests, points, c); of some tests together the same without the first axis."""

    own: FloatND
    known: FloatND
    response: FloatND

    def of(self, tests: Int1D) -> Moments:
        """Of some tests together."""
        return Moments(*(each[tests].sum(axis=0) for each in (self.own, self.known, self.response)))


@dataclass(frozen=True, slots=True)
class Weighed:
    """Of some tests. log_bf: with the prior, shape (points, sizes). mean: coefficients, shape (points, sizes, c)."""

    log_bf: Float2D
    mean: FloatND

    @property
    def total(self) -> float:
        """Log evidence over all points and sizes."""
        return float(_log_sum(self.log_bf.reshape(-1, 1))[0])

    @property
    def best(self) -> tuple[int, int]:
        """The point and the size that are most probable."""
        point, size = np.unravel_index(int(np.argmax(self.log_bf)), self.log_bf.shape)
        return int(point), int(size)

    @property
    def coefficients(self) -> Float1D:
        """At the best point and size, shape (c,)."""
        return np.asarray(self.mean[self.best])


@dataclass(frozen=True, slots=True)
class LeftOut:
    """Of all tests but one, for each of them in turn. total: shape (tests,), as of `Weighed`. point: (tests,), the
    likeliest one; coefficients: (tests, c), there at the likeliest size. toward: (tests, k), the products of what it
    then does in these tests with the known effects."""

    total: Float1D
    point: Int1D
    coefficients: Float2D
    toward: Float2D


def columns(problem: Problem, candidate: CandidateEffect) -> Columns | None:
    """None where its drivers never move."""
    made = basis(problem, candidate)
    own, others = np.vstack(made.own), np.vstack(made.others)
    moved = np.sqrt(np.mean(own**2, axis=0))
    if not np.any(moved > 0):
        return None
    scale = np.where(moved > 0, rms(problem.response_blocks) / np.where(moved > 0, moved, 1.0), 0.0)
    gains, ways = scale.shape[1], others.shape[2]
    whole = np.concatenate([own, others.reshape(*others.shape[:2], ways * gains)], axis=2)
    whole *= np.concatenate([scale] * (1 + ways), axis=1)
    width = np.concatenate([np.ones(gains), np.full(ways * gains, SPREAD)])
    return Columns(candidate, made.points, whole, scale, width, _prior(candidate, made.points, scale))


def _prior(candidate: CandidateEffect, points: Sequence[Mapping[str, float]], scale: Float2D) -> Float2D:
    """Logarithms, shape (points, sizes). With a time constant beyond its bounds an effect is as likely as a lag without
    a name."""
    largest = np.array([g.magnitude[1] for g in candidate.effect.gains])
    over = np.maximum(SIZES[None, :, None] * scale[:, None, :] / largest, 1.0)
    within = np.array([_within_bounds(candidate.effect.params, p) for p in points])
    named = np.where(within, candidate.log_prior, min(candidate.log_prior, UNNAMED))
    weight = named[:, None] - BEYOND * np.log(over).max(axis=2) ** 2
    result: Float2D = weight - np.log(max(int(within.sum()), 1) * len(SIZES))
    return result


def _within_bounds(params: Sequence[Param], point: Mapping[str, float]) -> bool:
    return all(p.reach is None or p.lower <= point[p.name] <= p.upper for p in params)


def moments(known: Known, columns: Columns) -> Moments:
    """A test each."""
    (white,) = _whitened_columns(known, [columns])
    parts = [(white[rows], known.both[rows]) for rows in known.space.parts]
    own = np.stack([_products_by_point(part, columns) for part, _ in parts])
    cross = np.stack([part.T @ both for part, both in parts]).reshape(len(parts), *columns.whole.shape[1:], -1)
    return Moments(own, cross[..., :-1], cross[..., -1])


def each_of_all(known: Known, some: Sequence[Columns]) -> Iterator[Moments]:
    """Of each of some candidates, of all tests together, at the cost of few."""
    kept = known.space.products
    sizes = np.cumsum([one.whole[0].size for one in some])
    for few in np.split(np.arange(len(some)), np.flatnonzero(np.diff(sizes // AT_ONCE)) + 1):
        group = [some[i] for i in few.tolist()]
        for one, white in zip(group, _whitened_columns(known, group), strict=True):
            if id(one) not in kept:  # the same, whatever is known
                kept[id(one)] = one, _products_by_point(white, one)
            cross = known.space.product(white, known.both).reshape(*one.whole.shape[1:], -1)
            known.of_all[id(one)] = one, Moments(kept[id(one)][1], cross[..., :-1], cross[..., -1])
            yield known.of_all[id(one)][1]


def _of_all(known: Known, columns: Columns) -> Moments:
    """Of all tests together: as they were made for a ranking, or made."""
    if id(columns) not in known.of_all:
        list(each_of_all(known, [columns]))
    found: Moments = known.of_all[id(columns)][1]
    return found


def _products_by_point(white: Float2D, columns: Columns) -> FloatND:
    """Products of a candidate's columns at each point, shape (points, c, c)."""
    by_point = white.reshape(-1, *columns.whole.shape[1:]).transpose(1, 0, 2)
    return np.asarray(by_point.transpose(0, 2, 1) @ by_point)


def _whitened_columns(known: Known, few: Sequence[Columns]) -> list[Float2D]:
    """Of each, of all tests, shape (rows, points * c)."""
    return known.space.of_each([(one, one.whole.reshape(len(one.whole), -1)) for one in few])


def weigh(known: Known, columns: Columns, moments: Moments, tests: Int1D) -> Weighed:
    """What some tests say. moments: of these together."""
    return Weighed(*_weigh(columns, *beyond_known(known, moments, tests)))


def each_left_out(known: Known, columns: Columns, moments: Moments) -> LeftOut:
    """What all tests but one say, for each of them in turn. moments: a test each."""
    cross, others = others_of_each(moments.known), known.of_others
    half = others.halved(cross)
    right = others_of_each(moments.response) - (cross @ others.mean[:, None, :, None])[..., 0]
    log_bf, mean = _weigh(columns, others_of_each(moments.own) - half @ half.swapaxes(-1, -2), right)
    by_test = log_bf.reshape(len(log_bf), -1)
    best = by_test.argmax(axis=1)
    point, sized = best // len(SIZES), mean.reshape(*by_test.shape, -1)[known.every, best]
    toward = (sized[:, None] @ cross[known.every, point])[:, 0]
    return LeftOut(_log_sum(by_test.T), point, sized, toward)


def beyond_known(known: Known, moments: Moments, tests: Int1D) -> tuple[FloatND, FloatND]:
    """M, shape (points, c, c), and b, (points, c), once the known effects have explained what they can. moments: of
    these tests together."""
    points, c, k = moments.known.shape
    half = halved(known.factor(tests), moments.known.reshape(points * c, k).T).T.reshape(points, c, k)
    left = moments.own - half @ half.transpose(0, 2, 1)
    return left, moments.response - moments.known @ known.mean(tests)


def _weigh(columns: Columns, left: FloatND, right: FloatND) -> tuple[FloatND, FloatND]:
    """log BF with the prior, shape (..., points, sizes), and coefficients, (..., points, sizes, c). left: M, shape
    (..., points, c, c); right: b, (..., points, c)."""
    deviation = SIZES[:, None] * columns.width
    scaled = deviation[:, :, None] * left[..., None, :, :] * deviation[:, None, :]
    scaled[..., np.arange(len(columns.width)), np.arange(len(columns.width))] += 1.0
    goal = deviation * right[..., None, :]
    solution = np.linalg.solve(scaled, goal[..., None])[..., 0]
    log_bf = 0.5 * np.einsum("...c,...c->...", goal, solution) - 0.5 * np.linalg.slogdet(scaled)[1]
    return log_bf + columns.prior, deviation * solution


def explained(known: Known, series: Float2D) -> Float2D:
    """The coefficients of the known effects in other responses, whitened, of all tests, (rows, s): shape (k, s)."""
    return solved(known.factor(known.every), known.space.product(known.white, series))


def of_each_series(known: Known, columns: Columns, series: Float2D, already: Float2D) -> Float1D:
    """log BF of other responses, whitened, of all tests, shape (rows, s): shape (s,). already: what is `explained` of
    them."""
    count = series.shape[1]
    (white,) = _whitened_columns(known, [columns])
    products = _of_all(known, columns)
    left, _ = beyond_known(known, products, known.every)
    right = known.space.product(white, series).reshape(*columns.whole.shape[1:], count)
    right -= products.known @ already
    deviation = SIZES[:, None] * columns.width
    scaled = deviation[None, :, :, None] * left[:, None] * deviation[None, :, None, :]
    scaled[..., np.arange(len(columns.width)), np.arange(len(columns.width))] += 1.0
    goal = deviation[None, :, :, None] * right[:, None]
    solution = np.linalg.solve(scaled, goal)
    log_bf = 0.5 * np.einsum("pscn,pscn->psn", goal, solution) - 0.5 * np.linalg.slogdet(scaled)[1][..., None]
    return _log_sum((log_bf + columns.prior[..., None]).reshape(-1, count))


def _log_sum(logs: Float2D) -> Float1D:
    """Logarithm of the sum of exponentials down each column."""
    top = logs.max(axis=0)
    return np.asarray(top + np.log(np.exp(logs - top).sum(axis=0)))
