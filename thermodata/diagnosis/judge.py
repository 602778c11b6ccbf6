"""From evidence to a verdict: what may be claimed, what can't be told apart, and what to do when nothing can."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Literal

from thermodata.diagnosis.candidates import GENERIC
from thermodata.diagnosis.evidence import (
    SHARP_DROP_LIMIT,
    SMALL_SHARE,
    Measure,
    enough_together,
    is_promising,
    is_proxy,
    passes,
    remaining,
)
from thermodata.diagnosis.problem import Problem
from thermodata.diagnosis.scored import Scored

Verdict = Literal["effect", "none", "unknown", "not_testable"]

TRIED = 3  # only the best few may be claimed
TWIN_COSINE = 0.9  # contributions this alike can't be told apart
TWIN_SSE = 1.15  # nor candidates whose left-out errors differ by less, if they act alike at all
SIMPLER_SSE = 1.05  # a simpler twin is preferred where it costs no more than this
TWIN_SSE_COSINE = 0.6
PAIRS_TRIED = 2  # each costs a ranking of its own


@dataclass(frozen=True, slots=True)
class Pair:
    """The best second effect beside a first one, and the error that both leave on left-out tests."""

    second: Scored | None
    left: float


@dataclass(frozen=True, slots=True)
class Judgement:
    """second: where one claim alone leaves much, the effect that is missing beside it."""

    verdict: Verdict
    claimed: Scored | None
    reason: str
    second: Scored | None = None


def judge(problem: Problem, ranked: Sequence[Scored], measure: Measure, pair: Callable[[Scored], Pair]) -> Judgement:
    """pair: asked only where one effect alone leaves much, for two may be missing."""
    if len(problem.blocks) < 2:
        return Judgement(
            "not_testable",
            None,
            f"{len(problem.blocks)} test with measured samples; an effect is claimed only where it also "
            "predicts a test that it was not fitted to, so at least two are needed",
        )
    if not ranked:
        return Judgement("not_testable", None, "no effect of the library fits the channels that were logged")
    rmse = remaining(ranked[0].sse_before, measure)
    good = [s for s in ranked[:TRIED] if not passes(s, measure)]
    if good and not is_proxy(simplest(good), measure):
        return Judgement("effect", simplest(good), "")
    if rmse <= measure.floor:
        return Judgement(
            "none",
            None,
            f"the error on left-out tests, {rmse:.2g} {problem.unit}, is at the floor of "
            f"{measure.floor:.2g} {problem.unit} (noise, and {SMALL_SHARE:.0%} of the response)",
        )
    return _of_two(problem, ranked, good, measure, pair)


def _of_two(
    problem: Problem, ranked: Sequence[Scored], good: list[Scored], measure: Measure, pair: Callable[[Scored], Pair]
) -> Judgement:
    """A claim that needs a second effect beside it, or what is unknown."""
    rmse = remaining(ranked[0].sse_before, measure)
    first = [simplest(good)] if good else []
    asked = [*first, *(s for s in ranked[:TRIED] if s not in first and is_promising(s, measure))]
    pairs = [(s, pair(s)) for s in asked[:PAIRS_TRIED]]
    for scored, both in sorted(pairs, key=lambda item: item[1].left):
        if both.second is not None and enough_together(both.left, rmse, measure):
            return Judgement("effect", scored, "", both.second)
    if pairs:
        scored, both = pairs[0]
        why = (
            f"{scored.candidate.id} goes with what is missing, but {both.left:.2g} of {rmse:.2g} {problem.unit} remain "
            "even with a second effect: it stands in for something that was not logged"
        )
    else:
        why = (
            f"{rmse:.2g} {problem.unit} remain on left-out tests, above the floor of {measure.floor:.2g}, and nothing "
            f"logged explains them: the best, {ranked[0].candidate.id}, fails because "
            + " and ".join(passes(ranked[0], measure))
        )
    return Judgement("unknown", None, why)


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
