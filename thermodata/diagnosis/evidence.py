"""The rules of a claim: each a constant with its reason, each a sentence where it is not met.

`benchmark-diagnosis` measures what they give.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from thermodata.diagnosis.scored import Scored
from thermodata.plugin import Float1D

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
SMALL_SHARE = 0.1  # a residual under this share of the response's spread (FIT 90) is left alone
NOISE_TIMES = 5.0


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


def is_promising(scored: Scored, measure: Measure) -> bool:
    """Whether chance does not explain it, though alone it explains little: another effect may be missing beside it."""
    return scored.p_value <= P_LIMIT and scored.white_drop > 0 and scored.drop >= SHARP_DROP_LIMIT


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


def enough_together(left: float, before: float, measure: Measure) -> bool:
    """Whether two effects leave so little of an error that both are missing. left, before: on left-out tests."""
    return left <= max(PAIR_LIMIT * before, FLOOR_SHARE * measure.floor)


def explained(scored: Scored, rows: int) -> float:
    """RMS of what the candidate takes away on left-out tests."""
    return float(np.sqrt(max(0.0, scored.sse_before.sum() - scored.sse_after.sum()) / max(rows, 1)))
