"""The heat that nobody logged, estimated: a source that never falls below zero, through one first-order lag.

    missing displacement = offset + sign F_tau{q},   q >= 0, in steps,   beside what the known effects can still do

q is in the response's unit: where the missing displacement would come to rest if the source stayed as it is.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from thermodata.diagnosis.question.problem import Problem
from thermodata.diagnosis.unlogged.one_way import Array, Normal, Solution, solve
from thermodata.diagnosis.unlogged.source_steps import (
    SourceColumns,
    SteppedTest,
    box_columns,
    in_steps,
    normal_equations,
    source_columns,
)
from thermodata.modelling.terms.rms import rms
from thermodata.plugin import Float1D, Float2D
from thermodata.view.grid.dataset import TestData

TAUS_S = tuple(300.0 * 2 ** (i / 2) for i in range(15))  # 5 min to 10.7 h
# how much the known effects may differ from their fit: as standard deviation of a coefficient (1 doubles an effect)
KNOWN_SPREAD = 0.3
STRENGTHS = (0.1, 0.3, 1.0)  # of the penalty on changes; the simplest that fits is chosen
REWEIGHTINGS = 4
CHANGE = 0.05  # of the typical change: what is smaller is none
# share of the residual that is no evidence: what one lag leaves of a machine that is distributed
LEAVES = 0.1
ONE_SIDED = 0.55  # by how much a row one sign must explain better than the other (in the logarithm of squared error)
RESAMPLED = 200
PART_STEPS = 4  # parts that are left out, in steps of the source


@dataclass(frozen=True, slots=True)
class Course:
    """The source in one test, in steps of step_s from from_s [s]; all arrays have shape (n,), in the response's unit.

    source: zero or more, unless it goes both ways. contribution: what it does, from its own mean over what was
    measured; residual: what the model leaves over, from its own mean, NaN where nothing was measured.
    """

    test: TestData
    from_s: float
    step_s: float
    source: Float1D
    contribution: Float1D
    residual: Float1D


@dataclass(frozen=True, slots=True)
class MissingHeat:
    """tau_s: with its range over tests drawn anew (5 to 95 %, and half a point of the grid) [s]. sign: 1 or -1; 0 where
    it goes both ways, so that no sign can be told. agreed: share of the draws with this sign. explained: share of the
    squared residual; predicted: the same on parts that were left out. courses: a test each."""

    tau_s: float
    tau_range_s: tuple[float, float]
    sign: int
    agreed: float
    explained: float
    predicted: float
    courses: tuple[Course, ...]


@dataclass(frozen=True, slots=True)
class _Fit:
    """One sign, time constant and strength. errors, changes: a test each, shape (tests,)."""

    sign: int
    tau_s: float
    strength: float
    solution: Solution
    errors: Float1D
    changes: Float1D


def missing_heat(problem: Problem, seed: int = 0) -> MissingHeat | None:
    """The source whose course is simplest for what it explains; None where none is worth its changes.

    Sign, time constant and strength of the penalty are chosen by the Bayesian information criterion [schwarz1978], the
    number of changes of the source counting as parameters, as in the fused lasso [tibshirani2005].
    """
    tests = in_steps(problem)
    rows = np.array([len(t.t_s) for t in tests], dtype=np.float64)
    energy = float(sum(np.sum(t.residual**2) for t in tests))
    if not len(tests) or energy <= max(problem.noise, 1e-9) ** 2 * rows.sum():
        return None
    price = energy / rows.sum() / KNOWN_SPREAD**2
    fits = [f for sign in (1, -1) for tau in TAUS_S for f in _fits(tests, sign, tau, price)]
    judge = _Criterion(rows, LEAVES**2 * energy / rows.sum())
    best = judge.simplest(fits)
    if judge(best.errors, best.changes) >= judge(_errors_without_source(tests, price), np.zeros(len(tests))):
        return None
    other = judge.simplest([f for f in fits if f.sign != best.sign])
    if judge(other.errors, other.changes) - judge(best.errors, best.changes) < ONE_SIDED * rows.sum():
        fits = [f for tau in TAUS_S for f in _fits(tests, 0, tau, price)]
        best = judge.simplest(fits)
    drawn = _fits_of_draws(fits, judge, seed)
    low, high = np.quantile([f.tau_s for f in drawn], (0.05, 0.95))
    # between two points of the grid none was tried
    half = float(np.sqrt(TAUS_S[1] / TAUS_S[0]))
    return MissingHeat(
        tau_s=best.tau_s,
        tau_range_s=(float(low) / half, float(high) * half),
        sign=best.sign,
        agreed=float(np.mean([f.sign == best.sign for f in drawn])),
        explained=1 - float(best.errors.sum()) / energy,
        predicted=1 - _left_out_error(tests, best, price) / energy,
        courses=tuple(_course(t, best, i) for i, t in enumerate(tests)),
    )


def _penalty(weight: Float2D, there: NDArray[np.bool_]) -> Array:
    """sum of weight times squared change, shape (tests, n, n); the first change is from rest before the test."""
    w = np.where(there, weight, 0.0)
    tests, n = w.shape
    made = np.zeros((tests, n, n))
    i = np.arange(n)
    made[:, i, i] = w
    made[:, i[:-1], i[:-1]] += w[:, 1:]
    made[:, i[1:], i[:-1]] = made[:, i[:-1], i[1:]] = -w[:, 1:]
    return made


def _changes(solution: Solution, there: NDArray[np.bool_]) -> Float2D:
    return np.where(there, np.abs(np.diff(solution.source, axis=1, prepend=0.0)), 0.0)


def _typical_change(changes: Float2D, there: NDArray[np.bool_]) -> float:
    return rms([changes[there]]) or 1.0


def counted(changes: Float2D, there: NDArray[np.bool_]) -> Float1D:
    """How many changes of a source are parameters, in each test: shapes (tests, n) to (tests,)."""
    return np.asarray(np.sum(changes > CHANGE * _typical_change(changes, there), axis=1), dtype=np.float64)


def _blocky_solution(normal: Normal, scale: float, one_way: bool) -> Solution:
    """Reweighted so that the sum of changes is held down, not of their squares: few steps, of any height."""
    weight, solution = np.ones(normal.aim.shape), None
    for _ in range(1 + REWEIGHTINGS):
        solution = solve(normal, scale * _penalty(weight, normal.there), solution, one_way=one_way)
        changes = _changes(solution, normal.there)
        weight = 1 / np.maximum(changes / _typical_change(changes, normal.there), 0.01)
    assert solution is not None
    return solution


def _penalty_scale(test: SteppedTest, tau_s: float, strength: float) -> float:
    """Of the penalty: by what one step of the source can move, so that one strength serves all time constants."""
    return strength * float(np.expm1(-(test.edges[1] - test.edges[0]) / tau_s)) ** 2


def _fits(tests: Sequence[SteppedTest], sign: int, tau_s: float, price: float) -> list[_Fit]:
    columns = [source_columns(t, sign, tau_s) for t in tests]
    normal = normal_equations(columns, price)
    made = []
    for strength in STRENGTHS:
        solution = _blocky_solution(normal, _penalty_scale(tests[0], tau_s, strength), one_way=sign != 0)
        changes = _changes(solution, normal.there)
        errors = np.array([np.sum(_residual_left(c, solution, i) ** 2) for i, c in enumerate(columns)])
        made.append(_Fit(sign, tau_s, strength, solution, errors, counted(changes, normal.there)))
    return made


def _residual_left(columns: SourceColumns, solution: Solution, test: int) -> Float1D:
    own = solution.source[test, : columns.source.shape[1]]
    return np.asarray(columns.residual - columns.source @ own - columns.known @ solution.known)


def _errors_without_source(tests: Sequence[SteppedTest], price: float) -> Float1D:
    """Squared error of each test with what the known effects can still do alone."""
    k = tests[0].known.shape[1]
    gram = sum((t.known.T @ t.known for t in tests), price * np.eye(k))
    c = np.linalg.solve(gram, sum((t.known.T @ t.residual for t in tests), np.zeros(k)))
    return np.array([np.sum((t.residual - t.known @ c) ** 2) for t in tests])


@dataclass(frozen=True, slots=True)
class _Criterion:
    """rows: of each test, (tests,). floor: mean squared error that is no evidence."""

    rows: Float1D
    floor: float

    def __call__(self, errors: Array, changes: Array, times: Float1D | None = None) -> Float1D:
        """Smaller is simpler; errors, changes: (..., tests). times: how often each test counts."""
        counted = np.ones(len(self.rows)) if times is None else times
        m = float(self.rows @ counted)
        worth = m * np.log(np.maximum(errors @ counted / m + self.floor, 1e-300)) + changes @ counted * np.log(m)
        return np.asarray(worth, dtype=np.float64)

    def simplest(self, fits: Sequence[_Fit], times: Float1D | None = None) -> _Fit:
        errors, changes = np.stack([f.errors for f in fits]), np.stack([f.changes for f in fits])
        return fits[int(np.argmin(self(errors, changes, times)))]


def _fits_of_draws(fits: Sequence[_Fit], judge: _Criterion, seed: int) -> list[_Fit]:
    """The choice made anew with tests drawn with replacement [efron1979]: how far it hangs on single tests."""
    rng, tests = np.random.default_rng(seed), len(judge.rows)
    draws = (np.bincount(rng.integers(0, tests, tests), minlength=tests) for _ in range(RESAMPLED))
    return [judge.simplest(fits, times.astype(np.float64)) for times in draws]


def _left_out_error(tests: Sequence[SteppedTest], best: _Fit, price: float) -> float:
    """Squared error in parts of each test that were left out in turn, every other one at a time; the first part of a
    test is always seen, for what the source was before is not known otherwise."""
    error = 0.0
    for turn in (0, 1):
        columns = []
        for t in tests:
            part = np.floor((t.t_s - t.edges[0]) / (PART_STEPS * (t.edges[1] - t.edges[0])))
            columns.append(source_columns(t, best.sign, best.tau_s, (part % 2 != turn) | (part == 0)))
        scale = _penalty_scale(tests[0], best.tau_s, best.strength)
        solution = _blocky_solution(normal_equations(columns, price), scale, one_way=best.sign != 0)
        error += sum(float(np.sum(_residual_left(c, solution, i)[~c.seen] ** 2)) for i, c in enumerate(columns))
    # the first parts, which none left out, with the error of the whole
    for i, t in enumerate(tests):
        first = t.t_s - t.edges[0] < PART_STEPS * (t.edges[1] - t.edges[0])
        error += float(np.sum(_residual_left(source_columns(t, best.sign, best.tau_s), best.solution, i)[first] ** 2))
    return error


def _course(test: SteppedTest, best: _Fit, place: int) -> Course:
    n = len(test.edges) - 1
    source = best.solution.source[place, :n]
    middles = (test.edges[1:] + test.edges[:-1]) / 2
    sign = best.sign or 1
    mean = float((box_columns(test.t_s, test.edges, best.tau_s) @ source).mean())
    contribution = sign * (box_columns(middles, test.edges, best.tau_s) @ source - mean)
    row = np.clip(np.floor((test.t_s - test.edges[0]) / (test.edges[1] - test.edges[0])).astype(np.int64), 0, n - 1)
    count = np.bincount(row, minlength=n)
    residual = np.where(count > 0, np.bincount(row, test.residual, minlength=n) / np.maximum(count, 1), np.nan)
    return Course(test.test, float(test.edges[0]), float(test.edges[1] - test.edges[0]), source, contribution, residual)
