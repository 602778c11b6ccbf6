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
    Weighed,
    each_left_out,
    each_of_all,
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
        (weigh(base, one, products, base.every), one)
        for one, products in zip(pool, each_of_all(base, pool), strict=True)
    ]
    weighed.sort(key=lambda item: -item[0].total)
    ranked = [score(base, one, w) if left_out else _seen(base, one, w) for w, one in weighed[:SCORED]]
    ranked += [_unscored(one, w) for w, one in weighed[SCORED:]]
    return Ranked(base, tuple(ranked))


def score(base: Known, one: Columns, w: Weighed) -> Scored:
    """With what the left-out tests say of it. base: the known effects; w: what all tests say."""
    tests, parts, known_columns, products = base.every, base.space.parts, base.problem.known, moments(base, one)
    before, after, own_before, own_after, gained = np.zeros((5, len(tests)))
    of_all, toward = (base.mean(tests), base.factor(tests)), products.known.sum(axis=0)
    toward_others = others_of_each(products.known)
    for i, seen in enumerate(each_left_out(base, one, products)):
        block, others, best = base.problem.blocks[i], base.others(i), seen.best
        gained[i] = w.total - seen.total
        held, sized = known_columns[parts[i]], seen.coefficients
        does = one.whole[parts[i], best[0]] @ sized
        of_others = base.mean(others), base.factor(others)
        before[i], after[i] = _errors(block, held, does, *of_others, toward_others[i, best[0]].T @ sized)
        own_before[i], own_after[i] = _errors(block, held, does, *of_all, toward[best[0]].T @ sized)
    contribution = one.does(w)
    rows = np.array([len(contribution[own]) for own in parts])
    size = np.sqrt(base.space.each(contribution**2) / rows)
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
    (products,) = each_of_all(base, [one])
    return weigh(base, one, products, base.every).total - one.candidate.log_prior


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
    return replace(_unscored(one, w), shape=_shape(base, one.does(w)))


def _unscored(one: Columns, w: Weighed) -> Scored:
    no = np.zeros(0)
    evidence = w.total - one.candidate.log_prior
    return Scored(one.candidate, one, w, evidence, no, no, no, no, no, no, no, spread=1.0, shape=no)


def _shape(base: Known, contribution: Float1D) -> Float1D:
    """The whitened contribution without what the known effects can do, unit length."""
    white = base.space.of(contribution[:, None])
    whole = (white - base.white @ solved(base.factor(base.every), base.white.T @ white))[:, 0]
    length = float(np.linalg.norm(whole))
    return np.asarray(whole / length if length > 0 else whole)
