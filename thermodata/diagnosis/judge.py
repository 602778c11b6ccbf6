"""From evidence to a verdict: what may be claimed, what only refines what is known, and why the others may not."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from thermodata.diagnosis.null import p_value
from thermodata.diagnosis.problem import Problem
from thermodata.diagnosis.scored import Scored
from thermodata.diagnosis.selection import Selection
from thermodata.plugin import Float1D

Verdict = Literal["effect", "refine", "none", "unknown", "not_testable"]

P_LIMIT = 0.01
DROP_LIMIT = 0.15  # fall of the error on left-out tests in which it acts
BETTER_LIMIT = 0.7  # share of these tests that it makes more probable
SPREAD_LIMIT = 0.5  # of its gain between tests, as a share
WORTH_SHARE = 0.15  # of the response: less is not worth a name
BESIDE_SHARE = 0.5  # of the largest claim's: a further claim must explain as much
MOST_CLAIMS = 3
STEADIES = 2.8  # a promised fall beyond this many times its own size only steadies an extrapolation
FLOOR_SHARE = 0.1  # a residual under this share of the response (FIT 90) is left alone
NOISE_TIMES = 5.0
ALIKE = 0.9  # cosine of contributions that can't be told apart
NEARLY = 0.97  # nor can those of nearly the same evidence, if they act alike at all
NEARLY_COSINE = 0.6


@dataclass(frozen=True, slots=True)
class Measure:
    """What claims are measured against. spread: RMS of the response about its offsets. noise: its short-term noise.
    chance: the best evidence of chance, shape (draws,)."""

    spread: float
    noise: float
    chance: Float1D

    @property
    def floor(self) -> float:
        """An error that is left alone: noise, and what a sum of lags leaves of a distributed machine."""
        return max(NOISE_TIMES * self.noise if np.isfinite(self.noise) else 0.0, FLOOR_SHARE * self.spread)


@dataclass(frozen=True, slots=True)
class Judged:
    """A member of the selection. refines: what it refines of the model, in words; None for a cause of its own.
    failed: the rules that it fails, as sentences. beside: all that was ranked without it."""

    scored: Scored
    refines: str | None
    failed: tuple[str, ...]
    beside: tuple[Scored, ...]

    @property
    def sound(self) -> bool:
        return not self.failed


@dataclass(frozen=True, slots=True)
class Judgement:
    """claims: missing causes, the largest first. refinements: sound ones of effects that the model has. judged: all
    members."""

    verdict: Verdict
    claims: tuple[Judged, ...]
    refinements: tuple[Judged, ...]
    judged: tuple[Judged, ...]
    reason: str


def judge(
    problem: Problem, selection: Selection | None, measure: Measure, refines: Callable[[Scored], str | None]
) -> Judgement:
    """refines: says what of the model a candidate refines, None where it is a cause of its own."""
    if len(problem.blocks) < 2:
        return _nothing(
            "not_testable",
            f"{len(problem.blocks)} test with measured samples; an effect is claimed only where it also "
            "predicts a test that it was not fitted to, so at least two are needed",
        )
    if selection is None:
        return _nothing("not_testable", "no effect of the library fits the channels that were logged")
    judged = tuple(
        Judged(m, refines(m), tuple(failed_rules(m, measure, problem.unit)), beside.ranked)
        for m, beside in zip(selection.members, selection.beside, strict=True)
    )
    claims = _claims([j for j in judged if j.sound and j.refines is None])
    kept = tuple(j for j in judged if j.sound and j.refines is not None)
    if claims:
        return Judgement("effect", claims, kept, judged, "")
    left = remaining(selection.first.ranked[0])
    if kept:
        return Judgement("refine", (), kept, judged, "no cause is missing; what the model has can be refined")
    if left <= measure.floor:
        why = (
            f"the error on left-out tests, {left:.2g} {problem.unit}, is at the floor of "
            f"{measure.floor:.2g} {problem.unit} (noise, and {FLOOR_SHARE:.0%} of the response)"
        )
        return Judgement("none", (), (), judged, why)
    best = judged[0] if judged else None
    because = f": the best, {best.scored.candidate.id}, fails because {best.failed[0]}" if best and best.failed else ""
    why = (
        f"{left:.2g} {problem.unit} remain on left-out tests, above the floor of {measure.floor:.2g}, and nothing "
        f"logged explains them{because}"
    )
    return Judgement("unknown", (), (), judged, why)


def _nothing(verdict: Verdict, reason: str) -> Judgement:
    return Judgement(verdict, (), (), (), reason)


def _claims(sound: Sequence[Judged]) -> tuple[Judged, ...]:
    """The largest, and those that explain nearly as much: what is far smaller may be what the largest leaves."""
    order = sorted(sound, key=lambda j: -explained(j.scored))
    return tuple(j for j in order if explained(j.scored) >= BESIDE_SHARE * explained(order[0].scored))[:MOST_CLAIMS]


def failed_rules(scored: Scored, measure: Measure, unit: str) -> list[str]:
    """The rules that a candidate fails, as sentences; none where it may be claimed."""
    failed = []
    p = p_value(scored.evidence, measure.chance)
    if p > P_LIMIT:
        failed.append(f"chance does as well in {p:.1%} of responses in which nothing is missing (limit {P_LIMIT:.0%})")
    count = int(scored.acts.sum())
    if scored.drop < DROP_LIMIT:
        failed.append(
            f"in the {count} left-out tests in which it acts the error falls by {max(scored.drop, 0):.0%} only "
            f"(limit {DROP_LIMIT:.0%})"
        )
    if scored.better < BETTER_LIMIT:
        failed.append(
            f"it makes {round(scored.better * count)} of the {count} tests in which it acts more probable (limit "
            f"{BETTER_LIMIT:.0%})"
        )
    if scored.spread > SPREAD_LIMIT:
        failed.append(
            f"its gain differs between tests by {scored.spread:.0%} (limit {SPREAD_LIMIT:.0%}): a cause acts alike "
            "everywhere"
        )
    if explained(scored) < WORTH_SHARE * measure.spread:
        failed.append(
            f"it explains {explained(scored):.2g} {unit} where it acts, of {measure.spread:.2g} {unit} (limit "
            f"{WORTH_SHARE:.0%})"
        )
    if explained(scored) > STEADIES * acting_size(scored):
        failed.append(
            f"the error falls by more than {STEADIES:g} times its own size: it only steadies what the model "
            "extrapolates"
        )
    return failed


def remaining(scored: Scored) -> float:
    """RMS error of all left-out tests without the candidate, each test alike."""
    return float(np.sqrt(np.mean(scored.sse_before / scored.rows)))


def explained(scored: Scored) -> float:
    """RMS of what it takes away on left-out tests in which it acts."""
    return float(np.sqrt(max(0.0, scored.error_before**2 - scored.error_after**2)))


def acting_size(scored: Scored) -> float:
    """RMS of its contribution in the tests in which it acts."""
    acts = scored.acts
    return float(np.sqrt(np.mean(scored.size[acts] ** 2))) if acts.any() else 0.0


def equivalents(chosen: Scored, ranked: Sequence[Scored]) -> list[Scored]:
    """The candidates that the data can't tell from the chosen one."""
    return [s for s in ranked if s.columns is not chosen.columns and len(s.shape) and _alike(chosen, s)]


def _alike(a: Scored, b: Scored) -> bool:
    cosine = abs(float(a.shape @ b.shape))
    return cosine > ALIKE or (cosine > NEARLY_COSINE and b.evidence > NEARLY * a.evidence)
