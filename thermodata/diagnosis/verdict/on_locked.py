"""What the whole set foretells of the locked tests, and what it would foretell without a claim.

The open tests alone choose and estimate; noise, time constants and gains come from them. Where several effects are
missing, one alone says little there, so the claims are asked beside all that was selected with them.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np
from threadpoolctl import threadpool_limits

from thermodata.diagnosis.claims.measure import Measure
from thermodata.diagnosis.claims.probability import is_made_a_claim, may_be_confirmed
from thermodata.diagnosis.question.discrepancy import Noise
from thermodata.diagnosis.question.known import Known, known
from thermodata.diagnosis.question.problem import Problem
from thermodata.diagnosis.verdict.judged import Judged, Judgement
from thermodata.diagnosis.verdict.selection import Selection
from thermodata.diagnosis.weigh.beside import extended
from thermodata.diagnosis.weigh.evidence import columns, moments, weigh
from thermodata.diagnosis.weigh.foretold import Foretold, Looked
from thermodata.diagnosis.weigh.scored import ACTS, Scored
from thermodata.modelling.terms.rms import rms_about_means
from thermodata.plugin import Bool1D, Float1D, Int1D


@dataclass(frozen=True, slots=True)
class Lock:
    """The locked tests beside the open ones, opened when first asked for. with_locked: the problem of both, whose first
    `opened` blocks are of open tests. asked: the ids of what they were opened for, in that order: each look counts."""

    with_locked: Callable[[], Problem]
    opened: int
    asked: dict[str, None] = field(default_factory=dict)

    def foretold(self, found: Selection, told: Judgement, claim: Judged, others: Sequence[Judged]) -> Foretold | None:
        """What a claim foretells beside the others that are claimed or likely; None where there are no locked tests."""
        both = self.with_locked()
        if len(both.blocks) == self.opened:
            return None
        self.asked.setdefault(claim.scored.candidate.id)
        claimed = {id(c.alone.columns) for c in (claim, *others)}
        beside = [o.scored for o in others]
        kept = [*beside, *(m.scored for m in found.members if id(m.alone.columns) not in claimed), *found.context]
        refining = [*beside, *(j.scored for j in told.refinements)]
        with threadpool_limits(1):
            beside_all = foretell(both, self.opened, found.noise, kept, [claim.scored])
            # what stands beside a claim without being one may stand in its way
            if beside_all.holds or len(kept) == len(refining):
                return beside_all
            alone = foretell(both, self.opened, found.noise, refining, [claim.scored])
            return max(beside_all, alone, key=lambda f: f.fall)

    def confirms(self, found: Selection, told: Judgement, one: Judged, measure: Measure) -> bool:
        """Whether they would make a claim of a member by themselves."""
        said = self.foretold(found, told, one, ()) if may_be_confirmed(one.scored) else None
        return said is not None and is_made_a_claim(one.scored, Looked(said, None, measure.said))


def foretell(problem: Problem, opened: int, noise: Noise, kept: Sequence[Scored], claims: Sequence[Scored]) -> Foretold:
    """problem: the first `opened` blocks are of open tests, the others of locked ones. kept: what is selected beside
    the claims. Asked are the locked tests in which a claim acts: another one says how well the rest of the model is
    known, and nothing of the claims. Errors of 0 where there is none."""
    tests = np.arange(opened)
    beside, _ = _with_effects_as_open(problem, tests, noise, kept)
    without = known(beside, noise)
    with_claims, acts = _with_effects_as_open(beside, tests, noise, claims)
    locked = [i for i in range(opened, len(problem.blocks)) if acts[i] or not claims]
    keys = frozenset(problem.blocks[i].test.key for i in locked)
    if not locked:
        return Foretold(0.0, 0.0, 0.0, tests=keys)
    among = known(with_claims, noise)
    before, after = _residuals_left(without, tests, locked), _residuals_left(among, tests, locked)
    asked = np.concatenate([tests, locked]).astype(np.int64)
    gained = _log_probability(among, asked, tests) - _log_probability(without, asked, tests)
    return Foretold(
        rms_about_means(before),
        rms_about_means(after),
        rms_about_means([a - b for a, b in zip(before, after, strict=True)]),
        gained / sum(len(r) for r in before),
        keys,
        noise.white,
        sum(len(r) for r in before),
    )


def _with_effects_as_open(
    problem: Problem, tests: Int1D, noise: Noise, chosen: Sequence[Scored]
) -> tuple[Problem, Bool1D]:
    """(each effect as the open tests have it, beside those before it; whether one of them acts in each test)."""
    acts = np.zeros(len(problem.blocks), dtype=np.bool_)
    for one in chosen:
        made = columns(problem, one.candidate)
        if made is None:
            continue
        base = known(problem, noise)
        weighed = weigh(base, made, moments(base, made).of(tests), tests)
        does = made.does(weighed)
        size = np.array([rms_about_means([does[rows]]) for rows in base.space.parts])
        acts |= size >= ACTS * size[tests].max()
        problem = extended(problem, [(made, weighed)])
    return problem, acts


def _residuals_left(base: Known, tests: Int1D, locked: Sequence[int]) -> list[Float1D]:
    """Of each locked test, what the coefficients of the open ones leave."""
    theta = base.mean(tests)
    return [_residual_of_test(base.problem, i, theta) for i in locked]


def _residual_of_test(problem: Problem, test: int, theta: Float1D) -> Float1D:
    block = problem.blocks[test]
    return np.asarray(block.response - np.hstack([block.base, block.slack]) @ theta)


def _log_probability(base: Known, both: Int1D, tests: Int1D) -> float:
    """Of the other tests among both, given these, but for what the noise alone makes of it: of both less of these."""
    return base.log_probability(both) - base.log_probability(tests)
