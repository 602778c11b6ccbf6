"""What an answer says of one candidate: its figures, and why it is claimed or not, in a sentence."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from thermodata.diagnosis.candidates.of_library import CandidateEffect
from thermodata.diagnosis.claims.measure import Measure
from thermodata.diagnosis.claims.probability import CLAIMED, limit_of, probability, sharpness
from thermodata.diagnosis.claims.refinement import SURE
from thermodata.diagnosis.claims.refines import by_kind, not_advised
from thermodata.diagnosis.claims.rules import LEAST_TESTS, also_missing, blunt, failed_rules, on_locked, rules
from thermodata.diagnosis.locked.confirm import Confirmation
from thermodata.diagnosis.tell.of_locked import said_by_locked
from thermodata.diagnosis.tell.of_one_body import in_place_of_heats, only_warms
from thermodata.diagnosis.tell.stated import is_a_cause, is_judged_beside
from thermodata.diagnosis.verdict.investigate import Investigation
from thermodata.diagnosis.verdict.judge import Judged, Judgement
from thermodata.diagnosis.weigh.figures import from_to, way
from thermodata.diagnosis.weigh.null import in_words as chance_in_words
from thermodata.diagnosis.weigh.scored import Scored
from thermodata.schema.words.sentences import in_percent, listed
from thermodata.view.grid.dataset import TestData

# what a claim may break where it is evident, by the name of the rule
_OUTWEIGHED = {
    "fall": "that the error hardly falls",
    "gain": "that its gain differs",
    "others": "that no other test foretells it",
    "worth": "that it explains so little",
}
_CUTTING = "cutting"
_NOTHING_IS_CUT = ("spindle", "spectrum", "linear_axis", "rotary_axis", "etve")
_SHOWN = 3  # tests
ALIKE = 0.1  # of an error: two that differ by less are not told apart
_DRIVES_A_MOTOR = ("power", "load", "current", "torque")


def judged_beside(s: Scored, member: Judged | None, investigation: Investigation, judgement: Judgement) -> list[str]:
    """Ids of what is in the model too where a candidate is judged, as the answer names them."""
    if s.as_modelled:
        return []
    if member is None or member.warms:
        return list(s.others)
    # what is offered beside the model as it stands stands beside no other candidate
    among_them = [j for j in judgement.judged if j.alone is not member.alone and not j.scored.as_modelled]
    others = [j.scored.candidate.id for j in among_them]
    context = () if investigation.selection is None else investigation.selection.context
    return [*others, *(c.candidate.id for c in context)]


def why(
    s: Scored,
    member: Judged | None,
    investigation: Investigation,
    judgement: Judgement,
    held: Confirmation | None,
    told: Scored | None = None,
    by_name: Scored | None = None,
    *,
    of_model: bool = True,
    against: str = "",
    has_twins: bool = True,
    by_that_name: bool = False,
) -> str:
    """member: the same, as it was judged; None where it was not selected. held: of what is claimed, on locked tests.
    told: the same, as the answer's errors on left-out tests are of it; of_model: whether beside the model alone.
    by_name: what says the same of its channels by a name, and has its probability stated. against: why a refinement
    is not to be added, where that is so. has_twins: whether others do the same in these tests. by_that_name: whether it
    is told in place of another that is one equation with it, and never claimed by its own name."""
    numbers = _figures(s, told, judged_beside(s, member, investigation, judgement), investigation, of_model=of_model)
    if by_that_name:
        numbers = f"it is one equation with {s.candidate.id} and told as that: {numbers}"
    if member is not None and among(member, judgement.claims):
        if by_that_name:
            return f"{numbers}; not claimed: it is claimed by that name"
        return f"{numbers}{_claimed(s, member, investigation, judgement, held)}"
    refused = among(member, judgement.refused)
    if member is not None and member.refines and not refused:
        refines = member.refines
        if not has_twins and len((of_all := told or s).rows):
            refines = by_kind(refines, from_to(*_left_out(of_all), investigation.problem.unit, "from", "to"))
        return f"{numbers}; a refinement, not claimed as missing: {not_advised(refines, against)}"
    reason = _refused(s, judgement) if refused else _not_claimed(s, member, investigation, judgement, by_name)
    return f"{numbers}; not claimed: {reason}"


def _figures(
    s: Scored, told: Scored | None, others: Sequence[str], investigation: Investigation, *, of_model: bool
) -> str:
    """What it does to the errors. told, of_model: as in `why`. others: what it is judged beside."""
    unit, tests = investigation.problem.unit, investigation.measure.tests
    if told is not None and of_model and others:
        left = from_to(*_left_out(told), unit, "from", "to")
        own = _numbers(s, None, investigation, others)
        return f"alone it takes the error on left-out {tests} {left}; it is judged beside others: {own}"
    return _numbers(s, told, investigation, others)


def _claimed(
    s: Scored, member: Judged, investigation: Investigation, judgement: Judgement, held: Confirmation | None
) -> str:
    """What speaks for a claim, and what is to be known of it."""
    measure, unit = investigation.measure, investigation.problem.unit
    broken = failed_rules(s, measure, unit)
    broken += [member.refines.partition(":")[0]] if member.refines else []
    said = [in_spite_of(s, measure, unit), f"; {chance_in_words(s.evidence, measure.chance)}"]
    if s.also_on:
        said.append(f"; {also_missing(s)}")
    if broken:
        said.append(f"; on the open tests {broken[0]}, which the locked ones outweigh")
    if held is not None:
        said.append(said_by_locked(s, held, unit, measure.tests, together=len(judgement.claims) > 1))
    if member.in_place_of:
        said.append(
            f"; taken by the locked tests in place of {member.in_place_of}, which the open ones can't tell it from"
        )
    said.append(in_place_of_heats(s, judgement, unit))
    if held is not None:
        said += [f"; {gain}" for gain in held.implausible.get(s.candidate.id, ())]
    said.append(where_nothing_is_cut(s, [b.test for b in investigation.problem.blocks]))
    said.append(also_of_motor(s, [j.scored for j in judgement.claims]))
    return "".join([*said, placeless_limit(s)])


def _not_claimed(
    s: Scored, member: Judged | None, investigation: Investigation, judgement: Judgement, by_name: Scored | None
) -> str:
    """Why the open tests claim it not. by_name: as in `why`."""
    if member is not None and member.warms and judgement.one_body is not None:
        return only_warms(s, judgement.one_body, investigation.problem.unit)
    failed = failed_rules(s, investigation.measure, investigation.problem.unit)
    # a probability that is stated of no candidate is no reason either
    if not failed and by_name is not None:
        return f"{by_name.candidate.id} says the same of its channels by a name"
    if not failed and member is None and not is_a_cause(s, member):
        return would_be_a_mode(s.candidate)
    names = [j.scored.candidate.id for j in judgement.chosen]
    beside = is_judged_beside(s, member, chosen=bool(names))
    if failed and s.looked is not None and s.looked.saying:
        return f"{failed[0]}; {on_locked(s.looked)}"
    improbable = [why for why in [blunt(s)] if why] if beside else []
    if failed:
        return "; and ".join([failed[0], *(why.partition(": ")[0] for why in improbable)])
    if improbable:
        return improbable[0] + in_place_of_heats(s, judgement, investigation.problem.unit)
    heads = [j.scored for j in (*judgement.claims, *judgement.refused)][:1]
    if not beside and all(_left_out(s)[1] < _left_out(head)[1] for head in heads):
        were = "was" if len(names) == 1 else "were"
        return f"it keeps the rules by itself, and {listed(names)} {were} chosen without it"
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


def _numbers(s: Scored, told: Scored | None, investigation: Investigation, others: Sequence[str] = ()) -> str:
    """Where it acts, how far the error falls there, and in how many tests it says so."""
    unit, tests, count = investigation.problem.unit, investigation.measure.tests, int(s.acts.sum())
    beside = f", beside {listed(others)}," if others else ""
    beside = ", beside the effects as the model has them, one lag each," if s.as_modelled else beside
    return (
        f"{where_it_acts(count, len(s.rows), tests)}{beside} the error "
        f"{way(s.error_before, s.error_after)} "
        # unlike the errors on left-out tests, for which the known effects are left out as well
        f"({from_to(s.error_before, s.error_after, unit)}), with its size from the other {tests} and the known effects "
        f"fitted to all{_of_all(s, told, tests, unit)}, {_more_probable(s, count)}; {gain_between(s, tests)}"
    )


def _more_probable(s: Scored, count: int) -> str:
    """In how many of the tests in which it acts; with how that can be where the error does not fall."""
    better = f"it makes {round(s.better * count)} of {count} more probable"
    if s.error_after < s.error_before or not s.better:
        return f"and {better}"
    return (
        f"though {better}: that is of their samples with the known effects free to act otherwise in each, the error of "
        "the course as the others foretell it"
    )


def gain_between(s: Scored, tests: str) -> str:
    """'its gain differs between tests by 8 %': of one test nobody knows."""
    if int(s.acts.sum()) < LEAST_TESTS:
        return f"no other {tests[:-1]} tells its gain"
    return f"its gain differs between {tests} by {in_percent(s.spread)}"


def where_it_acts(count: int, of: int, tests: str) -> str:
    """'where it acts most (6 of 7 tests)': in the others it does less than a fifth of its largest, which is no rest."""
    return f"where it acts{' most' if count < of else ''} ({count} of {of} {tests})"


def _left_out(s: Scored) -> tuple[float, float]:
    """Errors of all tests that are left out whole, without and with it."""
    return float(np.sqrt(np.mean(s.sse_before / s.rows))), float(np.sqrt(np.mean(s.sse_after / s.rows)))


def _of_all(s: Scored, told: Scored | None, tests: str, unit: str) -> str:
    """What the errors before and after are of, where these are others than those in which it acts; else ''."""
    if told is None or not len(told.rows):
        return ""
    left, own = _left_out(told), (s.error_before, s.error_after)
    if all(abs(a - b) <= ALIKE * b for a, b in zip(left, own, strict=True)):
        return ""
    return f" (over all {tests}, with these fitted to the other {tests} too, it goes {from_to(*left, unit)})"


def placeless_limit(s: Scored) -> str:
    """Of a claim that is less probable than one of a declared place must be: by which limit it stands; else ''."""
    if probability(s) >= CLAIMED or not s.candidate.placeless:
        return ""
    return (
        f"; no temperature has a declared place, so it names a channel and no part of the machine, and a claim asks "
        f"{in_percent(limit_of(s))} in place of {in_percent(CLAIMED)}: declare 'at' of the channels to ask for more"
    )


def where_nothing_is_cut(s: Scored, tests: Sequence[TestData]) -> str:
    """Of a cause by its heat of cutting: tests in which it acts, though by their kind nothing is cut in them; else
    ''."""
    if s.candidate.family != _CUTTING:
        return ""
    acting = (test for test, acts in zip(tests, s.acts, strict=True) if acts and test.kind in _NOTHING_IS_CUT)
    names = list(dict.fromkeys(f"{test.test} ({test.kind.replace('_', ' ')})" for test in acting))
    if not names:
        return ""
    more = f" and {len(names) - _SHOWN} more" if len(names) > _SHOWN else ""
    return (
        f"; it acts in {', '.join(names[:_SHOWN])}{more}, where nothing is cut: what heats there is what "
        "the spindle itself loses, in its motor first"
    )


def also_of_motor(s: Scored, claims: Sequence[Scored]) -> str:
    """What drives a motor heats it before it cuts: said of a power that is not surely a cause of its own, beside a
    sharper claim of the motor's temperature; else ''."""
    if probability(s) >= SURE or not any(n.quantity in _DRIVES_A_MOTOR for n in s.candidate.effect.needs):
        return ""
    motors = [c for c in claims if _reads_motor(c) and sharpness(c) > sharpness(s)]
    if not motors:
        return ""
    heats = "heats" if len(s.candidate.channels) == 1 else "heat"
    return (
        f"; {listed(s.candidate.channels)} {heats} the motor too, which is claimed as {motors[0].candidate.id}: it "
        "may be more of that heat and no cause of its own, which the same path as an air cut tells: add that one "
        "first, and ask again"
    )


def _reads_motor(s: Scored) -> bool:
    return any(p.endswith("spindle.motor") for n in s.candidate.effect.needs for p in n.places)


def in_spite_of(s: Scored, measure: Measure, unit: str) -> str:
    """What stands in these figures against a claim and is outweighed, for it is evident in each test by itself."""
    lifted = [r.name for r in rules(s, measure, unit) if r.holds and not r.asked]
    said = " and ".join(_OUTWEIGHED[name] for name in lifted if name in _OUTWEIGHED)
    evident = f"its evidence, {sharpness(s):.2f} a sample, outweighs"
    return f"; {evident} {said}: the effects of the model take part of what it does for their own" if said else ""


def _refused(s: Scored, judgement: Judgement) -> str:
    """Why what keeps every rule on the open tests is no claim."""
    if not judgement.claims:
        return judgement.reason
    claims = " with ".join(c.scored.candidate.id for c in judgement.claims)
    said = f": {on_locked(s.looked)}" if s.looked is not None and s.looked.saying else ""
    return f"it explains the open tests, but beside {claims} the locked ones do not bear it out{said}"


def among(member: Judged | None, some: Sequence[Judged]) -> bool:
    return any(member is one for one in some)
