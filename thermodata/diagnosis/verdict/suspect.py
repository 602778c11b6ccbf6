"""What is likely the cause though it may not be claimed: the answer points to it, and to nothing against it."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from thermodata.diagnosis.candidates.candidate_effect import CandidateEffect
from thermodata.diagnosis.claims.measure import GOOD_SHARE, Measure
from thermodata.diagnosis.claims.probability import limit_of, probability
from thermodata.diagnosis.claims.rules import DROP_LIMIT
from thermodata.diagnosis.claims.rules_together import failed_rules
from thermodata.diagnosis.question.problem import Problem
from thermodata.diagnosis.verdict.judged import Judgement
from thermodata.diagnosis.weigh.figures import from_to
from thermodata.diagnosis.weigh.scored import Scored
from thermodata.schema.agreed.limits import OF_NOTHING, PLAUSIBLE
from thermodata.schema.words.sentences import apart, beside

Doubt = Literal["none", "some", "all"]
"""Whether any heat is missing: more is left than of machines that lack nothing, as much, or as a good model leaves."""


@dataclass(frozen=True, slots=True)
class Suspect:
    """causes: one, or those that were to be claimed together. stopped: what alone stood against a claim, in words."""

    causes: tuple[CandidateEffect, ...]
    stopped: str

    @property
    def channels(self) -> frozenset[str]:
        """Every driver of the causes."""
        return frozenset(channel for one in self.causes for channel in one.channels)

    @property
    def told(self) -> str:
        """A sentence without its full stop."""
        return f"It may be {' with '.join(one.id for one in self.causes)}: {self.stopped}"


@dataclass(frozen=True, slots=True)
class First:
    """The first of the list, whatever rule it breaks: where it is plausible (then `probability` says so), or where
    left-out tests are foretold so much better with it that it is nearest to what is missing. acts_in: the keys of the
    tests in which it acts. error: where it acts, without and with it, in words."""

    cause: CandidateEffect
    probability: float | None
    acts_in: frozenset[tuple[str, str]]
    error: str = ""


@dataclass(frozen=True, slots=True)
class Supposed:
    """What an answer supposes of heat that nobody logged. suspect: what is likely it, and is logged; first: what ranks
    first, where it is plausible or nearest to it; doubt: whether any heat is missing."""

    suspect: Suspect | None = None
    first: First | None = None
    doubt: Doubt = "none"

    @property
    def channels(self) -> Collection[str]:
        """Those of what is likely it, else of what ranks first."""
        return self.suspect.channels if self.suspect else self.first.cause.channels if self.first else ()


NOTHING_SUPPOSED = Supposed()


def first(head: Scored | None, problem: Problem) -> First | None:
    """The first that refines nothing; None where it is not plausible, or no test was weighed for it."""
    if head is None or not len(head.rows) or probability(head) < PLAUSIBLE:
        return None
    return First(head.candidate, probability(head), _acts_in(head, problem))


def nearest(heads: Sequence[Scored], problem: Problem) -> First | None:
    """The first of the list that left-out tests are foretold better with, over all and by what a claim asks where it
    acts: no claim, but not to be passed over either."""
    for head in heads:
        if (
            len(head.rows)
            and head.drop >= DROP_LIMIT
            and np.mean(head.sse_after / head.rows) < np.mean(head.sse_before / head.rows)
        ):
            error = from_to(head.error_before, head.error_after, problem.unit)
            return First(head.candidate, None, _acts_in(head, problem), error)
    return None


def _acts_in(head: Scored, problem: Problem) -> frozenset[tuple[str, str]]:
    return frozenset(b.test.key for b, acts in zip(problem.blocks, head.acts.tolist(), strict=False) if acts)


def suspect(judgement: Judgement, head: Scored | None, measure: Measure, unit: str) -> Suspect | None:
    """What keeps the rules of a claim, and only the locked tests, the limit of its probability or the choice stopped;
    None where nothing is so likely. head: the first of the list that refines nothing. unit: of the response."""
    if judgement.refused:
        causes = tuple(j.scored.candidate for j in judgement.refused)
        return Suspect(causes, "the open tests say so, the locked ones do not bear it out")
    if head is None or failed_rules(head, measure, unit) or probability(head) < PLAUSIBLE:
        return None
    sure, limit = probability(head), limit_of(head)
    stopped = (
        f"it keeps the rules of a claim, but causes like it were right in {apart(sure, limit)} of cases only "
        f"({beside(sure, limit)})"
        if sure < limit
        else "alone it keeps the rules of a claim, but not beside what else was chosen"
    )
    return Suspect((head.candidate,), stopped)


def doubt_of_heat(left: float, measure: Measure, *, known: bool) -> Doubt:
    """What is left speaks for a body that nobody logged by its size alone: any residual has a course that one gives.

    left: the error of left-out tests, in the response's unit. known: whether a plausible cause, or locked tests, say
    that something is missing."""
    if known or left > OF_NOTHING * measure.spread:
        return "none"
    return "some" if left > max(measure.noises, GOOD_SHARE * measure.spread) else "all"
