"""The question that a diagnosis asks, as plain arrays: what the model leaves over, and what the model can still do.

Every test keeps only its measured samples, averaged to a coarse step, in order ("compressed"). Columns are
computed on the full grid first, so that lags see the time that was not measured.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import Any

import numpy as np

from thermodata.modelling.terms.nuisance import WARM, unknown_start
from thermodata.plugin import Bool1D, Float1D, Float2D, Int1D
from thermodata.schema.units.unit import difference_unit
from thermodata.view.grid.dataset import TestData

TARGET_ROWS = 9000
MIN_ROWS = 10
FEW_TESTS = 3
FOLDS_WANTED = 4
PART_ROWS = 100
ALIKE = 1e-4  # of the largest: decays that differ by less are one


@dataclass(frozen=True, slots=True)
class Block:
    """One test, or a part of one in time, compressed.

    t_s: shape (m,). response, residual: shape (m,), measured and left over by the fitted model, in the response's
    unit, without what is free (`freed`). base: shape (m, k), what the model can still do (its gains, and its nonlinear
    parameters to first order). slack: shape (m, s), what it may do at a price. segment: shape (m,), one free offset
    each. group: shape (n,), the compressed row of every row of the grid, -1 where it does not count.
    """

    test: TestData
    t_s: Float1D
    response: Float1D
    residual: Float1D
    base: Float2D
    slack: Float2D
    segment: Int1D
    group: Int1D
    size: int

    def compress(self, columns: Float2D) -> Float2D:
        """Columns on the full grid, shape (n, k), to this block's samples, shape (m, k), without what is free."""
        return self.freed(self.mean(columns))

    def mean(self, columns: Float2D) -> Float2D:
        """Columns on the full grid, shape (n, k), to this block's samples, shape (m, k)."""
        return _group_mean(columns, self.group, self.size)

    def freed(self, columns: Float2D) -> Float2D:
        """Columns, shape (m, k), without what is free."""
        return freed(columns, self.test, self.t_s, self.segment)

    def with_known(self, base: Float2D, slack: Float2D) -> Block:
        """The same with what the model can do, shapes (m, k) and (m, s)."""
        return replace(self, base=base, slack=slack)

    def without(self, rows: Bool1D) -> Block:
        """The same as if some of its samples, shape (m,), had not been measured."""
        kept = ~rows
        number = np.where(rows, -1, np.cumsum(kept) - 1)
        arrays = {n: getattr(self, n)[kept] for n in ("t_s", "response", "residual", "base", "slack", "segment")}
        group = np.where(self.group >= 0, number[self.group], -1)
        return replace(self, **arrays, group=group, size=int(kept.sum()))


@dataclass(frozen=True, slots=True)
class Problem:
    """All tests of one response. step_s: of the compressed samples, each the mean of so many of the grid (averaged).
    noise: short-term noise of the response on the grid.
    kept: what stays the same as long as samples and offsets do, by who made it: columns of candidates (`basis`),
    distances in time (`discrepancy`)."""

    response: str
    unit: str
    step_s: float
    blocks: tuple[Block, ...]
    noise: float
    averaged: int = 1
    kept: dict[str, dict[Any, Any]] = field(default_factory=dict, repr=False, compare=False)

    @property
    def response_blocks(self) -> list[Float1D]:
        """Of each test, in its unit, shape (m,) each."""
        return [b.response for b in self.blocks]

    @property
    def rows(self) -> int:
        """Samples that count, of all tests."""
        return sum(len(b.t_s) for b in self.blocks)

    @property
    def parts(self) -> list[slice]:
        """The samples of each test among those of all, one test after the other."""
        ends = np.cumsum([0, *(len(b.t_s) for b in self.blocks)]).tolist()
        return [slice(a, b) for a, b in pairwise(ends)]

    @property
    def known(self) -> Float2D:
        """What the model can still do in all tests, shape (rows, k + s): base and slack together."""
        return np.hstack([np.vstack([b.base for b in self.blocks]), np.vstack([b.slack for b in self.blocks])])

    def with_known(self, base: Float2D, slack: Float2D) -> Problem:
        """The same with further columns of all tests, shapes (rows, k) and (rows, s), among what the model can do."""
        base = np.hstack([np.vstack([b.base for b in self.blocks]), base])
        slack = np.hstack([np.vstack([b.slack for b in self.blocks]), slack])
        parts = zip(self.blocks, self.parts, strict=True)
        return replace(self, blocks=tuple(b.with_known(base[rows], slack[rows]) for b, rows in parts))

    @property
    def in_parts(self) -> bool:
        """Whether tests are cut into parts in time."""
        return len({b.test.key for b in self.blocks}) < len(self.blocks)

    def thinned(self, every: int) -> Problem:
        """Every n-th sample only: what is slow stays, and costs less. Its blocks compress nothing."""
        blocks = []
        for b in self.blocks:
            rows = slice(None, None, every) if len(b.t_s) >= MIN_ROWS * every else slice(None)
            arrays = {n: getattr(b, n)[rows] for n in ("t_s", "response", "residual", "base", "slack", "segment")}
            blocks.append(replace(b, **arrays))
        return replace(self, blocks=tuple(blocks), kept={})

    def split(self, at: dict[tuple[str, str], list[float]], parted_s: float = 0.0) -> Problem:
        """The same with further free offsets: after each of the times (s) found in a test. parted_s: nearer to one than
        this, a sample is the mean of what was before and after it, and is left out; 0 where none is."""
        blocks = []
        for block in self.blocks:
            times = at.get(block.test.key, [])
            if times and parted_s:
                block = block.without(_distances_to_nearest(block.t_s, times) < parted_s)
            segment = np.searchsorted(np.sort(np.asarray(times, dtype=float)), block.t_s, side="right").astype(np.int64)
            both = np.column_stack([block.response, block.residual, block.base, block.slack])
            free, k = freed(both, block.test, block.t_s, segment), 2 + block.base.shape[1]
            blocks.append(
                replace(
                    block,
                    segment=segment,
                    response=free[:, 0],
                    residual=free[:, 1],
                    base=free[:, 2:k],
                    slack=free[:, k:],
                )
            )
        return replace(self, blocks=tuple(blocks), kept={})


def _distances_to_nearest(t_s: Float1D, times: Sequence[float]) -> Float1D:
    """How far the nearest of some times is, shape (m,)."""
    return np.asarray(np.abs(t_s[:, None] - np.asarray(times)[None, :]).min(axis=1))


def freed(columns: Float2D, test: TestData, t_s: Float1D, segment: Int1D) -> Float2D:
    """Columns, shape (m, k), without what nobody knows of a test: an offset in each segment, and, where it began warm,
    what fades from its start."""
    result = center(columns, segment)
    start = start_directions(test, t_s, segment)
    return result - start @ (start.T @ result) if start.size else result


def start_directions(test: TestData, t_s: Float1D, segment: Int1D) -> Float2D:
    """An orthonormal basis of what fades from the start beside the offsets, shape (m, directions): (m, 0) where a test
    began at balance, or is too short to tell."""
    if test.start_state != WARM:
        return np.empty((len(t_s), 0))
    decays = unknown_start(test, t_s)
    if not decays.size or len(t_s) <= decays.shape[1] + len(np.unique(segment)):
        return np.empty((len(t_s), 0))
    directions, size, _ = np.linalg.svd(center(decays, segment), full_matrices=False)
    return np.asarray(directions[:, size > ALIKE * size[0]])


def center(columns: Float2D, segment: Int1D) -> Float2D:
    """Columns, shape (m, k), minus their mean in each segment."""
    result = np.array(columns, dtype=np.float64, copy=True)
    segments = np.unique(segment)
    if len(segments) == 1 and result.flags.c_contiguous:
        result -= result.mean(axis=0)
        return result
    for one in segments:
        rows = segment == one
        result[rows] -= result[rows].mean(axis=0)
    return result


def _group_mean(columns: Float2D, group: Int1D, size: int) -> Float2D:
    """Groups follow each other in time, and none is empty."""
    if not size:
        return np.empty((0, columns.shape[1]))
    used = group >= 0
    numbers = group[used]
    starts = np.searchsorted(numbers, np.arange(size))
    many = np.diff(starts, append=len(numbers))
    counted = columns if len(numbers) == len(group) and columns.flags.c_contiguous else columns[used]
    result: Float2D = np.add.reduceat(counted, starts) / many[:, None]
    return result


Base = Callable[[TestData], Float2D]


@dataclass(frozen=True, slots=True)
class Explained:
    """A response that a model explains, as functions of a test with n rows. measured, residual: shape (n,), in `unit`;
    mask: shape (n,), the samples that count; base, slack: shapes (n, k) and (n, s), as in a `Block`."""

    response: str
    unit: str
    measured: Callable[[TestData], Float1D]
    residual: Callable[[TestData], Float1D]
    mask: Callable[[TestData], Bool1D]
    base: Base
    slack: Base


def build_problem(explained: Explained, tests: Sequence[TestData], step_s: float, rows: int = TARGET_ROWS) -> Problem:
    """Compress every test. step_s: of the tests' grid. rows: of all tests together, at most, but for what a step cannot
    divide."""
    masks = {t.key: explained.mask(t) for t in tests}
    total = sum(int(m.sum()) for m in masks.values())
    every = max(1, -(-total // rows))
    usable = [t for t in tests if masks[t.key].sum() >= MIN_ROWS]
    blocks: list[Block] = []
    noises: list[float] = []
    for test in usable:
        mask, left = masks[test.key], explained.residual(test)
        noises.append(_short_noise(left[mask]))
        both = np.nan_to_num(np.column_stack([explained.measured(test), left]))
        base, slack = explained.base(test), explained.slack(test)
        for keep in _parts_in_time(mask, len(usable)):
            block = _empty_block(test, keep, every)
            y = block.compress(both)
            filled = block.with_known(block.compress(base), block.compress(slack))
            blocks.append(replace(filled, response=y[:, 0], residual=y[:, 1]))
    noise = float(np.median(noises)) if noises else float("nan")
    return Problem(explained.response, difference_unit(explained.unit), step_s * every, tuple(blocks), noise, every)


def _empty_block(test: TestData, keep: Bool1D, every: int) -> Block:
    """The rows of a test that are kept, shape (n,), the mean of so many each, with nothing in them yet."""
    names, group_of_kept = np.unique((np.arange(len(test.t_s)) // every)[keep], return_inverse=True)
    group = np.full(len(test.t_s), -1, dtype=np.int64)
    group[keep] = group_of_kept
    empty, none, size = np.empty(0), np.empty((0, 0)), len(names)
    t_s = _group_mean(test.t_s[:, None], group, size)[:, 0]
    return Block(test, t_s, empty, empty, none, none, np.zeros(size, dtype=np.int64), group, size)


def _parts_in_time(mask: Bool1D, tests: int) -> list[Bool1D]:
    """Where tests are few, parts of one in time stand for tests: each with an offset of its own, left out in turn."""
    count = min(-(-FOLDS_WANTED // tests), int(mask.sum()) // PART_ROWS) if tests < FEW_TESTS else 1
    if count < 2:
        return [mask]
    rank = np.cumsum(mask) - 1
    part = rank * count // int(mask.sum())
    return [mask & (part == i) for i in range(count)]


def _short_noise(values: Float1D) -> float:
    """Standard deviation of the noise between neighbouring samples, robust (second differences)."""
    if len(values) < 8:
        return float("nan")
    second = np.diff(values, 2)
    return float(np.median(np.abs(second - np.median(second))) * 1.4826 / np.sqrt(6.0))
