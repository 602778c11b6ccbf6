"""The error on left-out tests of the user's own model with all that a verdict names: before and after are then of
models that somebody has, whatever else a candidate was judged beside. One model has one such error, wherever it is
told."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from threadpoolctl import threadpool_limits

from thermodata.diagnosis.candidates.candidate_effect import CandidateEffect
from thermodata.diagnosis.question.known import known, likeliest
from thermodata.diagnosis.tell.listing.advised import lets_an_error_fall
from thermodata.diagnosis.tell.listing.errors_told import beside_the_model, fall, judged_beside
from thermodata.diagnosis.tell.of_version.same_equation import may_be
from thermodata.diagnosis.verdict.investigate import Investigation, weighed
from thermodata.diagnosis.verdict.judged import Judged, Judgement
from thermodata.diagnosis.weigh.scored import Scored
from thermodata.errors import ThermodataError
from thermodata.modelling.terms.fitted_response import FittedResponse
from thermodata.plugin import Float1D
from thermodata.view.grid.dataset import Dataset, TestData

# the model with candidates, fitted to all open tests
Refit = Callable[[Sequence[CandidateEffect]], FittedResponse]


def named(investigation: Investigation, judgement: Judgement) -> list[Judged]:
    """The claims; where nothing is claimed, the refinements that let an error fall."""
    offered = [j for j in judgement.refinements if lets_an_error_fall(j.scored, investigation)]
    return list(judgement.claims) or offered


def left_with_named(
    investigation: Investigation, judgement: Judgement, refit: Refit, data: Dataset, tests: Sequence[TestData]
) -> Float1D | None:
    """Mean square of the error of each test that is left out in turn, as the next version's own answer will have it;
    as the candidate has it where that version can't be made. None where the verdict names nothing."""
    found = named(investigation, judgement)
    # beside the model as it has its effects errors are others, and the candidate tells them itself
    if not found or any(j.scored.as_modelled for j in found):
        return None
    left = _of_version([j.scored.candidate for j in found], refit, data, tests)
    if left is not None or len(found) > 1:
        return left
    told, of_model = beside_the_model(found[0].scored, investigation)
    if of_model or not judged_beside(found[0].scored, found[0], investigation, judgement):
        return told.sse_after / told.rows
    return None


def _of_version(
    candidates: Sequence[CandidateEffect], refit: Refit, data: Dataset, tests: Sequence[TestData]
) -> Float1D | None:
    try:
        fitted = refit(candidates)
    except ThermodataError:  # no open test has all of their channels
        return None
    if not all(fitted.can_predict(test) for test in tests):
        return None
    with threadpool_limits(1):
        problem, _ = weighed(fitted, data, tests)
        left = known(problem, likeliest(problem)).squares_left_out
    return left if np.all(np.isfinite(left)) else None


def told_alike(investigation: Investigation, judgement: Judgement, left: Float1D | None) -> Investigation:
    """With the errors that are told of candidates where one model has them all: what alone is named has those of the
    next version, and what may have the equation of another, those of that other. left: of the tests with all that is
    named."""
    if investigation.selection is None:
        return investigation
    told = dict[int, tuple[Scored, bool]]()
    # errors beside the model as it has its effects are of no other candidate
    judged = [j for j in judgement.judged if not j.scored.as_modelled]
    found = named(investigation, judgement)
    if len(found) == 1 and left is not None:
        one = found[0]
        scored, of_model = beside_the_model(one.scored, investigation)
        if (of_model or not judged_beside(one.scored, one, investigation, judgement)) and len(left) == len(scored.rows):
            told[id(one.scored.columns)] = replace(scored, sse_after=left * scored.rows), True
    # what was selected first, then what foretells best
    models = [
        (j.scored, *told.get(id(j.scored.columns), _told_beside_others(j, investigation, judgement))) for j in judged
    ]
    tests = list({id(b.test): b.test for b in investigation.problem.blocks}.values())
    others = [s for s in investigation.selection.first.ranked if len(s.rows)]
    others = [s for s in others if not any(s.columns is j.scored.columns for j in judged)]
    models += [(s, s, True) for s in sorted(others, key=lambda s: -fall(s))]
    for s in others:
        like = next((m for m in models if m[0].columns is not s.columns and may_be(s, m[0], tests)), None)
        better = like is not None and (any(like[0] is j.scored for j in judged) or fall(like[1]) > fall(s))
        if like is not None and better:
            told[id(s.columns)] = like[1], like[2]
    return replace(investigation, told=told)


def _told_beside_others(one: Judged, investigation: Investigation, judgement: Judgement) -> tuple[Scored, bool]:
    scored, of_model = beside_the_model(one.scored, investigation)
    others = () if of_model else tuple(judged_beside(one.scored, one, investigation, judgement))
    return replace(scored, others=others), of_model
