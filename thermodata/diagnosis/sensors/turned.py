"""Tests in which the probe's sign is turned: what all that is logged foretells of them, they do the other way round.

The model alone cannot tell where an effect is missing that does as much as it. So each test is foretold, by the others,
from all channels through lags of several lengths beside the model's effects, whether they are causes or not.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from thermodata.diagnosis.candidates.basis import Means, basis, sharing
from thermodata.diagnosis.candidates.candidate_effect import CandidateEffect
from thermodata.diagnosis.candidates.of_library import candidates
from thermodata.diagnosis.question.compressed import WEIGHED_ROWS, compressed
from thermodata.diagnosis.question.known import FloatND
from thermodata.diagnosis.question.present import GENERIC, present
from thermodata.diagnosis.question.problem import Block, Problem
from thermodata.modelling.terms.fitted_response import FittedResponse
from thermodata.plugin import Bool1D, Effect, Float1D, Float2D, Int1D
from thermodata.schema.answers.diagnosis import Artefact
from thermodata.view.grid.dataset import Dataset, TestData

LEAST_TESTS = 3  # of two nobody can say which one is turned
ALL_DROP = 0.6  # of the squared error of all left-out tests, which turning one must take away
LEAST_FIT = 40.0  # [%] of that test as the others foretell it, turned
MOVES = 0.2  # of the RMS of all tests: what hardly moves goes up or down by what no channel tells, and spoils no choice
MOST_IN_PAIRS = 24  # tests, of which two are tried at once
EVERY = 3  # points of a lag's grid: four, from its shortest time constant to its longest
# of a column's squares: how much is held against a lag (the least error of left-out tests decides), and against the
# model's own effects
RIDGES, OWN_RIDGE = (1e-3, 1e-2, 1e-1, 1.0), 1e-6


def turned_probes(
    fitted: FittedResponse, data: Dataset, tests: Sequence[TestData], library: Mapping[str, Effect], means: Means
) -> list[Artefact]:
    """Of the tests that a model is fitted to. The plainest first, and fewer than half: a sign is turned against those
    of most tests."""
    problem = sharing(compressed(fitted, data, tests, WEIGHED_ROWS), means)
    asked = candidates(library, data.channels, present(fitted), fitted.name)
    return turned(problem, [c for c in asked if c.family == GENERIC])


def turned(problem: Problem, lags: Sequence[CandidateEffect]) -> list[Artefact]:
    """lags: of all channels, at which the response is foretold beside the model."""
    blocks = problem.blocks
    if len({b.test.key for b in blocks}) < LEAST_TESTS or not any(b.response.any() for b in blocks):
        return []
    said = _foretold_by_ridges(problem, lags)
    signs, left = np.ones(len(blocks)), said[0].energy
    now = _least_errors(said, signs)
    size = np.sqrt(left / np.array([len(b.response) for b in blocks]))
    moves = np.flatnonzero(size >= MOVES * np.sqrt(left.sum() / sum(len(b.response) for b in blocks)))
    while (found := _plainest_turned(said, signs, now, moves)) is not None:
        signs, now = found
    return [_artefact(problem, blocks[i], now[i], _fit(now[i], left[i])) for i in np.flatnonzero(signs < 0)]


def _plainest_turned(
    said: Sequence[_Foretold], signs: Float1D, now: Float1D, moves: Int1D
) -> tuple[Float1D, Float1D] | None:
    """(signs, squared errors) with the test turned that is plainly so, or two of them: before both are turned they hide
    each other. None where none is, or where it would not be fewer than half. moves: the tests that may be."""
    upright = [i for i in moves.tolist() if signs[i] > 0]
    for together in (1, 2) if len(signs) <= MOST_IN_PAIRS else (1,):
        if 2 * (np.sum(signs < 0) + together) >= len(signs):
            break
        found = []
        for some in combinations(upright, together):
            tried = signs.copy()
            tried[list(some)] = -1.0
            errors = _least_errors(said, tried)
            fit = min(_fit(errors[i], said[0].energy[i]) for i in some)
            if is_turned(now.sum(), errors.sum(), fit):
                found.append((tried, errors))
        if found:
            return min(found, key=lambda one: float(one[1].sum()))
    return None


def is_turned(before: float, after: float, fit: float) -> bool:
    """before, after: squared error of all left-out tests, and with one turned. fit [%]: of that one then."""
    return after < (1 - ALL_DROP) * before and fit >= LEAST_FIT


@dataclass(frozen=True, slots=True)
class _Foretold:
    """What the others say of each test, as their signs are. energy: of its response, shape (tests,). along: of both,
    shape (tests, others). power: of what is said, shape (tests, others, others)."""

    energy: Float1D
    along: Float2D
    power: FloatND

    def errors(self, signs: Float1D) -> Float1D:
        """Squared error of each test as the others foretell it, shape (tests,)."""
        said = np.einsum("i,tij,j->t", signs, self.power, signs)
        return np.asarray(np.maximum(self.energy - 2 * signs * (self.along @ signs) + said, 0.0))


def _foretold_by_ridges(problem: Problem, lags: Sequence[CandidateEffect]) -> list[_Foretold]:
    """By each of the ridges."""
    columns, is_lag = _columns(problem, lags)
    gram = np.stack([c.T @ c for c in columns])
    cross = np.stack([c.T @ b.response for c, b in zip(columns, problem.blocks, strict=True)])
    energy, whole, tests = (
        np.array([float(b.response @ b.response) for b in problem.blocks]),
        gram.sum(axis=0),
        len(gram),
    )
    said = []
    for ridge in RIDGES:
        held = np.diag(np.where(is_lag, ridge, OWN_RIDGE))
        along, power = np.zeros((tests, tests)), np.zeros((tests, tests, tests))
        for i in range(tests):
            others = cross.T.copy()
            others[:, i] = 0.0
            gains = np.linalg.solve(whole - gram[i] + held, others)
            along[i], power[i] = cross[i] @ gains, gains.T @ gram[i] @ gains
        said.append(_Foretold(energy, along, power))
    return said


def _columns(problem: Problem, lags: Sequence[CandidateEffect]) -> tuple[list[Float2D], Bool1D]:
    """Of each test, shape (m, k), all of one size; which are of lags, shape (k,)."""
    drawn = [basis(problem, c).own for c in lags]
    own = problem.blocks[0].base.shape[1]
    whole = [
        np.column_stack([b.base, *(d[t][:, ::EVERY].reshape(len(b.t_s), -1) for d in drawn)])
        for t, b in enumerate(problem.blocks)
    ]
    size = np.sqrt(sum(np.sum(w**2, axis=0) for w in whole))
    acts = size > 0
    return [w[:, acts] / size[acts] for w in whole], (np.arange(len(size)) >= own)[acts]


def _least_errors(said: Sequence[_Foretold], signs: Float1D) -> Float1D:
    """The errors by whichever way foretells all tests best."""
    return min((s.errors(signs) for s in said), key=lambda e: float(e.sum()))


def _fit(squared: float, energy: float) -> float:
    return (1 - float(np.sqrt(squared / energy))) * 100 if energy > 0 else 0.0


def _artefact(problem: Problem, block: Block, squared: float, fit: float) -> Artefact:
    return Artefact(
        kind="sign",
        campaign=block.test.campaign,
        test=block.test.test,
        at_s=None,
        size_um=float(np.sqrt(squared / max(len(block.response), 1))),
        why=f"turned round, this test is as all that is logged foretells it from the other tests (FIT {fit:.0f}): its "
        "sign is wrong. It takes no part in the choice; check on which side the probe stood, and give the test a "
        f"calibration of its own (in the campaign file, below tests: channels: {problem.response}: calibration)",
    )
