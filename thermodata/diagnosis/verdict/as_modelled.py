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
from thermodata.diagnosis.question.known import known, likeliest
from thermodata.diagnosis.question.problem import Problem
from thermodata.diagnosis.verdict.judge import Judged, Judgement
from thermodata.diagnosis.verdict.preference import is_its_name
from thermodata.diagnosis.verdict.selection import Selection
from thermodata.diagnosis.weigh.ranking import rank_in
from thermodata.diagnosis.weigh.scored import Scored

# of what the model as it stands leaves a refinement takes away this share, at least: what takes less foretells locked
# tests hardly better (docs/method.md#as-modelled)
FALLS = 0.3
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
    """None where no test can be left out. offers: whether a refinement is looked for."""
    if selection is None:
        return None
    with threadpool_limits(1):
        tight = _as_it_stands(problem)
        base = known(tight, likeliest(tight))
        left = base.left_out
        if not offers or left <= measure.noises:
            return AsModelled(left, None)
        pool = [s.columns for s in selection.first.ranked]
        ranked = tuple(replace(s, as_modelled=True) for s in rank_in(tight, pool, base.space.noise).ranked)
    sound = [s for s in ranked if len(s.rows) and _is_sound(s) and s.error_of_all <= (1 - FALLS) * left]
    best = min(sound, key=lambda s: s.error_of_all, default=None)
    if best is None:
        return AsModelled(left, None)
    chosen = next((s for s in sound if is_its_name(best, s)), best)
    return AsModelled(left, Judged(chosen, chosen, REFINES, ranked))


def refined(judgement: Judgement, found: AsModelled | None) -> Judgement:
    """What finds nothing missing, with what is offered."""
    if judgement.verdict != "none" or found is None or found.offered is None:
        return judgement
    judged = (*(j for j in judgement.judged if j.alone.columns is not found.offered.alone.columns), found.offered)
    return replace(judgement, verdict="refine", refinements=(found.offered,), judged=judged)


def _as_it_stands(problem: Problem) -> Problem:
    """Its gains and time constants are free, to first order, and nothing else. Columns of candidates, and what was
    whitened, stay as they are."""
    blocks = tuple(replace(b, slack=np.zeros((len(b.t_s), 0))) for b in problem.blocks)
    return replace(problem, blocks=blocks)


def _is_sound(s: Scored) -> bool:
    """Whether it acts alike in all tests, and makes most of them more probable."""
    return s.candidate.unforetold is None and s.better >= BETTER_LIMIT and s.spread <= SPREAD_LIMIT
