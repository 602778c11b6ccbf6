"""What is missing makes the noise large, and in a large noise the right candidate hardly stands out: so all are ranked
in the noise that the best of them leaves."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from thermodata.diagnosis.question.discrepancy import Noise
from thermodata.diagnosis.question.known import Known, known, likeliest_of
from thermodata.diagnosis.question.problem import Problem
from thermodata.diagnosis.weigh.beside import beside
from thermodata.diagnosis.weigh.evidence import Columns
from thermodata.diagnosis.weigh.ranking import Ranked, rank_in, score
from thermodata.diagnosis.weigh.scored import Scored
from thermodata.plugin import Int1D

STANDS = 0.15  # of the first one's evidence: less, and no noise brings a candidate to the front
TRIED = 5  # candidates beside which the noise is estimated


@dataclass(frozen=True, slots=True)
class Found:
    """All candidates, ranked in the noise that is left beside the best of them."""

    known: Known
    ranked: tuple[Scored, ...]
    best: Columns

    def scored(self, one: Scored) -> Scored:
        """One of those ranked, with what left-out tests say of it."""
        if len(one.rows):
            return one
        return score(self.known, one.columns, one.weighed)


def in_noise_of_best(last: Ranked, tried: int, least: float = -np.inf) -> Found | None:
    """What is missing makes the noise large, and in a large noise the right candidate hardly stands out: so beside each
    of the first ones the noise is estimated anew. None where the best of them adds less than `least` to the log
    evidence: then no other is asked in its noise."""
    base = last.known
    some = different(last.ranked)[:tried]
    some = [s for s in some if s.evidence >= STANDS * some[0].evidence]
    found: tuple[float, Noise, Scored] | None = None
    for one, noise in zip(some, likeliest_beside(base.problem, some, base.space.noise), strict=True):
        worth = known(beside(base.problem, [one]), noise).log_evidence - base.log_evidence
        if found is None or worth > found[0]:
            found = worth, noise, one
    if found is None or found[0] < least:
        return None
    _, noise, one = found
    again = rank_in(base.problem, [s.columns for s in last.ranked], noise, left_out=False)
    return Found(again.known, again.ranked, one.columns)


def likeliest_beside(problem: Problem, some: Sequence[Scored], start: Noise) -> list[Noise]:
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


def different(ranked: Sequence[Scored]) -> list[Scored]:
    """The first on each set of channels, and the first that changes each effect of the model: a lag on its channels
    says something else."""
    found: dict[tuple[str | None, ...], Scored] = {}
    for one in ranked:
        found.setdefault((one.candidate.within, *one.candidate.channels), one)
    return list(found.values())
