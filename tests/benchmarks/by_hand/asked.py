"""One machine as both diagnoses are asked about it: the same tests, offsets, candidates, baseline and locked tests."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from thermodata.diagnosis.candidates.candidate_effect import CandidateEffect
from thermodata.diagnosis.case import Case
from thermodata.diagnosis.question.compressed import WEIGHED_ROWS, compressed
from thermodata.diagnosis.question.present import TIME_UNITS
from thermodata.diagnosis.question.problem import Block, Problem
from thermodata.diagnosis.verdict.asked import of_library
from thermodata.diagnosis.verdict.investigate import weighed
from thermodata.diagnosis.weigh.evidence import columns
from thermodata.modelling.terms.fitted_response import FittedResponse, FittedTerm
from thermodata.plugin import Float1D, Float2D
from thermodata.view.grid.dataset import TestData

FloatND = NDArray[np.float64]

BANK = np.geomspace(1 / 25, 25, 6)  # a known effect's time constants, as multiples of its own
KERNELS = np.geomspace(1 / 25, 25, 11)  # those that a kernel is drawn from by chance
# another mode of what the model has, or its heat by another channel: the bank of the base is to hold that
OF_THE_BASE = ("itself", "same", "heat")


@dataclass(frozen=True, slots=True)
class Candidates:
    """All candidates, at each point of their grids. bank: shape (rows, points, c), scaled so that 1 is as large as the
    response, c the most gains of any, zero where one has fewer. owner: shape (points,), the number of the candidate.
    prior: shape (points,), logarithm. scale: shape (points, c), gain of a coefficient of 1."""

    each: tuple[CandidateEffect, ...]
    points: tuple[dict[str, float], ...]
    bank: FloatND
    owner: NDArray[np.int64]
    prior: Float1D
    scale: Float2D

    def of(self, number: int) -> slice:
        """The points of one of them."""
        first, last = np.searchsorted(self.owner, [number, number + 1]).tolist()
        return slice(first, last)


@dataclass(frozen=True, slots=True)
class Asked:
    """problem: the open tests, one after the other. base: the bank of the known effects in them, shape (rows, k);
    kernels: the same on a finer grid, a known effect each, shape (rows, len(KERNELS)). locked: tests of which something
    can be foretold; base_locked: the bank in them."""

    problem: Problem
    base: Float2D
    kernels: tuple[Float2D, ...]
    candidates: Candidates
    locked: tuple[Block, ...]
    base_locked: Float2D

    @property
    def response(self) -> Float1D:
        """Of the open tests, shape (rows,)."""
        return np.concatenate(self.problem.response_blocks)

    def in_locked(self, point: int) -> Float2D:
        """What a candidate does in the locked tests at one of its points, shape (rows, c)."""
        made = self.candidates
        one = made.each[made.owner[point]]
        own = [b.compress(one.in_test(b.test)(made.points[point])) for b in self.locked]
        gains = own[0].shape[1]
        found = np.zeros((sum(map(len, own)), made.scale.shape[1]))
        found[:, :gains] = np.vstack(own) * made.scale[point, :gains]
        return found


def asked_of(case: Case) -> Asked:
    """case: as thermodata asks it, with clocks put right and slips known."""
    response = case.beside.fitted.responses[case.index]
    problem, fine = weighed(response, case.data, case.tests)
    some = [c for c in of_library(response, case.data, case.tests, case.library, fine) if c.kin not in OF_THE_BASE]
    both = compressed(response, case.data, [*case.tests, *case.locked], WEIGHED_ROWS)
    closed = {t.key for t in case.locked}
    locked = tuple(b for b in both.blocks if b.test.key in closed)
    base = np.vstack([b.compress(_base(response, b.test)) for b in problem.blocks])
    kernels = tuple(
        np.vstack([b.compress(_acting_otherwise(term, b.test, KERNELS).sum(axis=2)) for b in problem.blocks])
        for term in response.terms
    )
    return Asked(
        problem,
        base,
        kernels,
        _candidates(problem, some),
        locked,
        np.vstack([np.zeros((0, base.shape[1])), *(b.compress(_base(response, b.test)) for b in locked)]),
    )


def _base(response: FittedResponse, test: TestData) -> Float2D:
    """The bank of the known effects, shape (n, k)."""
    parts = [_acting_otherwise(term, test, BANK).reshape(len(test.t_s), -1) for term in response.terms]
    return np.hstack([np.zeros((len(test.t_s), 0)), *parts])


def _acting_otherwise(term: FittedTerm, test: TestData, factors: Float1D) -> FloatND:
    """A known effect as fitted, at multiples of its time constants, shape (n, factors, gains); at one point only where
    it has none [the response's unit]."""
    times = [p.name for p in term.effect.params if p.unit in TIME_UNITS]
    some = factors if times else np.ones(1)
    values = term.values(test)
    if values is None or not term.bound.covers(test):
        return np.zeros((len(test.t_s), len(some), len(term.effect.gains)))
    gains = np.array([values.gains[g.name] for g in term.effect.gains])
    made = []
    for factor in some.tolist():
        changed = {n: v * factor if n in times else v for n, v in values.params.items()}
        made.append(term.bound.columns(test, changed) * gains)
    return np.stack(made, axis=1)


def _candidates(problem: Problem, some: Sequence[CandidateEffect]) -> Candidates:
    made = [c for c in (columns(problem, one) for one in some) if c is not None]
    most = max(c.gains for c in made)

    def padded(values: FloatND) -> FloatND:
        return np.pad(values, [(0, 0)] * (values.ndim - 1) + [(0, most - values.shape[-1])])

    return Candidates(
        tuple(c.candidate for c in made),
        tuple(p for c in made for p in c.points),
        np.concatenate([padded(c.whole[:, :, : c.gains]) for c in made], axis=1),
        np.repeat(np.arange(len(made)), [len(c.points) for c in made]),
        # a bound of the library is no wall: what lies beyond it is less probable
        np.concatenate([c.prior[:, 3] + np.log(len(c.points)) for c in made]),
        np.vstack([padded(c.scale) for c in made]),
    )
