"""One fitted response, investigated: the problem, what is selected, the steps, the weak spots, the judgement."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cache, partial

import numpy as np
from threadpoolctl import threadpool_limits

from thermodata.diagnosis.candidates.basis import Means, sharing
from thermodata.diagnosis.candidates.candidate_effect import CandidateEffect
from thermodata.diagnosis.claims.at_rest import AtRest, at_rest
from thermodata.diagnosis.claims.detection import Limit, limits
from thermodata.diagnosis.claims.measure import Measure
from thermodata.diagnosis.claims.probability import at_best, limit_of, may_be_borne_out
from thermodata.diagnosis.claims.refinement import Refinement
from thermodata.diagnosis.claims.rules_together import failed_rules
from thermodata.diagnosis.question.compressed import WEIGHED_ROWS, compressed, error_of
from thermodata.diagnosis.question.known import Known, known
from thermodata.diagnosis.question.known_effects import owners, remembered
from thermodata.diagnosis.question.problem import TARGET_ROWS, Base, Problem
from thermodata.diagnosis.question.weak import weak_spots
from thermodata.diagnosis.sensors.logging_faults import (
    faulty_sensors,
    first_of_each,
    wrong_parameters,
)
from thermodata.diagnosis.steps import repeating
from thermodata.diagnosis.steps.artefact import as_artefacts, find_steps
from thermodata.diagnosis.steps.of_model import steps_of_model
from thermodata.diagnosis.steps.step import Step
from thermodata.diagnosis.verdict.asked import of_library
from thermodata.diagnosis.verdict.faults import faults_of_logs, that_nothing_missing_makes
from thermodata.diagnosis.verdict.inquiry import Given, Inquiry, Prepared
from thermodata.diagnosis.verdict.judge import concluded, judge, sound_twins
from thermodata.diagnosis.verdict.judged import Judged, Judgement
from thermodata.diagnosis.verdict.on_locked import Lock
from thermodata.diagnosis.verdict.selection import Member, Selection, any_stands_out, first_ranking, select
from thermodata.diagnosis.weigh.beside import beside
from thermodata.diagnosis.weigh.by_phase import heating_and_cooling_apart
from thermodata.diagnosis.weigh.evidence import Columns, columns
from thermodata.diagnosis.weigh.foretold import Foretold
from thermodata.diagnosis.weigh.gain_by import gains_by_condition
from thermodata.diagnosis.weigh.null import best_of_chance
from thermodata.diagnosis.weigh.ranking import rank_in
from thermodata.diagnosis.weigh.scored import Scored
from thermodata.modelling.terms.fitted_response import FittedResponse
from thermodata.modelling.terms.rms import rms
from thermodata.plugin import Int1D
from thermodata.schema.answers.diagnosis import Artefact, WeakSpot
from thermodata.view.grid.dataset import Dataset, TestData

# what other axes say of a candidate: (channel, probability there)
Witness = Callable[[Scored], tuple[tuple[str, float], ...]]
# what one claim foretells of the locked tests beside the others that are claimed or likely; None where there are none
BorneOut = Callable[[Judged, Sequence[Judged]], Foretold | None]
Conclude = Callable[[tuple[Judged, ...]], Judgement]


@dataclass(frozen=True, slots=True)
class Investigation:
    """problem: in the samples in which candidates are weighed. selection: None where nothing can be left out. on_open:
    what the open tests alone say, before any locked one is asked.
    conclude: judges members anew. limits: how large what is not named would have to be. at_rest: what no open test
    moves. looked_for: the ids of what the locked tests were opened for on the way, whatever became of it. told: by the
    identity of a candidate's columns the errors that are told of it (`together.told_alike`)."""

    problem: Problem
    selection: Selection | None
    artefacts: list[Artefact]
    spots: list[WeakSpot]
    on_open: Judgement
    measure: Measure
    borne_out: BorneOut
    conclude: Conclude
    limits: tuple[Limit, ...] = ()
    at_rest: tuple[AtRest, ...] = ()
    looked_for: tuple[str, ...] = ()
    told: Mapping[int, tuple[Scored, bool]] = field(default_factory=dict)


def investigate(inquiry: Inquiry, given: Given | None = None, prepared: Prepared | None = None) -> Investigation:
    """given: what is known and asked beside it; prepared: what was made for other questions."""
    given = Given() if given is None else given
    prepared = Prepared() if prepared is None else prepared
    fitted, data, tests, means = inquiry.fitted, inquiry.data, inquiry.tests, prepared.means
    base = remembered(fitted)
    fine = compressed(fitted, data, tests, TARGET_ROWS, base) if prepared.fine is None else prepared.fine
    found = find_steps(fine) if prepared.steps is None else list(prepared.steps)
    single = repeating.single(found)
    faults = faults_of_logs(fitted, data, fine, base)
    whole = compressed(fitted, data, tests, WEIGHED_ROWS, base)
    problem = sharing(_without_steps(fitted, whole, single, fine.step_s), means)
    asked, unforetold = _candidates(inquiry, problem, fine, given.refused)

    def causes(response: FittedResponse, among: Sequence[TestData]) -> list[Scored]:
        return causes_of(replace(inquiry, fitted=response, tests=among), means)

    witness = None if given.others is None else partial(given.others.say, causes=causes)
    lock = Lock(_with_locked(inquiry, given.locked, problem, base), len(problem.blocks))
    # thousands of small products: threads of the linear algebra library would wait for each other
    with threadpool_limits(1):
        selection, judgement, measure = _select_and_judge(fitted, problem, asked, inquiry.seed, witness, lock)
        unseen = () if selection is None else _limits(fitted, problem, selection, measure)
        selection = _with_unforetold(problem, selection, unforetold)
    asked_about = fitted if given.as_fitted is None else given.as_fitted
    spots = weak_spots([(t, asked_about.residual(t), asked_about.mask(t)) for t in tests], problem.noise)
    at_floor = selection is not None and selection.left <= measure.floor
    faults = that_nothing_missing_makes(faults, judgement, at_floor)
    if selection is not None and not single:  # a slip is in the fit of the model, and in its error
        faults += wrong_parameters(problem, error_of(asked_about, tests), selection.left, measure.floor)
    artefacts = _artefacts(inquiry, given.known_faults, found, faults)

    def borne_out(claim: Judged, others: Sequence[Judged]) -> Foretold | None:
        return None if selection is None else lock.foretold(selection, judgement, claim, others)

    def conclude(judged: tuple[Judged, ...]) -> Judgement:
        return judgement if selection is None else concluded(problem, selection, measure, judged)

    others_of = [t for t in data.tests if t.key not in {o.key for o in tests}]
    rests = tuple(at_rest(asked, tests, others_of, data.channels))
    said = judgement, measure, borne_out, conclude, unseen, rests, tuple(lock.asked)
    return Investigation(problem, selection, artefacts, spots, *said)


def _candidates(
    inquiry: Inquiry, problem: Problem, fine: Problem, refused: frozenset[str]
) -> tuple[list[CandidateEffect], list[CandidateEffect]]:
    """(what is asked, what no test foretells)."""
    fitted, tests = inquiry.fitted, inquiry.tests
    asked = of_library(fitted, inquiry.data, tests, inquiry.library, fine)
    there = {b.test.key for b in problem.blocks}
    among = [t for t in tests if t.key in there]
    by_condition = gains_by_condition(fitted, among, inquiry.data.tests)
    asked += [c for c in by_condition if c.unforetold is None]
    asked += heating_and_cooling_apart(fitted, among, inquiry.data.tests)
    asked = [c for c in asked if not (refused and refused.issuperset(c.channels))]
    return asked, [c for c in by_condition if c.unforetold]


def _with_locked(inquiry: Inquiry, locked: Sequence[TestData], problem: Problem, base: Base) -> Callable[[], Problem]:
    """What makes the problem with locked tests beside the open ones, once, where it is asked for."""

    @cache
    def with_locked() -> Problem:
        every = [*inquiry.tests, *locked]
        blocks = compressed(inquiry.fitted, inquiry.data, every, WEIGHED_ROWS, base).blocks if locked else ()
        closed = tuple(b for b in blocks if b.test.key in {t.key for t in locked})
        return replace(problem, blocks=(*problem.blocks, *closed), kept={})

    return with_locked


def _artefacts(
    inquiry: Inquiry, known_faults: Sequence[Artefact], steps: Sequence[Step], faults: Sequence[Artefact]
) -> list[Artefact]:
    """What the logs have that no machine does: each fault once, those of steps, and sensors."""
    fitted, data = inquiry.fitted, inquiry.data
    unit = data.channels[fitted.name].unit
    of_steps = as_artefacts(repeating.single(steps), unit, steps)
    of_steps += repeating.as_artefacts(repeating.repeating(steps), unit)
    read = {n for term in fitted.terms for t in data.tests for n in term.bound.reads(t)}
    return [*first_of_each([*known_faults, *of_steps, *faults]), *faulty_sensors(data, fitted.name, read)]


def causes_of(inquiry: Inquiry, means: Means) -> list[Scored]:
    """The sound causes that a response misses, as they are judged beside each other; refinements are none."""
    problem, fine = weighed(inquiry.fitted, inquiry.data, inquiry.tests)
    problem = sharing(problem, means)
    asked = of_library(inquiry.fitted, inquiry.data, inquiry.tests, inquiry.library, fine)
    _, judgement, _ = _select_and_judge(inquiry.fitted, problem, asked, inquiry.seed)
    return [j.scored for j in judgement.judged if j.refines is None]


def weighed(fitted: FittedResponse, data: Dataset, tests: Sequence[TestData]) -> tuple[Problem, Problem]:
    """In the samples in which candidates are weighed, and in those in which steps were looked for."""
    base = remembered(fitted)
    fine, rough = (compressed(fitted, data, tests, rows, base) for rows in (TARGET_ROWS, WEIGHED_ROWS))
    return _without_steps(fitted, rough, repeating.single(find_steps(fine)), fine.step_s), fine


def _without_steps(fitted: FittedResponse, problem: Problem, steps: Sequence[Step], seen_s: float) -> Problem:
    """With a free offset after each step, of the model too, and without the samples around it, for one of them is a
    mean of both levels. seen_s: between the samples in which steps were looked for."""
    at = steps_of_model(fitted, problem)
    for step in steps:
        at.setdefault(step.test.key, []).append(step.at_s)
    return problem.split(at, parted_s=problem.step_s / 2 + 0.99 * seen_s)


def _select_and_judge(
    fitted: FittedResponse,
    problem: Problem,
    asked: Sequence[CandidateEffect],
    seed: int,
    witness: Witness | None = None,
    lock: Lock | None = None,
) -> tuple[Selection | None, Judgement, Measure]:
    spread = rms(problem.response_blocks) if problem.blocks else 0.0
    first = first_ranking(problem, asked)
    if first is None:
        measure = Measure(spread, problem.noise, np.zeros(0), problem.in_parts, problem.averaged)
        return None, judge(problem, None, measure, lambda scored: None), measure
    chance = best_of_chance(first.known, [s.columns for s in first.ranked], seed)
    measure = Measure(spread, problem.noise, chance, problem.in_parts, problem.averaged)

    def judged(among: Sequence[Columns]) -> tuple[Selection, Judgement, bool]:
        good = measure.good(refined=False)
        found = select(
            problem, first, lambda scored: not failed_rules(scored, measure, problem.unit), among=among, good=good
        )
        refines = Refinement(fitted, problem, found.noise, sound_twins(found, measure, problem.unit))
        told = judge(problem, found, measure, refines)
        if witness is None:
            return found, told, bool(told.claims)
        standing = [j for j in told.judged if j.refines is None and may_be_borne_out(j.scored)]
        # the locked tests are looked at in the end anyway, and each other axis is a diagnosis of its own
        open_still = [j for j in standing if lock is None or not lock.confirms(found, told, j, measure)]
        if heard := _said_by_other_axes(open_still, witness):
            found = replace(found, members=tuple(_with_other_axes(m, heard) for m in found.members))
            told = judge(problem, found, measure, refines)
        return found, told, bool(told.claims) or len(open_still) < len(standing)

    def may_be(scored: Scored) -> bool:
        return at_best(scored, problem.rows) >= limit_of(scored)

    everything = [s.columns for s in first.ranked]
    # what is passive can hardly be claimed, and drives out what it follows: so it is asked where nothing else is, and
    # only where it might be
    active, passive = ([c for c in everything if c.candidate.passive is so] for so in (False, True))
    selection, judgement, named = judged(active)
    if not named and any_stands_out(problem, first, selection, passive, may_be):
        selection, judgement, _ = judged(everything)
    return selection, judgement, measure


def _said_by_other_axes(standing: Sequence[Judged], witness: Witness) -> dict[int, tuple[tuple[str, float], ...]]:
    """What other axes say of members that are no claim without them, by their columns' identity."""
    said = {id(j.scored.columns): witness(j.scored) for j in standing}
    return {columns: told for columns, told in said.items() if told}


def _with_other_axes(member: Member, heard: Mapping[int, tuple[tuple[str, float], ...]]) -> Member:
    said = heard.get(id(member.scored.columns))
    return member if said is None else replace(member, scored=replace(member.scored, also_on=said))


def _limits(fitted: FittedResponse, problem: Problem, selection: Selection, measure: Measure) -> tuple[Limit, ...]:
    """Beside what was selected, in the noise that is left."""
    full = known(beside(problem, selection.together), selection.noise)
    pool = [s.columns for s in selection.first.ranked]
    return tuple(limits(full, pool, measure.spread, _owners(fitted, full)))


def _owners(fitted: FittedResponse, full: Known) -> Int1D:
    """Of each known column the number of its effect in the model; -1 for what was selected."""
    block = full.problem.blocks[0]
    found = [
        [*numbers, *[-1] * (columns.shape[1] - len(numbers))]
        for numbers, columns in zip(owners(fitted), (block.base, block.slack), strict=True)
    ]
    return np.array(found[0] + found[1], dtype=np.int64)


def _with_unforetold(
    problem: Problem, selection: Selection | None, asked: Sequence[CandidateEffect]
) -> Selection | None:
    """What no test foretells takes no part in the choice, and is told beside what did."""
    if selection is None or not asked:
        return selection
    pool = [c for c in (columns(problem, one) for one in asked) if c is not None]
    more = rank_in(problem, pool, selection.first.known.space.noise)
    return replace(selection, first=replace(selection.first, ranked=(*selection.first.ranked, *more.ranked)))
