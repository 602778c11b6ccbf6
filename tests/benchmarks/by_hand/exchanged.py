"""Histories exchanged between tests: what is left of one test, put into another.

A response of this kind keeps the slow course that displacements have, and what the programmes of all tests have in
common; where a cause is missing, it keeps that, too, at times at which its channels did something else.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from functools import cache

import numpy as np

from thermodata.diagnosis.case import Case
from thermodata.diagnosis.concluded import Concluded
from thermodata.diagnosis.question.chain import chain_of
from thermodata.diagnosis.question.discrepancy import Noise, free_of
from thermodata.diagnosis.question.known import Known, known
from thermodata.diagnosis.question.problem import Block, Problem, freed
from thermodata.diagnosis.verdict.judged import Judged
from thermodata.diagnosis.verdict.selection import Selection
from thermodata.diagnosis.weigh.beside import beside, without
from thermodata.diagnosis.weigh.evidence import Columns, Moments, weigh
from thermodata.plugin import Float1D, Float2D, Int1D

from .chance import DRAWS

# columns of the first samples of a test, by its number -> the same without what is free in these, in units of the noise
Weighing = Callable[[int, Float2D], Float2D]
# (numbers of a test and of the one whose rest stands in it) -> (columns, shape (m, k), and the response, (m,), weighed)
Pair = Callable[[int, int], tuple[Float2D, Float1D]]


def derangements(tests: int, rng: np.random.Generator, count: int = DRAWS) -> Iterator[Int1D]:
    """Orders of the tests in which none stands at its own place; of few tests there are few, and they come again."""
    while count:
        order = rng.permutation(tests)
        if (order != np.arange(tests)).all():
            yield order
            count -= 1


def pairs(problem: Problem, columns: Float2D, explained: Float1D, weighing: Weighing) -> Pair:
    """columns: of all tests, shape (rows, k). explained: what is known, in a unit of the response, shape (rows,). A
    test that is longer than the one whose rest it is given ends where that one does."""
    blocks, parts = problem.blocks, problem.parts
    left = np.concatenate(problem.response_blocks) - explained

    @cache
    def of_test(test: int, size: int) -> Float2D:
        return weighing(test, columns[parts[test]][:size])

    def pair(test: int, other: int) -> tuple[Float2D, Float1D]:
        mine, theirs = blocks[test], blocks[other]
        size = max(int(np.searchsorted(mine.t_s, theirs.t_s[-1], side="right")), 1)
        theirs_here = np.interp(mine.t_s[:size], theirs.t_s, left[parts[other]])
        response = weighing(test, (explained[parts[test]][:size] + theirs_here)[:, None])
        return of_test(test, size), response[:, 0]

    return pair


def without_offsets(blocks: Sequence[Block]) -> Weighing:
    """Each sample alike."""
    return lambda test, columns: freed(
        columns, blocks[test].test, blocks[test].t_s[: len(columns)], blocks[test].segment[: len(columns)]
    )


def whitened(blocks: Sequence[Block], noise: Noise) -> Weighing:
    """In units of the noise, as the evidence weighs them."""

    def weighing(test: int, columns: Float2D) -> Float2D:
        block, size = blocks[test], len(columns)
        chain = chain_of([block.t_s[:size]], noise.white, noise.slow, noise.tau_s)
        free = free_of(block)[:size]
        white = chain.halved(np.hstack([columns, free[:, np.abs(free).max(axis=0) > 0]]))
        own, offsets = white[:, : columns.shape[1]], np.linalg.qr(white[:, columns.shape[1] :])[0]
        return np.asarray(own - offsets @ (offsets.T @ own))

    return weighing


def p_of_claims(case: Case, found: Concluded, seed: int = 0) -> dict[str, float]:
    """Of each claim of an answer by its evidence: how often the best of all candidates does as well, beside the other
    members, where what is left is exchanged between the open tests."""
    selection = found.investigation.selection
    if selection is None:
        return {}
    return {
        claim.scored.candidate.id: _p_of_claim(found.investigation.problem, selection, claim, seed)
        for claim in found.judgement.claims
    }


def _p_of_claim(problem: Problem, selection: Selection, claim: Judged, seed: int) -> float:
    own = claim.scored.columns
    others = [m.scored for m in selection.members if not any(c is own for c in (m.scored.columns, m.alone.columns))]
    others = [o for o in others if o.columns is not claim.alone.columns]
    others += [c for c in selection.context if c.columns is not own]
    base = known(beside(problem, others), selection.noise)
    pool = without([s.columns for s in selection.first.ranked], others)
    if not any(c is own for c in pool):
        pool.append(own)
    best = _best_of_exchanged(base, pool, np.random.default_rng(seed))
    return float((1 + np.sum(best >= _evidence_as_it_stands(base, own))) / (len(best) + 1))


def _evidence_as_it_stands(base: Known, one: Columns) -> float:
    flat = one.whole.reshape(len(one.whole), -1)
    white = base.space.of(flat)
    by_point = white.reshape(one.whole.shape).transpose(1, 2, 0)
    products = (white.T @ base.both).reshape(*one.whole.shape[1:], -1)
    of_all = Moments(by_point @ by_point.transpose(0, 2, 1), products[..., :-1], products[..., -1])
    return weigh(base, one, of_all, base.every).total - one.candidate.log_prior


def _best_of_exchanged(base: Known, pool: Sequence[Columns], rng: np.random.Generator) -> Float1D:
    """The largest evidence of any candidate, shape (DRAWS,)."""
    problem = base.problem
    explained = base.held @ base.mean(base.every)
    columns = np.hstack([base.held, *(c.whole.reshape(len(c.whole), -1) for c in pool)])
    pair = pairs(problem, columns, explained, whitened(problem.blocks, base.space.noise))

    @cache
    def products(test: int, other: int) -> list[np.ndarray]:  # type: ignore[type-arg]
        """Of the known columns; then three of each candidate."""
        both, response = pair(test, other)
        k = base.held.shape[1]
        held, found = both[:, :k], [both[:, :k].T @ both[:, :k], both[:, :k].T @ response]
        begin = k
        for one in pool:
            points, c = one.whole.shape[1:]
            white = both[:, begin : begin + points * c]
            begin += points * c
            by_point = white.reshape(-1, points, c).transpose(1, 2, 0)
            found += [
                by_point @ by_point.transpose(0, 2, 1),
                (white.T @ held).reshape(points, c, k),
                (white.T @ response).reshape(points, c),
            ]
        return found

    best = []
    for order in derangements(len(problem.blocks), rng):
        each = [products(i, j) for i, j in enumerate(order.tolist())]
        total = [np.asarray(sum(parts)) for parts in zip(*each, strict=True)]
        here = _as_known(base, total[0], total[1])
        best.append(
            max(
                weigh(here, one, Moments(*total[2 + 3 * i : 5 + 3 * i]), here.every).total - one.candidate.log_prior
                for i, one in enumerate(pool)
            )
        )
    return np.array(best)


def _as_known(base: Known, gram: Float2D, cross: Float1D) -> Known:
    """The known effects beside another response, of all tests together."""
    return replace(base, gram=gram[None], cross=cross[None], energy=np.zeros(1))
