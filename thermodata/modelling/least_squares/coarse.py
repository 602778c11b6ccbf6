"""Where a search starts on many samples: the optimum of the same problem on a coarser grid.

Time constants do not depend on the grid, so that the wide, expensive part of a search (the sweeps) need not run over
every sample; the optimum itself is always that of all samples.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from thermodata.modelling.least_squares.design import MOMENTS
from thermodata.modelling.least_squares.search import Problem, along_whole_range, search
from thermodata.plugin import Bool1D, Float1D
from thermodata.view.grid.dataset import TestData

MANY = 20_000  # samples in all tests from which on a coarse look is worth its while
ENOUGH = 3_000  # samples of the coarse look
LONGEST_S = 600.0  # of its steps
RESOLVED = 3.0  # a time constant below so many coarse steps is looked for again among all samples

Make = Callable[[Sequence[TestData]], Problem]


def search_from_coarse(problem: Problem, tests: Sequence[TestData], make: Make) -> Float1D:
    """As `search`; shape (free parameters,). make: the problem on other tests than its own."""
    factor = _factor(problem, tests)
    if factor < 2:
        return search(problem)
    coarse = make([coarser(test, factor) for test in tests])
    if not _have_same_parameters(problem, coarse):
        return search(problem)
    x = search(coarse)
    step_min = factor * _step_s(tests[0]) / 60.0
    for i, free in enumerate(problem.free):
        if free.log and free.inside(float(x[i])) < RESOLVED * step_min:
            x = along_whole_range(problem, x, i)
    return search(problem, start=x)


def rough(problem: Problem, tests: Sequence[TestData], wanted: tuple[str, ...] | None, make: Make) -> Problem | None:
    """The same problem on about ENOUGH samples, to look at the error around its optimum; None where it has few, or is
    not the same there."""
    some = coarse_tests(tests, wanted)
    if all(a is b for a, b in zip(some, tests, strict=True)):
        return None
    other = make(some)
    return other if _have_same_parameters(problem, other) else None


def _have_same_parameters(problem: Problem, other: Problem) -> bool:
    names = [[(f.param.name, len(f.slots)) for f in p.free] for p in (problem, other)]
    return names[0] == names[1] and other.design.n > 0


def coarse_tests(tests: Sequence[TestData], wanted: tuple[str, ...] | None) -> list[TestData]:
    """The tests with about as many samples as a choice needs; as they are where there are few. Declared phases go by
    time and stay; phases that are told from the machine's work would move with the grid."""
    total = sum(int(t.in_window.sum()) for t in tests)
    plain = wanted is None or all(t.phases for t in tests)
    factor = 1 if not tests or not plain else min(total // ENOUGH, min(len(t.t_s) for t in tests) // 50)
    factor = min(factor, int(LONGEST_S / _step_s(tests[0]))) if tests else 1
    return [coarser(t, factor) for t in tests] if factor > 1 else list(tests)


def coarser(test: TestData, factor: int) -> TestData:
    """Means of the valid samples of `factor` neighbours; what is left over at the end goes. Kept with the test: each
    fit looks at the same."""
    key = "coarser", factor
    if key not in test.kept:
        test.kept[key] = _coarser(test, factor)
    found: TestData = test.kept[key]
    return found


def _coarser(test: TestData, factor: int) -> TestData:
    n = len(test.t_s) // factor
    rows = n * factor

    def mean(values: Float1D, good: Bool1D) -> tuple[Float1D, Bool1D]:
        counts = good[:rows].reshape(n, factor).sum(axis=1)
        sums = np.where(good[:rows], values[:rows], 0.0).reshape(n, factor).sum(axis=1)
        return np.where(counts > 0, sums / np.maximum(counts, 1), np.nan), counts > 0

    values, valid = {}, {}
    for name, full in test.values.items():
        known = np.isfinite(full) & test.valid.get(name, np.ones(len(full), bool))
        values[name], valid[name] = mean(full, known)
    window = np.asarray(test.in_window[:rows].reshape(n, factor).all(axis=1))
    return replace(test, t_s=test.t_s[:rows:factor], values=values, valid=valid, in_window=window)


def _factor(problem: Problem, tests: Sequence[TestData]) -> int:
    if problem.design.n < MANY or not problem.free or any(f.points == MOMENTS for f in problem.free):
        return 1
    step = _step_s(tests[0])
    return max(1, min(problem.design.n // ENOUGH, int(LONGEST_S / step), min(len(t.t_s) for t in tests) // 50))


def _step_s(test: TestData) -> float:
    return float(test.t_s[1] - test.t_s[0]) if len(test.t_s) > 1 else 1.0
