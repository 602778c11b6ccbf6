"""How sure the parameters are, with residuals that hang together (840 samples can be worth 14)."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from thermodata.modelling.least_squares.design import MOMENTS
from thermodata.modelling.least_squares.labels import alike, fastest_first
from thermodata.modelling.least_squares.search import Problem, search
from thermodata.modelling.terms.fitted_response import Ends
from thermodata.modelling.trust.coordinate import Coordinate, Searched, Solved
from thermodata.modelling.trust.profile import Profile
from thermodata.modelling.trust.slow_noise import Scatter, make_noise, nothing
from thermodata.modelling.trust.start_unknown import disturbances
from thermodata.plugin import Float1D, Float2D
from thermodata.schema.agreed.certainty import Z95

Rough = Callable[[], Problem | None]
UNKNOWN = 3.0  # half an interval, in units of the search (a factor of 20): of what nobody knows no profile is asked
HELD = 1.1  # times as wide is a gain's interval once a time constant at its bound is let go: they hang together
CARRIED = 0.1  # of log(value), or of the range: further than that no slope is straight
SPANNED = 1e-8  # of the most power of a direction: below, columns undo each other to four digits
LEAST = 1e-12  # likewise: below, they are one
ROUNDING = 1e-15  # likewise: below, nothing is told of it
STEP = 1e-4  # of a parameter's range, for its slope
AS_SURE = (0.7, 1.4)  # times as wide is the quadratic interval of fewer samples that may stand for all
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
    """Of a column of the Jacobian: its slots and name, and what it is in the problem."""

    slots: tuple[int, ...]
    name: str
    of: Coordinate


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
    known = _inside(problem, x)
    inside = _Estimate(problem, x, gains, known)
    for owner, sd, half in zip(inside.owners, inside.scatter.sd, inside.scatter.half, strict=True):
        if np.isfinite(sd) and np.isfinite(half):
            for s in owner.slots:
                by_slot[s].sd[owner.name], by_slot[s].half[owner.name] = float(sd), float(half)
    cover = _cover(inside)
    if rough is None or not problem.free:
        return by_slot, logs, cover
    free = inside if len(known) == len(problem.free) else _Estimate(problem, x, gains)

    def asked(k: int, of: Coordinate, half: float) -> bool:
        if isinstance(of, Searched):
            # at a bound the half width says nothing, and the profile has one side only
            return half < UNKNOWN or of.place not in known
        held = by_slot[of.slots[0]].half.get(of.name, 0.0)
        return free.carries(k, half) or half > HELD * held

    small = _Small(free, rough)
    for k, whole, half in _profiles(free, asked):
        of = whole.of
        # all samples say whether a path is straight; only where it is not, is there something to search for
        quadratic = whole.is_straight(half)
        profile = whole if quadratic else small.instead_of(k, whole)
        quadratic = quadratic or profile.is_quadratic(half)
        for s in of.slots:
            if not quadratic:
                by_slot[s].ends[of.name] = profile.ends(half)
            elif isinstance(of, Solved):
                by_slot[s].half[of.name] = half
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


@dataclass(frozen=True)
class Seen:
    """The profile of a searched parameter. half: of the quadratic interval, in the units of the search; quadratic:
    whether the profile's is the same."""

    profile: Profile
    of: Searched
    half: float
    quadratic: bool


def profiles(problem: Problem, x: Float1D, gains: Float1D, rough: Rough) -> Iterator[Seen]:
    """Of every searched parameter but moments, whose error has no slope; those at a bound as well."""
    estimate = _Estimate(problem, x, gains)
    small = _Small(estimate, rough)
    for k, whole, half in _profiles(estimate, lambda k, of, half: isinstance(of, Searched)):
        if isinstance(whole.of, Searched):
            profile = small.instead_of(k, whole)
            yield Seen(profile, whole.of, half, whole.is_straight(half) or profile.is_quadratic(half))


class _Estimate:
    """The Jacobian of the prediction to some searched parameters (all) and all free gains, and how they scatter."""

    def __init__(self, problem: Problem, x: Float1D, gains: Float1D, places: Iterable[int] | None = None) -> None:
        self.problem, self.x, self.gains = problem, x, gains
        design = problem.design
        matrix = problem.matrix(x)
        columns: list[Float1D] = []
        self.owners: list[Owner] = []
        like = alike(problem)
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


def _profiles(
    estimate: _Estimate, asked: Callable[[int, Coordinate, float], bool]
) -> Iterator[tuple[int, Profile, float]]:
    """(place of the estimate, its profile on all samples, half of its quadratic interval)."""
    free_to_move, slopes = _inside(estimate.problem, estimate.x), estimate.slopes()
    for k, owner in enumerate(estimate.owners):
        of, half = owner.of, float(estimate.scatter.half[k])
        if isinstance(of, Searched) and of.free.points == MOMENTS:
            continue
        if not estimate.moves[k] or not np.isfinite(half) or half <= 0 or not asked(k, of, half):
            continue
        along = estimate.along(k, free_to_move) if estimate.known[k] else None
        yield k, Profile(estimate.problem, estimate.x, of, estimate.allowed, along, slopes), half


class _Small:
    """Profiles on fewer samples in place of those on all, where they show the same; made when first asked for."""

    def __init__(self, estimate: _Estimate, make: Rough) -> None:
        self._whole, self._make = estimate, make

    @cached_property
    def _estimate(self) -> _Estimate | None:
        small = self._make()
        if small is None:
            return None
        # on other samples the optimum is a little elsewhere, and from beside it an error is no parabola
        near = fastest_first(small, search(small, self._whole.x))
        found = _Estimate(small, near, small.gains(small.matrix(near)), self._whole.places)
        names = [[(owner.slots, owner.name) for owner in e.owners] for e in (found, self._whole)]
        return found if names[0] == names[1] and found.noise is not None else None

    def instead_of(self, k: int, whole: Profile) -> Profile:
        """Of the same estimate. Where means over many minutes err by more than the noise, as they do for a lag of
        minutes, they would allow a rise that the samples do not."""
        there = self._estimate
        if there is None:
            return whole
        as_wide = 1.0
        if self._whole.known[k]:
            as_wide = float(there.scatter.half[k] / self._whole.scatter.half[k])
            if not AS_SURE[0] <= as_wide <= AS_SURE[1]:
                return whole
        moved = whole.centre - whole.of.at(there.problem, there.x)

        def allowed(way: Float1D) -> float:
            # the shape is that of fewer samples, and how wide it is all samples say
            return there.allowed(way) / as_wide**2

        return Profile(there.problem, there.x, whole.of, allowed, whole.along, there.slopes(), moved)


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
