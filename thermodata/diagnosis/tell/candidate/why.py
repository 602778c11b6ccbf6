"""What an answer says of one candidate: its figures, and why it is claimed or not, in a sentence."""

from __future__ import annotations

from thermodata.diagnosis.candidates.candidate_effect import CandidateEffect
from thermodata.diagnosis.claims.in_words import also_missing, on_locked
from thermodata.diagnosis.claims.refines import by_kind, not_advised
from thermodata.diagnosis.claims.rules import LEAST_TESTS
from thermodata.diagnosis.claims.rules_together import failed_rules
from thermodata.diagnosis.tell.candidate.ladder import of_probability
from thermodata.diagnosis.tell.candidate.of_claim import (
    also_of_motor,
    in_spite_of,
    placeless_limit,
    where_nothing_is_cut,
)
from thermodata.diagnosis.tell.candidate.of_locked import said_by_locked
from thermodata.diagnosis.tell.candidate.of_one_body import in_place_of_heats, only_warms
from thermodata.diagnosis.tell.candidate.told import Told
from thermodata.diagnosis.tell.listing.errors_told import errors_of_all
from thermodata.diagnosis.tell.listing.stated import among, is_a_cause, is_judged_beside
from thermodata.diagnosis.tell.outcome import Outcome
from thermodata.diagnosis.verdict.judged import Judged, Judgement
from thermodata.diagnosis.weigh.figures import from_to, way
from thermodata.diagnosis.weigh.null import in_words as chance_in_words
from thermodata.diagnosis.weigh.scored import Scored
from thermodata.schema.words.sentences import in_percent, listed

ALIKE = 0.1  # of an error: two that differ by less are not told apart


def why(told: Told, outcome: Outcome) -> str:
    """The figures of a row, and then: what speaks for a claim, what a refinement is, or why it is neither."""
    judged, judgement = told.judged, outcome.judgement
    numbers = _errors_in_words(told, outcome)
    if told.by_another:
        numbers = f"it is one equation with {told.one.candidate.id} and told as that: {numbers}"
    if judged is not None and among(judged, judgement.claims):
        if told.by_another:
            return f"{numbers}; not claimed: it is claimed by that name"
        return f"{numbers}{_why_claimed(told, judged, outcome)}"
    refused = among(judged, judgement.refused)
    if judged is not None and judged.refines and not refused:
        refines = judged.refines
        if not told.twins and len(told.errors.rows):
            refines = by_kind(refines, from_to(*errors_of_all(told.errors), outcome.unit, "from", "to"))
        return f"{numbers}; a refinement, not claimed as missing: {not_advised(refines, told.against)}"
    reason = _why_refused(told.one, judgement) if refused else _not_claimed(told, outcome)
    return f"{numbers}; not claimed: {reason}"


def _errors_in_words(told: Told, outcome: Outcome) -> str:
    """What it does to the errors."""
    if told.of_model and told.others:
        left = from_to(*errors_of_all(told.errors), outcome.unit, "from", "to")
        own = _fall_where_it_acts(told, outcome)
        return f"alone it takes the error on left-out {outcome.tests} {left}; it is judged beside others: {own}"
    return _fall_where_it_acts(told, outcome, of_all=told.errors)


def _why_claimed(told: Told, judged: Judged, outcome: Outcome) -> str:
    """What speaks for a claim, and what is to be known of it."""
    scored, held, judgement = told.one, told.held, outcome.judgement
    measure, unit = outcome.measure, outcome.unit
    broken = failed_rules(scored, measure, unit)
    broken += [judged.refines.partition(":")[0]] if judged.refines else []
    said = [in_spite_of(scored, measure, unit), f"; {chance_in_words(scored.evidence, measure.chance)}"]
    if scored.also_on:
        said.append(f"; {also_missing(scored)}")
    if broken:
        said.append(f"; on the open tests {broken[0]}, which the locked ones outweigh")
    if held is not None:
        said.append(said_by_locked(scored, held, unit, measure.tests, together=len(judgement.claims) > 1))
    if judged.in_place_of:
        said.append(
            f"; taken by the locked tests in place of {judged.in_place_of}, which the open ones can't tell it from"
        )
    said.append(in_place_of_heats(scored, judgement, unit))
    if held is not None:
        said += [f"; {gain}" for gain in held.implausible.get(scored.candidate.id, ())]
    said.append(where_nothing_is_cut(scored, [b.test for b in outcome.investigation.problem.blocks]))
    said.append(also_of_motor(scored, [j.scored for j in judgement.claims]))
    return "".join([*said, placeless_limit(scored)])


def _not_claimed(told: Told, outcome: Outcome) -> str:
    """Why the open tests claim it not."""
    scored, judged, judgement = told.one, told.judged, outcome.judgement
    if judged is not None and judged.warms and judgement.one_body is not None:
        return only_warms(scored, judgement.one_body, outcome.unit)
    failed = failed_rules(scored, outcome.measure, outcome.unit)
    # a probability that is stated of no candidate is no reason either
    if not failed and told.by_name is not None:
        return f"{told.by_name.candidate.id} says the same of its channels by a name"
    if not failed and judged is None and not is_a_cause(scored, judged):
        return would_be_a_mode(scored.candidate)
    names = [j.scored.candidate.id for j in judgement.chosen]
    beside = is_judged_beside(scored, judged, chosen=bool(names))
    sure = of_probability(scored, told.sure)
    improbable = [sure.fails] if beside and not sure.holds else []
    if failed:
        said = "; and ".join([failed[0], *(why.partition(": ")[0] for why in improbable)])
        return f"{said}; {on_locked(scored.looked)}" if scored.looked is not None and scored.looked.saying else said
    if improbable:
        return improbable[0] + in_place_of_heats(scored, judgement, outcome.unit)
    heads = [j.scored for j in (*judgement.claims, *judgement.refused)][:1]
    if not beside and all(errors_of_all(scored)[1] < errors_of_all(head)[1] for head in heads):
        were = "was" if len(names) == 1 else "were"
        rules = "the rules" if sure.holds else "all rules but that of the probability"
        return f"it keeps {rules} by itself, and {listed(names)} {were} chosen without it"
    if judgement.claims:
        return f"{judgement.claims[0].scored.candidate.id} explains it, or more"
    if judgement.refused:
        first = judgement.refused[0].scored.candidate.id
        return f"{first}, which the locked tests do not bear out, explains it, or more"
    return judgement.reason


def would_be_a_mode(one: CandidateEffect) -> str:
    """Why what is no cause by its kin is none: of a plain function, what else it may be."""
    if not one.unmodelled:
        return "it would be another mode of what the model has"
    return (
        f"the model reads what sits there already, so {one.id}, which names no heat, may be another mode of that; or "
        f"it is {' or '.join(one.unmodelled)}, of whose heat the model has nothing: confirm it by that name"
    )


def _fall_where_it_acts(told: Told, outcome: Outcome, of_all: Scored | None = None) -> str:
    """Where it acts, how far the error falls there, and in how many tests it says so. of_all: what the errors over all
    tests are said of, where they are said."""
    scored, unit, tests = told.one, outcome.unit, outcome.tests
    count = int(scored.acts.sum())
    beside = f", beside {listed(told.others)}," if told.others else ""
    beside = ", beside the effects as the model has them, one lag each," if scored.as_modelled else beside
    return (
        f"{where_it_acts(count, len(scored.rows), tests)}{beside} the error "
        f"{way(scored.error_before, scored.error_after)} "
        # unlike the errors on left-out tests, for which the known effects are left out as well
        f"({from_to(scored.error_before, scored.error_after, unit)}), with its size from the other {tests} and the "
        f"known effects fitted to all{_of_all(scored, of_all, tests, unit)}, {_more_probable(scored, count)}; "
        f"{gain_between(scored, tests)}"
    )


def _more_probable(scored: Scored, count: int) -> str:
    """In how many of the tests in which it acts; with how that can be where the error does not fall."""
    better = f"it makes {round(scored.better * count)} of {count} more probable"
    if scored.error_after < scored.error_before or not scored.better:
        return f"and {better}"
    return (
        f"though {better}: that is of their samples with the known effects free to act otherwise in each, the error of "
        "the course as the others foretell it"
    )


def gain_between(scored: Scored, tests: str) -> str:
    """'its gain differs between tests by 8 %': of one test nobody knows."""
    if int(scored.acts.sum()) < LEAST_TESTS:
        return f"no other {tests[:-1]} tells its gain"
    return f"its gain differs between {tests} by {in_percent(scored.spread)}"


def where_it_acts(count: int, of: int, tests: str) -> str:
    """'where it acts most (6 of 7 tests)': in the others it does less than a fifth of its largest, which is no rest."""
    return f"where it acts{' most' if count < of else ''} ({count} of {of} {tests})"


def _of_all(scored: Scored, told: Scored | None, tests: str, unit: str) -> str:
    """What the errors before and after are of, where these are others than those in which it acts; else ''."""
    if told is None or not len(told.rows):
        return ""
    left, own = errors_of_all(told), (scored.error_before, scored.error_after)
    if all(abs(a - b) <= ALIKE * b for a, b in zip(left, own, strict=True)):
        return ""
    return f" (over all {tests}, with these fitted to the other {tests} too, it goes {from_to(*left, unit)})"


def _why_refused(scored: Scored, judgement: Judgement) -> str:
    """Why what keeps every rule on the open tests is no claim."""
    if not judgement.claims:
        return judgement.reason
    claims = " with ".join(c.scored.candidate.id for c in judgement.claims)
    said = f": {on_locked(scored.looked)}" if scored.looked is not None and scored.looked.saying else ""
    return f"it explains the open tests, but beside {claims} the locked ones do not bear it out{said}"
