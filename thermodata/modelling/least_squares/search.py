"""Variable projection: the search over time constants, with the gains solved for at every point.

First a coarse grid, one parameter after the other (a sweep), then least squares within bounds
(scipy.optimize.least_squares, trust region) on the residual that is left after the gains are solved. A grid alone is
not enough: what a wrong time constant leaves behind looks like a missing effect. Sources: [golub1973], [branch1999].
"""

from __future__ import annotations

import itertools
import warnings
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from thermodata.modelling.least_squares.design import Design, Nonlinear
from thermodata.modelling.least_squares.solve import solve_gains, squared_error
from thermodata.plugin import Float1D, Float2D
from thermodata.store.base.counting import counted, watcher

SWEEPS = 4
HALVINGS = 3
LOOKS = 60  # of a refinement, each with one at every parameter beside it
TOLD = 30  # parameters from which on a search says how far it is
LONG = 100  # parameters from which on it is said before that it takes long: with their third power


@dataclass
class Problem:
    """A design with what is searched and what is held. held[slot]: fixed parameters by name;
    low, high: shape (columns,), equal where a gain is held. silent[slot]: parameters
    that change nothing with the slot's drivers."""

    design: Design
    free: list[Nonlinear]
    held: list[dict[str, float]]
    low: Float1D
    high: Float1D
    silent: list[frozenset[str]]

    def __post_init__(self) -> None:
        self.widths = [len(self.design.terms[s.term].effect.gains) for s in self.design.slots]
        self.starts = np.concatenate([[0], np.cumsum(self.widths)]).astype(int)

    def params(self, x: Float1D) -> list[dict[str, float]]:
        """Parameters of every slot at a point of the search."""
        values = [dict(h) for h in self.held]
        for value, nonlinear in zip(x, self.free, strict=True):
            for slot in nonlinear.slots:
                values[slot][nonlinear.param.name] = nonlinear.inside(float(value))
        return values

    def matrix(self, x: Float1D) -> Float2D:
        """shape (n, columns)."""
        blocks = [self.design.columns(s, p) for s, p in enumerate(self.params(x))]
        return np.concatenate(blocks, axis=1) if blocks else np.zeros((self.design.n, 0))

    def gains(self, matrix: Float2D) -> Float1D:
        return solve_gains(matrix.T @ matrix, matrix.T @ self.design.y, self.low, self.high)

    def residual(self, x: Float1D) -> Float1D:
        """shape (n,): what is left once the gains are solved."""
        matrix = self.matrix(x)
        return self.design.y - matrix @ self.gains(matrix)

    def box(self) -> tuple[Float1D, Float1D]:
        """The bounds of the search; shapes (free parameters,)."""
        low = np.array([f.outside(f.lower) for f in self.free], dtype=np.float64)
        return low, np.array([f.outside(f.upper) for f in self.free], dtype=np.float64)

    def start(self) -> Float1D:
        return np.array([f.outside(f.start) for f in self.free], dtype=np.float64)


def search(problem: Problem, start: Float1D | None = None, loose: bool = False, enough: float | None = None) -> Float1D:
    """The point with the least squared error; shape (free parameters,). start: a point near it, in place of a look
    over the whole range. loose: near enough to say how good the model is, not what its parameters are. enough: change
    of the squared error, as a share of it, at which a loose search ends."""
    x = problem.start() if start is None else start
    if not len(x) or not problem.design.n:
        return x
    if len(x) >= LONG:
        warnings.warn(
            f"{len(x)} parameters of '{problem.design.bound.name}' are searched together, which takes long, and these "
            "tests need not tell their effects apart: fix some (fixed: {...}), or begin with few effects and ask "
            "diagnose which one is missing",
            stacklevel=1,
        )
    found = _refine(problem, _sweeps(problem, x) if start is None else x, loose, enough)
    if start is not None or loose or len(x) == 1:
        return found
    # sweeps choose a valley while the others are coarse; once they are not, another one may be deeper
    elsewhere = found
    for i in _places_watched(problem, "parameters, along their range"):
        elsewhere = along_whole_range(problem, elsewhere, i)
    return found if elsewhere is found else _refine(problem, elsewhere, loose, enough)


def along_whole_range(problem: Problem, x: Float1D, i: int) -> Float1D:
    """The best point over the range of one parameter, the others as they are; shape (free parameters,)."""
    f = problem.free[i]
    points = np.linspace(f.outside(f.lower), f.outside(f.upper), f.points)
    return _best_along(problem, x, i, points, np.inf)[0]


def _sweeps(problem: Problem, x: Float1D) -> Float1D:
    """Coordinate descent over the whole range until nothing moves, then over ever smaller neighbourhoods."""
    low, high = problem.box()
    best = np.inf
    for _ in range(SWEEPS):
        before = x
        for i in _places_watched(problem, "parameters, over their range"):
            x, best = _best_along(problem, x, i, np.linspace(low[i], high[i], problem.free[i].points), best)
        if len(x) == 1 or np.array_equal(x, before):
            break
    reach = np.array([(b - a) / (f.points - 1) for a, b, f in zip(low, high, problem.free, strict=True)])
    for _ in range(HALVINGS):
        reach = reach / 2
        for i in _places_watched(problem, "parameters, nearby"):
            near = np.array([x[i] - reach[i], x[i] + reach[i]])
            x, best = _best_along(problem, x, i, np.clip(near, low[i], high[i]), best)
    return x


def _places_watched(problem: Problem, what: str) -> Iterator[int]:
    """The place of each parameter; where there are many, whoever watches is told how far it is."""
    places = range(len(problem.free))
    return counted(places, what) if len(places) >= TOLD else iter(places)


def _told_residual(problem: Problem, most: int) -> Callable[[Float1D], Float1D]:
    """The residual of a refinement of at most so many looks, likewise."""
    tell, count = watcher(), len(problem.free)
    if tell is None or count < TOLD:
        return problem.residual
    looks, total = itertools.count(), most * (count + 1)

    def residual(x: Float1D) -> Float1D:
        tell("looks, at most", min(next(looks), total), total)
        return problem.residual(x)

    return residual


def _best_along(problem: Problem, x: Float1D, i: int, points: Float1D, best: float) -> tuple[Float1D, float]:
    """The best of some values of one parameter; only its own columns of the Gram matrix are made anew."""
    design, nonlinear = problem.design, problem.free[i]
    matrix = problem.matrix(x)
    gram, cross, total = matrix.T @ matrix, matrix.T @ design.y, float(design.y @ design.y)
    places = np.concatenate([np.arange(problem.starts[s], problem.starts[s + 1]) for s in nonlinear.slots])
    rest = np.setdiff1d(np.arange(matrix.shape[1]), places)
    others = matrix[:, rest]
    if not np.isfinite(best):
        best = squared_error(total, gram, cross, solve_gains(gram, cross, problem.low, problem.high))
    out = x
    for value in points:
        trial = x.copy()
        trial[i] = value
        params = problem.params(trial)
        own = np.concatenate([design.columns(s, params[s]) for s in nonlinear.slots], axis=1)
        g, c = gram.copy(), cross.copy()
        g[np.ix_(places, places)] = own.T @ own
        g[np.ix_(places, rest)] = own.T @ others
        g[np.ix_(rest, places)] = g[np.ix_(places, rest)].T
        c[places] = own.T @ design.y
        error = squared_error(total, g, c, solve_gains(g, c, problem.low, problem.high))
        if error < best * (1 - 1e-9):
            best, out = error, trial
    return out, best


def _refine(problem: Problem, x: Float1D, loose: bool, enough: float | None) -> Float1D:
    from scipy.optimize import least_squares

    low, high = problem.box()
    margin = 1e-6 * (high - low)
    inside = np.clip(x, low + margin, high - margin)
    most = 12 if loose else LOOKS
    optimum = least_squares(
        _told_residual(problem, most),
        inside,
        bounds=(low, high),
        method="trf",
        diff_step=1e-5,
        x_scale=high - low,
        xtol=1e-4 if loose and enough is None else 1e-7,
        ftol=(enough or 1e-5) if loose else 1e-9,
        gtol=1e-12,
        max_nfev=most,
    )
    at_x = problem.residual(x)
    return np.asarray(optimum.x) if 2 * optimum.cost <= float(at_x @ at_x) else x
