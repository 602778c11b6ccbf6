"""Several heats that are claimed together, and the one body that all of them warm.

A turret is warmed by its drive, by coolant and by the cut; what holds the probes by the air, too. The temperature of
such a body says in one effect what its heats say in two or three. These fit the open tests as well, each with a size
and a time constant of its own, and more closely where the sensor on the body is coarse. The locked tests tell them
apart: what has fewer sizes to choose foretells them better.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import combinations

import numpy as np

from thermodata.diagnosis.candidates.candidate_effect import CandidateEffect
from thermodata.diagnosis.candidates.unread import TEMPERATURE
from thermodata.diagnosis.locked.confirm import Fits, rmse, shape_of
from thermodata.diagnosis.verdict.judged import Judged, OneBody
from thermodata.diagnosis.verdict.preference import FORETELLS, UNNAMED
from thermodata.diagnosis.weigh.scored import Scored
from thermodata.errors import ThermodataError
from thermodata.modelling.terms.fitted_response import FittedResponse

SEVERAL = 2
# cosine of what the body changes in the open tests with what its heats change together: 0.84 to 0.97 of bodies that
# were the cause of several claims, 0.55 at most where each of these was a cause
ALIKE = 0.8


def one_body(claims: Sequence[Judged], ranked: Sequence[Scored], fits: Fits) -> OneBody | None:
    """The body that takes the place of most claims, two at least, and leaves least of the locked tests then. It does in
    the open tests what they do together, and leaves 80 % of their error of the locked ones at most, as scored and about
    each test's mean; None where no body does. ranked: candidates beside the model alone. fits: of the model with
    candidates."""
    if len(claims) < SEVERAL or not fits.locked:
        return None
    bodies = [s.candidate for s in ranked if len(s.rows) and _is_body(s.candidate, claims, fits)]
    found = [
        one
        for body in bodies
        for heats in _combinations_of_claims(claims)
        if (one := _in_place(body, heats, claims, fits))
    ]
    return min(found, key=lambda one: (-len(one.heats), one.left), default=None)


def _is_body(one: CandidateEffect, claims: Sequence[Judged], fits: Fits) -> bool:
    """Whether it names a body by its own temperature, of which nothing is claimed or in the model. The air is no body,
    and a casting follows all that makes heat."""
    named = one.family not in UNNAMED and one.kin is None and one.within is None
    claimed = {channel for c in claims for channel in c.scored.candidate.channels}
    own = len(one.channels) == 1 and fits.data.channels[one.channels[0]].quantity == TEMPERATURE
    return named and own and not (one.around or one.passive) and claimed.isdisjoint(one.channels)


def _combinations_of_claims(claims: Sequence[Judged]) -> Iterator[tuple[Judged, ...]]:
    for count in range(len(claims), SEVERAL - 1, -1):
        yield from combinations(claims, count)


def _in_place(body: CandidateEffect, heats: tuple[Judged, ...], claims: Sequence[Judged], fits: Fits) -> OneBody | None:
    kept = [c.scored.candidate for c in claims if not any(c is heat for heat in heats)]
    try:
        without, ours = fits.of(kept), fits.of([c.scored.candidate for c in claims])
        theirs = fits.of([*kept, body])
    except ThermodataError:  # no open test has all of their channels
        return None
    if _likeness(without, ours, theirs, fits) < ALIKE:
        return None
    usable = [t for t in fits.locked if ours.can_predict(t) and theirs.can_predict(t)]
    errors = [rmse(f, usable, free=free) for free in (False, True) for f in (theirs, ours)]
    scored, scored_by_heats, left, left_by_heats = (np.nan if e is None else e for e in errors)
    if not (scored <= FORETELLS * scored_by_heats and left <= FORETELLS * left_by_heats):
        return None
    return OneBody(body.id, tuple(replace(j, warms=body.id) for j in heats), left, left_by_heats)


def _likeness(without: FittedResponse, one: FittedResponse, other: FittedResponse, fits: Fits) -> float:
    """Cosine of what two models change in the open tests, about each one's mean."""
    usable = [t for t in fits.tests if all(f.can_predict(t) for f in (without, one, other))]
    products = np.zeros((2, 2))
    for test in usable:
        mask = without.mask(test) & one.mask(test) & other.mask(test)
        base = without.residual(test)
        both = np.array([shape_of(base - f.residual(test), test, mask) for f in (one, other)], dtype=np.float64)
        products += both @ both.T
    lengths = float(np.sqrt(products[0, 0] * products[1, 1]))
    return float(products[0, 1]) / lengths if lengths > 0 else 0.0
