"""All candidates beside some known effects, the most likely first, and what left-out tests say of the first ones."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from thermodata.diagnosis.question.discrepancy import Noise
from thermodata.diagnosis.question.known import Known, known, solved
from thermodata.diagnosis.question.problem import Problem
from thermodata.diagnosis.weigh.evidence import (
    Columns,
    Weighed,
    each_left_out,
    each_of_all,
    moments,
    weigh,
)
from thermodata.diagnosis.weigh.invariance import spread_of_gain
from thermodata.diagnosis.weigh.scored import Scored, acting
from thermodata.plugin import Float1D, Float2D

SCORED = 15  # candidates whose left-out tests are computed


@dataclass(frozen=True, slots=True)
class Ranked:
    """All candidates beside some known effects, the most likely first. ranked: with left-out tests for the first
    `SCORED`."""

    known: Known
    ranked: tuple[Scored, ...]


def rank_in(problem: Problem, pool: Sequence[Columns], noise: Noise, *, left_out: bool = True) -> Ranked:
    """The same in a given noise."""
    base = known(problem, noise)
    weighed = [
        (weigh(base, one, products, base.every), one)
        for one, products in zip(pool, each_of_all(base, pool), strict=True)
    ]
    weighed.sort(key=lambda item: -item[0].total)
    ranked = _scored(base, weighed[:SCORED], left_out=left_out) + [_unscored(one, w) for w, one in weighed[SCORED:]]
    return Ranked(base, tuple(ranked))


def score(base: Known, one: Columns, w: Weighed) -> Scored:
    """With what the left-out tests say of it. base: the known effects; w: what all tests say."""
    return _scored(base, [(w, one)])[0]


def _scored(base: Known, some: Sequence[tuple[Weighed, Columns]], *, left_out: bool = True) -> list[Scored]:
    """What they look like and, where these are asked, what the left-out tests say of them."""
    if not some:
        return []
    does = np.column_stack([one.does(w) for w, one in some])
    white = base.space.of(does)
    seen = [replace(_unscored(one, w), shape=s) for (w, one), s in zip(some, _shapes(base, white), strict=True)]
    return [_with_left_out(base, s, does[:, i], white[:, i]) for i, s in enumerate(seen)] if left_out else seen


def _with_left_out(base: Known, seen: Scored, does: Float1D, white: Float1D) -> Scored:
    """does: its contribution, shape (rows,); white: the same whitened."""
    one, space, products = seen.columns, base.space, moments(base, seen.columns)
    others = each_left_out(base, one, products)
    point, sized = others.point, others.coefficients
    alone = np.concatenate([one.whole[rows, point[i]] @ sized[i] for i, rows in enumerate(space.parts)])
    of_all = (sized[:, None] @ products.known.sum(axis=0)[point])[:, 0]
    pulled = solved(base.factor(base.every), of_all.T).T
    own_before, own_after = _errors_of_left_out(base, np.tile(base.mean(base.every), (len(sized), 1)), pulled, alone)
    before, after = _errors_of_left_out(base, base.of_others.mean, base.of_others.solved(others.toward), alone)
    size = np.sqrt(space.each(does**2) / space.sizes)
    return replace(
        seen,
        gained=seen.weighed.total - others.total,
        rows=space.sizes,
        white=space.noise.white,
        sse_before=before,
        sse_after=after,
        own_before=own_before,
        own_after=own_after,
        size=size,
        spread=spread_of_gain(base, white, acting(size)),
        sides=tuple(_evidence(base, side) for side in one.sides),
    )


def _evidence(base: Known, one: Columns) -> float:
    (products,) = each_of_all(base, [one])
    return weigh(base, one, products, base.every).total - one.candidate.log_prior


def _errors_of_left_out(base: Known, theta: Float2D, pulled: Float2D, does: Float1D) -> tuple[Float1D, Float1D]:
    """Squared error of each test without and with the candidate of the others. theta: coefficients of the known effects
    in each, shape (tests, k); pulled: what the candidate takes off these; does: what it does there, shape (rows,)."""
    without = np.concatenate(base.problem.response_blocks) - base.does(theta)
    among = without + base.does(pulled) - does
    return base.space.each(without**2), base.space.each(among**2)


def _unscored(one: Columns, w: Weighed) -> Scored:
    no = np.zeros(0)
    evidence = w.total - one.candidate.log_prior
    return Scored(one.candidate, one, w, evidence, no, no, no, no, no, no, no, spread=1.0, shape=no)


def _shapes(base: Known, white: Float2D) -> list[Float1D]:
    """Whitened contributions, shape (rows, c), without what the known effects can do, of unit length: each (rows,)."""
    whole = white - base.white @ solved(base.factor(base.every), base.white.T @ white)
    length = np.linalg.norm(whole, axis=0)
    return list(np.ascontiguousarray((whole / np.where(length > 0, length, 1.0)).T))
