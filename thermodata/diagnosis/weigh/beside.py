"""Chosen effects among what is known, and each of them weighed beside the others."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from thermodata.diagnosis.question.discrepancy import Noise
from thermodata.diagnosis.question.problem import Problem
from thermodata.diagnosis.weigh.evidence import Columns, Weighed
from thermodata.diagnosis.weigh.ranking import rank_in
from thermodata.diagnosis.weigh.scored import Scored


def beside(problem: Problem, chosen: Sequence[Scored]) -> Problem:
    """The same with chosen effects among what is known."""
    for one in chosen:
        problem = extended(problem, one.columns, one.weighed)
    return problem


def extended(problem: Problem, made: Columns, weighed: Weighed) -> Problem:
    """The same with an effect among what is known: at its likeliest time constant, its neighbours at a price."""
    point, gains = weighed.best[0], made.gains
    sized, here = weighed.coefficients[:gains], made.whole[:, point]
    own = here[:, :gains] * np.where(sized == 0, 1.0, sized)
    spare = [here[:, gains:].reshape(len(here), -1, gains) @ sized]
    if made.on_a_line:
        neighbours = [p for p in (point - 1, point + 1) if 0 <= p < len(made.points)]
        spare += [(made.whole[:, p, :gains] @ sized - own.sum(axis=1))[:, None] for p in neighbours]
    return problem.with_known(own, np.hstack(spare))


def each_beside_others(problem: Problem, chosen: Sequence[Scored], noise: Noise) -> list[Scored]:
    """In the noise beside all: what is left once nothing is missing, which is what tells rivals apart."""
    found = []
    for one in chosen:
        others = [c for c in chosen if c is not one]
        found.append(weighed_beside(rank_in(beside(problem, others), [one.columns], noise).ranked[0], others))
    return found


def weighed_beside(one: Scored, others: Sequence[Scored]) -> Scored:
    return replace(one, others=tuple(o.candidate.id for o in others))


def without(pool: Sequence[Columns], chosen: Sequence[Scored]) -> list[Columns]:
    return [c for c in pool if not any(c is s.columns for s in chosen)]
