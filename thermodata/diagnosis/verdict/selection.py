"""Which effects together: forward, one at a time by evidence, the noise estimated again each time, and with swaps.

Where two or three effects are missing, one alone is judged in the noise of the others: so every member is weighed again
beside all others, by what dropping it costs.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from thermodata.diagnosis.candidates.candidate_effect import CandidateEffect
from thermodata.diagnosis.question.discrepancy import Noise
from thermodata.diagnosis.question.known import known, likeliest
from thermodata.diagnosis.question.problem import Problem
from thermodata.diagnosis.verdict.context import MOST, WORTH, Together, with_context
from thermodata.diagnosis.verdict.preference import (
    better_twin,
    gives_way,
    its_name,
    preferred,
    read_alone,
    what_warms_it,
)
from thermodata.diagnosis.weigh.beside import beside, each_beside_others, weighed_beside, without
from thermodata.diagnosis.weigh.difference import with_sides
from thermodata.diagnosis.weigh.evidence import Columns, columns
from thermodata.diagnosis.weigh.in_noise_of_best import TRIED, in_noise_of_best
from thermodata.diagnosis.weigh.ranking import Ranked, rank_in
from thermodata.diagnosis.weigh.scored import Scored
from thermodata.store.base.counting import counted

PASSES = 3


@dataclass(frozen=True, slots=True)
class _Ended:
    """What a pass ends with. weighed: the same, each beside all others. noise: beside all."""

    chosen: tuple[Scored, ...]
    weighed: tuple[Scored, ...]
    noise: Noise


@dataclass(frozen=True, slots=True)
class Member:
    """One effect of the set. alone: as it was chosen, beside what was chosen before. scored: beside all others. beside:
    all candidates, ranked beside these others."""

    alone: Scored
    scored: Scored
    beside: tuple[Scored, ...]


@dataclass(frozen=True, slots=True)
class Selection:
    """first: the ranking beside the model alone. members: in the order of their choice, weighed beside the context too.
    dropped: what the evidence chose and a rule forbade, the context among it. noise: beside all members. left: RMS
    error of the model alone on left-out tests, in the response's unit."""

    first: Ranked
    members: tuple[Member, ...]
    dropped: tuple[Scored, ...]
    noise: Noise
    left: float
    context: tuple[Scored, ...] = ()

    @property
    def together(self) -> tuple[Scored, ...]:
        """All that the noise is estimated beside: the members, as they were chosen, and the context."""
        return (*(m.alone for m in self.members), *self.context)


def first_ranking(problem: Problem, candidates: Sequence[CandidateEffect]) -> Ranked | None:
    """Beside the model alone. None where nothing can be left out, or no candidate's drivers move."""
    if len(problem.blocks) < 2:
        return None
    pool = [c for c in (columns(problem, k) for k in counted(candidates, "candidates")) if c is not None]
    return rank(problem, with_sides(pool), None) if pool else None


def select(
    problem: Problem, first: Ranked, sound: Callable[[Scored], bool], *, among: Sequence[Columns], good: float = 0.0
) -> Selection:
    """Forward by evidence, then what is not sound beside the others goes, the least likely first; and again, for what
    it stood in the way of; of what these passes end with the likeliest stands; at last what was dropped beside others
    that went later is asked again. sound: whether a candidate keeps the rules of a claim. among: what may be chosen, of
    all that was ranked. good: an error of the model on left-out tests that hides nothing."""
    passes, dropped = _passes(problem, first, sound, among)
    best = _likeliest_of(problem, passes)
    chosen, current, noise = list(best.chosen), list(best.weighed), best.noise
    dropped = [s for s in dropped if not any(s.columns is c.columns for c in chosen)]
    before = len(chosen)
    noise = _second_chance(problem, chosen, dropped, noise, sound)
    if len(chosen) > before:
        current = each_beside_others(problem, chosen, noise)
    whole = Together(tuple(chosen), tuple(current), noise)
    if first.known.left_out > good:
        whole = with_context(problem, whole, sound, among)
    held, noise, chosen = beside(problem, whole.context), whole.noise, list(whole.chosen)
    credits = _credits(held, whole.weighed, noise)
    current = [replace(s, credit=c) for s, c in zip(whole.weighed, credits, strict=True)]
    swaps = _Swaps(held, without([s.columns for s in first.ranked], whole.context), among, noise, sound)
    members = tuple(swaps.member(chosen, i, own) for i, own in enumerate(current))
    named = [*chosen, *whole.context]
    gone = (s for s in dropped if not any(s.columns is n.columns for n in named))
    return Selection(first, members, (*whole.context, *gone), noise, first.known.left_out, whole.context)


def any_stands_out(
    problem: Problem,
    first: Ranked,
    selection: Selection,
    some: Sequence[Columns],
    may: Callable[[Scored], bool],
) -> bool:
    """Whether one of some may be claimed at best, beside the model alone or beside the members, each time in the noise
    that the best of them leaves. first: all, beside the model alone."""
    if not some:
        return False
    full = beside(problem, selection.together)
    beside_all = rank_in(full, without(some, selection.together), selection.noise, left_out=False)
    found = (in_noise_of_best(ranked, TRIED) for ranked in (_ranked_among(first, some), beside_all))
    return any(may(s) for one in found if one is not None for s in one.ranked)


def _passes(
    problem: Problem, first: Ranked, sound: Callable[[Scored], bool], among: Sequence[Columns]
) -> tuple[list[_Ended], list[Scored]]:
    """(what each pass ends with, what they dropped): forward, then what is not sound beside the others goes."""
    noise = first.known.space.noise
    chosen: list[Scored] = []
    dropped: list[Scored] = []
    passes: list[_Ended] = []
    for number in range(PASSES):
        rest = without(among, [*chosen, *dropped])
        last = (
            _ranked_among(first, among) if number == 0 else rank(beside(problem, chosen), rest, noise, left_out=False)
        )
        before = len(dropped)
        _select_forward(problem, among, chosen, dropped, last)
        noise = likeliest(beside(problem, chosen), noise)
        current = each_beside_others(problem, chosen, noise)
        while unsound := [i for i, s in enumerate(current) if not sound(s)]:
            worst = min(unsound, key=lambda i: current[i].evidence)
            dropped.append(current[worst])
            chosen.pop(worst)
            noise = likeliest(beside(problem, chosen), noise)
            current = each_beside_others(problem, chosen, noise)
        passes.append(_Ended(tuple(chosen), tuple(current), noise))
        if len(dropped) == before:
            break
    return passes, dropped


def _likeliest_of(problem: Problem, passes: Sequence[_Ended]) -> _Ended:
    """The last, unless an earlier one is more likely by what a further effect is worth: what a pass adds may drive out
    what was found, and go itself. The last in the likeliest of their noises, for each is found by search."""
    likely = [known(beside(problem, p.chosen), p.noise).log_evidence for p in passes]
    last = beside(problem, passes[-1].chosen)
    limit = max(known(last, p.noise).log_evidence for p in passes) + WORTH
    best = int(np.argmax(likely))
    return passes[best] if likely[best] >= limit else passes[-1]


def _select_forward(
    problem: Problem, pool: Sequence[Columns], chosen: list[Scored], dropped: Sequence[Scored], last: Ranked
) -> None:
    """Adds to the chosen while the evidence is worth it. last: the ranking beside them."""
    while len(chosen) < MOST:
        # what the first pass dropped is small beside what it kept: the noise hides no more causes
        found = in_noise_of_best(last, TRIED if not dropped else 1, WORTH)
        best = None if found is None else preferred(found.ranked)
        if found is None or best is None:
            return
        base, best = found.known, found.scored(best)
        chosen.append(best)
        full, rest = beside(problem, chosen), without(pool, [*chosen, *dropped])
        noise = base.space.noise
        if best.columns is not found.best:
            noise = likeliest(full, noise)
        last = rank_in(full, rest, noise, left_out=False)


def _second_chance(
    problem: Problem, chosen: list[Scored], dropped: list[Scored], noise: Noise, sound: Callable[[Scored], bool]
) -> Noise:
    """Moves from the dropped to the chosen, likeliest first, what is worth it and leaves the whole set sound. The noise
    beside what is chosen then."""
    base = beside(problem, chosen)
    left = rank_in(base, [s.columns for s in dropped], noise).ranked if dropped else ()
    for _ in range(TRIED):
        best = preferred(left)
        if best is None or len(chosen) >= MOST:
            break
        left = tuple(s for s in left if s.columns is not best.columns)
        tried = [*chosen, best]
        full = beside(base, [best])
        quieter = likeliest(full, noise)
        worth = known(full, quieter).log_evidence - known(base, quieter).log_evidence
        if worth >= WORTH and all(sound(s) for s in each_beside_others(problem, tried, quieter)):
            chosen.append(best)
            dropped[:] = [s for s in dropped if s.columns is not best.columns]
            base, noise = full, quieter
            left = rank_in(base, [s.columns for s in left], noise).ranked
    return noise


def _credits(problem: Problem, members: Sequence[Scored], noise: Noise) -> list[float]:
    """The log evidence of each beside the likelier ones alone: what two of them explain alike is the likelier one's.
    Least likely first, each goes once it is weighed."""
    left, found = list(members), {id(one): one.evidence for one in members}
    while len(left) > 1:
        left.remove(min(left, key=lambda s: found[id(s)]))
        for one, again in zip(left, each_beside_others(problem, left, noise, left_out=False), strict=True):
            found[id(one)] = again.evidence
    return [found[id(one)] for one in members]


def _ranked_among(ranked: Ranked, some: Sequence[Columns]) -> Ranked:
    kept = {id(c) for c in some}
    return replace(ranked, ranked=tuple(s for s in ranked.ranked if id(s.columns) in kept))


@dataclass(frozen=True, slots=True)
class _Swaps:
    """What a member may be swapped for at last. problem: with the context; every: all candidates; among: those that may
    be chosen; noise: beside all members; sound: whether one keeps the rules of a claim."""

    problem: Problem
    every: Sequence[Columns]
    among: Sequence[Columns]
    noise: Noise
    sound: Callable[[Scored], bool]

    def member(self, chosen: Sequence[Scored], number: int, own: Scored) -> Member:
        """One that a sound candidate does clearly better, beside the others, is swapped for it; or one that is
        preferred to it, as in the choice: a lag that was added beside a name, and then drove it out, is still not the
        lag's own, where the name foretells left-out tests better; or for a twin that the model does not read, that does
        so much better, that warms what it reads, or that is its name. own: `chosen[number]` beside all others."""
        others = [c for i, c in enumerate(chosen) if i != number]
        ranking = rank_in(beside(self.problem, others), without(self.every, others), self.noise)
        eligible = _ranked_among(ranking, self.among)
        best = preferred(eligible.ranked)
        if best is not None and gives_way(own, best, eligible) and self.sound(best):
            own = _in_place_of(own, best, others)
        for one in (read_alone, better_twin, what_warms_it, its_name):
            twin = one(own, eligible.ranked)
            if twin is not None and self.sound(twin):
                own = _in_place_of(own, twin, others)
                break
        return Member(chosen[number], own, ranking.ranked)


def _in_place_of(own: Scored, other: Scored, beside: Sequence[Scored]) -> Scored:
    """What replaces another leaves it the credit for what likelier and less likely members explain alike."""
    gained = other.evidence - own.evidence
    return replace(weighed_beside(other, beside), credit=(own.credit or own.evidence) + gained)


def rank(problem: Problem, pool: Sequence[Columns], start: Noise | None, *, left_out: bool = True) -> Ranked:
    """By evidence. start: where the search of the noise begins. left_out: whether the first `SCORED` are asked for the
    tests that are left out; who chooses by evidence alone needs only what they look like."""
    return rank_in(problem, pool, likeliest(problem, start), left_out=left_out)
