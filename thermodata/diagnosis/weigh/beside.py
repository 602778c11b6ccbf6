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
from thermodata.plugin import Float2D


def beside(problem: Problem, chosen: Sequence[Scored]) -> Problem:
    """The same with chosen effects among what is known."""
    return extended(problem, [(one.columns, one.weighed) for one in chosen])


def extended(problem: Problem, some: Sequence[tuple[Columns, Weighed]]) -> Problem:
    """The same with effects among what is known."""
    if not some:
        return problem
    own, spare = zip(*(_as_known(made, weighed) for made, weighed in some), strict=True)
    return problem.with_known(np.hstack(own), np.hstack(spare))


def _as_known(made: Columns, weighed: Weighed) -> tuple[Float2D, Float2D]:
    """An effect at its likeliest time constant, and, at a price, how else it may act: by its neighbours, too."""
    point, gains = weighed.best[0], made.gains
    sized, here = weighed.coefficients[:gains], made.whole[:, point]
    own = here[:, :gains] * np.where(sized == 0, 1.0, sized)
    spare = [here[:, gains:].reshape(len(here), -1, gains) @ sized]
    if made.on_a_line:
        neighbours = [p for p in (point - 1, point + 1) if 0 <= p < len(made.points)]
        spare += [(made.whole[:, p, :gains] @ sized - own.sum(axis=1))[:, None] for p in neighbours]
    return own, np.hstack(spare)


def each_beside_others(
    problem: Problem, chosen: Sequence[Scored], noise: Noise, *, left_out: bool = True
) -> list[Scored]:
    """In the noise beside all: what is left once nothing is missing, which is what tells rivals apart. left_out:
    whether the tests that are left out are asked."""
    found = []
    for one in chosen:
        others = [c for c in chosen if c is not one]
        alone = rank_in(beside(problem, others), [one.columns], noise, left_out=left_out).ranked[0]
        found.append(weighed_beside(alone, others))
    return found


def weighed_beside(one: Scored, others: Sequence[Scored]) -> Scored:
    """The same, with the ids of those that it was weighed beside."""
    return replace(one, others=tuple(o.candidate.id for o in others))


def without(pool: Sequence[Columns], chosen: Sequence[Scored]) -> list[Columns]:
    """The candidates of a pool that were not chosen."""
    return [c for c in pool if not any(c is s.columns for s in chosen)]
