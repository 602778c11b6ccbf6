"""The candidates of an answer: which are listed, in what order, and what is said of each."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from thermodata.diagnosis.candidates.of_library import CandidateEffect
from thermodata.diagnosis.candidates.unread import reads
from thermodata.diagnosis.claims.probability import elsewhere, probability
from thermodata.diagnosis.claims.rules import blunt, explained
from thermodata.diagnosis.locked.confirm import Confirmation
from thermodata.diagnosis.tell import ladder
from thermodata.diagnosis.tell.stated import Row, causes, goes_by_name, is_judged_beside, likeliest, reads_as, stated
from thermodata.diagnosis.tell.why import among, judged_beside, why
from thermodata.diagnosis.verdict.investigate import Investigation
from thermodata.diagnosis.verdict.judge import Judged, Judgement, equivalents
from thermodata.diagnosis.weigh.figures import from_to
from thermodata.diagnosis.weigh.foretold import Foretold
from thermodata.diagnosis.weigh.null import p_value
from thermodata.diagnosis.weigh.scored import Scored
from thermodata.schema.answers.candidate import Candidate
from thermodata.view.grid.dataset import Dataset

SHOWN = 15


def _count(tests: frozenset[tuple[str, str]] | None) -> int | None:
    return None if tests is None else len(tests)


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


def lets_an_error_fall(s: Scored, investigation: Investigation) -> bool:
    """Whether left-out tests are foretold better with it, over all or where it acts, and locked ones that were opened
    for it no worse: nothing else is advised."""
    added = _added(s)
    if added is not None and added.after >= added.before:
        return False
    return s.drop > 0 or fall(beside_the_model(s, investigation)[0]) > 0


def _against_adding(s: Scored, investigation: Investigation) -> str:
    """Why a refinement is not advised, with what the locked tests say, where they were opened for it; '' where it
    is."""
    if lets_an_error_fall(s, investigation):
        return ""
    added, unit = _added(s), investigation.problem.unit
    figures = "" if added is None else f" ({from_to(added.before, added.after, unit)} about each one's mean)"
    if added is not None and added.after >= added.before:
        return f"locked tests are foretold no better with it{figures}"
    though = f", though locked ones are{figures}" if added is not None else ""
    return f"left-out tests are foretold no better with it{though}"


def _added(s: Scored) -> Foretold | None:
    """What locked tests say of it, added to the model as it stands; None where they were not opened, or say nothing."""
    added = s.looked.added if s.looked is not None else None
    return added if added is not None and s.looked is not None and added in s.looked.saying else None


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


def candidate(
    rank: int,
    s: Scored,
    member: Judged | None,
    heads: bool,
    told_with: Sequence[Scored],
    investigation: Investigation,
    judgement: Judgement,
    confirmation: Confirmation | None,
    data: Dataset,
) -> Candidate:
    """heads: whether it is the first that refines nothing. told_with: of which a probability is stated."""
    problem, measure = investigation.problem, investigation.measure
    claimed = among(member, judgement.claims)
    heads = heads or claimed or among(member, judgement.refused)
    refining = among(member, judgement.refinements)
    beside = member.beside if member else investigation.selection.first.ranked if investigation.selection else ()
    held = confirmation if claimed else None
    told, of_model = beside_the_model(s, investigation)
    one, as_judged = as_told(s, member, told, investigation, judgement)
    shape = held.on(held.asked) if held else _added(s) if refining else s.looked.least if s.looked else None
    told_of = any(s is t for t in told_with)
    by_name = goes_by_name(one, told_with) if as_judged is None else None
    mode = reads_as(one, [j.scored for j in judgement.refinements]) if as_judged is None else None
    twins = [t.candidate for t in equivalents(_as_ranked(s, beside), beside)]
    against = _against_adding(one, investigation) if among(as_judged, judgement.refinements) else ""
    return Candidate(
        rank=rank,
        id=s.candidate.id,
        effect=s.candidate.effect.name,
        family=s.candidate.family,
        drivers=list(s.candidate.channels),
        gain_by=s.candidate.gain_by,
        phases=list(s.candidate.phases),
        claimed=claimed,
        refinement=refining,
        # measured for what is sound; nothing is known of the share of the others
        probability=probability(s) if told_of else None,
        # chance was asked beside effects that may act otherwise
        p_value=None if one.as_modelled else p_value(one.evidence, measure.chance),
        rmse_um_before=rmse(told.sse_before, told),
        rmse_um_after=rmse(told.sse_after, told),
        fit_before=_fit(told.sse_before, told, measure.spread),
        fit_after=_fit(told.sse_after, told, measure.spread),
        locked_rmse_um_before=held.before if held else None,
        locked_rmse_um_after=held.after if held else None,
        locked_shape_um_before=shape.before if shape else None,
        locked_shape_um_after=shape.after if shape else None,
        locked_tests_asked=_count(held.asked if held else s.looked.foretold.tests if s.looked else None),
        as_modelled=s.as_modelled,
        parameters=held.parameters.get(s.candidate.id, {}) if held else {},
        beside=[] if of_model else judged_beside(one, as_judged, investigation, judgement),
        equivalent=[t.id for t in twins],
        unread=_unread(s, [*twins, *(j.scored.candidate for j in judgement.claims)], data) if heads or told_of else [],
        also_on=dict(s.also_on),
        why=why(
            one,
            as_judged,
            investigation,
            judgement,
            held,
            told,
            by_name or mode,
            of_model=of_model,
            against=against,
            has_twins=bool(twins),
            by_that_name=one.candidate is not s.candidate,
        ),
        evidence=float(one.evidence) if np.isfinite(one.evidence) and not one.as_modelled else None,
        rungs=ladder.rungs(one, measure, problem.unit, sure=s if told_of else one),
        left_out=ladder.left_out(told, problem),
        courses=ladder.courses(one, problem) if heads or refining else [],
    )


def as_told(s: Scored, member: Judged | None, told: Scored, investigation: Investigation, judgement: Judgement) -> Row:
    """What a row says of itself: its own candidate, or, where its errors are told of another that is one equation with
    it, that other as it stands in its own row, so that figures, rules and reason are of one thing."""
    if told.candidate is s.candidate:
        return s, member
    for j in (*judgement.judged, *judgement.heats):
        if j.scored.columns is told.columns:
            return j.scored, j
    dropped = () if investigation.selection is None else investigation.selection.dropped
    return next((d for d in dropped if d.columns is told.columns), told), None


def _as_ranked(s: Scored, ranked: Sequence[Scored]) -> Scored:
    """What was dropped was scored beside others, and is alike only as the same ranking has it."""
    return next((r for r in ranked if r.columns is s.columns and len(r.shape)), s)


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


def _unread(s: Scored, named: Sequence[CandidateEffect], data: Dataset) -> list[str]:
    """Places of other parts that it may be; not those that a temperature reads which the answer names beside it."""
    others = {n for one in named for n in one.channels if n not in s.candidate.channels}
    beside = {n: channel for n, channel in data.channels.items() if n in others}
    return [place for place in elsewhere(s) if not reads(beside, place)]


def beside_the_model(s: Scored, investigation: Investigation) -> tuple[Scored, bool]:
    """The candidate beside the user's own model, where it shows there what it does; else beside what hides it. And
    whether it is the former. Of some candidates the answer has errors that are told in their place."""
    if s.as_modelled:
        return s, True
    if (told := investigation.told.get(id(s.columns))) is not None:
        return told
    first = investigation.selection.first.ranked if investigation.selection is not None else ()
    ranked = [f for f in first if len(f.rows)]
    alone = next((f for f in ranked if f.columns is s.columns), None)
    if alone is not None and not len(s.rows):
        return alone, True
    # with nothing beside it, what falls is the model's own error; in the little noise that is left the known effects
    # are pulled further towards what is missing, and foretell other tests worse than the model does
    judged = investigation.on_open.judged
    if ranked and (judged or not s.others) and all(j.scored.columns is s.columns for j in judged):
        s = replace(s, sse_before=ranked[0].sse_before)
    if alone is None:
        return s, False
    return (alone, True) if fall(alone) >= fall(s) else (s, False)


def explainable(shown: Sequence[Scored], investigation: Investigation) -> tuple[float | None, str | None]:
    """What one candidate alone takes off the squared error, as a share, and which that is: the most of those listed,
    and of all others beside the model. Beside others a candidate takes away what they leave; of one alone that says
    nothing."""
    ranked = investigation.selection.first.ranked if investigation.selection is not None else ()
    told = [beside_the_model(s, investigation)[0] for s in shown]
    alone = [s for s in (*told, *ranked) if len(s.rows) and not s.others and not s.as_modelled]
    best = max(alone, key=fall, default=None)
    return (None, None) if best is None else (float(np.clip(fall(best), 0.0, 1.0)), best.candidate.id)


def rmse(sse: np.ndarray, s: Scored) -> float | None:
    return float(np.sqrt(np.mean(sse / s.rows))) if len(s.rows) else None


def fall(s: Scored) -> float:
    """Of the squared error on left-out tests, each test alike, as a share."""
    before = float(np.mean(s.sse_before / s.rows))
    return 1 - float(np.mean(s.sse_after / s.rows)) / before if before > 0 else 0.0


def _fit(sse: np.ndarray, s: Scored, spread: float) -> float | None:
    error = rmse(sse, s)
    return None if error is None or spread <= 0 else (1 - error / spread) * 100
