"""How sure the parameters are: their intervals, by slopes or by profile, and how they spread together."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from thermodata.modelling.least_squares.design import MOMENTS
from thermodata.modelling.least_squares.labels import fastest_first
from thermodata.modelling.least_squares.search import Problem, search
from thermodata.modelling.terms.fitted_response import Ends
from thermodata.modelling.trust.intervals.coordinate import Coordinate, Searched, Solved
from thermodata.modelling.trust.intervals.estimate import Estimate, inside_bounds
from thermodata.modelling.trust.intervals.profile import Profile
from thermodata.plugin import Float1D, Float2D
from thermodata.schema.agreed.certainty import Z95

Rough = Callable[[], Problem | None]
UNKNOWN = 3.0  # half an interval, in units of the search (a factor of 20): of what nobody knows no profile is asked
HELD = 1.1  # times as wide is a gain's interval once a time constant at its bound is let go: they hang together
AS_SURE = (0.7, 1.4)  # times as wide is the quadratic interval of fewer samples that may stand for all


@dataclass(frozen=True)
class Spread:
    """Of a slot's parameters and gains, by name. sd: standard deviation; half: half of the interval of 95 %, both of
    log(value) where that is searched; ends: of the interval by profile, where it is not as wide up as down. Parameters
    at a bound have ends alone, held gains nothing."""

    sd: dict[str, float] = field(default_factory=dict)
    half: dict[str, float] = field(default_factory=dict)
    ends: dict[str, Ends] = field(default_factory=dict)


@dataclass(frozen=True)
class Cover:
    """How the parameters of a fit spread together. owners: (slots, name), shape k; matrix: covariance, shape (k, k), of
    log(value) for names that are searched as logarithms, as wide as their intervals of 95 % are over 1.96."""

    owners: tuple[tuple[tuple[int, ...], str], ...]
    matrix: Float2D


def spreads(
    problem: Problem, x: Float1D, gains: Float1D, rough: Rough | None = None, profiled: Collection[int] | None = None
) -> tuple[list[Spread], frozenset[str], Cover | None]:
    """One a slot, the names that are searched as logarithms, and all of them with their correlations (None where these
    are not known). rough: makes the same problem on fewer samples, for profiles; None: without profiles.
    profiled: the slots whose profiles are asked for; None: all, and each costs some fits."""
    by_slot = [Spread() for _ in problem.design.slots]
    logs = frozenset(f.param.name for f in problem.free if f.log)
    known = inside_bounds(problem, x)
    inside = Estimate(problem, x, gains, known)
    for owner, sd, half in zip(inside.owners, inside.scatter.sd, inside.scatter.half, strict=True):
        if np.isfinite(sd) and np.isfinite(half):
            for s in owner.slots:
                by_slot[s].sd[owner.name], by_slot[s].half[owner.name] = float(sd), float(half)
    cover = _cover(inside)
    if rough is None or not problem.free:
        return by_slot, logs, cover
    free = inside if len(known) == len(problem.free) else Estimate(problem, x, gains)

    def asked(k: int, of: Coordinate, half: float) -> bool:
        if profiled is not None and set(of.slots).isdisjoint(profiled):
            return False
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


def _cover(estimate: Estimate) -> Cover | None:
    found = estimate.scatter
    known = np.isfinite(found.sd) & np.isfinite(found.half) & (found.sd > 0)
    if not known.any():
        return None
    # an interval is wider than the deviation says where few samples are independent
    wider = found.half[known] / (Z95 * found.sd[known])
    owners = tuple((o.slots, o.name) for o, good in zip(estimate.owners, known, strict=True) if good)
    return Cover(owners, found.cover[np.ix_(known, known)] * np.outer(wider, wider))


@dataclass(frozen=True)
class SeenProfile:
    """The profile of a searched parameter. half: of the quadratic interval, in the units of the search; quadratic:
    whether the profile's is the same."""

    profile: Profile
    of: Searched
    half: float
    quadratic: bool


def profiles(problem: Problem, x: Float1D, gains: Float1D, rough: Rough) -> Iterator[SeenProfile]:
    """Of every searched parameter but moments, whose error has no slope; those at a bound as well."""
    estimate = Estimate(problem, x, gains)
    small = _Small(estimate, rough)
    for k, whole, half in _profiles(estimate, lambda k, of, half: isinstance(of, Searched)):
        if isinstance(whole.of, Searched):
            profile = small.instead_of(k, whole)
            yield SeenProfile(profile, whole.of, half, whole.is_straight(half) or profile.is_quadratic(half))


def _profiles(
    estimate: Estimate, asked: Callable[[int, Coordinate, float], bool]
) -> Iterator[tuple[int, Profile, float]]:
    """(place of the estimate, its profile on all samples, half of its quadratic interval)."""
    free_to_move, slopes = inside_bounds(estimate.problem, estimate.x), estimate.slopes()
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

    def __init__(self, estimate: Estimate, make: Rough) -> None:
        self._whole, self._make = estimate, make

    @cached_property
    def _estimate(self) -> Estimate | None:
        small = self._make()
        if small is None:
            return None
        # on other samples the optimum is a little elsewhere, and from beside it an error is no parabola
        near = fastest_first(small, search(small, self._whole.x))
        found = Estimate(small, near, small.gains(small.matrix(near)), self._whole.places)
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
