"""A row of the answer before it is put into words: what is listed, and what stands behind each of its figures."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from thermodata.diagnosis.candidates.candidate_effect import CandidateEffect
from thermodata.diagnosis.locked.confirmation import Confirmation
from thermodata.diagnosis.tell.listing.advised import against_adding
from thermodata.diagnosis.tell.listing.errors_told import as_told, beside_the_model, judged_beside
from thermodata.diagnosis.tell.listing.stated import Row, among, goes_by_name, reads_as
from thermodata.diagnosis.tell.outcome import Outcome
from thermodata.diagnosis.verdict.judge import equivalents
from thermodata.diagnosis.verdict.judged import Judged
from thermodata.diagnosis.weigh.scored import Scored


@dataclass(frozen=True, slots=True)
class Told:
    """listed, member: the candidate as the list has it. one, judged: of what its figures, rules and reason are, mostly
    the same (`as_told`). others: ids of what `one` is judged beside. errors: on left-out tests; of_model: whether these
    are beside the model alone. stated: whether its probability is. by_name: what says the same of its channels by a
    name, and has its probability stated or refines the model. twins: what the tests can't tell from it. against: why a
    refinement is not to be added, '' where it is. held: what is claimed, on the locked tests; None of all else."""

    listed: Scored
    member: Judged | None
    one: Scored
    judged: Judged | None
    others: tuple[str, ...]
    errors: Scored
    of_model: bool
    stated: bool
    by_name: Scored | None
    twins: tuple[CandidateEffect, ...]
    against: str
    held: Confirmation | None

    @property
    def sure(self) -> Scored:
        """Of which its probability is told: its own where one is stated, so that a row has one."""
        return self.listed if self.stated else self.one

    @property
    def by_another(self) -> bool:
        """Whether it is told in place of another that is one equation with it, and never claimed by its own name."""
        return self.one.candidate is not self.listed.candidate


def told_of(row: Row, with_probability: Sequence[Scored], outcome: Outcome) -> Told:
    """with_probability: of which candidates one is stated."""
    s, member = row
    investigation, judgement = outcome.investigation, outcome.judgement
    errors, of_model = beside_the_model(s, investigation)
    one, judged = as_told(s, member, errors, investigation, judgement)
    by_name = None
    if judged is None:
        refining = [j.scored for j in judgement.refinements]
        named = goes_by_name(one, with_probability) or reads_as(one, refining)
        # what is told in the place of the row's own candidate goes by no other name than that
        by_name = None if named is None or named.candidate is s.candidate else named
    beside = member.beside if member else investigation.selection.first.ranked if investigation.selection else ()
    return Told(
        listed=s,
        member=member,
        one=one,
        judged=judged,
        others=tuple(judged_beside(one, judged, investigation, judgement)),
        errors=errors,
        of_model=of_model,
        stated=any(s is t for t in with_probability),
        by_name=by_name,
        twins=tuple(t.candidate for t in equivalents(as_ranked(s, beside), beside)),
        against=against_adding(one, investigation) if among(judged, judgement.refinements) else "",
        held=outcome.confirmation if among(member, judgement.claims) else None,
    )


def as_ranked(scored: Scored, ranked: Sequence[Scored]) -> Scored:
    """What was dropped was scored beside others, and is alike only as the same ranking has it."""
    return next((r for r in ranked if r.columns is scored.columns and len(r.shape)), scored)
