"""How sure the parameters are, with residuals that hang together (840 samples can be worth 14)."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field

import numpy as np

from thermodata.modelling.design import MOMENTS
from thermodata.modelling.fitted_response import Ends
from thermodata.modelling.profile import Profile
from thermodata.modelling.search import Problem, search
from thermodata.modelling.slow_noise import scatter
from thermodata.modelling.start_unknown import disturbances
from thermodata.plugin import Float1D, Float2D
from thermodata.schema.certainty import Z95

Rough = Callable[[], Problem | None]
UNKNOWN = 3.0  # half an interval, in units of the search (a factor of 20): of what nobody knows no profile is asked
STEP = 1e-4  # of a parameter's range, for its slope
_LONGEST = 0.25  # of a test; a longer memory cannot be told from a trend


@dataclass(frozen=True)
class Spread:
    """Of a slot's parameters and gains, by name. sd: standard deviation; half: half of the interval of 95 %, both of
    log(value) where that is searched; ends: of the interval by profile, where it is not as wide up as down. Parameters
    at a bound have ends alone, held gains nothing."""

    sd: dict[str, float] = field(default_factory=dict)
    half: dict[str, float] = field(default_factory=dict)
    ends: dict[str, Ends] = field(default_factory=dict)


@dataclass(frozen=True)
class Owner:
    """Of a column of the Jacobian: its slots and name, and its place among the searched parameters (None: a gain)."""

    slots: tuple[int, ...]
    name: str
    place: int | None = None


@dataclass(frozen=True)
class Cover:
    """How the parameters of a fit spread together. owners: (slots, name), shape k; matrix: covariance, shape (k, k), of
    log(value) for names that are searched as logarithms, as wide as their intervals of 95 % are over 1.96."""

    owners: tuple[tuple[tuple[int, ...], str], ...]
    matrix: Float2D


def spreads(
    problem: Problem, x: Float1D, gains: Float1D, rough: Rough | None = None
) -> tuple[list[Spread], frozenset[str], Cover | None]:
    """One a slot, the names that are searched as logarithms, and all of them with their correlations (None where these
    are not known). rough: makes the same problem on fewer samples, for profiles; None: without profiles."""
    by_slot = [Spread() for _ in problem.design.slots]
    logs = frozenset(f.param.name for f in problem.free if f.log)
    inside = _Estimate(problem, x, gains, _inside(problem, x))
    for owner, sd, half in zip(inside.owners, inside.scatter.sd, inside.scatter.half, strict=True):
        if np.isfinite(sd) and np.isfinite(half):
            for s in owner.slots:
                by_slot[s].sd[owner.name], by_slot[s].half[owner.name] = float(sd), float(half)
    cover = _cover(inside)
    if rough is None or not problem.free:
        return by_slot, logs, cover
    known = _inside(problem, x)
    whole = len(known) == len(problem.free)
    for i, profile, half in _profiles(inside if whole else _Estimate(problem, x, gains), rough()):
        # at a bound the half width says nothing, and the profile has one side only
        if (half < UNKNOWN or i not in known) and not profile.is_quadratic(half):
            ends = profile.ends(half)
            for s in problem.free[i].slots:
                by_slot[s].ends[problem.free[i].param.name] = ends
    return by_slot, logs, cover


def _cover(estimate: _Estimate) -> Cover | None:
    found = estimate.scatter
    known = np.isfinite(found.sd) & np.isfinite(found.half) & (found.sd > 0)
    if not known.any():
        return None
    # an interval is wider than the deviation says where few samples are independent
    wider = found.half[known] / (Z95 * found.sd[known])
    owners = tuple((o.slots, o.name) for o, good in zip(estimate.owners, known, strict=True) if good)
    return Cover(owners, found.cover[np.ix_(known, known)] * np.outer(wider, wider))


def profiles(
    problem: Problem, x: Float1D, gains: Float1D, rough: Problem | None = None
) -> Iterator[tuple[int, Profile, float]]:
    """(place, profile, half of the quadratic interval in the units of the search) of every searched parameter but
    moments, whose error has no slope; those at a bound as well."""
    return _profiles(_Estimate(problem, x, gains), rough)


class _Estimate:
    """The Jacobian of the prediction to some searched parameters (all) and all free gains, and how they scatter."""

    def __init__(self, problem: Problem, x: Float1D, gains: Float1D, places: Iterable[int] | None = None) -> None:
        self.problem, self.x = problem, x
        design = problem.design
        matrix = problem.matrix(x)
        columns: list[Float1D] = []
        self.owners: list[Owner] = []
        for i in range(len(problem.free)) if places is None else places:
            nonlinear = problem.free[i]
            low, high = nonlinear.outside(nonlinear.lower), nonlinear.outside(nonlinear.upper)
            delta = STEP * (high - low) * (1.0 if x[i] + STEP * (high - low) < high else -1.0)
            trial = x.copy()
            trial[i] += delta
            columns.append((problem.matrix(trial) - matrix) @ gains / delta)
            self.owners.append(Owner(nonlinear.slots, nonlinear.param.name, i))
        for s, slot in enumerate(design.slots):
            for j, gain in enumerate(design.terms[slot.term].effect.gains):
                k = problem.starts[s] + j
                if problem.low[k] < gains[k] < problem.high[k]:
                    columns.append(matrix[:, k])
                    self.owners.append(Owner((s,), gain.name))
        self.jacobian = np.column_stack(columns) if columns else np.zeros((design.n, 0))
        unknown = disturbances(design, problem.params(x), gains, problem.starts)
        self.scatter = scatter(self.jacobian, design.y - matrix @ gains, design.parts, unknown)


def _profiles(estimate: _Estimate, rough: Problem | None) -> Iterator[tuple[int, Profile, float]]:
    problem, x, jacobian = estimate.problem, estimate.x, estimate.jacobian
    size = np.sqrt(np.sum(jacobian**2, axis=0))
    moves = size > 0
    size[~moves] = 1.0
    inverse = np.linalg.pinv((jacobian / size).T @ (jacobian / size), rcond=1e-12) / np.outer(size, size)
    # on other samples the optimum is a little elsewhere, and from beside it an error is no parabola
    small, near = (problem, x) if rough is None else (rough, search(rough, x))
    free_to_move = _inside(problem, x)
    places = {owner.place: k for k, owner in enumerate(estimate.owners) if owner.place is not None}
    for i, free in enumerate(problem.free):
        k = places[i]
        half = float(estimate.scatter.half[k])
        if free.points == MOMENTS or not moves[k] or not np.isfinite(half) or inverse[k, k] <= 0 or half <= 0:
            continue
        allowed = half**2 / inverse[k, k] * small.design.n / problem.design.n
        along = np.array([inverse[places[o], k] / inverse[k, k] if o in free_to_move else 0.0 for o in places])
        along[i] = 1.0
        yield i, Profile(small, near, i, allowed, along, float(x[i] - near[i])), half


def _inside(problem: Problem, x: Float1D) -> list[int]:
    """Searched parameters that do not stand at a bound."""
    found = []
    for i, nonlinear in enumerate(problem.free):
        low, high = nonlinear.outside(nonlinear.lower), nonlinear.outside(nonlinear.upper)
        if low + 10 * STEP * (high - low) < x[i] < high - 10 * STEP * (high - low):
            found.append(i)
    return found


def memory(residual: Float1D, parts: list[slice]) -> float:
    """Integrated autocorrelation time in samples: 1 + 2 sum(rho), to the first rho below 0.05; all tests together."""
    return max(1.0, 1.0 + 2.0 * float(_correlations(residual, parts).sum()))


def effective_count(residual: Float1D, parts: list[slice]) -> float:
    """How many independent samples the residual is worth."""
    return len(residual) / memory(residual, parts) if len(residual) else 0.0


def _correlations(residual: Float1D, parts: list[slice]) -> Float1D:
    longest = max((p.stop - p.start for p in parts), default=0)
    if longest < 4:
        return np.zeros(0)
    size = int(2 ** np.ceil(np.log2(2 * longest)))
    spectrum = np.zeros(size // 2 + 1)
    for part in parts:
        spectrum += np.abs(np.fft.rfft(residual[part], size)) ** 2
    cover = np.fft.irfft(spectrum, size)[: int(longest * _LONGEST) + 1]
    if cover[0] <= 0:
        return np.zeros(0)
    rho = cover[1:] / cover[0]
    below = np.flatnonzero(rho < 0.05)
    return np.asarray(rho[: below[0]] if len(below) else rho)
