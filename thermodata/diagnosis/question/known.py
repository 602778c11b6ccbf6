"""What the model can do already, as a Gaussian prior: its gains freely, other time constants at a price."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import astuple, dataclass, field, replace
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from thermodata.diagnosis.question.directions import Products, Weighted, log_evidence
from thermodata.diagnosis.question.discrepancy import (
    LEAST_WHITE,
    Noise,
    Whitened,
    ascend,
    bounds_of,
    cholesky,
    halved,
    inverse,
    left_over,
    whitened,
)
from thermodata.diagnosis.question.problem import Problem
from thermodata.modelling.terms.rms import rms
from thermodata.plugin import Float1D, Float2D, Int1D

FloatND = NDArray[np.float64]

GAIN = 2.0  # prior standard deviation of a known effect's gain, as a multiple of its fit,
SEARCHED = 700  # rows that the noise is estimated from
FREE = 1.0  # or of what would make it as large as the response: an effect that another one hides has a small fit


@dataclass(frozen=True, slots=True)
class Others:
    """What all tests but one say of the known effects, for each in turn. inverse: of the factors of their posterior
    precision, shape (tests, k, k). mean: coefficients, (tests, k)."""

    inverse: FloatND
    mean: Float2D

    def halved(self, right: FloatND) -> FloatND:
        """The inverse factor of each times the right sides, shape (tests, ..., k)."""
        rows = right.reshape(len(right), math.prod(right.shape[1:-1]), right.shape[-1])
        return np.asarray((rows @ self.inverse.swapaxes(1, 2)).reshape(right.shape))

    def solved(self, right: Float2D) -> Float2D:
        """The inverse precision of each times the right side, shape (tests, k)."""
        return np.asarray((self.halved(right)[:, None] @ self.inverse)[:, 0])


@dataclass(frozen=True, slots=True)
class Known:
    """The known effects under a noise. held: their columns in all tests, (rows, k). both: the same and, last, the
    response, whitened, (rows, k + 1). gram: shape (tests, k, k). cross: (tests, k), with the response. energy:
    (tests,). precision: (k,), of the prior. of_all: products with candidates, of all tests, by whose they are. Factors
    and means are asked beside each candidate, and kept, by tests."""

    problem: Problem
    space: Whitened
    held: Float2D
    both: Float2D
    gram: FloatND
    cross: Float2D
    energy: Float1D
    precision: Float1D
    of_all: dict[int, tuple[object, Any]] = field(default_factory=dict, init=False, repr=False, compare=False)
    _factors: dict[bytes, Float2D] = field(default_factory=dict, init=False, repr=False, compare=False)
    _means: dict[bytes, Float1D] = field(default_factory=dict, init=False, repr=False, compare=False)
    _others: list[Others] = field(default_factory=list, init=False, repr=False, compare=False)

    def factor(self, tests: Int1D) -> Float2D:
        """Cholesky factor of the posterior precision, from some tests, shape (k, k)."""
        key = tests.tobytes()
        if key not in self._factors:
            self._factors[key] = cholesky(self.gram[tests].sum(axis=0) + np.diag(self.precision))
        return self._factors[key]

    def mean(self, tests: Int1D) -> Float1D:
        """Coefficients that some tests and the prior give, shape (k,)."""
        key = tests.tobytes()
        if key not in self._means:
            self._means[key] = solved(self.factor(tests), self.cross[tests].sum(axis=0)[:, None])[:, 0]
        return self._means[key]

    @property
    def every(self) -> Int1D:
        """The numbers of all tests, shape (tests,)."""
        return np.arange(len(self.gram))

    @property
    def of_others(self) -> Others:
        """The same of all tests but one, for each in turn."""
        if not self._others:
            each = others_of_each(self.gram) + np.diag(self.precision)
            found = Others(np.stack([inverse(cholesky(one)) for one in each]), np.empty_like(self.cross))
            self._others.append(replace(found, mean=found.solved(others_of_each(self.cross))))
        return self._others[0]

    @property
    def white(self) -> Float2D:
        """The columns alone, shape (rows, k)."""
        return self.both[:, :-1]

    @property
    def response(self) -> Float1D:
        """Whitened, shape (rows,)."""
        return self.both[:, -1]

    @property
    def left_out(self) -> float:
        """RMS error of tests that are left out in turn, each alike, in the response's unit."""
        return float(np.sqrt(np.mean(self.squares_left_out)))

    @property
    def squares_left_out(self) -> Float1D:
        """Mean square of the error of each test that is left out, shape (tests,)."""
        left = np.concatenate(self.problem.response_blocks) - self.does(self.of_others.mean)
        return np.asarray(self.space.each(left**2) / self.space.sizes)

    def does(self, coefficients: Float2D) -> Float1D:
        """What the known effects do in all tests by coefficients of each, shape (tests, k): shape (rows,)."""
        return np.concatenate([self.held[rows] @ one for rows, one in zip(self.space.parts, coefficients, strict=True)])

    def log_probability(self, tests: Int1D) -> float:
        """Of some tests, but for terms of the noise and the prior: for differences between sets of known effects that
        share the noise, or between tests."""
        factor = self.factor(tests)
        half = halved(factor, self.cross[tests].sum(axis=0)[:, None])[:, 0]
        return float(0.5 * half @ half - np.log(np.diag(factor)).sum() - 0.5 * self.energy[tests].sum())

    @property
    def log_evidence(self) -> float:
        """Of the response, offsets integrated out."""
        of_all = self.gram.sum(axis=0), self.cross.sum(axis=0), float(self.energy.sum())
        return log_evidence(*of_all, self.space.logdet, self.space.rows, self.precision)


def known(problem: Problem, noise: Noise) -> Known:
    """The known effects and the response of each test, whitened by the noise, with their products."""
    space = whitened(problem, noise)
    held = problem.known
    both = space.of(np.column_stack([held, np.concatenate(problem.response_blocks)]))
    products = np.stack([both[rows].T @ both[rows] for rows in space.parts])
    return Known(
        problem,
        space,
        held,
        both,
        products[:, :-1, :-1],
        products[:, :-1, -1],
        products[:, -1, -1],
        _precision(_gain_deviations(problem), problem.blocks[0].slack.shape[1], noise.share),
    )


def likeliest(problem: Problem, start: Noise | None = None) -> Noise:
    """The noise of the largest evidence, by a search along each of its numbers in turn; of some `SEARCHED` rows."""
    every = np.arange(problem.blocks[0].base.shape[1] + problem.blocks[0].slack.shape[1])
    return likeliest_of(problem, [every], start)[0]


def likeliest_of(problem: Problem, parts: Sequence[Int1D], start: Noise | None = None) -> list[Noise]:
    """The same beside each of some parts of what is known: indices of its columns, of base and slack together. The
    searches pass through the same noises, and each is whitened once."""
    every = max(1, round(problem.rows / SEARCHED))
    thin = _thinned(problem, every) if every > 1 else problem
    first, bounds = bounds_of(problem)
    tests = Weighted(thin)
    gains, slack = _gain_deviations(thin), thin.blocks[0].slack.shape[1]
    made: dict[bytes, Products] = {}

    def products(x: Float1D) -> Products:
        # the price of other time constants changes no covariance
        key = np.round(x[:3], 9).tobytes()
        if key not in made:
            made[key] = tests.products(_noise_at(x))
        return made[key]

    def evidence(x: Float1D, part: Int1D) -> float:
        gram, cross, energy, logdet, rows = products(x)
        precision = _precision(gains, slack, float(np.exp(x[3])))[part]
        return log_evidence(gram[part[:, None], part], cross[part], energy, logdet, rows, precision)

    begin = np.log(astuple(first if start is None else start))
    found = [_noise_at(ascend(partial(evidence, part=part), begin, bounds)) for part in parts]
    least = LEAST_WHITE * left_over(problem)
    return [replace(noise, white=max(noise.white, least)) for noise in found]


def _noise_at(x: Float1D) -> Noise:
    return Noise(*(float(v) for v in np.exp(x)))


def _thinned(problem: Problem, every: int) -> Problem:
    """What its samples alone say is kept with the whole problem, for the next search."""
    kept = problem.kept.setdefault("thinned", {}).setdefault(every, {})
    return replace(problem.thinned(every), kept=kept)


def others_of_each(parts: FloatND) -> FloatND:
    """The sum of all parts but one, for each in turn, shape (tests, ...) as the parts: of those before and after it,
    for a difference to the whole would lose digits."""
    before, after = np.zeros_like(parts), np.zeros_like(parts)
    np.cumsum(parts[:-1], axis=0, out=before[1:])
    np.cumsum(parts[:0:-1], axis=0, out=after[-2::-1])
    return before + after


def solved(factor: Float2D, right: Float2D) -> Float2D:
    """(L L')^-1 times the right side, shape (k, columns)."""
    return halved(factor, halved(factor, right), transposed=True)


def _gain_deviations(problem: Problem) -> Float1D:
    """Prior standard deviation of each known gain, as a multiple of its fit."""
    large = rms(problem.response_blocks)
    own = np.sqrt(np.mean(np.vstack([b.base for b in problem.blocks]) ** 2, axis=0))
    return np.asarray(np.maximum(GAIN, FREE * large / np.maximum(own, 1e-9 * large + 1e-300)))


def _precision(gains: Float1D, slack: int, share: float) -> Float1D:
    """Of the prior. slack: how many columns are other time constants. share: their prior standard deviation."""
    return np.concatenate([gains**-2.0, np.full(slack, share**-2.0)])
