"""The error over the whole range of one time constant or gain, all else fitted anew at each value: its profile.

A deviation makes an interval that reaches as far up as down. Where a test is too short for a lag, the error falls
steeply on one side and hardly rises on the other, and only the profile tells where the data end. A gain is linear, but
what it says hangs on its time constants: where these are ill known it is no more quadratic than they are.

The error may rise by what the noise does along the way that the prediction has gone, d: in white noise of size s by
(1.96 s)^2 whatever d is, in noise that hangs together by 1.96^2 d'Nd / d'd, N its covariance, which is more where d is
slow. Where the prediction is linear this is what the quadratic interval allows, and both intervals are the same.
Source: [bates1988]
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from thermodata.modelling.least_squares.search import Problem, search
from thermodata.modelling.terms.fitted_response import Ends
from thermodata.modelling.trust.intervals.anew import could_fall, fit_anew
from thermodata.modelling.trust.intervals.coordinate import Coordinate, Solved
from thermodata.plugin import Float1D, Float2D

ALIKE = (0.92, 1.1)  # of the allowed rise, at the ends of the quadratic interval, that make it the profile's: beyond
# such an end lies the truth in 2 to 3 of 100 cases, in place of 2.5
CLOSE = 0.025  # of the way to an end, or of a gain: how closely it is found
SAME = 0.01  # of the way to an end: there 2.4 to 2.6 in place of 2.5 of 100 cases lie beyond
CLOSER = 4  # times at most
PAST = 1.15  # times as far as a parabola says: so far out is an end looked for at first, then twice as far
MOST = 4.0  # times as far as the last look
ROUGHLY = 1e-5  # of the squared error: to that it is searched before a rise is known
ONWARD = 2.0  # times the last step: so far others are thought to go on as they did
NEAR = 0.02  # of the allowed rise: to that an error is searched
MOVES = 4  # of the border between two like lags, while one of them lies at it
POINTS = 9  # of the curve, on each side


class Profile:
    """Of one coordinate. allowed: rise of the squared error at an end of the interval of 95 %, by how the prediction
    has moved, shape (n,); along: how the searched parameters move with it where the error is quadratic, shape (free
    parameters,), None where too little is known to say; slopes: of the prediction to these, at the optimum, shape (n,
    free parameters), None where one has none; x: the optimum of this problem; moved: of the coordinate to the optimum
    of the problem that it stands for."""

    def __init__(
        self,
        problem: Problem,
        x: Float1D,
        of: Coordinate,
        allowed: Callable[[Float1D], float],
        along: Float1D | None,
        slopes: Float2D | None = None,
        moved: float = 0.0,
    ) -> None:
        self.problem, self.x, self.of, self.allowed, self.along = problem, x, of, allowed, along
        # of what is searched beside it
        self._slopes = None if slopes is None else slopes[:, of.others(np.arange(len(x), dtype=np.float64)).astype(int)]
        self.moved = moved
        self.centre = of.at(problem, x)
        self.low, self.high = of.range(problem, x)
        self.residual = problem.residual(x)
        self.least = float(self.residual @ self.residual)
        self._near: dict[float, Float1D] = {self.centre: of.others(x)}
        self._rises: dict[float, float] = {self.centre: 0.0}
        self._squares: dict[float, float] = {self.centre: self.least}
        self._in_one: float | None = None
        self._enough: float | None = None

    def rise(self, at: float) -> float:
        """Of the squared error where it is held at a value, as a share of what is allowed."""
        if at in self._rises:  # another search from another start would end a little elsewhere
            return self._rises[at]
        found = self._start(at)
        for _ in range(MOVES):
            near = found
            part = self.of.held(self.problem, at, near)
            found, residual = self._fitted_anew(part, near)
            pressed = self.of.pressed(found, near)
            if not pressed:
                break
        self._near[at] = found
        square = float(residual @ residual)
        if pressed:
            # two lags in one lie on the border, whatever their gains
            if self._in_one is None:
                self._in_one = self.of.in_one(self.problem)
            square = min(square, self._in_one)
        self._squares[at], self._rises[at] = square, self._share(square, residual)
        return self._rises[at]

    def _fitted_anew(self, part: Problem, near: Float1D) -> tuple[Float1D, Float1D]:
        """Where the others end, and what is left there."""
        if self._enough is None and self.least > 0:
            allowed = self.allowed(self.residual - part.residual(near))
            self._enough = NEAR * allowed / self.least if np.isfinite(allowed) and allowed > 0 else None
        low, high = part.box()
        if np.any((near < low) | (near > high)):
            # a like lag was passed: at the border both are one, and slopes of the optimum say nothing of it
            near = np.clip(near, low, high)
        elif self._slopes is not None:
            refit = fit_anew(part, near, self._slopes, self._enough or ROUGHLY)
            if refit is not None:
                return refit.x, refit.residual
        found = search(part, near, loose=True, enough=self._enough)
        return found, part.residual(found)

    def _start(self, at: float) -> Float1D:
        """Where the others stand further in, or where they would if they went on as they did."""
        # from the optimum outwards: a point further out may lie in another valley
        inner = [known for known in self._near if min(self.centre, at) <= known <= max(self.centre, at)]
        inner.sort(key=lambda known: abs(known - at))
        last = self._near[inner[0]]
        if len(inner) < 2 and self.along is not None:
            onward = self.of.others(self.x + (at - self.centre) * self.along)
        elif len(inner) < 2 or abs(at - inner[0]) > ONWARD * abs(inner[0] - inner[1]):
            return last
        else:
            onward = last + (at - inner[0]) / (inner[0] - inner[1]) * (last - self._near[inner[1]])
        part = self.of.held(self.problem, at, last)
        low, high = part.box()
        if np.any((last < low) | (last > high)):
            return last
        onward = np.clip(onward, low, high)
        squares = [float(r @ r) for r in (part.residual(last), part.residual(onward))]
        return onward if squares[1] < squares[0] else last

    def _share(self, square: float, residual: Float1D) -> float:
        return (square - self.least) / self.allowed(self.residual - residual)

    def is_straight(self, half: float) -> bool:
        """Whether the path that a quadratic error would take has the allowed rise at both ends of an interval of that
        half width, in the units of the search: it costs a look at each. By what the others could still take from it if
        they were fitted anew, slopes tell."""
        if not self._reaches(half) or self.along is None:
            return False
        return all(ALIKE[0] <= self._straight(side * half, self.along) <= ALIKE[1] for side in (-1.0, 1.0))

    def is_quadratic(self, half: float) -> bool:
        """Whether an interval of that half width has the profile's ends, all others fitted anew."""
        return self._reaches(half) and all(
            ALIKE[0] <= self.rise(float(end)) <= ALIKE[1] for end in (self.centre - half, self.centre + half)
        )

    def _reaches(self, half: float) -> bool:
        return self.low < self.centre - half and self.centre + half < self.high

    def ends(self, half: float) -> Ends:
        low, high = self._end(-half), self._end(half)
        return (None if low is None else self._value(low), None if high is None else self._value(high))

    def _value(self, at: float) -> float:
        return self.of.value(at + self.moved)

    def curve(self, half: float) -> list[tuple[float, float]]:
        """(value, root mean square of the residual) from twice the half width below to twice above."""
        count = max(1, self.problem.design.n)
        rows = [(self._value(self.centre), float(np.sqrt(self.least / count)))]
        for side in (-1.0, 1.0):
            for step in np.linspace(0, 2 * half, POINTS + 1)[1:]:
                point = self.centre + side * float(step)
                if self.low <= point <= self.high:
                    self.rise(point)
                    rows.append((self._value(point), float(np.sqrt(self._squares[point] / count))))
        return sorted(rows)

    def _straight(self, step: float, along: Float1D) -> float:
        there = np.clip(self.x + step * along, *self.problem.box())
        others = self.of.others(there)
        part = self.of.held(self.problem, self.centre + step, others)
        residual = part.residual(others)
        square = float(residual @ residual)
        if self._slopes is not None:
            square -= could_fall(part, others, residual, self._slopes)
        return self._share(square, residual)

    def _end(self, half: float) -> float | None:
        """Where the rise is what is allowed; None where it is not before the end of the range."""
        bound = self.high if half > 0 else self.low
        inner, outer = self.centre, self.centre + half
        least = 1.0
        while (bound - outer) * half > 0 and self.rise(outer) < 1.0:
            further = min(MOST, max(least, PAST / np.sqrt(max(self.rise(outer), PAST**2 / MOST**2))))
            inner, outer, least = outer, self.centre + further * (outer - self.centre), 2.0
        if (bound - outer) * half <= 0:
            outer = bound
            if not np.isfinite(bound) or abs(outer - inner) < 1e-12 or self.rise(outer) < 1.0:
                return None
        if self.rise(inner) >= 1.0:
            return inner
        for _ in range(CLOSER):
            size = max(abs(inner), abs(outer)) if isinstance(self.of, Solved) else np.inf
            end = self._root(inner, outer, CLOSE * min(size, abs(outer - self.centre)))
            if not isinstance(self.of, Solved) or not self._beyond(end):
                break
            # a gain of two lags that undo each other may be a hundred times as large as its end
            inner, outer = self._bracket(inner, outer)
            if abs(outer - inner) <= 2 * CLOSE * max(abs(inner), abs(outer)):
                break
        return end

    def _bracket(self, inner: float, outer: float) -> tuple[float, float]:
        """The nearest points looked at, of which the inner one is inside of the interval, and the outer is not."""
        between = [(k, r) for k, r in self._rises.items() if min(inner, outer) <= k <= max(inner, outer)]
        inner = max((k for k, r in between if r < 1.0), key=lambda k: abs(k - self.centre), default=inner)
        beyond = [k for k, r in between if r >= 1.0 and abs(k - self.centre) > abs(inner - self.centre)]
        return inner, min(beyond, key=lambda k: abs(k - self.centre), default=outer)

    def _root(self, inner: float, outer: float, close: float) -> float:
        from scipy.optimize import brentq

        return float(brentq(lambda p: self._beyond(float(p)), inner, outer, xtol=close))

    def _beyond(self, at: float) -> float:
        """How far a value lies outside of the interval, as a share of the way to its end where the rise is quadratic;
        0 where that is as good as the end."""
        # the root of the rise is straight where the rise is quadratic
        beyond = float(np.sqrt(max(0.0, self.rise(at)))) - 1.0
        return 0.0 if abs(beyond) < SAME else beyond
