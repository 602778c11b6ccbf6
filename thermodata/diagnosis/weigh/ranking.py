"""All candidates beside some known effects, the most likely first, and what left-out tests say of the first ones."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from thermodata.diagnosis.question.discrepancy import Noise
from thermodata.diagnosis.question.known import Known, known, solved
from thermodata.diagnosis.question.problem import Block, Problem
from thermodata.diagnosis.weigh.evidence import (
    Columns,
    Moments,
    Weighed,
    each_left_out,
    each_moments,
    moments,
    others_of_each,
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
        (weigh(base, one, products, base.every), products, one)
        for one, products in zip(pool, each_moments(base, pool), strict=True)
    ]
    weighed.sort(key=lambda item: -item[0].total)
    ranked = [
        score(problem, base, one, products, w) if left_out else _seen(base, one, w)
        for w, products, one in weighed[:SCORED]
    ]
    ranked += [_unscored(one, w) for w, _, one in weighed[SCORED:]]
    return Ranked(base, tuple(ranked))


def score(problem: Problem, base: Known, one: Columns, products: Moments, w: Weighed) -> Scored:
    """With what the left-out tests say of it. base: the known effects; products: with them; w: what all tests say."""
    tests = base.every
    before, after, own_before, own_after, gained = np.zeros((5, len(tests)))
    of_all, toward = (base.mean(tests), base.factor(tests)), products.known.sum(axis=0)
    toward_others = others_of_each(products.known)
    for i, seen in enumerate(each_left_out(base, one, products)):
        block, others, best = problem.blocks[i], np.delete(tests, i), seen.best
        gained[i] = w.total - seen.total
        held, sized = np.hstack([block.base, block.slack]), seen.mean[best]
        does = one.blocks[i][:, best[0]] @ sized
        of_others = base.mean(others), base.factor(others)
        before[i], after[i] = _errors(block, held, does, *of_others, toward_others[i, best[0]].T @ sized)
        own_before[i], own_after[i] = _errors(block, held, does, *of_all, toward[best[0]].T @ sized)
    point, sized = w.best[0], w.coefficients
    contribution = [b[:, point] @ sized for b in one.blocks]
    rows = np.array([len(c) for c in contribution])
    size = np.sqrt([np.mean(c**2) for c in contribution])
    return Scored(
        candidate=one.candidate,
        columns=one,
        weighed=w,
        evidence=w.total - one.candidate.log_prior,
        gained=gained,
        rows=rows,
        sse_before=before,
        sse_after=after,
        own_before=own_before,
        own_after=own_after,
        size=size,
        spread=spread_of_gain(base, contribution, acting(size)),
        shape=_shape(base, contribution),
        sides=tuple(_evidence(base, side) for side in one.sides),
    )


def _evidence(base: Known, one: Columns) -> float:
    return weigh(base, one, moments(base, one), base.every).total - one.candidate.log_prior


def _errors(
    block: Block, held: Float2D, does: Float1D, theta: Float1D, factor: Float2D, toward: Float1D
) -> tuple[float, float]:
    """Squared error of a test without and with the candidate of the others. held: the known effects' columns. does:
    what the candidate does there. theta, factor, toward: of the tests that the known effects are fitted to: their
    coefficients and posterior, and their products with the candidate."""
    without = block.response - held @ theta
    pulled = solved(factor, toward[:, None])[:, 0]
    among = without + held @ pulled - does
    return float(without @ without), float(among @ among)


def _seen(base: Known, one: Columns, w: Weighed) -> Scored:
    """What it looks like, without the left-out tests."""
    point, sized = w.best[0], w.coefficients
    return replace(_unscored(one, w), shape=_shape(base, [b[:, point] @ sized for b in one.blocks]))


def _unscored(one: Columns, w: Weighed) -> Scored:
    no = np.zeros(0)
    evidence = w.total - one.candidate.log_prior
    return Scored(one.candidate, one, w, evidence, no, no, no, no, no, no, no, spread=1.0, shape=no)


def _shape(base: Known, contribution: Sequence[np.ndarray]) -> np.ndarray:
    """The whitened contribution without what the known effects can do, unit length."""
    white = [base.space.of(i, c[:, None])[:, 0] for i, c in enumerate(contribution)]
    cross = np.sum([x.T @ w for x, w in zip(base.white, white, strict=True)], axis=0)
    theta = solved(base.factor(base.every), cross[:, None])[:, 0]
    whole = np.concatenate([w - x @ theta for x, w in zip(base.white, white, strict=True)])
    length = float(np.linalg.norm(whole))
    return np.asarray(whole / length if length > 0 else whole)
