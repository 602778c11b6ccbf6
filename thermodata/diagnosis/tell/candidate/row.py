"""A candidate as the published answer has it: its figures, its evidence, and why it is claimed or not."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from thermodata.diagnosis.candidates.candidate_effect import CandidateEffect
from thermodata.diagnosis.candidates.unread import motors_of, reads
from thermodata.diagnosis.claims.probability import elsewhere, of_either, probability
from thermodata.diagnosis.tell.candidate import ladder
from thermodata.diagnosis.tell.candidate.of_claim import heats_its_motor
from thermodata.diagnosis.tell.candidate.of_locked import stands_for
from thermodata.diagnosis.tell.candidate.told import Told
from thermodata.diagnosis.tell.candidate.why import why
from thermodata.diagnosis.tell.listing.advised import as_added
from thermodata.diagnosis.tell.listing.errors_told import rmse
from thermodata.diagnosis.tell.listing.stated import among
from thermodata.diagnosis.tell.outcome import Outcome
from thermodata.diagnosis.weigh.foretold import Foretold
from thermodata.diagnosis.weigh.null import p_value
from thermodata.diagnosis.weigh.scored import Scored
from thermodata.schema.answers.candidate import Candidate
from thermodata.view.grid.dataset import ChannelInfo, Dataset


def candidate(rank: int, told: Told, outcome: Outcome, data: Dataset, *, first: bool) -> Candidate:
    """first: whether it is the first of the list that refines nothing."""
    scored, one, errors, held = told.listed, told.one, told.errors, told.held
    problem, measure, judgement = outcome.investigation.problem, outcome.measure, outcome.judgement
    claimed = among(told.member, judgement.claims)
    heads = first or claimed or among(told.member, judgement.refused)
    refining = among(told.member, judgement.refinements)
    shape = _on_locked(told, refining=refining)
    asked = held.asked if held else scored.looked.foretold.tests if scored.looked else None
    unread = _unread_places(told, outcome, data) if heads or told.stated else []
    return Candidate(
        rank=rank,
        id=scored.candidate.id,
        effect=scored.candidate.effect.name,
        family=scored.candidate.family,
        drivers=list(scored.candidate.channels),
        gain_by=scored.candidate.gain_by,
        phases=list(scored.candidate.phases),
        claimed=claimed,
        refinement=refining,
        # measured for what is sound; nothing is known of the share of the others
        probability=probability(scored) if told.stated else None,
        probability_with_unread=of_either(scored) if told.stated and unread else None,
        # chance was asked beside effects that may act otherwise
        p_value=None if one.as_modelled else p_value(one.evidence, measure.chance),
        rmse_um_before=rmse(errors.sse_before, errors),
        rmse_um_after=rmse(errors.sse_after, errors),
        acting_um_before=one.error_before if one.acts.any() else None,
        acting_um_after=one.error_after if one.acts.any() else None,
        fit_before=_fit(errors.sse_before, errors, measure.spread),
        fit_after=_fit(errors.sse_after, errors, measure.spread),
        locked_rmse_um_before=held.before if held else None,
        locked_rmse_um_after=held.after if held else None,
        locked_rmse_um_fitted=held.stands if held else None,
        locked_shape_um_before=shape.before if shape else None,
        locked_shape_um_after=shape.after if shape else None,
        locked_tests_asked=None if asked is None else len(asked),
        stands_for=stands_for(scored, held) if held else None,
        as_modelled=scored.as_modelled,
        parameters=held.parameters.get(scored.candidate.id, {}) if held else {},
        beside=[] if told.of_model else list(told.others),
        equivalent=[t.id for t in told.twins],
        unread=unread,
        also_on=dict(scored.also_on),
        why=why(told, outcome),
        evidence=float(one.evidence) if np.isfinite(one.evidence) and not one.as_modelled else None,
        rungs=ladder.rungs(one, measure, problem.unit, sure=told.sure, claimed=claimed),
        left_out=ladder.left_out(errors, problem),
        courses=ladder.courses(one, problem) if heads or refining else [],
    )


def alike_both_ways(found: Sequence[Candidate]) -> list[Candidate]:
    """Of each pair the one that stands first says whether the two can be told apart."""
    twins = {one.id: list(one.equivalent) for one in found}
    for i, one in enumerate(found):
        for other in found[i + 1 :]:
            if other.id in twins[one.id] and one.id not in twins[other.id]:
                twins[other.id].append(one.id)
            elif other.id not in twins[one.id] and one.id in twins[other.id]:
                twins[other.id].remove(one.id)
    return [one.model_copy(update={"equivalent": twins[one.id]}) for one in found]


def _unread_places(told: Told, outcome: Outcome, data: Dataset) -> list[str]:
    """Places of other parts that it may be; not those that a temperature reads which the answer names beside it. The
    motor of a spindle that cuts nothing comes first, unless another claim reads it."""
    scored, claims = told.listed, [j.scored.candidate for j in outcome.judgement.claims]

    def read_by(some: Sequence[CandidateEffect]) -> dict[str, ChannelInfo]:
        names = {n for one in some for n in one.channels if n not in scored.candidate.channels}
        return {n: channel for n, channel in data.channels.items() if n in names}

    nothing_is_cut = heats_its_motor(scored, [b.test for b in outcome.investigation.problem.blocks])
    motors = motors_of(scored.candidate.channels, data.channels) if nothing_is_cut else ()
    found = [place for place in motors if not reads(read_by(claims), place)]
    beside = read_by([*told.twins, *claims])
    return list(dict.fromkeys([*found, *(place for place in elsewhere(scored) if not reads(beside, place))]))


def _on_locked(told: Told, *, refining: bool) -> Foretold | None:
    """What the locked tests say where it acts: as they were asked of a claim, of a refinement as it is added, else in
    the way that says least for it."""
    if told.held:
        return told.held.on(told.held.asked)
    if refining:
        return as_added(told.listed)
    return told.listed.looked.least if told.listed.looked else None


def _fit(sse: np.ndarray, scored: Scored, spread: float) -> float | None:
    error = rmse(sse, scored)
    return None if error is None or spread <= 0 else (1 - error / spread) * 100
