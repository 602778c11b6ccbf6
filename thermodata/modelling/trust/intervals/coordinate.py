"""What a profile holds at one value after another: a time constant or exponent that is searched, or a gain.

Like lags stay in order while one of them is held (see `labels`): beyond the border both are one lag.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Protocol

import numpy as np

from thermodata.modelling.least_squares.design import Nonlinear
from thermodata.modelling.least_squares.labels import SwappableLags
from thermodata.modelling.least_squares.search import Problem, search
from thermodata.plugin import Float1D

FAR = 1000.0  # of the response over the driver; a gain beyond is of two columns that undo each other
TOUCH = 1e-3  # of log(value): so near to the border a lag lies at it
THIN = 1e-6  # of its range is left at least to a lag that another one bounds


class Coordinate(Protocol):
    """What is held at one value after another."""

    @property
    def slots(self) -> tuple[int, ...]: ...
    @property
    def name(self) -> str: ...
    @property
    def unit(self) -> str: ...

    def at(self, problem: Problem, x: Float1D) -> float:
        """Where it stands at a point of the search."""

    def range(self, problem: Problem, x: Float1D) -> tuple[float, float]:
        """Within which it is looked at."""

    def held(self, problem: Problem, at: float, near: Float1D) -> Problem:
        """The same problem with it held, and like lags kept in order. near: a point of that problem."""

    def others(self, x: Float1D) -> Float1D:
        """What is searched beside it; shape (free parameters of the held problem,)."""

    def value(self, at: float) -> float:
        """In its own unit."""

    def pressed(self, x: Float1D, near: Float1D) -> bool:
        """Whether a point of the held problem is where it is only since like lags were kept in order about `near`."""

    def in_one(self, problem: Problem) -> float:
        """The least squared error where two like lags are one: the border between both orders."""


@dataclass(frozen=True)
class Searched:
    """A time constant or exponent: the free parameter of that place."""

    place: int
    free: Nonlinear
    like: Sequence[SwappableLags] = ()

    @property
    def slots(self) -> tuple[int, ...]:
        return self.free.slots

    @property
    def name(self) -> str:
        return self.free.param.name

    @property
    def unit(self) -> str:
        return self.free.param.unit

    def at(self, problem: Problem, x: Float1D) -> float:
        return float(x[self.place])

    def range(self, problem: Problem, x: Float1D) -> tuple[float, float]:
        return self.free.outside(self.free.lower), self.free.outside(self.free.upper)

    def held(self, problem: Problem, at: float, near: Float1D) -> Problem:
        held = [dict(h) for h in problem.held]
        for slot in self.free.slots:
            held[slot][self.free.param.name] = self.free.inside(at)
        free = [self._in_order(k, f, at) for k, f in enumerate(problem.free) if k != self.place]
        return replace(problem, free=free, held=held)

    def _in_order(self, k: int, other: Nonlinear, at: float) -> Nonlinear:
        if not any(k in found.places and self.place in found.places for found in self.like):
            return other
        return _below(other, at) if k < self.place else _above(other, at)

    def others(self, x: Float1D) -> Float1D:
        return np.delete(x, self.place)

    def value(self, at: float) -> float:
        return self.free.inside(at)

    def pressed(self, x: Float1D, near: Float1D) -> bool:
        return False  # its own value is the border, wherever it is looked at

    def in_one(self, problem: Problem) -> float:
        return float("inf")  # no border presses it, so nothing on one is less than what was found


@dataclass(frozen=True)
class Solved:
    """A gain: a column of the problem, of one slot."""

    column: int
    slot: int
    name: str
    unit: str
    like: Sequence[SwappableLags] = ()

    @property
    def slots(self) -> tuple[int, ...]:
        return (self.slot,)

    def at(self, problem: Problem, x: Float1D) -> float:
        return float(problem.gains(problem.matrix(x))[self.column])

    def range(self, problem: Problem, x: Float1D) -> tuple[float, float]:
        size = float(np.linalg.norm(problem.matrix(x)[:, self.column]))
        far = FAR * float(np.linalg.norm(problem.design.y)) / size if size > 0 else np.inf
        return max(float(problem.low[self.column]), -far), min(float(problem.high[self.column]), far)

    def held(self, problem: Problem, at: float, near: Float1D) -> Problem:
        low, high = problem.low.copy(), problem.high.copy()
        low[self.column] = high[self.column] = at
        free = list(problem.free)
        for a, b, border in self._borders(near):
            free[a], free[b] = _below(free[a], border), _above(free[b], border)
        return replace(problem, free=free, low=low, high=high)

    def _borders(self, near: Float1D) -> Iterator[tuple[int, int, float]]:
        """Half way between two neighbours, of lags that have a gain each."""
        for found in self.like:
            for a, b in pairwise(found.places) if found.columns else ():
                yield a, b, float(near[a] + near[b]) / 2

    def others(self, x: Float1D) -> Float1D:
        return x

    def value(self, at: float) -> float:
        return at

    def pressed(self, x: Float1D, near: Float1D) -> bool:
        return any(min(border - x[a], x[b] - border) < TOUCH for a, b, border in self._borders(near))

    def in_one(self, problem: Problem) -> float:
        least = np.inf
        for columns in (list(found.columns) for found in self.like if found.columns):
            low, high = problem.low.copy(), problem.high.copy()
            low[columns] = high[columns] = 0.0
            part = replace(problem, low=low, high=high)
            residual = part.residual(search(part, loose=True))
            least = min(least, float(residual @ residual))
        return least


def _below(free: Nonlinear, at: float) -> Nonlinear:
    low, high = free.outside(free.lower), free.outside(free.upper)
    return replace(free, upper=free.inside(max(min(high, at), low + THIN * (high - low))))


def _above(free: Nonlinear, at: float) -> Nonlinear:
    low, high = free.outside(free.lower), free.outside(free.upper)
    return replace(free, lower=free.inside(min(max(low, at), high - THIN * (high - low))))
