"""What the evidence asks for beside the chosen, though a rule forbids that it be named.

Without it the chosen are weighed in the noise that it makes, and may not stand out. Where three are missing, one that
breaks a rule (its gain differs between tests) hides two others that break none. So it stands beside them, unnamed, as
long as all of them are the surer for it: what takes their evidence is a rival.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from thermodata.diagnosis.claims.probability import limit_of, probability
from thermodata.diagnosis.question.discrepancy import Noise
from thermodata.diagnosis.question.known import likeliest
from thermodata.diagnosis.question.problem import Problem
from thermodata.diagnosis.verdict.preference import preferred
from thermodata.diagnosis.weigh.beside import beside, each_beside_others, without
from thermodata.diagnosis.weigh.evidence import Columns
from thermodata.diagnosis.weigh.in_noise_of_best import TRIED, in_noise_of_best
from thermodata.diagnosis.weigh.ranking import rank_in
from thermodata.diagnosis.weigh.scored import Scored

WORTH = 10.0  # log evidence that a further effect must bring
MOST = 5  # effects that one diagnosis adds, the context among them
RIVALS = 3  # that would take evidence of the chosen, and the search ends


@dataclass(frozen=True, slots=True)
class Together:
    """chosen: with what is sound beside all. weighed: the same, beside all others. context: beside all others, too.
    noise: beside all."""

    chosen: tuple[Scored, ...]
    weighed: tuple[Scored, ...]
    noise: Noise
    context: tuple[Scored, ...] = ()


def with_context(
    problem: Problem, alone: Together, sound: Callable[[Scored], bool], among: Sequence[Columns]
) -> Together:
    """Adds one at a time, by evidence; none where nothing more can be claimed for it. alone: without any. among: what
    may be added; what reads a channel of the chosen is another mode of them and no context."""
    chosen, weighed, noise = list(alone.chosen), list(alone.weighed), alone.noise
    context: list[Scored] = []
    beside_all: list[Scored] = []
    rivals: list[Scored] = []
    while len(chosen) + len(context) < MOST and len(rivals) < RIVALS:
        read = {channel for one in chosen for channel in one.candidate.channels}
        pool = [c for c in without(among, [*chosen, *context, *rivals]) if read.isdisjoint(c.candidate.channels)]
        if not pool:
            break
        last = rank_in(beside(problem, [*chosen, *context]), pool, noise, left_out=False)
        found = in_noise_of_best(last, TRIED, WORTH)
        best = None if found is None else preferred(found.ranked)
        if found is None or best is None:
            break
        best = found.scored(best)
        tried = [*chosen, *context, best]
        quieter = likeliest(beside(problem, tried), noise)
        again = each_beside_others(problem, tried, quieter)
        surer = zip(again[: len(chosen)], weighed, strict=True)
        if not all(sound(now) and now.evidence >= was.evidence for now, was in surer):
            rivals.append(best)
            continue
        fine = [i < len(chosen) or sound(one) for i, one in enumerate(again)]
        chosen, context = _parted(tried, fine)
        weighed, beside_all = _parted(again, fine)
        noise = quieter
    whole = Together(tuple(chosen), tuple(weighed), noise, tuple(beside_all))
    return whole if _names_more(whole, alone) else alone


def _names_more(whole: Together, alone: Together) -> bool:
    """Whether more can be claimed, and none of it for what is more evident itself and has no name."""
    before = {id(s.columns) for s in alone.weighed if _is_sure(s)}
    gained = [s.evidence for s in whole.weighed if _is_sure(s) and id(s.columns) not in before]
    more = sum(map(_is_sure, whole.weighed)) > len(before)
    return more and max((s.evidence for s in whole.context), default=0.0) < min(gained)


def _is_sure(one: Scored) -> bool:
    return probability(one) >= limit_of(one)


def _parted(some: Sequence[Scored], fine: Sequence[bool]) -> tuple[list[Scored], list[Scored]]:
    return [s for s, f in zip(some, fine, strict=True) if f], [s for s, f in zip(some, fine, strict=True) if not f]
