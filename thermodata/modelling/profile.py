"""The error over the whole range of one time constant, all else fitted anew at each value: its profile.

A deviation makes an interval that reaches as far up as down. Where a test is too short for a lag, the error falls
steeply on one side and hardly rises on the other, and only the profile tells where the data end. The error may rise as
much as a quadratic one would up to the ends of its own interval, correlated residuals and all, so that both intervals
are the same where the error is quadratic. Source: [bates1988], and for what correlation does [chandler2007]
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from thermodata.modelling.fitted_response import Ends
from thermodata.modelling.search import Problem, search
from thermodata.plugin import Float1D

ALIKE = (0.7, 1.4)  # of the allowed rise, at the ends of the quadratic interval, that make it the profile's
CLOSE = 0.05  # of half the quadratic interval: how closely an end is found
POINTS = 9  # of the curve, on each side


class Profile:
    """Of a searched parameter (place i). allowed: rise of the squared error at an end of the interval of 95 %;
    along: how the searched parameters move with this one where the error is quadratic, shape (free parameters,); x: the
    optimum of this problem; moved: of this parameter to the optimum of the problem that it stands for."""

    def __init__(
        self, problem: Problem, x: Float1D, i: int, allowed: float, along: Float1D, moved: float = 0.0
    ) -> None:
        self.problem, self.x, self.i, self.allowed, self.along = problem, x, i, allowed, along
        self.moved = moved
        self.free = problem.free[i]
        self.low, self.high = self.free.outside(self.free.lower), self.free.outside(self.free.upper)
        residual = problem.residual(x)
        self.least = float(residual @ residual)
        self._near: dict[float, Float1D] = {float(x[i]): np.delete(x, i)}
        self._rises: dict[float, float] = {}

    def rise(self, at: float) -> float:
        """Of the squared error where the parameter is held at a point of the search, as a share of what is allowed."""
        if at in self._rises:  # another search from another start would end a little elsewhere
            return self._rises[at]
        rest = [f for k, f in enumerate(self.problem.free) if k != self.i]
        held = [dict(h) for h in self.problem.held]
        for slot in self.free.slots:
            held[slot][self.free.param.name] = self.free.inside(at)
        part = replace(self.problem, free=rest, held=held)
        nearest = min(self._near, key=lambda known: abs(known - at))
        found = search(part, self._near[nearest], loose=True)
        self._near[at] = found
        residual = part.residual(found)
        self._rises[at] = (float(residual @ residual) - self.least) / self.allowed
        return self._rises[at]

    def is_quadratic(self, half: float) -> bool:
        """Whether an interval of that half width, in the units of the search, has the profile's ends."""
        ends = (self.x[self.i] - half, self.x[self.i] + half)
        if ends[0] <= self.low or ends[1] >= self.high:
            return False
        # the path that a quadratic error would take costs one look; only where it errs are all others fitted anew
        straight = [self._straight(side * half) for side in (-1.0, 1.0)]
        if all(ALIKE[0] <= rise <= ALIKE[1] for rise in straight):
            return True
        return all(ALIKE[0] <= self.rise(float(end)) <= ALIKE[1] for end in ends)

    def ends(self, half: float) -> Ends:
        low, high = self._end(-half), self._end(half)
        return (None if low is None else self._value(low), None if high is None else self._value(high))

    def _value(self, at: float) -> float:
        return self.free.inside(at + self.moved)

    def curve(self, half: float) -> list[tuple[float, float]]:
        """(value, root mean square of the residual) from twice the half width below to twice above."""
        at = float(self.x[self.i])
        count = max(1, self.problem.design.n)
        rows = [(self._value(at), float(np.sqrt(self.least / count)))]
        for side in (-1.0, 1.0):
            for step in np.linspace(0, 2 * half, POINTS + 1)[1:]:
                point = at + side * float(step)
                if self.low <= point <= self.high:
                    square = self.least + self.rise(point) * self.allowed
                    rows.append((self._value(point), float(np.sqrt(max(0.0, square) / count))))
        return sorted(rows)

    def _straight(self, step: float) -> float:
        low = np.array([f.outside(f.lower) for f in self.problem.free])
        high = np.array([f.outside(f.upper) for f in self.problem.free])
        residual = self.problem.residual(np.clip(self.x + step * self.along, low, high))
        return (float(residual @ residual) - self.least) / self.allowed

    def _end(self, half: float) -> float | None:
        """Where the rise is what is allowed; None where it is not before the bound."""
        from scipy.optimize import brentq

        at = float(self.x[self.i])
        bound = self.high if half > 0 else self.low
        inner, outer = at, at + half
        while (bound - outer) * half > 0 and self.rise(outer) < 1.0:
            inner, outer = outer, at + 2 * (outer - at)
        if (bound - outer) * half <= 0:
            outer = bound
            if abs(outer - inner) < 1e-12 or self.rise(outer) < 1.0:
                return None
        if self.rise(inner) >= 1.0:
            return inner
        return float(brentq(lambda p: self.rise(float(p)) - 1.0, inner, outer, xtol=CLOSE * abs(half)))
