"""All that a fit estimates at once: the slope of its prediction to each parameter and gain, and how these scatter."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from dataclasses import dataclass

import numpy as np

from thermodata.modelling.least_squares.design import MOMENTS
from thermodata.modelling.least_squares.labels import swappable_lags
from thermodata.modelling.least_squares.search import Problem
from thermodata.modelling.trust.intervals.coordinate import Coordinate, Searched, Solved
from thermodata.modelling.trust.intervals.slow_noise import Scatter, make_noise, nothing
from thermodata.modelling.trust.intervals.start_unknown import disturbances
from thermodata.plugin import Float1D, Float2D

CARRIED = 0.1  # of log(value), or of the range: further than that no slope is straight
SPANNED = 1e-8  # of the most power of a direction: below, columns undo each other to four digits
LEAST = 1e-12  # likewise: below, they are one
ROUNDING = 1e-15  # likewise: below, nothing is told of it
STEP = 1e-4  # of a parameter's range, for its slope


@dataclass(frozen=True)
class Owner:
    """Of a column of the Jacobian: its slots and name, and what it is in the problem."""

    slots: tuple[int, ...]
    name: str
    of: Coordinate


class Estimate:
    """The Jacobian of the prediction to some searched parameters (all) and all free gains, and how they scatter."""

    def __init__(self, problem: Problem, x: Float1D, gains: Float1D, places: Iterable[int] | None = None) -> None:
        self.problem, self.x, self.gains = problem, x, gains
        design = problem.design
        matrix = problem.matrix(x)
        columns: list[Float1D] = []
        self.owners: list[Owner] = []
        like = swappable_lags(problem)
        for i in range(len(problem.free)) if places is None else places:
            nonlinear = problem.free[i]
            low, high = nonlinear.outside(nonlinear.lower), nonlinear.outside(nonlinear.upper)
            delta = STEP * (high - low) * (1.0 if x[i] + STEP * (high - low) < high else -1.0)
            trial = x.copy()
            trial[i] += delta
            columns.append((problem.matrix(trial) - matrix) @ gains / delta)
            self.owners.append(Owner(nonlinear.slots, nonlinear.param.name, Searched(i, nonlinear, like)))
        for s, slot in enumerate(design.slots):
            for j, gain in enumerate(design.terms[slot.term].effect.gains):
                k = problem.starts[s] + j
                if problem.low[k] < gains[k] < problem.high[k]:
                    columns.append(matrix[:, k])
                    self.owners.append(Owner((s,), gain.name, Solved(int(k), s, gain.name, gain.unit, like)))
        self.jacobian = np.column_stack(columns) if columns else np.zeros((design.n, 0))
        self.unknown = disturbances(design, problem.params(x), gains, problem.starts)
        self.noise = make_noise(self.jacobian, design.y - matrix @ gains, design.parts)
        self.scatter = self._scatter(self.jacobian)

        size = np.sqrt(np.sum(self.jacobian**2, axis=0))
        self.moves = size > 0
        size[~self.moves] = 1.0
        # columns that undo each other leave a direction that nobody knows: where it is most of what an interval is
        # wide by, slopes say nothing of it
        power, directions = np.linalg.eigh((self.jacobian / size).T @ (self.jacobian / size))
        top = float(power.max(initial=0.0))
        wide = directions**2 / np.maximum(power, ROUNDING * top) if top > 0 else directions
        self.known = wide[:, power < SPANNED * top].sum(axis=1) < 0.5 * wide.sum(axis=1)
        spans = power > LEAST * top
        inverse = (directions[:, spans] / power[spans]) @ directions[:, spans].T
        self.inverse = inverse / np.outer(size, size)
        self.places = {owner.of.place: k for k, owner in enumerate(self.owners) if isinstance(owner.of, Searched)}

    def _scatter(self, columns: Float2D) -> Scatter:
        if self.noise is None:
            return nothing(columns.shape[1])
        return self.noise.scatter(columns, self.problem.design.parts, self.unknown)

    def allowed(self, moved: Float1D) -> float:
        """Rise of the squared error at the ends of an interval of 95 %, where that moves the prediction so."""
        half = float(self._scatter(moved[:, None]).half[0])
        return half**2 * float(moved @ moved) if np.isfinite(half) else np.inf

    def slopes(self) -> Float2D | None:
        """Of the prediction to everything that is searched, shape (n, searched); None where something has none."""
        free = self.problem.free
        if len(self.places) < len(free) or any(f.points == MOMENTS for f in free):
            return None
        return self.jacobian[:, [self.places[i] for i in range(len(free))]]

    def along(self, k: int, movable: Collection[int]) -> Float1D:
        """How the searched parameters move with the estimate k where the error is quadratic; shape (searched,)."""
        moved = np.zeros(len(self.problem.free))
        for place, column in self.places.items():
            if place in movable:
                moved[place] = self.inverse[column, k] / self.inverse[k, k]
        return moved

    def carries(self, k: int, half: float) -> bool:
        """Whether an estimate that moves as far as its interval takes searched parameters along, so that what is
        linear in it alone is not so any more; or whether slopes say nothing of it."""
        if not self.known[k] or self.inverse[k, k] <= 0:
            return True
        far = half * self.along(k, self.places)
        return any(
            abs(by) > CARRIED * (1.0 if f.log else f.outside(f.upper) - f.outside(f.lower))
            for by, f in zip(far, self.problem.free, strict=True)
        )


def inside_bounds(problem: Problem, x: Float1D) -> list[int]:
    """Searched parameters that do not stand at a bound."""
    found = []
    for i, nonlinear in enumerate(problem.free):
        low, high = nonlinear.outside(nonlinear.lower), nonlinear.outside(nonlinear.upper)
        if low + 10 * STEP * (high - low) < x[i] < high - 10 * STEP * (high - low):
            found.append(i)
    return found
