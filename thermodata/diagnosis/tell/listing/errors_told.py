"""Which errors are told of a candidate: beside the user's own model, or beside what hides it there."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from thermodata.diagnosis.tell.listing.stated import Row
from thermodata.diagnosis.verdict.investigate import Investigation
from thermodata.diagnosis.verdict.judged import Judged, Judgement
from thermodata.diagnosis.weigh.scored import Scored


def beside_the_model(scored: Scored, investigation: Investigation) -> tuple[Scored, bool]:
    """The candidate beside the user's own model, where it shows there what it does; else beside what hides it. And
    whether it is the former. Of some candidates the answer has errors that are told in their place."""
    if scored.as_modelled:
        return scored, True
    if (told := investigation.told.get(id(scored.columns))) is not None:
        return told
    first = investigation.selection.first.ranked if investigation.selection is not None else ()
    ranked = [f for f in first if len(f.rows)]
    alone = next((f for f in ranked if f.columns is scored.columns), None)
    if alone is not None and not len(scored.rows):
        return alone, True
    # with nothing beside it, what falls is the model's own error; in the little noise that is left the known effects
    # are pulled further towards what is missing, and foretell other tests worse than the model does
    judged = investigation.on_open.judged
    if ranked and (judged or not scored.others) and all(j.scored.columns is scored.columns for j in judged):
        scored = replace(scored, sse_before=ranked[0].sse_before)
    if alone is None:
        return scored, False
    return (alone, True) if fall(alone) >= fall(scored) else (scored, False)


def as_told(
    scored: Scored, member: Judged | None, told: Scored, investigation: Investigation, judgement: Judgement
) -> Row:
    """What a row says of itself: its own candidate, or, where its errors are told of another that is one equation with
    it, that other as it stands in its own row, so that figures, rules and reason are of one thing. Where that row is
    judged beside the candidate itself, the other beside the model."""
    if told.candidate is scored.candidate:
        return scored, member
    for j in (*judgement.judged, *judgement.heats):
        if j.scored.columns is told.columns:
            return j.scored, j
    dropped = () if investigation.selection is None else investigation.selection.dropped
    own = (d for d in dropped if d.columns is told.columns and scored.candidate.id not in d.others)
    return next(own, told), None


def judged_beside(
    scored: Scored, member: Judged | None, investigation: Investigation, judgement: Judgement
) -> list[str]:
    """Ids of what is in the model too where a candidate is judged, as the answer names them."""
    if scored.as_modelled:
        return []
    if member is None or member.warms:
        return list(scored.others)
    # what is offered beside the model as it stands stands beside no other candidate
    among_them = [j for j in judgement.judged if j.alone is not member.alone and not j.scored.as_modelled]
    others = [j.scored.candidate.id for j in among_them]
    context = () if investigation.selection is None else investigation.selection.context
    return [*others, *(c.candidate.id for c in context)]


def errors_of_all(scored: Scored) -> tuple[float, float]:
    """Errors of all tests that are left out whole, without and with it."""
    return float(np.sqrt(np.mean(scored.sse_before / scored.rows))), float(
        np.sqrt(np.mean(scored.sse_after / scored.rows))
    )


def rmse(sse: np.ndarray, scored: Scored) -> float | None:
    """RMS error in the response's unit, each test alike; None where no test was left out. sse: of each test."""
    return float(np.sqrt(np.mean(sse / scored.rows))) if len(scored.rows) else None


def fall(scored: Scored) -> float:
    """Of the squared error on left-out tests, each test alike, as a share."""
    before = float(np.mean(scored.sse_before / scored.rows))
    return 1 - float(np.mean(scored.sse_after / scored.rows)) / before if before > 0 else 0.0
