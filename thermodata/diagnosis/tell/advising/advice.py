"""Which of the pieces of advice (`next_test`, `to_find`) an answer ends with."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from thermodata.diagnosis.candidates.candidate_effect import CandidateEffect
from thermodata.diagnosis.claims.detection import LARGE, of_each_effect
from thermodata.diagnosis.claims.rules import P_LIMIT, rules
from thermodata.diagnosis.tell.advising import next_test
from thermodata.diagnosis.tell.advising.bare import to_log, with_fixture
from thermodata.diagnosis.tell.advising.to_find import to_find
from thermodata.diagnosis.tell.advising.worked import worked
from thermodata.diagnosis.tell.outcome import Outcome
from thermodata.diagnosis.verdict.investigate import Investigation
from thermodata.diagnosis.verdict.judge import equivalents
from thermodata.diagnosis.verdict.judged import Judged
from thermodata.diagnosis.weigh.null import p_value
from thermodata.diagnosis.weigh.scored import Scored
from thermodata.view.grid.dataset import Dataset


def advice(
    outcome: Outcome, first: Scored | None, head: Scored | None, data: Dataset, terms: Sequence[str]
) -> str | None:
    """first: of the list. head: the first that refines nothing. terms: ids of the model's effects."""
    said = _advice(outcome, first, data, terms)
    if outcome.judgement.verdict != "unknown":
        return said
    said = with_fixture(said, head, data.channels)
    unasked = _of_one_test_each(outcome.investigation)
    return said if unasked is None else next_test.to_ask_of_locked(unasked, said)


def _advice(outcome: Outcome, first: Scored | None, data: Dataset, terms: Sequence[str]) -> str | None:
    investigation, judgement, confirmation = outcome.investigation, outcome.judgement, outcome.confirmation
    claims, refused = ([j.scored.candidate for j in some] for some in (judgement.claims, judgement.refused))
    if claims:
        claim = judgement.claims[0]
        apart = next_test.to_tell_apart(claim.scored, equivalents(claim.scored, claim.beside), data.channels)
        if apart is not None:
            return apart
        for other in judgement.claims:
            if (log := to_log(other.scored, data.channels)) is not None:
                return log
        for each in judgement.claims:
            twins = [s.candidate for s in equivalents(each.scored, each.beside)]
            if (parts := next_test.to_tell_parts(each.scored.candidate, twins, data.channels)) is not None:
                return parts
    if refused:
        return next_test.to_decide(refused, data.channels)
    if claims and confirmation is not None and confirmation.asked == frozenset():
        return next_test.to_bear_out(claims, data.channels)
    if judgement.verdict in ("none", "refine"):
        large = LARGE * investigation.measure.spread
        for one in of_each_effect(investigation.limits):
            if one.least > large and one.hides and one.like is not None:
                return next_test.to_exclude(one.candidate, terms[one.like], data.channels)
        return None
    if judgement.verdict not in ("unknown", "not_testable"):
        return None
    if resting := [j.scored.candidate for j in judgement.judged if _acts_in_no_locked_test(j)]:
        return next_test.to_bear_out(resting, data.channels)
    if first is not None and (only := _only_test(first, investigation)) is not None:
        return next_test.to_repeat(first.candidate, only, data.channels)
    took_part = {b.test.key: b.test for b in investigation.problem.blocks}
    sources = worked(list(took_part.values()), data.channels)
    return to_find(len(took_part), investigation.spots, data.channels, first, sources)


def _of_one_test_each(investigation: Investigation) -> CandidateEffect | None:
    """What left-out tests can't be asked of, for one of its conditions stands in one test only: the likeliest one that
    chance does not do as well."""
    ranked = () if investigation.selection is None else investigation.selection.first.ranked
    chance = investigation.measure.chance
    some = [s for s in ranked if s.candidate.unforetold and p_value(s.evidence, chance) <= P_LIMIT]
    return max(some, key=lambda s: s.evidence).candidate if some else None


def _acts_in_no_locked_test(judged: Judged) -> bool:
    """Whether the lock was opened for it, as it is likely, and it acts in none of the locked tests."""
    looked = judged.scored.looked
    return judged.refines is None and looked is not None and looked.foretold.tests == frozenset()


def _only_test(scored: Scored, investigation: Investigation) -> str | None:
    """The name of the test that a candidate acts in, where that is one and no claim for it: another such test would
    tell. None where chance does as well."""
    broken = {r.name for r in rules(scored, investigation.measure, investigation.problem.unit) if not r.holds}
    if not len(scored.rows) or "others" not in broken or "chance" in broken:
        return None
    return str(investigation.problem.blocks[int(np.argmax(scored.size))].test.test)
