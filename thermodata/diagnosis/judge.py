"""From evidence to a verdict: what may be claimed, what can't be told apart, and what to do when nothing can.

Every rule is a constant with its reason; `benchmark-diagnosis` measures what they give.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from thermodata.diagnosis.problem import Problem
from thermodata.diagnosis.rank import Scored

Verdict = Literal["effect", "none", "unknown", "not_testable"]

P_LIMIT = 0.02                  # against the best of all candidates on surrogate residuals
DROP_LIMIT = 0.15               # fall of the squared error on left-out tests
TWIN_COSINE = 0.9               # contributions this alike can't be told apart
TWIN_SSE = 1.15                 # nor candidates whose left-out errors differ by less, if they act alike at all
TWIN_SSE_COSINE = 0.6
SMALL_SHARE = 0.05              # a residual under this share of the response's spread is left alone
NOISE_TIMES = 3.0


@dataclass(frozen=True, slots=True)
class Judgement:
    verdict: Verdict
    claimed: Scored | None
    reason: str


def passes(scored: Scored) -> list[str]:
    """The rules that a candidate fails, as sentences; none where it may be claimed."""
    failed = []
    if scored.p_value > P_LIMIT:
        failed.append(f"chance does as well in {scored.p_value:.0%} of surrogate residuals (limit {P_LIMIT:.0%})")
    if scored.drop < DROP_LIMIT:
        failed.append(f"the error on left-out tests falls by {max(scored.drop, 0):.0%} only (limit {DROP_LIMIT:.0%})")
    if scored.white_drop <= 0:
        failed.append("with the residual's own inertia removed it predicts nothing")
    return failed


def judge(problem: Problem, ranked: Sequence[Scored], spread: float) -> Judgement:
    """spread: RMS of the response about its offsets, in its unit."""
    if len(problem.blocks) < 2:
        return Judgement("not_testable", None,
                         f"{len(problem.blocks)} test with measured samples; an effect is claimed only where it also "
                         "predicts a test that it was not fitted to, so at least two are needed")
    if not ranked:
        return Judgement("not_testable", None, "no effect of the library fits the channels that were logged")
    for scored in ranked[:3]:
        if not passes(scored):
            return Judgement("effect", scored, "")
    rmse = float(np.sqrt(ranked[0].sse_before.sum() / problem.rows))
    floor = max(NOISE_TIMES * problem.noise if np.isfinite(problem.noise) else 0.0, SMALL_SHARE * spread)
    best = ranked[0]
    if rmse <= floor:
        return Judgement("none", None,
                         f"the error on left-out tests, {rmse:.2g} {problem.unit}, is at the floor of "
                         f"{floor:.2g} {problem.unit} (noise, and {SMALL_SHARE:.0%} of the response)")
    return Judgement("unknown", None,
                     f"{rmse:.2g} {problem.unit} remain on left-out tests, above the floor of {floor:.2g}, and nothing "
                     f"logged explains them: the best, {best.candidate.id}, fails because " + " and ".join(passes(best)))


def equivalents(chosen: Scored, ranked: Sequence[Scored]) -> list[Scored]:
    """The candidates that the data can't tell from the chosen one."""
    return [s for s in ranked if s is not chosen and _alike(chosen, s)]


def _alike(a: Scored, b: Scored) -> bool:
    cosine = abs(float(a.shape @ b.shape))
    if b.drop < DROP_LIMIT:
        return False
    return cosine > TWIN_COSINE or (
        cosine > TWIN_SSE_COSINE and b.sse_after.sum() < TWIN_SSE * a.sse_after.sum())
