"""What the model leaves as it stands, and which refinement would take most of it away.

A candidate is weighed beside effects that may act faster and slower than they are fitted, so that a distributed machine
is no missing effect. What they then explain, the model itself leaves, one lag an effect: another mode of it, or a cause
that hides behind it. These tests can't tell which, so what foretells left-out tests best beside the model as it stands
is offered as a refinement, and named no cause (docs/method.md#as-modelled).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from threadpoolctl import threadpool_limits

from thermodata.diagnosis.claims.measure import Measure
from thermodata.diagnosis.claims.rules import BETTER_LIMIT, SPREAD_LIMIT
from thermodata.diagnosis.question.known import Known, known, likeliest
from thermodata.diagnosis.question.problem import Problem
from thermodata.diagnosis.verdict.judged import Judged, Judgement, Verdict
from thermodata.diagnosis.verdict.preference import is_its_name
from thermodata.diagnosis.verdict.selection import Selection
from thermodata.diagnosis.weigh.ranking import rank_in
from thermodata.diagnosis.weigh.scored import Scored
from thermodata.plugin import Bool1D
from thermodata.schema.agreed.limits import NOISY

# of what the model as it stands leaves a refinement takes away this share, at least: what takes less foretells locked
# tests hardly better (docs/method.md#as-modelled)
FALLS = 0.3
ALONE = 0.9  # of the squares of what an effect of the model does: a test that has so much has it alone
REFINES = (
    "the effects of the model do as much where they may act otherwise than by one lag each, so these tests can't tell "
    "a cause of its own from another mode of them (add it, and watch tests that took no part)"
)


@dataclass(frozen=True, slots=True)
class AsModelled:
    """left: RMS error of tests that are left out in turn, each alike, in the response's unit, with the effects acting
    as the model has them. offered: what takes away most of it; None where nothing does."""

    left: float
    offered: Judged | None


def as_modelled(problem: Problem, selection: Selection | None, measure: Measure, *, offers: bool) -> AsModelled | None:
    """None where no test can be left out, and where the model leaves noise: how badly tests are foretold says then how
    few they are, and nothing of the model. offers: whether a refinement is looked for."""
    if selection is None:
        return None
    with threadpool_limits(1):
        tight = _as_it_stands(problem)
        base = known(tight, likeliest(tight))
        if _error_left(base, np.zeros(len(tight.blocks), dtype=np.bool_)) <= NOISY * problem.noise:
            return None
        foretold = _is_foretold(tight)
        left = _error_left(base, foretold)
        if not offers or left <= measure.noises:
            return AsModelled(left, None)
        pool = [s.columns for s in selection.first.ranked]
        ranked = tuple(_scored_as_modelled(s, foretold) for s in rank_in(tight, pool, base.space.noise).ranked)
    sound = [s for s in ranked if len(s.rows) and _is_sound(s) and s.error_of_all <= (1 - FALLS) * left]
    best = min(sound, key=lambda s: s.error_of_all, default=None)
    if best is None:
        return AsModelled(left, None)
    chosen = next((s for s in sound if is_its_name(best, s)), best)
    return AsModelled(left, Judged(chosen, chosen, REFINES, ranked))


def refined(judgement: Judgement, found: AsModelled | None, measure: Measure) -> Judgement:
    """What finds nothing missing, with what is offered; of an error that is left alone it is no other verdict."""
    if judgement.verdict != "none" or found is None or found.offered is None:
        return judgement
    judged = (*(j for j in judgement.judged if j.alone.columns is not found.offered.alone.columns), found.offered)
    verdict: Verdict = "refine" if found.left > measure.floor else "none"
    return replace(judgement, verdict=verdict, refinements=(found.offered,), judged=judged)


def _as_it_stands(problem: Problem) -> Problem:
    """Its gains and time constants are free, to first order, and nothing else. Columns of candidates, and what was
    whitened, stay as they are."""
    blocks = tuple(replace(b, slack=np.zeros((len(b.t_s), 0))) for b in problem.blocks)
    return replace(problem, blocks=blocks)


def _is_foretold(tight: Problem) -> Bool1D:
    """Whether the other tests foretell each one: what an effect of the model does in one test alone they say nothing
    of, as of a tool that one test had; there the model is taken as all tests fit it."""
    energy = np.array([np.sum(b.base**2, axis=0) for b in tight.blocks])
    share = energy / np.maximum(energy.sum(axis=0), np.finfo(float).tiny)
    return np.asarray((share < ALONE).all(axis=1))


def _error_left(base: Known, foretold: Bool1D) -> float:
    """RMS error of all tests, each alike: of those that are foretold by a fit to the others, else to all."""
    squares = []
    for i, block in enumerate(base.problem.blocks):
        theta = base.mean(np.delete(base.every, i) if foretold[i] else base.every)
        squares.append(np.mean((block.response - block.base @ theta) ** 2))
    return float(np.sqrt(np.mean(squares)))


def _scored_as_modelled(scored: Scored, foretold: Bool1D) -> Scored:
    if not len(scored.rows):
        return replace(scored, as_modelled=True)
    before, after = (
        np.where(foretold, scored.sse_before, scored.own_before),
        np.where(foretold, scored.sse_after, scored.own_after),
    )
    return replace(scored, as_modelled=True, sse_before=before, sse_after=after)


def _is_sound(scored: Scored) -> bool:
    """Whether it acts alike in all tests, and makes most of them more probable."""
    return scored.candidate.unforetold is None and scored.better >= BETTER_LIMIT and scored.spread <= SPREAD_LIMIT
