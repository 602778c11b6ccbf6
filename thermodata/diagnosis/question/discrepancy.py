"""What a response does that no column explains: white noise and slow noise a test, and free offsets.

    y = X b + offset + s(t) + e,    cov s = ou^2 exp(-|dt| / tau),    var e = white^2

Slow noise is an Ornstein-Uhlenbeck process: what drifts, and what a sum of lags leaves of a distributed machine. It is
what makes a long test worth its effective number of samples, not its rows. Sources: [uhlenbeck1930]; a discrepancy
beside a model: [kennedy2001]. Offsets have a flat prior, so all products are taken after they are projected out
(restricted likelihood [patterson1971]).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg.lapack import dpotrf, dtrtri, dtrtrs

from thermodata.diagnosis.question.chain import chain_of, sound
from thermodata.diagnosis.question.problem import Block, Problem, start_directions
from thermodata.modelling.terms.rms import rms
from thermodata.plugin import Float1D, Float2D

# a model is never better than this share of what it leaves: without it, a misfit of 0.05 um that repeats outweighs all
LEAST_WHITE = 0.1
# bounds of the search, as multiples of what the model leaves; of tau in seconds
WHITE = (1e-3, 1.0)
SLOW = (1e-2, 4.0)
TAU_S = (600.0, 96 * 3600.0)
SHARE = (0.03, 3.0)
START_TAU_S = 7200.0


KEPT_BYTES = 64 << 20  # of whitened columns, a noise: those of 25 channels take 25 MB
NEAR = 1 << 17  # values that are whitened at once
PIECE = 320  # rows of which products are taken at once
SPACES = 3  # noises whose columns are kept: what is chosen is asked in two by turns, and of a third between


@dataclass(frozen=True, slots=True)
class Noise:
    """white, slow: standard deviations in the response's unit. tau_s: memory of the slow noise. share: how much of a
    known effect may act otherwise than by its fitted lag (prior standard deviation)."""

    white: float
    slow: float
    tau_s: float
    share: float


class Whitened:
    """The tests of a problem under one noise. rows: that are left once the offsets are known. logdet: of the
    covariance, offsets included. parts: the samples of each test among all; sizes: how many, shape (tests,). kept: what
    was whitened already and is asked again beside other effects, by who asks, `KEPT_BYTES` at most. products: of these
    with each other, by who asks them."""

    def __init__(self, problem: Problem, noise: Noise) -> None:
        self.noise = noise
        self.parts = problem.parts
        self.sizes = np.array([len(b.t_s) for b in problem.blocks])
        self.kept: dict[int, tuple[object, Float2D]] = {}
        self.products: dict[int, tuple[object, NDArray[np.float64]]] = {}
        self._room = KEPT_BYTES
        self._chain = chain_of([b.t_s for b in problem.blocks], noise.white, noise.slow, noise.tau_s)
        self._offsets: list[Float2D] = []
        self.rows, self.logdet = 0, self._chain.logdet
        whole, counts = _free_of_all(problem)
        white = self._chain.halved(whole)
        for rows, count in zip(self.parts, counts, strict=True):
            q, sizes = _orthogonal(white[rows, :count])
            self._offsets.append(q)
            self.logdet += 2 * float(np.log(sizes).sum())
            self.rows += len(q) - count

    def of(self, columns: Float2D) -> Float2D:
        """Columns of all tests, shape (rows, k), in units of the noise, without what an offset explains."""
        return self.projected(self._chain.halved(columns)) if columns.size else columns

    def of_each(self, asked: Sequence[tuple[object, Float2D]]) -> list[Float2D]:
        """The same of each of several askers, whitened at once, shape (rows, columns) each. An asker lives as long as
        this."""
        lacking = [(who, columns) for who, columns in asked if id(who) not in self.kept]
        ends = np.cumsum([columns.shape[1] for _, columns in lacking])
        made = {id(who): np.empty(columns.shape) for who, columns in lacking}
        for first, last in self._runs_of_tests(int(ends[-1]) if lacking else 0):
            rows = slice(self.parts[first].start, self.parts[last].stop)
            white = self._chain.part(first, last).halved(np.hstack([columns[rows] for _, columns in lacking]))
            together = self.projected(white, first)
            for (who, _), own in zip(lacking, np.hsplit(together, ends[:-1]), strict=True):
                made[id(who)][rows] = own
        for who, _ in lacking:
            white = made[id(who)]
            if white.nbytes <= self._room:
                self._room -= white.nbytes
                self.kept[id(who)] = who, white
        return [made[id(who)] if id(who) in made else self.kept[id(who)][1] for who, _ in asked]

    def each(self, values: Float1D | Float2D) -> NDArray[np.float64]:
        """The sum of values of all tests, shape (rows, ...), in each of them, shape (tests, ...)."""
        return np.asarray(np.add.reduceat(values, [rows.start for rows in self.parts], axis=0))

    def product(self, left: Float2D, right: Float2D) -> Float2D:
        """Of the columns of both, shapes (rows, k) and (rows, s): shape (k, s). Piece by piece: of long columns the
        library makes less than of what is near the processor."""
        pieces = (slice(i, i + PIECE) for i in range(0, len(left), PIECE))
        return np.asarray(sum(left[rows].T @ right[rows] for rows in pieces))

    def projected(self, white: Float2D, first: int = 0) -> Float2D:
        """Columns in units of the noise, shape (rows, k), of a test and as many that follow as there are rows, less
        what an offset explains, in their place."""
        begin = 0
        for free in self._offsets[first:]:
            own = white[begin : begin + len(free)]
            if not len(own):
                break
            own -= free @ (free.T @ own)
            begin += len(free)
        return white

    def _runs_of_tests(self, columns: int) -> Iterator[tuple[int, int]]:
        """The first and the last of tests that follow each other, of which so many columns stay near the processor."""
        first = 0
        for last in range(len(self.parts) if columns else 0):
            begin = self.parts[first].start
            if last + 1 == len(self.parts) or (self.parts[last + 1].stop - begin) * columns > NEAR:
                yield first, last
                first = last + 1


def whitened(problem: Problem, noise: Noise) -> Whitened:
    """Kept with the problem: the same samples are asked again beside other effects."""
    spaces: dict[Noise, Whitened] = problem.kept.setdefault("spaces", {})
    found = spaces.pop(noise, None) or Whitened(problem, noise)
    spaces[noise] = found
    while len(spaces) > SPACES:
        del spaces[next(iter(spaces))]
    return found


def _free_of_all(problem: Problem) -> tuple[Float2D, list[int]]:
    """(what is free in all tests, shape (rows, most columns), how many columns each has); of every noise the same."""
    kept: dict[str, tuple[Float2D, list[int]]] = problem.kept.setdefault("free", {})
    if "whole" not in kept:
        members = [free_of(b) for b in problem.blocks]
        counts = [m.shape[1] for m in members]
        kept["whole"] = np.vstack([np.pad(m, ((0, 0), (0, max(counts) - m.shape[1]))) for m in members]), counts
    return kept["whole"]


def _orthogonal(columns: Float2D) -> tuple[Float2D, Float1D]:
    """(orthonormal columns of the same span, the product of whose sizes is the root of their Gram determinant)."""
    if columns.shape[1] == 1:
        size = np.linalg.norm(columns, axis=0)
        return columns / size, size
    q, r = np.linalg.qr(columns)
    return q, np.abs(np.diag(r))


def halved(factor: Float2D, right: Float2D, *, transposed: bool = False) -> Float2D:
    """L^-1 times the right side, shape (k, columns), or L'^-1, for a lower Cholesky factor L, shape (k, k). Thousands
    of small ones: LAPACK itself, for what stands around it costs more than it does."""
    if not right.size:
        return right
    return sound(*dtrtrs(factor, right, lower=1, trans=int(transposed)))


def cholesky(precision: Float2D) -> Float2D:
    """The lower factor L of a matrix, shape (k, k), likewise."""
    return sound(*dpotrf(precision, lower=1)) if precision.size else precision


def inverse(factor: Float2D) -> Float2D:
    """L^-1 for a lower Cholesky factor L, shape (k, k)."""
    return sound(*dtrtri(factor, lower=1)) if factor.size else factor


def free_of(block: Block) -> Float2D:
    """A column for each free offset of a test, 1 where it counts, and what fades from a warm start, (m, columns)."""
    offsets = np.asarray(block.segment[:, None] == np.unique(block.segment)[None], dtype=np.float64)
    start = start_directions(block.test, block.t_s, block.segment)
    return np.hstack([offsets, start]) if start.size else offsets


def distances(problem: Problem, test: int) -> Float2D:
    """Between the samples of a test in time [s], shape (m, m)."""
    kept = problem.kept.setdefault("distances", {})
    if test not in kept:
        t = problem.blocks[test].t_s
        kept[test] = np.abs(t[:, None] - t[None])
    found: Float2D = kept[test]
    return found


def bounds_of(problem: Problem) -> tuple[Noise, Float2D]:
    """Where a search begins, and the bounds of the logarithms of its four numbers, shape (4, 2)."""
    rms = left_over(problem)
    white = max(problem.noise if np.isfinite(problem.noise) else 0.0, 0.02 * rms)
    longest = max(float(b.t_s[-1] - b.t_s[0]) for b in problem.blocks)
    least = min(TAU_S[0], longest / 20)  # a test of minutes has a slow noise of its own scale
    ends = [(WHITE[0] * rms, max(WHITE[1] * rms, 2 * white)), (SLOW[0] * rms, SLOW[1] * rms), (least, TAU_S[1]), SHARE]
    return Noise(white, rms, min(START_TAU_S, longest / 4), 0.5), np.log(ends)


def left_over(problem: Problem) -> float:
    """RMS of what the fitted model leaves, in the response's unit."""
    return rms([b.residual for b in problem.blocks]) + 1e-9


def ascend(goal: Callable[[Float1D], float], x: Float1D, bounds: Float2D, most: int = 90) -> Float1D:
    """A local maximum of a goal by steps that halve, shape (k,). x: its start, shape (k,); bounds: lower and upper
    ones, shape (k, 2); most: how often the goal is asked at about most."""
    low, high = bounds.T
    x = np.clip(x, low, high)
    best, step, asked = goal(x), 0.8, 1
    while step > 0.12 and asked < most:
        moved = False
        for way in _search_directions(len(x)):
            z = np.minimum(np.maximum(x + step * way, low), high)
            if (z == x).all():
                continue
            value = goal(z)
            asked += 1
            if value > best + 1e-3:
                best, x, moved = value, z, True
        step = step if moved else step / 2
    return x


def _search_directions(count: int) -> Sequence[Float1D]:
    """Along each axis, and along size and memory of the slow noise together: short records know their ratio only."""
    axes = [sign * axis for axis in np.eye(count) for sign in (1.0, -1.0)]
    both = np.zeros(count)
    both[1], both[2] = 0.5, 1.0
    return [*axes, both, -both]
