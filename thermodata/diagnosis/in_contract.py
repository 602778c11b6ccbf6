"""What a diagnosis came to, in the contract's form."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from thermodata.diagnosis.case import Case
from thermodata.diagnosis.claims.at_rest import AtRest as Resting
from thermodata.diagnosis.claims.detection import LARGE, Limit
from thermodata.diagnosis.concluded import Concluded
from thermodata.diagnosis.question.problem import Problem
from thermodata.diagnosis.question.responses import shares_left
from thermodata.diagnosis.sound import told
from thermodata.diagnosis.steps.artefact import noise_with_treads
from thermodata.diagnosis.tell.advising.advice import advice
from thermodata.diagnosis.tell.advising.next_test import after_clocks
from thermodata.diagnosis.tell.candidate import ladder
from thermodata.diagnosis.tell.candidate.row import alike_both_ways, candidate
from thermodata.diagnosis.tell.candidate.told import told_of
from thermodata.diagnosis.tell.listing.listed import explainable, first_cause, listed, with_probability
from thermodata.diagnosis.tell.listing.stated import Row
from thermodata.diagnosis.tell.of_version.as_stored import as_fitted
from thermodata.diagnosis.tell.of_version.started_on import started_with
from thermodata.diagnosis.tell.outcome import Outcome
from thermodata.diagnosis.unlogged.not_logged import not_logged
from thermodata.diagnosis.unlogged.unexplained import characterise
from thermodata.diagnosis.verdict.investigate import Investigation
from thermodata.diagnosis.verdict.suspect import Supposed, doubt_of_heat, first, nearest, suspect
from thermodata.diagnosis.weigh.scored import Scored
from thermodata.schema.answers.candidate import Candidate
from thermodata.schema.answers.clocks_in_doubt import clocks_in_doubt
from thermodata.schema.answers.diagnosis import (
    AtRest,
    DetectionLimit,
    Diagnosis,
    LockedUnasked,
    PutRight,
    ResponseLeft,
)
from thermodata.schema.answers.missing_heat import Unknown
from thermodata.view.grid.dataset import Dataset


def in_contract(
    case: Case, found: Concluded, model_id: str, left_on_locked: float | None, *, by_choice: bool
) -> Diagnosis:
    """left_on_locked: the error on the locked tests, where it is known. by_choice: whether the response was asked
    for."""
    investigation, judgement, data = found.investigation, found.judgement, case.data
    problem, alone = investigation.problem, investigation.selection
    outcome = Outcome(investigation, judgement, found.confirmation)
    terms = [t.id for t in case.sound.fitted.responses[case.index].terms]
    shown = listed(investigation, judgement)
    head = first_cause(shown)
    right = _put_right(case, found)
    most, most_by = explainable([s for s, _ in shown], investigation)
    candidates = _candidates(shown, head, outcome, data)
    unread = not_logged(most, max((c.probability or 0.0 for c in candidates if not c.refinement), default=0.0))
    return Diagnosis(
        model=model_id,
        response=problem.response,
        verdict=judgement.verdict,
        noise_um=noise_with_treads(problem) if np.isfinite(problem.noise) else None,
        noise_over_s=next((float(b.test.t_s[1] - b.test.t_s[0]) for b in problem.blocks if len(b.test.t_s) > 1), None),
        left_out_over_s=problem.step_s,
        rmse_um=alone.left if alone is not None else _error_left(problem),
        named_rmse_um=None if found.named is None else float(np.sqrt(np.mean(found.named))),
        modelled_rmse_um=None if found.stands is None else found.stands.left,
        fitted_rmse_um=as_fitted(case.response, case.logged),
        locked_rmse_um=left_on_locked,
        explainable=most,
        explainable_by=most_by,
        weak_spots=investigation.spots,
        candidates=candidates,
        artefacts=investigation.artefacts,
        put_right=right,
        unknown=_unknown(shown, head, found, unread) if judgement.verdict == "unknown" else None,
        next_test=after_clocks(
            clocks_in_doubt(investigation.artefacts, right),
            advice(outcome, shown[0][0] if shown else None, head, data, terms),
        ),
        response_um=investigation.measure.spread,
        limits=[]
        if judgement.claims
        else [_detection_limit(one, terms, investigation) for one in investigation.limits],
        at_rest=[] if judgement.claims else _at_rest(investigation.at_rest, data),
        chance=ladder.chance(investigation.measure),
        responses=_responses_left(case),
        by_choice=by_choice,
        started_on=started_with(case.response, case.logged),
        open_tests=len(case.logged),
        open_tests_asked=len({b.test.key for b in problem.blocks}),
        locked_unasked=_locked_unasked(case, found),
        locked_tests=len(case.locked) + len(case.shut),
    )


def _candidates(shown: Sequence[Row], head: Scored | None, outcome: Outcome, data: Dataset) -> list[Candidate]:
    """head: the first that refines nothing."""
    stated = with_probability(shown, outcome.investigation, outcome.judgement)
    return alike_both_ways(
        [
            candidate(rank, told_of(row, stated, outcome), outcome, data, first=row[0] is head)
            for rank, row in enumerate(shown, 1)
        ]
    )


def _unknown(shown: Sequence[Row], head: Scored | None, found: Concluded, unread: float | None) -> Unknown:
    """Of heat that nobody logged. head: the first that refines nothing. unread: how probable it is that there is
    such."""
    investigation, problem = found.investigation, found.investigation.problem
    likely = suspect(found.judgement, head, investigation.measure, problem.unit)
    plausible = first(head, problem)
    left = investigation.selection.left if investigation.selection is not None else np.inf
    known = found.on_locked or likely is not None or plausible is not None
    supposed = Supposed(
        likely,
        plausible or nearest([s for s, _ in shown[:1] if s is head], problem),
        doubt_of_heat(left, investigation.measure, known=known),
    )
    return characterise(problem, investigation.spots, supposed, unread)


def _locked_unasked(case: Case, found: Concluded) -> list[LockedUnasked]:
    """The locked tests that lack what the model reads, and those that lack what is claimed."""
    lacking = list(case.shut)
    held = found.confirmation
    if held is not None and held.fitted is not None:
        asked = {s.key for s in held.shapes}
        rest = [t for t in case.locked if t.key not in asked and t.key not in found.turned]
        lacking += [(t, why) for t in rest if (why := held.fitted.why_not(t)) is not None]
    return [LockedUnasked(campaign=t.campaign, test=t.test, why=why) for t, why in lacking]


def _put_right(case: Case, found: Concluded) -> PutRight | None:
    mended = case.sound.put_right
    return told(mended.model_copy(update={"left_out": [*mended.left_out, *found.turned]}))


def _responses_left(case: Case) -> list[ResponseLeft]:
    shares = shares_left(case.fitted, case.logged)
    return [ResponseLeft(response=r.name, left=left) for r, left in zip(case.fitted.responses, shares, strict=True)]


def _at_rest(found: Sequence[Resting], data: Dataset) -> list[AtRest]:
    several = len({t.campaign for t in data.tests}) > 1
    return [
        AtRest(
            channel=one.channel,
            warms=list(one.warms),
            effects=list(one.effects),
            moves_in=["/".join(t.key) if several else t.test for t in one.moves_in],
        )
        for one in found
    ]


def _detection_limit(one: Limit, terms: Sequence[str], investigation: Investigation) -> DetectionLimit:
    ranked = investigation.selection.first.ranked if investigation.selection is not None else ()
    evidence = next((s.evidence for s in ranked if s.candidate.id == one.candidate.id), None)
    return DetectionLimit(
        id=one.candidate.id,
        effect=one.candidate.effect.name,
        family=one.candidate.family,
        drivers=list(one.candidate.channels),
        least_um=one.least if np.isfinite(one.least) else None,
        seen=one.beyond,
        behind=terms[one.like] if one.like is not None and one.hides else None,
        large=one.least > LARGE * investigation.measure.spread,
        evidence=float(evidence) if evidence is not None and np.isfinite(evidence) else None,
    )


def _error_left(problem: Problem) -> float | None:
    """The error of the model as it is fitted, where no candidate asked for left-out tests."""
    whole = np.concatenate([b.residual for b in problem.blocks]) if problem.blocks else np.empty(0)
    return float(np.sqrt(np.mean(whole**2))) if len(whole) else None
