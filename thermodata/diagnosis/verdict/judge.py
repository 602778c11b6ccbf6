"""From evidence to a verdict: what may be claimed, what only refines what is known, and why the others may not."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from thermodata.diagnosis.claims.measure import FLOOR_SHARE, Measure
from thermodata.diagnosis.claims.probability import may_be_confirmed, probability, sharpness
from thermodata.diagnosis.claims.refinement import is_surely_missing
from thermodata.diagnosis.claims.refines import PART
from thermodata.diagnosis.claims.rules import LEAST_TESTS, rules
from thermodata.diagnosis.claims.rules_together import blunt, contradicts, failed_rules, halves, is_plain
from thermodata.diagnosis.question.present import CONTROL, GENERIC
from thermodata.diagnosis.question.problem import Problem
from thermodata.diagnosis.verdict.judged import Judged, Judgement, Verdict
from thermodata.diagnosis.verdict.selection import Selection
from thermodata.diagnosis.weigh.figures import short
from thermodata.diagnosis.weigh.scored import Scored
from thermodata.schema.words.sentences import in_percent

# rules of size and likeness, that few open tests break for a cause now and then; locked tests may outweigh one of them
OUTWEIGHED = ("fall", "gain", "others", "worth")

MOST_CLAIMS = 3
RATHER = 0.5  # so probable, and it is rather the cause than not
ALIKE = 0.9  # cosine of contributions that can't be told apart,
APART = 2.0  # unless the tests surely speak for one, and the other leaves this many times its error;
FAR = 4.0  # no twin leaves, however few the tests that say so: of three nothing is sure;
# nor can those that act alike at all and leave nearly the same error, where the tests that one wins are not more than
# chance would give it: the difference of their log probabilities against its standard error [vehtari2017]
ALIKE_AT_ALL = 0.5
NEARLY = 1.2
SURE = 2.0


def judge(
    problem: Problem, selection: Selection | None, measure: Measure, refines: Callable[[Scored], str | None]
) -> Judgement:
    """refines: says what of the model a candidate refines, None where it is a cause of its own."""
    if len(problem.blocks) < 2:
        return _nothing_claimed(
            "not_testable",
            f"{len(problem.blocks)} test with measured samples; an effect is claimed only where it also "
            "predicts a test that it was not fitted to, so at least two are needed",
        )
    if selection is None:
        return _nothing_claimed("not_testable", "no effect of the library fits the channels that were logged")
    members = [Judged(m.scored, m.alone, refines(m.scored), m.beside) for m in selection.members]
    judged = _beside_each_other([_or_a_mode(member, refines) for member in members])
    found = concluded(problem, selection, measure, judged)
    if found.verdict not in ("unknown", "none") or found.likely:
        return found
    return replace(found, likely=_nearly_claimed(selection, measure, problem.unit, refines))


def concluded(problem: Problem, selection: Selection, measure: Measure, judged: tuple[Judged, ...]) -> Judgement:
    """The same of members that are judged already."""
    own = [j for j in judged if j.refines is None]
    maybe = [j for j in judged if _may_be_its_own(j)]
    sure = [j for j in own if blunt(j.scored) is None and not (j.scored.looked and j.scored.looked.refuted)]
    claims = causes(sure)[:MOST_CLAIMS]
    kept = tuple(j for j in judged if j.refines is not None)
    if claims:
        return Judgement("effect", claims, kept, judged, "", likely=_likely([*own, *maybe], claims))
    left = selection.left
    halved = left > measure.noises and any(halves(j.alone, left) for j in judged)
    # what a known effect takes for its own leaves no error, and is plain all the same
    plain = left > measure.noises and any(is_plain(s) for s in selection.dropped)
    if left <= measure.floor and not halved and not plain and not any(map(_is_rather_missing, own)):
        why = (
            f"the error on left-out tests, {short(left)} {problem.unit}, is at the floor of "
            f"{short(measure.floor)} {problem.unit} (noise, and {in_percent(FLOOR_SHARE)} of the response)"
        )
        return Judgement("none", (), (), judged, why, likely=_likely(own, ()))
    more_than_noise = left if left > measure.noises else 0.0
    if not plain and not any(contradicts(j.scored, j.alone, more_than_noise) for j in own):
        rest = min([left, *(j.alone.error_of_all for j in kept)])
        # what refines the model without lessening its error excuses none
        limit = measure.good(refined=rest < left)
        if rest <= limit:
            enough = _why_no_cause_is_missing(rest, limit, problem.unit, measure)
            return Judgement("refine" if kept else "none", (), kept, judged, enough, likely=_likely(maybe, ()))
    best = selection.first.ranked[0]
    if own:
        best = own[0].scored
    failed = failed_rules(best, measure, problem.unit) or [why for why in [blunt(best)] if why]
    because = f": the best, {best.candidate.id}, fails because {failed[0]}" if failed else ""
    why = (
        f"{short(left)} {problem.unit} remain on left-out tests, {_beside_the_floor(left, measure.floor)}, and nothing "
        f"logged may be named for them{because}"
    )
    return Judgement("unknown", (), kept, judged, why, likely=_likely([*own, *maybe], ()))


def _is_rather_missing(judged: Judged) -> bool:
    """Whether it is rather the cause than not: then nobody says that nothing is missing, however little is left."""
    one = judged.scored
    return probability(one) >= RATHER and not (one.looked and one.looked.refuted)


def parts_offered(found: Judgement, conclude: Callable[[tuple[Judged, ...]], Judgement]) -> Judgement:
    """The same, where nothing can be named: a sound member that the model reads already together with others, as the
    air beside its gradient, is offered as more of that, for the tests can't tell which of both it is; not where the
    locked tests were asked for it, and their error falls in neither way. conclude: judges members anew."""
    parts = [
        j
        for j in found.judged
        if j.refines is None and j.scored.candidate.kin == "part" and not (j.scored.looked and j.scored.looked.refuted)
    ]
    if found.verdict != "unknown" or found.refused or not parts:
        return found
    offered = tuple(replace(j, refines=PART) if any(j is part for part in parts) else j for j in found.judged)
    return conclude(offered)


def _or_a_mode(judged: Judged, refines: Callable[[Scored], str | None]) -> Judged:
    """A lag or a difference names no physics: where the tests can't tell it from another mode of what the model has, it
    is that, unless it is surely missing."""
    nameless = judged.scored.candidate.family in (GENERIC, CONTROL)
    if judged.refines is not None or not nameless or is_surely_missing(judged.scored):
        return judged
    for twin in equivalents(judged.scored, judged.beside):
        if twin.candidate.kin == "same" and twin.candidate.within is None and (said := refines(twin)) is not None:
            told = f"{said}; nor do they tell it from {twin.candidate.id}, which is one"
            return replace(judged, refines=told, like_a_mode=True)
    return judged


def _may_be_its_own(judged: Judged) -> bool:
    """Whether what refines the model by the open tests is so probable that the locked ones may tell a cause of its own:
    another mode of the same effect, a change of it, or the temperature of a body whose heat the model has, is none."""
    one = judged.scored.candidate
    another = not judged.like_a_mode and one.kin != "same" and (one.kin != "heat" or one.of_motion)
    return judged.refines is not None and one.within is None and another and blunt(judged.scored) is None


def _likely(own: Sequence[Judged], claims: Sequence[Judged]) -> tuple[Judged, ...]:
    """What the locked tests may make a claim beside the claims, as many as there may be."""
    among = causes([j for j in own if may_be_confirmed(j.scored)])
    others = [j for j in among if not any(j is c for c in claims)]
    return tuple(sorted(others, key=lambda j: -probability(j.scored))[: MOST_CLAIMS - len(claims)])


def _nearly_claimed(
    selection: Selection, measure: Measure, unit: str, refines: Callable[[Scored], str | None]
) -> tuple[Judged, ...]:
    """The likeliest of what was dropped for one rule alone that other tests may outweigh."""
    for one in sorted((s for s in selection.dropped if len(s.rows)), key=lambda s: -probability(s)):
        broken = [rule.name for rule in rules(one, measure, unit) if not rule.holds]
        # of two tests in which it acts the rule asks for both
        few = ("tests",) if int(one.acts.sum()) <= LEAST_TESTS else ()
        alone = len(broken) == 1 and broken[0] in (*OUTWEIGHED, *few) and one.candidate.unforetold is None
        if alone and may_be_confirmed(one) and not one.candidate.within and refines(one) is None:
            return (Judged(one, one, None, selection.first.ranked),)
    return ()


def _why_no_cause_is_missing(rest: float, limit: float, unit: str, measure: Measure) -> str:
    """Why no cause is missing. rest: the error of left-out tests, with what refines the model where something does."""
    return (
        f"the error on left-out tests, {short(rest)} {unit}, is {in_percent(rest / measure.spread)} of the response, "
        f"as lags "
        f"leave of a machine that lacks nothing (limit {in_percent(limit / measure.spread)}), and nothing logged "
        "may be named for it"
    )


def _beside_the_floor(left: float, floor: float) -> str:
    if left <= floor:
        return f"no more than the floor of {short(floor)}, but much of them goes with what is logged"
    return f"above the floor of {short(floor)}"


def _nothing_claimed(verdict: Verdict, reason: str) -> Judgement:
    return Judgement(verdict, (), (), (), reason)


def _beside_each_other(members: Sequence[Judged]) -> tuple[Judged, ...]:
    """Which causes a sharper one stands beside: what is dull may be what that one leaves."""
    causes = [j.scored for j in members if j.refines is None and not j.scored.candidate.passive]
    sharpest = max(map(sharpness, causes), default=0.0)

    def told(judged: Judged) -> Judged:
        beaten = judged.refines is None and sharpness(judged.scored) < sharpest
        return replace(judged, scored=replace(judged.scored, beaten=True)) if beaten else judged

    return tuple(told(j) for j in members)


def causes(claims: Sequence[Judged]) -> tuple[Judged, ...]:
    """Without what a sharper one of the same family says of the same channels: it is one cause, in two modes; nor the
    same twice, where two members gave way to it."""

    def again(judged: Judged, other: Judged) -> bool:
        mine, theirs = judged.scored.candidate, other.scored.candidate
        named = mine.family == theirs.family and mine.family not in (GENERIC, CONTROL)
        shared = not set(mine.channels).isdisjoint(theirs.channels)
        return named and shared and sharpness(judged.scored) < sharpness(other.scored)

    sharpest_first = sorted(claims, key=lambda j: -sharpness(j.scored))
    once = {j.scored.candidate.id: j for j in reversed(sharpest_first)}
    return tuple(j for j in claims if once[j.scored.candidate.id] is j and not any(again(j, o) for o in claims))


def equivalents(chosen: Scored, ranked: Sequence[Scored]) -> list[Scored]:
    """The candidates that the data can't tell from the chosen one."""
    return [s for s in ranked if s.columns is not chosen.columns and len(s.shape) and _equally_good(chosen, s)]


def sound_twins(selection: Selection, measure: Measure, unit: str) -> dict[int, list[Scored]]:
    """Of each member, by the identity of its columns, those of its family that the tests can't tell from it, and that
    keep every rule but the probability's."""
    return {
        id(member.scored.columns): [
            twin
            for twin in equivalents(member.scored, member.beside)
            if twin.candidate.family == member.scored.candidate.family and not failed_rules(twin, measure, unit)
        ]
        for member in selection.members
    }


def _equally_good(one: Scored, other: Scored) -> bool:
    """Whether they act alike, or tests would have to be drawn again to tell which predicts left-out ones better."""
    cosine = abs(float(one.shape @ other.shape))
    if cosine <= ALIKE_AT_ALL:
        return False
    difference = one.gained - other.gained
    sure = abs(difference.sum()) > SURE * np.sqrt(len(difference)) * difference.std(ddof=1)
    if cosine > ALIKE:
        return bool(_error(other) <= (APART if sure else FAR) * _error(one))
    return bool(not sure and _error(other) <= NEARLY * _error(one))


def _error(scored: Scored) -> float:
    return float(np.sqrt(np.mean(scored.own_after / scored.rows)))
