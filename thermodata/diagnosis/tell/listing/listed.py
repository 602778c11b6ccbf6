"""The candidates of an answer: which are listed, in what order, and of which a probability is stated."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from thermodata.diagnosis.claims.probability import probability
from thermodata.diagnosis.claims.rules import explained
from thermodata.diagnosis.claims.rules_together import blunt
from thermodata.diagnosis.tell.listing.advised import lets_an_error_fall
from thermodata.diagnosis.tell.listing.errors_told import beside_the_model, fall
from thermodata.diagnosis.tell.listing.stated import Row, among, causes, is_judged_beside, likeliest, stated
from thermodata.diagnosis.verdict.investigate import Investigation
from thermodata.diagnosis.verdict.judged import Judgement
from thermodata.diagnosis.weigh.scored import Scored

SHOWN = 15


def listed(investigation: Investigation, judgement: Judgement) -> list[Row]:
    """Claims, what the locked tests refused, refinements that let an error fall, then all others by the error that they
    take away in the tests in which they act, beside the model as the answer tells it; what was dropped as it was judged
    last. Where nothing is claimed the likeliest of the others comes before them; other refinements come last."""
    idle = [j for j in judgement.refinements if not lets_an_error_fall(j.scored, investigation)]
    refinements = [j for j in judgement.refinements if not among(j, idle)]
    first = [*judgement.claims, *judgement.refused, *refinements]
    order: list[Row] = [(j.scored, j) for j in first]
    rest = [j for j in judgement.judged if not any(j.scored.columns is f.scored.columns for f in first)]
    rest += judgement.heats
    others: list[Row] = [(j.scored, j) for j in rest]
    if investigation.selection is not None:
        found = [*investigation.selection.dropped, *investigation.selection.first.ranked]
        for s in found:
            if len(s.rows) and not any(s.columns is k.columns for k, _ in (*order, *others)):
                others.append((s, None))
    # what lets no error fall gives nothing, and stands by what is known of it otherwise
    others.sort(key=lambda item: (-explained(beside_the_model(item[0], investigation)[0]), -probability(item[0])))
    chosen = bool(judgement.chosen)
    head = likeliest([*order, *others], investigation.measure, investigation.problem.unit, chosen=chosen)
    others.sort(key=lambda item: not among(item[1], idle))
    if head is not None and not judgement.claims and not judgement.refused:
        others.sort(key=lambda item: item[0] is not head)
    return [*order, *others][:SHOWN]


def with_probability(shown: Sequence[Row], investigation: Investigation, judgement: Judgement) -> list[Scored]:
    """Of which candidates a probability is stated: claims, what the locked tests refused, the first cause, and causes
    that keep all other rules, each where it was judged beside what was chosen. What a claim may explain is judged
    beside it, or not at all, and may be another mode of it where its probability would do."""
    heads = [s for s, m in shown if among(m, judgement.claims) or among(m, judgement.refused)]
    chosen = bool(judgement.chosen)
    told = stated(shown, investigation.measure, investigation.problem.unit, chosen=chosen)
    if heads:
        judged = [j.scored for j in judgement.judged]
        told = [s for s in told if blunt(s) is not None and any(s is j for j in judged)]
    first = [s for s, m in causes(shown)[:1] if is_judged_beside(s, m, chosen=chosen)]
    return [*heads, *told, *first]


def first_cause(shown: Sequence[Row]) -> Scored | None:
    """The first of the list that refines nothing: what does is no missing cause, also where it leaves much."""
    return next((s for s, _ in causes(shown)), None)


def explainable(shown: Sequence[Scored], investigation: Investigation) -> tuple[float | None, str | None]:
    """What one candidate alone takes off the squared error, as a share, and which that is: the most of those listed,
    and of all others beside the model. Beside others a candidate takes away what they leave; of one alone that says
    nothing."""
    ranked = investigation.selection.first.ranked if investigation.selection is not None else ()
    told = [beside_the_model(s, investigation)[0] for s in shown]
    alone = [s for s in (*told, *ranked) if len(s.rows) and not s.others and not s.as_modelled]
    best = max(alone, key=fall, default=None)
    return (None, None) if best is None else (float(np.clip(fall(best), 0.0, 1.0)), best.candidate.id)
