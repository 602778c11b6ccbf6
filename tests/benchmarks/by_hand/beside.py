"""What stands beside a candidate, the base and other members, and what left-out tests say of each candidate there."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from thermodata.plugin import Float1D, Float2D

from .asked import Asked, FloatND
from .chance import slow_noise
from .left_out import Fit, LeftOut, Products, Series, fit, left_out, products, series

STANDS_OUT = 0.5  # times what is left: a candidate acts where it does more,
ACTS = 0.2  # and this share of what it does in its largest test
LOOSE = 1.0  # prior standard deviation of a coefficient of the bank, as a multiple of the effect as fitted


@dataclass(frozen=True)
class Beside:
    """What stands beside a candidate. base: the bank of the known effects and of members, shape (rows, k). ridge: prior
    precision of each, (k,). numbers: candidates that are in it. made, own: products, of the response as measured.
    weight: of a row of each test, (tests,). noise: RMS of what is left [the response's unit]."""

    asked: Asked
    base: Float2D
    ridge: Float1D
    numbers: frozenset[int]
    made: Products = field(repr=False)
    own: Series = field(repr=False)
    weight: Float1D
    noise: float

    def left_out(self, made: Products | None = None, of: Series | None = None) -> LeftOut:
        """made, of: in place of its own, of another response or of parts of the tests."""
        return left_out(made or self.made, of or self.own, self.asked.candidates, self.weight_of(made), self.ridge)

    def weight_of(self, made: Products | None) -> Float1D:
        """Of each test the same, whatever its rows."""
        return self.weight if made is None else self.weight * self.made.rows / made.rows

    def whole(self) -> Fit:
        return fit(self.made, self.own, self.asked.candidates, self.weight, self.ridge)

    def shares(self, found: LeftOut) -> Float2D:
        """How much of the error each candidate takes off by the tests in which it acts, shape (candidates, s): of the
        geometric mean over all tests, so that each counts alike, however large its error."""
        acts = acting(found.does, self.noise)
        floor = self.asked.problem.noise**2
        ratio = (found.after + floor) / (found.before[:, None] + floor)
        fall = 1 - np.exp(np.where(acts, np.log(ratio), 0.0).mean(axis=0))
        fall[list(self.numbers)] = -np.inf
        return np.asarray(fall)


def acting(does: FloatND, noise: float) -> NDArray[np.bool_]:
    """does: mean squares, shape (tests, ...)."""
    return np.asarray((does >= (STANDS_OUT * noise) ** 2) & (does >= ACTS**2 * does.max(axis=0)))


def beside(asked: Asked, chosen: Sequence[tuple[int, int]]) -> Beside:
    """chosen: (number, point) of the candidates that stand beside the base."""
    made, large = asked.candidates, float(np.sqrt(np.mean(asked.response**2)))
    own = np.sqrt(np.mean(asked.base**2, axis=0))
    loose = np.maximum(LOOSE, large / np.maximum(own, 1e-9 * large))
    more = [made.bank[:, near(asked, *c)].reshape(len(asked.base), -1) for c in chosen]
    base = np.hstack([asked.base, *more])
    ridge = np.concatenate([loose**-2.0, np.ones(base.shape[1] - len(loose))])
    parts = asked.problem.parts
    together, of = products(base, made.bank, parts), series(base, made.bank, asked.response[:, None], parts)
    left, weight, noise = asked.response, np.ones(len(parts)), 1.0
    for _ in range(2):  # what is left says how much the samples of a test tell, and that what is left
        noise = max(float(np.sqrt(np.mean(left**2))), asked.problem.noise)
        weight = _effective(asked, left) / (together.rows * noise**2)
        left = asked.response - base @ fit(together, of, made, weight, ridge).base[:, 0]
    return Beside(asked, base, ridge, frozenset(n for n, _ in chosen), together, of, weight, noise)


def _effective(asked: Asked, left: Float1D) -> float:
    """As how many samples each test counts: those that are apart by twice the memory of what is left."""
    blocks = asked.problem.blocks
    memory = slow_noise(blocks, left).tau_s
    return float(np.median([1 + b.size * asked.problem.step_s / (2 * memory) for b in blocks]))


def near(asked: Asked, number: int, point: int) -> slice:
    """A member at its point and the two beside it, for a body is no single lag."""
    own = asked.candidates.of(number)
    return slice(max(point - 1, own.start), min(point + 2, own.stop))
