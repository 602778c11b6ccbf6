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
from thermodata.diagnosis.candidates.of_library import UNNAMED, CandidateEffect
from thermodata.diagnosis.question.discrepancy import halved
from thermodata.diagnosis.question.known import FloatND, Known, rms, solved
from thermodata.diagnosis.question.problem import Problem
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
    """A candidate's columns, scaled so that a coefficient of 1 is as large as the response. blocks: a test each, shape
    (m, points, c): own columns, then how they differ where the effect acts faster and slower. scale: shape (points,
    gains), gain of a coefficient of 1. width: shape (c,), prior standard deviation at size 1. prior: shape (points,
    sizes), log probability. sides: of a difference of two temperatures, a plain lag of each."""

    candidate: CandidateEffect
    points: list[dict[str, float]]
    blocks: tuple[FloatND, ...]
    scale: Float2D
    width: Float1D
    prior: Float2D
    sides: tuple[Columns, ...] = ()

    @property
    def gains(self) -> int:
        return int(self.scale.shape[1])

    @property
    def on_a_line(self) -> bool:
        """Whether its points differ in one parameter only: then each one's neighbours stand beside it."""
        return len({name for p in self.points for name, value in p.items() if value != self.points[0][name]}) == 1


@dataclass(frozen=True, slots=True)
class Moments:
    """Products a test: shapes (tests, points, c, c), with the known effects (tests, points, c, k) and with the response
    (tests, points, c)."""

    own: FloatND
    known: FloatND
    response: FloatND


@dataclass(frozen=True, slots=True)
class Weighed:
    """Of some tests. log_bf: with the prior, shape (points, sizes). mean: coefficients, shape (points, sizes, c)."""

    log_bf: Float2D
    mean: FloatND

    @property
    def total(self) -> float:
        return float(_log_sum(self.log_bf.reshape(-1, 1))[0])

    @property
    def best(self) -> tuple[int, int]:
        point, size = np.unravel_index(int(np.argmax(self.log_bf)), self.log_bf.shape)
        return int(point), int(size)

    @property
    def coefficients(self) -> Float1D:
        return np.asarray(self.mean[self.best])


def columns(problem: Problem, candidate: CandidateEffect) -> Columns | None:
    """None where its drivers never move."""
    made = basis(problem, candidate)
    own = np.vstack(made.own)
    moved = np.sqrt(np.mean(own**2, axis=0))
    if not np.any(moved > 0):
        return None
    scale = np.where(moved > 0, rms(problem.response_blocks) / np.where(moved > 0, moved, 1.0), 0.0)
    gains, ways = scale.shape[1], made.others[0].shape[2]
    full = np.concatenate([scale] * (1 + ways), axis=1)
    blocks = tuple(
        np.concatenate([o, w.reshape(*w.shape[:2], ways * gains)], axis=2) * full
        for o, w in zip(made.own, made.others, strict=True)
    )
    width = np.concatenate([np.ones(gains), np.full(ways * gains, SPREAD)])
    return Columns(candidate, made.points, blocks, scale, width, _prior(candidate, made.points, scale))


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
    return next(each_moments(known, [columns]))


def each_moments(known: Known, some: Sequence[Columns]) -> Iterator[Moments]:
    """Of each of some candidates, at the cost of few."""
    sizes = np.cumsum([one.blocks[0][0].size for one in some])
    for few in np.split(np.arange(len(some)), np.flatnonzero(np.diff(sizes // AT_ONCE)) + 1):
        yield from _moments_of(known, [some[i] for i in few.tolist()])


def _moments_of(known: Known, few: Sequence[Columns]) -> Iterator[Moments]:
    kept = known.space.products
    own: list[list[FloatND]] = [[] for _ in few]
    cross: list[list[FloatND]] = [[] for _ in few]
    # test by test: what was just whitened is near the processor
    for i, both in enumerate(known.both):
        for n, white in enumerate(_whites(known, few, i)):
            cross[n].append(white.T @ both)
            if id(few[n]) not in kept:  # the same, whatever is known
                by_point = white.reshape(-1, *few[n].blocks[i].shape[1:]).transpose(1, 0, 2)
                own[n].append(by_point.transpose(0, 2, 1) @ by_point)
    for n, one in enumerate(few):
        if own[n]:
            kept[id(one)] = one, np.stack(own[n])
        with_both = np.stack(cross[n]).reshape(len(one.blocks), *one.blocks[0].shape[1:], -1)
        yield Moments(kept[id(one)][1], with_both[..., :-1], with_both[..., -1])


def _whites(known: Known, few: Sequence[Columns], test: int) -> list[Float2D]:
    """Of each in a test, shape (m, points * c)."""
    return known.space.of_each(test, [(one, one.blocks[test].reshape(len(one.blocks[test]), -1)) for one in few])


def weigh(known: Known, columns: Columns, moments: Moments, tests: Int1D) -> Weighed:
    """What some tests say."""
    return Weighed(*_weigh(columns, *beyond_known(known, moments, tests)))


def each_left_out(known: Known, columns: Columns, moments: Moments) -> list[Weighed]:
    """What all tests but one say, for each of them in turn."""
    every, cross = known.every, others_of_each(moments.known)
    count, points, c, k = cross.shape
    half = np.empty_like(cross)
    right = others_of_each(moments.response)
    for i in range(count):
        others = np.delete(every, i)
        half[i] = halved(known.factor(others), cross[i].reshape(points * c, k).T).T.reshape(points, c, k)
        right[i] -= cross[i] @ known.mean(others)
    left = others_of_each(moments.own) - half @ half.swapaxes(-1, -2)
    return [Weighed(*one) for one in zip(*_weigh(columns, left, right), strict=True)]


def others_of_each(parts: FloatND) -> FloatND:
    """The sum of all parts but one, for each in turn, shape (tests, ...) as the parts: of those before and after it,
    for a difference to the whole would lose digits."""
    before, after = np.zeros_like(parts), np.zeros_like(parts)
    np.cumsum(parts[:-1], axis=0, out=before[1:])
    np.cumsum(parts[:0:-1], axis=0, out=after[-2::-1])
    return before + after


def beyond_known(known: Known, moments: Moments, tests: Int1D) -> tuple[FloatND, FloatND]:
    """M, shape (points, c, c), and b, (points, c), once the known effects have explained what they can."""
    cross = moments.known[tests].sum(axis=0)
    points, c, k = cross.shape
    factor = known.factor(tests)
    half = halved(factor, cross.reshape(points * c, k).T).T.reshape(points, c, k)
    theta = known.mean(tests)
    left = moments.own[tests].sum(axis=0) - half @ half.transpose(0, 2, 1)
    return left, moments.response[tests].sum(axis=0) - cross @ theta


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


def of_each_series(known: Known, columns: Columns, series: Sequence[Float2D]) -> Float1D:
    """log BF of other responses, whitened, shape (m, s) a test: shape (s,)."""
    tests = known.every
    factor = known.factor(tests)
    count = series[0].shape[1]
    cross = np.zeros((len(known.precision), count))
    right: FloatND = np.zeros((*columns.blocks[0].shape[1:], count))
    products = moments(known, columns)
    for i, values in enumerate(series):
        cross += known.white[i].T @ values
        right += (_whites(known, [columns], i)[0].T @ values).reshape(right.shape)
    left, _ = beyond_known(known, products, tests)
    right -= products.known.sum(axis=0) @ solved(factor, cross)
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
