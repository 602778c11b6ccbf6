"""What candidates would do, as columns: compressed, a test each, at every point of a grid, and kept between rankings.

The same candidates are ranked again beside a first effect; their columns do not change with what the model can do. Nor
do they, until what is free goes, with the axis that a probe looks along: all axes share them, where they share samples.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from thermodata.diagnosis.candidates.candidate_effect import CandidateEffect
from thermodata.diagnosis.candidates.grid import grid
from thermodata.diagnosis.question.problem import Problem
from thermodata.plugin import Float2D, Param

KEPT_BYTES = 256 * 2**20  # of columns; what is beyond is made anew

# who acts in which test, at which points and in which samples -> (columns, shape (m, k), and whose they are)
Means = dict[tuple[Any, ...], tuple[Any, ...]]


@dataclass(frozen=True, slots=True)
class Basis:
    """A candidate's columns. points: of the grid, without those that change nothing.

    own: a block each, shape (m, points, gains). others: shape (m, points, ways, gains), how each column differs where
    the effect acts faster or slower (`CandidateEffect.slack_params`).
    """

    points: list[dict[str, float]]
    own: list[NDArray[np.float64]]
    others: list[NDArray[np.float64]]

    @property
    def nbytes(self) -> int:
        return sum(a.nbytes for a in (*self.own, *self.others))


def sharing(problem: Problem, means: Means) -> Problem:
    """The same, beside other questions to the same tests: what candidates do in these is kept for all of them."""
    return replace(problem, kept={**problem.kept, "means": means})


def basis(problem: Problem, candidate: CandidateEffect) -> Basis:
    """From what the problem keeps, or made."""
    bases = problem.kept.setdefault("basis", {})
    kept = bases.get(id(candidate))
    if kept is not None and kept[0] is candidate:
        found: Basis = kept[1]
        return found
    made = _make_basis(problem, candidate)
    size = made.nbytes
    if sum(taken for *_, taken in bases.values()) + size <= KEPT_BYTES:
        bases[id(candidate)] = candidate, made, size
    return made


def _make_basis(problem: Problem, candidate: CandidateEffect) -> Basis:
    points = grid(_acting_params(problem, candidate), problem.step_s)
    held = {p.name: p.start for p in candidate.effect.params}
    points = [{**held, **p} for p in points]
    asked = [q for p in points for q in (p, *candidate.slack_params(p))]
    gains = len(candidate.effect.gains)
    compressed = [
        block.freed(mean).reshape(block.size, len(points), -1, gains)
        for block, mean in zip(problem.blocks, _effect_at_points(problem, candidate, asked), strict=True)
    ]
    place = _first_alike(compressed)
    kept = sorted(set(place))
    own = [np.ascontiguousarray(each[:, kept, 0]) for each in compressed]
    others = [each[:, kept, 1:] - each[:, kept, :1] for each in compressed]
    return Basis([points[i] for i in kept], own, others)


def _effect_at_points(
    problem: Problem, candidate: CandidateEffect, asked: Sequence[Mapping[str, float]]
) -> Iterator[Float2D]:
    """What it does at each of the points asked, a block each, shape (m, columns); from what the problem keeps for other
    responses (`sharing`), or made."""
    kept = problem.kept.get("means", {})
    who = candidate.effect if candidate.within is None else candidate
    where = tuple(candidate.binding.items()), tuple(tuple(q.values()) for q in asked)
    keys = [(id(who), id(b.test), where, b.group.tobytes()) for b in problem.blocks]
    # parts of one test share its columns
    tests = {id(b.test): b.test for b, key in zip(problem.blocks, keys, strict=True) if key not in kept}
    made = dict(zip(tests, candidate.in_tests(list(tests.values()), asked), strict=True))
    for block, key in zip(problem.blocks, keys, strict=True):
        test = block.test
        if key in kept:
            yield kept[key][0]
            continue
        mean = block.mean(made[id(test)])
        if mean.nbytes * len(kept) <= KEPT_BYTES:
            kept[key] = mean, who, test  # an id is one's own as long as one lives
        yield mean


def _acting_params(problem: Problem, candidate: CandidateEffect) -> list[Param]:
    """The parameters that change a column in any test: an exponent of a speed means nothing where a temperature drives
    the effect, and a grid of time constants alone is finer."""
    params = candidate.effect.params
    if len(params) < 2:
        return list(params)
    held = {p.name: p.start for p in params}
    left, tests = list(params), {id(b.test): b.test for b in problem.blocks}
    for test in tests.values():
        at = candidate.in_test(test)
        left = [p for p in left if np.array_equal(at({**held, p.name: p.lower}), at({**held, p.name: p.upper}))]
        if not left:
            break
    return [p for p in params if p not in left] or list(params)


def _first_alike(compressed: Sequence[NDArray[np.float64]]) -> list[int]:
    """For each grid point the first one with the same columns in all tests: an exponent of a speed means nothing
    where a temperature drives the effect."""
    place: list[int] = []
    for i in range(compressed[0].shape[1]):
        alike = (j for j in sorted(set(place)) if all(np.array_equal(c[:, i], c[:, j]) for c in compressed))
        place.append(next(alike, i))
    return place
