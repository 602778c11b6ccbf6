"""A test in steps of a source: averaged to a few rows a step, and what each step of the source does in it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from thermodata.diagnosis.question.problem import Block, Problem, freed
from thermodata.diagnosis.unlogged.one_way import Normal
from thermodata.plugin import Bool1D, Float1D, Float2D, Int1D
from thermodata.view.grid.dataset import TestData

STEPS_A_TEST = 64  # of the source, in the longest test
SHORTEST_STEP_S = 300.0
ROWS_A_STEP = 2


@dataclass(frozen=True, slots=True)
class SteppedTest:
    """One test, averaged to two rows a step. t_s, residual: shape (m,); known: (m, k), what the model can still do;
    segment: (m,), one free offset each; edges: (n + 1,), of the steps [s]."""

    test: TestData
    t_s: Float1D
    residual: Float1D
    known: Float2D
    segment: Int1D
    edges: Float1D


def box_columns(t_s: Float1D, edges: Float1D, tau_s: float) -> Float2D:
    """F_tau of a source of 1 in each step, shape (m, n): t_s (m,), edges (n + 1,) [s]; at rest before the first."""
    since = t_s[:, None] - edges[None, :]
    risen = np.where(since > 0, -np.expm1(-np.maximum(since, 0.0) / tau_s), 0.0)
    return np.asarray(risen[:, :-1] - risen[:, 1:])


def in_steps(problem: Problem) -> list[SteppedTest]:
    """Every test. Parts of one test are one test here, each with its own offset: the source goes on between them."""
    of_test: dict[tuple[str, str], list[Block]] = {}
    for block in problem.blocks:
        of_test.setdefault(block.test.key, []).append(block)
    longest = max((float(b.t_s[-1] - b.test.t_s[0]) for b in problem.blocks), default=0.0)
    step_s = max(SHORTEST_STEP_S, 2 * problem.step_s, longest / STEPS_A_TEST)
    return [_averaged_over_steps(blocks, step_s) for blocks in of_test.values()]


def _averaged_over_steps(blocks: Sequence[Block], step_s: float) -> SteppedTest:
    start = float(blocks[0].test.t_s[0])
    t_s = np.concatenate([b.t_s for b in blocks])
    first = np.cumsum([0, *(int(b.segment.max()) + 1 for b in blocks)])
    segment = np.concatenate([b.segment + first[i] for i, b in enumerate(blocks)])
    columns = np.vstack([np.column_stack([b.t_s, b.residual, b.base, b.slack]) for b in blocks])
    place = np.floor((t_s - start) / (step_s / ROWS_A_STEP)).astype(np.int64)
    names, row = np.unique(np.column_stack([segment, place]), axis=0, return_inverse=True)
    row = row.ravel()
    mean = np.zeros((len(names), columns.shape[1]))
    np.add.at(mean, row, columns)
    mean /= np.bincount(row, minlength=len(names))[:, None]
    steps = int(np.floor((float(t_s.max()) - start) / step_s)) + 1
    segment = names[:, 0].astype(np.int64)
    free = freed(mean[:, 1:], blocks[0].test, mean[:, 0], segment)
    return SteppedTest(
        blocks[0].test, mean[:, 0], free[:, 0], free[:, 1:], segment, start + step_s * np.arange(steps + 1.0)
    )


@dataclass(frozen=True, slots=True)
class SourceColumns:
    """A test's source columns (m, n), known columns (m, k) and residual (m,), each from its mean over `seen`, (m,)."""

    source: Float2D
    known: Float2D
    residual: Float1D
    seen: Bool1D


def source_columns(test: SteppedTest, sign: int, tau_s: float, seen: Bool1D | None = None) -> SourceColumns:
    """sign: 1, -1, or 0 for both ways. seen: the rows that count, all by default."""
    source = (sign or 1) * box_columns(test.t_s, test.edges, tau_s)
    if seen is None:
        free = freed(source, test.test, test.t_s, test.segment)
        return SourceColumns(free, test.known, test.residual, np.ones(len(test.t_s), dtype=np.bool_))
    both = np.column_stack([test.residual, test.known, source])
    for one in np.unique(test.segment):
        rows = test.segment == one
        if (rows & seen).any():
            both[rows] -= both[rows & seen].mean(axis=0)
    k = test.known.shape[1]
    return SourceColumns(both[:, 1 + k :], both[:, 1 : 1 + k], both[:, 0], seen)


def normal_equations(columns: Sequence[SourceColumns], price: float) -> Normal:
    """Of all tests. price: of a coefficient of the known effects, squared."""
    n, k = max(c.source.shape[1] for c in columns), columns[0].known.shape[1]
    gram, cross = np.zeros((len(columns), n, n)), np.zeros((len(columns), n, k))
    aim, there = np.zeros((len(columns), n)), np.zeros((len(columns), n), dtype=np.bool_)
    shared, shared_aim = price * np.eye(k), np.zeros(k)
    for i, c in enumerate(columns):
        a, x, r = c.source[c.seen], c.known[c.seen], c.residual[c.seen]
        own = slice(0, a.shape[1])
        gram[i, own, own], cross[i, own], aim[i, own], there[i, own] = a.T @ a, a.T @ x, a.T @ r, True
        shared, shared_aim = shared + x.T @ x, shared_aim + x.T @ r
    return Normal(gram, cross, aim, shared, shared_aim, there)
