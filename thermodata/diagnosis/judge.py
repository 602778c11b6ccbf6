"""From evidence to a verdict: what may be claimed, what can't be told apart, and what to do when nothing can.

Every rule is a constant with its reason; `benchmark-diagnosis` measures what they give.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from thermodata.diagnosis.candidates import GENERIC
from thermodata.diagnosis.problem import Problem
from thermodata.diagnosis.scored import Scored
from thermodata.plugin import Float1D

Verdict = Literal["effect", "none", "unknown", "not_testable"]

TRIED = 3  # only the best few may be claimed
P_LIMIT = 0.02  # against the best of all candidates on surrogate residuals
DROP_LIMIT = 0.3  # fall of the squared error on left-out tests (16 % of the RMS error)
FAMILY_DROP_LIMIT = 0.5  # the same for an effect whose family the model has: it may only refine what is known
# a proxy of what is missing has its slow shape but not its timing: with sharp timing less of a fall is enough
SHARP_WHITE_DROP = 0.3
SHARP_DROP_LIMIT = 0.15
# an effect that leaves most of what was missing is a proxy of it: this share of the error may remain on left-out
# tests, or this share of the floor, or a little more of both;
# where a second effect is missing too, both together must leave less
REMAINDER_LIMIT = 0.5
NEAR_REMAINDER_LIMIT = 0.6
NEAR_FLOORS = 1.5
PAIR_LIMIT = 0.35
FLOOR_SHARE = 0.7
TESTS_LIMIT = 0.7  # share of the tests in which the error falls
STRONG_DROP = 0.65  # what takes away this much is worth a name even where little is left to explain
SHARE_LIMIT = 0.03  # least share of the response's spread that is worth a name
TWIN_COSINE = 0.9  # contributions this alike can't be told apart
TWIN_SSE = 1.15  # nor candidates whose left-out errors differ by less, if they act alike at all
SIMPLER_SSE = 1.05  # a simpler twin is preferred where it costs no more than this
TWIN_SSE_COSINE = 0.6
SMALL_SHARE = 0.1  # a residual under this share of the response's spread (FIT 90) is left alone
NOISE_TIMES = 5.0


@dataclass(frozen=True, slots=True)
class Judgement:
    verdict: Verdict
    claimed: Scored | None
    reason: str


@dataclass(frozen=True, slots=True)
class Measure:
    """What claims are measured against. rows: of all tests. spread: RMS of the response about its offsets. noise: its
    short-term noise. families: those of the model's effects."""

    rows: int
    spread: float
    noise: float
    families: frozenset[str]

    @property
    def floor(self) -> float:
        """An error that is left alone: noise, and what a sum of lags leaves of a distributed machine."""
        return max(NOISE_TIMES * self.noise if np.isfinite(self.noise) else 0.0, SMALL_SHARE * self.spread)


def passes(scored: Scored, measure: Measure) -> list[str]:
    """The rules that a candidate fails, as sentences; none where it may be claimed."""
    failed = []
    if scored.p_value > P_LIMIT:
        failed.append(f"chance does as well in {scored.p_value:.0%} of surrogate residuals (limit {P_LIMIT:.0%})")
    known = scored.candidate.family in measure.families
    sharp = scored.white_drop >= SHARP_WHITE_DROP
    limit = SHARP_DROP_LIMIT if sharp else FAMILY_DROP_LIMIT if known else DROP_LIMIT
    better = float(np.mean(scored.sse_after < scored.sse_before))
    if scored.drop < limit:
        why = ", for the model has its family already" if known and not sharp else ""
        failed.append(
            f"the squared error on left-out tests falls by {max(scored.drop, 0):.0%} only (limit {limit:.0%}{why})"
        )
    elif remaining(scored.sse_before, measure) <= measure.floor and scored.drop < STRONG_DROP and not sharp:
        failed.append(f"there is too little to explain: FIT {fit_of(scored.sse_before, measure):.0f} without it")
    elif better < TESTS_LIMIT and not sharp:
        failed.append(f"the error falls in {better:.0%} of the left-out tests only (limit {TESTS_LIMIT:.0%})")
    elif explained(scored, measure.rows) < SHARE_LIMIT * measure.spread:
        share = f"{explained(scored, measure.rows):.2g} of {measure.spread:.2g}"
        failed.append(f"it explains {share} RMS (limit {SHARE_LIMIT:.0%})")
    if scored.white_drop <= 0:
        failed.append("with the residual's own inertia removed it predicts nothing")
    return failed


def is_proxy(scored: Scored, measure: Measure) -> bool:
    """Whether it leaves so much that it may only stand in for what is missing. A lag of a
    channel whose place nobody declared names no physics: it is never more than a proxy, and says so."""
    if scored.candidate.placeless:
        return False
    share = 1.0 if scored.white_drop >= SHARP_WHITE_DROP else FLOOR_SHARE
    before, after = remaining(scored.sse_before, measure), remaining(scored.sse_after, measure)
    near = min(NEAR_REMAINDER_LIMIT * before, NEAR_FLOORS * measure.floor)
    return after > max(REMAINDER_LIMIT * before, share * measure.floor, near)


def remaining(sse: Float1D, measure: Measure) -> float:
    """RMS error of all left-out tests from their squared errors, shape (tests,)."""
    return float(np.sqrt(sse.sum() / max(measure.rows, 1)))


def fit_of(sse: Float1D, measure: Measure) -> float:
    """The same as FIT [%]."""
    return 100.0 * (1.0 - remaining(sse, measure) / measure.spread) if measure.spread > 0 else 0.0


def explained(scored: Scored, rows: int) -> float:
    """RMS of what the candidate takes away on left-out tests."""
    return float(np.sqrt(max(0.0, scored.sse_before.sum() - scored.sse_after.sum()) / max(rows, 1)))


def judge(problem: Problem, ranked: Sequence[Scored], measure: Measure, pairs: Callable[[Scored], float]) -> Judgement:
    """pairs: the error on left-out tests that a claim leaves together with the best second effect, asked only where the
    claim alone leaves much: two effects may be missing."""
    if len(problem.blocks) < 2:
        return Judgement(
            "not_testable",
            None,
            f"{len(problem.blocks)} test with measured samples; an effect is claimed only where it also "
            "predicts a test that it was not fitted to, so at least two are needed",
        )
    if not ranked:
        return Judgement("not_testable", None, "no effect of the library fits the channels that were logged")
    rmse = float(np.sqrt(ranked[0].sse_before.sum() / problem.rows))
    good = [s for s in ranked[:TRIED] if not passes(s, measure)]
    if good:
        chosen = simplest(good)
        left = pairs(chosen) if is_proxy(chosen, measure) else 0.0
        if left <= max(PAIR_LIMIT * rmse, FLOOR_SHARE * measure.floor):
            return Judgement("effect", chosen, "")
        return Judgement(
            "unknown",
            None,
            f"{chosen.candidate.id} goes with what is missing, but {left:.2g} of {rmse:.2g} {problem.unit} remain even "
            "with a second effect: it stands in for something that was not logged",
        )
    if rmse <= measure.floor:
        return Judgement(
            "none",
            None,
            f"the error on left-out tests, {rmse:.2g} {problem.unit}, is at the floor of "
            f"{measure.floor:.2g} {problem.unit} (noise, and {SMALL_SHARE:.0%} of the response)",
        )
    return Judgement(
        "unknown",
        None,
        f"{rmse:.2g} {problem.unit} remain on left-out tests, above the floor of {measure.floor:.2g}, and nothing "
        f"logged explains them: the best, {ranked[0].candidate.id}, fails because "
        + " and ".join(passes(ranked[0], measure)),
    )


def simplest(good: Sequence[Scored]) -> Scored:
    """The first, unless one that acts alike explains as much from fewer channels or with a name."""
    first = good[0]
    alike = [
        first,
        *(s for s in good[1:] if _alike(first, s) and s.sse_after.sum() < SIMPLER_SSE * first.sse_after.sum()),
    ]
    return min(
        alike,
        key=lambda s: (s.candidate.family == GENERIC, len(s.candidate.channels), bool(s.candidate.refines), s.order),
    )


def equivalents(chosen: Scored, ranked: Sequence[Scored]) -> list[Scored]:
    """The candidates that the data can't tell from the chosen one."""
    return [s for s in ranked if s is not chosen and _alike(chosen, s)]


def _alike(a: Scored, b: Scored) -> bool:
    cosine = abs(float(a.shape @ b.shape))
    if b.drop < SHARP_DROP_LIMIT:
        return False
    return cosine > TWIN_COSINE or (cosine > TWIN_SSE_COSINE and b.sse_after.sum() < TWIN_SSE * a.sse_after.sum())
