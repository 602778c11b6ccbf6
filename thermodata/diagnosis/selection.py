"""Which effects together: forward, one at a time by evidence, the noise estimated again each time, and with swaps.

Where two or three effects are missing, one alone is judged in the noise of the others: so every member is weighed again
beside all others, by what dropping it costs.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from thermodata.diagnosis.candidates import CandidateEffect
from thermodata.diagnosis.discrepancy import Noise
from thermodata.diagnosis.evidence import Columns, Weighed, columns, moments
from thermodata.diagnosis.known import Known, known, likeliest, likeliest_of
from thermodata.diagnosis.preference import better_twin, gives_way, preferred
from thermodata.diagnosis.problem import Problem
from thermodata.diagnosis.ranking import Ranked, rank_in, score
from thermodata.diagnosis.scored import Scored
from thermodata.plugin import Int1D
from thermodata.store.base.counting import counted

MOST = 5  # effects that one diagnosis adds
PASSES = 3
WORTH = 10.0  # log evidence that a further effect must bring
STANDS = 0.15  # of the first one's evidence: less, and no noise brings a candidate to the front
TRIED = 5  # candidates beside which the noise is estimated


@dataclass(frozen=True, slots=True)
class Member:
    """One effect of the set. alone: as it was chosen, beside what was chosen before. scored: beside all others. beside:
    all candidates, ranked beside these others."""

    alone: Scored
    scored: Scored
    beside: tuple[Scored, ...]


@dataclass(frozen=True, slots=True)
class Selection:
    """first: the ranking beside the model alone. members: in the order of their choice. dropped: what the evidence
    chose and a rule forbade. noise: beside all members. left: RMS error of the model alone on left-out tests, in the
    response's unit."""

    first: Ranked
    members: tuple[Member, ...]
    dropped: tuple[Scored, ...]
    noise: Noise
    left: float


def first_ranking(problem: Problem, candidates: Sequence[CandidateEffect]) -> Ranked | None:
    """Beside the model alone. None where nothing can be left out, or no candidate's drivers move."""
    if len(problem.blocks) < 2:
        return None
    pool = [c for c in (columns(problem, k) for k in counted(candidates, "candidates")) if c is not None]
    return rank(problem, pool, None) if pool else None


def select(problem: Problem, first: Ranked, sound: Callable[[Scored], bool], *, among: Sequence[Columns]) -> Selection:
    """Forward by evidence, then what is not sound beside the others goes, the least likely first; and again, for what
    it stood in the way of; at last what was dropped beside others that went later is asked again. sound: whether a
    candidate keeps the rules of a claim. among: what may be chosen, of all that was ranked."""
    noise = first.known.space.noise
    chosen: list[Scored] = []
    current: list[Scored] = []
    dropped: list[Scored] = []
    for number in range(PASSES):
        rest = without(among, [*chosen, *dropped])
        last = _only(first, among) if number == 0 else rank(beside(problem, chosen), rest, noise, left_out=False)
        before = len(dropped)
        _forward(problem, among, chosen, dropped, last)
        noise = likeliest(beside(problem, chosen), noise)
        current = _each_beside_others(problem, chosen, noise)
        while unsound := [i for i, s in enumerate(current) if not sound(s)]:
            worst = min(unsound, key=lambda i: current[i].evidence)
            dropped.append(current[worst])
            chosen.pop(worst)
            noise = likeliest(beside(problem, chosen), noise)
            current = _each_beside_others(problem, chosen, noise)
        if len(dropped) == before:
            break
    before = len(chosen)
    noise = _second_chance(problem, chosen, dropped, noise, sound)
    if len(chosen) > before:
        current = _each_beside_others(problem, chosen, noise)
    credits = _credits(problem, current, noise)
    current = [replace(s, credit=c) for s, c in zip(current, credits, strict=True)]
    members = tuple(_member(problem, first, among, chosen, i, current[i], noise, sound) for i in range(len(chosen)))
    return Selection(first, members, tuple(dropped), noise, first.known.left_out)


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
    full = beside(problem, [m.alone for m in selection.members])
    beside_all = rank_in(full, without(some, [m.alone for m in selection.members]), selection.noise, left_out=False)
    found = (in_noise_of_best(ranked, TRIED) for ranked in (_only(first, some), beside_all))
    return any(may(s) for one in found if one is not None for s in one.ranked)


def _forward(
    problem: Problem, pool: Sequence[Columns], chosen: list[Scored], dropped: Sequence[Scored], last: Ranked
) -> None:
    """Adds to the chosen while the evidence is worth it. last: the ranking beside them."""
    while len(chosen) < MOST:
        # what the first pass dropped is small beside what it kept: the noise hides no more causes
        found = in_noise_of_best(last, TRIED if not dropped else 1)
        best = None if found is None else preferred(found.ranked)
        if found is None or best is None or found.worth < WORTH:
            return
        base = found.known
        if not len(best.rows):
            best = score(base.problem, base, best.columns, moments(base, best.columns), best.weighed)
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
        if worth >= WORTH and all(sound(s) for s in _each_beside_others(problem, tried, quieter)):
            chosen.append(best)
            dropped[:] = [s for s in dropped if s.columns is not best.columns]
            base, noise = full, quieter
            left = rank_in(base, [s.columns for s in left], noise).ranked
    return noise


@dataclass(frozen=True, slots=True)
class Found:
    """All candidates, ranked in the noise that is left beside the best of them. worth: what this one adds to the log
    evidence."""

    known: Known
    ranked: tuple[Scored, ...]
    best: Columns
    worth: float


def in_noise_of_best(last: Ranked, tried: int) -> Found | None:
    """What is missing makes the noise large, and in a large noise the right candidate hardly stands out: so beside each
    of the first ones the noise is estimated anew."""
    base = last.known
    some = _different(last.ranked)[:tried]
    some = [s for s in some if s.evidence >= STANDS * some[0].evidence]
    found: tuple[float, Noise, Scored] | None = None
    for one, noise in zip(some, _likeliest_beside(base.problem, some, base.space.noise), strict=True):
        worth = known(beside(base.problem, [one]), noise).log_evidence - base.log_evidence
        if found is None or worth > found[0]:
            found = worth, noise, one
    if found is None:
        return None
    worth, noise, one = found
    again = rank_in(base.problem, [s.columns for s in last.ranked], noise, left_out=False)
    return Found(again.known, again.ranked, one.columns, worth)


def _likeliest_beside(problem: Problem, some: Sequence[Scored], start: Noise) -> list[Noise]:
    """The noise beside each of them alone."""
    shapes = [problem.blocks[0]]
    for one in some:
        problem = beside(problem, [one])
        shapes.append(problem.blocks[0])
    base, slack = (np.array([getattr(b, name).shape[1] for b in shapes]) for name in ("base", "slack"))

    def columns(number: int) -> Int1D:
        """Those of the problem, and of this candidate."""
        own = [
            start + np.r_[: ends[0], ends[number] : ends[number + 1]] for start, ends in ((0, base), (base[-1], slack))
        ]
        return np.concatenate(own)

    return likeliest_of(problem, [columns(i) for i in range(len(some))], start) if some else []


def _different(ranked: Sequence[Scored]) -> list[Scored]:
    """The first on each set of channels, and the first that changes each effect of the model: a lag on its channels
    says something else."""
    found: dict[tuple[str | None, ...], Scored] = {}
    for one in ranked:
        found.setdefault((one.candidate.within, *one.candidate.channels), one)
    return list(found.values())


def beside(problem: Problem, chosen: Sequence[Scored]) -> Problem:
    """The same with chosen effects among what is known."""
    for one in chosen:
        problem = extended(problem, one.columns, one.weighed)
    return problem


def _each_beside_others(problem: Problem, chosen: Sequence[Scored], noise: Noise) -> list[Scored]:
    """In the noise beside all: what is left once nothing is missing, which is what tells rivals apart."""
    found = []
    for one in chosen:
        others = [c for c in chosen if c is not one]
        found.append(_weighed_beside(rank_in(beside(problem, others), [one.columns], noise).ranked[0], others))
    return found


def _weighed_beside(one: Scored, others: Sequence[Scored]) -> Scored:
    return replace(one, others=tuple(o.candidate.id for o in others))


def _credits(problem: Problem, members: Sequence[Scored], noise: Noise) -> list[float]:
    """The log evidence of each beside the likelier ones alone: what two of them explain alike is the likelier one's.
    Least likely first, each goes once it is weighed."""
    left, found = list(members), {id(one): one.evidence for one in members}
    while len(left) > 1:
        left.remove(min(left, key=lambda s: found[id(s)]))
        for one, again in zip(left, _each_beside_others(problem, left, noise), strict=True):
            found[id(one)] = again.evidence
    return [found[id(one)] for one in members]


def _only(ranked: Ranked, some: Sequence[Columns]) -> Ranked:
    kept = {id(c) for c in some}
    return replace(ranked, ranked=tuple(s for s in ranked.ranked if id(s.columns) in kept))


def _member(
    problem: Problem,
    first: Ranked,
    among: Sequence[Columns],
    chosen: Sequence[Scored],
    number: int,
    own: Scored,
    noise: Noise,
    sound: Callable[[Scored], bool],
) -> Member:
    """One that a sound candidate does clearly better, beside the others, is swapped for it; or one that is preferred to
    it, as in the choice: a lag that was added beside a name, and then drove it out, is still not the lag's own, where
    the name foretells left-out tests better; or for a twin that does so much better."""
    others = [c for i, c in enumerate(chosen) if i != number]
    ranking = rank_in(beside(problem, others), without([s.columns for s in first.ranked], others), noise)
    eligible = _only(ranking, among)
    best = preferred(eligible.ranked)
    if best is not None and gives_way(own, best, eligible) and sound(best):
        own = _in_place_of(own, best, others)
    twin = better_twin(own, eligible.ranked)
    if twin is not None and sound(twin):
        own = _in_place_of(own, twin, others)
    return Member(chosen[number], own, ranking.ranked)


def _in_place_of(own: Scored, other: Scored, beside: Sequence[Scored]) -> Scored:
    """What replaces another leaves it the credit for what likelier and less likely members explain alike."""
    gained = other.evidence - own.evidence
    return replace(_weighed_beside(other, beside), credit=(own.credit or own.evidence) + gained)


def without(pool: Sequence[Columns], chosen: Sequence[Scored]) -> list[Columns]:
    return [c for c in pool if not any(c is s.columns for s in chosen)]


def rank(problem: Problem, pool: Sequence[Columns], start: Noise | None, *, left_out: bool = True) -> Ranked:
    """By evidence. start: where the search of the noise begins. left_out: whether the first `SCORED` are asked for the
    tests that are left out; who chooses by evidence alone needs only what they look like."""
    return rank_in(problem, pool, likeliest(problem, start), left_out=left_out)


def extended(problem: Problem, made: Columns, weighed: Weighed) -> Problem:
    """The same with an effect among what is known: at its likeliest time constant, its neighbours at a price."""
    point, coefficients = weighed.best[0], weighed.coefficients
    gains, neighbours = made.gains, [p for p in (point - 1, point + 1) if 0 <= p < len(made.points)]
    blocks = []
    for block, full in zip(problem.blocks, made.blocks, strict=True):
        here = full[:, point]
        own = here[:, :gains] * np.where(coefficients[:gains] == 0, 1.0, coefficients[:gains])
        spare = [here[:, gains:].reshape(len(here), -1, gains) @ coefficients[:gains]]
        if made.on_a_line:
            spare += [(full[:, p, :gains] @ coefficients[:gains] - own.sum(axis=1))[:, None] for p in neighbours]
        blocks.append(replace(block, base=np.hstack([block.base, own]), slack=np.hstack([block.slack, *spare])))
    return replace(problem, blocks=tuple(blocks))
