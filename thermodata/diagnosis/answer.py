"""The answer in the contract's form, from a fitted model and its data. Pure: no store."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from thermodata.diagnosis.candidates.failing import without_failing
from thermodata.diagnosis.candidates.of_library import CandidateEffect
from thermodata.diagnosis.claims.at_rest import AtRest as Resting
from thermodata.diagnosis.claims.detection import LARGE, Limit
from thermodata.diagnosis.claims.other_axes import OtherAxes
from thermodata.diagnosis.clocks.ends_of_logs import UNKNOWN, Ends
from thermodata.diagnosis.locked.confirm import Confirmation, Fits, confirm
from thermodata.diagnosis.locked.copies import as_artefacts, copies
from thermodata.diagnosis.locked.left_on_locked import contradicted
from thermodata.diagnosis.locked.unlocking import Look, unlocked
from thermodata.diagnosis.question.problem import Problem
from thermodata.diagnosis.question.responses import response_index, shares_left
from thermodata.diagnosis.sensors.loose import loose_sensors
from thermodata.diagnosis.sound import beside_slips, sound, told
from thermodata.diagnosis.steps.artefact import noise_with_treads
from thermodata.diagnosis.tell import ladder
from thermodata.diagnosis.tell.advice import advice
from thermodata.diagnosis.tell.as_stored import as_fitted
from thermodata.diagnosis.tell.in_version import told_by_versions
from thermodata.diagnosis.tell.listed import (
    alike_both_ways,
    candidate,
    explainable,
    first_cause,
    listed,
    with_probability,
)
from thermodata.diagnosis.tell.started_on import started_with
from thermodata.diagnosis.tell.together import left_with_named, told_alike
from thermodata.diagnosis.unlogged.unexplained import characterise
from thermodata.diagnosis.verdict.as_modelled import as_modelled, refined
from thermodata.diagnosis.verdict.investigate import Investigation, investigate
from thermodata.diagnosis.verdict.judge import Judged, Judgement
from thermodata.diagnosis.verdict.suspect import doubt_of_heat, first, nearest, suspect
from thermodata.modelling.terms.fitted import FittedModel
from thermodata.modelling.terms.fitted_response import FittedResponse
from thermodata.plugin import Effect
from thermodata.schema.answers.diagnosis import Artefact, AtRest, DetectionLimit, Diagnosis, ResponseLeft
from thermodata.view.grid.dataset import Dataset, TestData


@dataclass(frozen=True, slots=True)
class Answer:
    """looks: each time that locked tests were opened."""

    diagnosis: Diagnosis
    looks: tuple[Look, ...] = ()

    @property
    def locked(self) -> tuple[TestData, ...]:
        """The tests that were looked at."""
        return tuple({t.key: t for look in self.looks for t in look.tests}.values())

    @property
    def asked(self) -> tuple[str, ...]:
        """The ids of the candidates that they were looked at for."""
        return tuple(dict.fromkeys(name for look in self.looks for name in look.asked))


def answer(
    fitted: FittedModel,
    data: Dataset,
    library: Mapping[str, Effect],
    model_id: str,
    seed: int = 0,
    *,
    left_on_locked: Mapping[str, float] | None = None,
    ends: Ends = UNKNOWN,
    name: str | None = None,
) -> Answer:
    """Diagnose the response that is named, else the one of which most is left; locked tests are opened once, for what
    is claimed or likely. left_on_locked: response -> their error, where it is known already. ends: how logs begin and
    end. EffectError for an effect of the model that fails; one of the library is left out, and told."""

    def ask(asked: Mapping[str, Effect]) -> Answer:
        return _answer(fitted, data, asked, model_id, seed, left_on_locked, ends, name)

    found, failed = without_failing(library, ask)
    return replace(found, diagnosis=found.diagnosis.model_copy(update={"not_asked": list(failed)}))


def _answer(
    fitted: FittedModel,
    data: Dataset,
    library: Mapping[str, Effect],
    model_id: str,
    seed: int,
    left_on_locked: Mapping[str, float] | None,
    ends: Ends,
    name: str | None,
) -> Answer:
    tests = fitted.tests(data)
    shares = shares_left(fitted, tests)
    index = response_index(fitted, tests, name)
    response = fitted.responses[index]
    usable = [t for t in tests if response.can_predict(t)]
    asked_of = sound(fitted, index, data, usable, library, ends)
    refitted, data, usable = asked_of.fitted, asked_of.data, list(asked_of.tests)
    beside = beside_slips(asked_of, index)
    same = copies(fitted.tests(data, "locked"), tests, response.name)
    again = {one.key for one, _ in same}
    locked = [t for t in fitted.tests(data, "locked") if response.can_predict(t) and t.key not in again]
    loose = loose_sensors(data, response.name)

    def asks(
        locked: Sequence[TestData], faults: Sequence[Artefact], refused: frozenset[str] = frozenset()
    ) -> Investigation:
        return investigate(
            beside.fitted.responses[index],
            data,
            usable,
            library,
            seed,
            as_fitted=response,
            locked=locked,
            # a second look asks so much of the locked tests that no other axis decides
            others=None if refused else OtherAxes(asked_of.spec, response.name, data, library),
            known_faults=(*asked_of.faults, *as_artefacts(same, response.name), *loose, *faults),
            refused=refused,
            fine=beside.fine,
            steps=beside.steps,
            means=beside.means,
        )

    def fits_of(locked: Sequence[TestData]) -> Fits:
        return Fits(fitted.spec, index, data, usable, locked, refitted)

    opened = unlocked(asks, fits_of, locked)
    investigation, judgement, confirmation = opened.investigation, opened.judgement, None
    known = (left_on_locked or {}).get(response.name)
    if judgement.claims:
        chosen = [c.scored.candidate for c in judgement.claims]
        confirmation = confirm(fitted.spec, index, data, chosen, usable, opened.locked, refitted)
        confirmation = replace(confirmation, asked=_asked(judgement.claims))
    on_locked = False
    if not judgement.claims:
        told_by_open = judgement
        judgement = contradicted(judgement, known, response, locked)
        on_locked = judgement is not told_by_open
    stands = None
    if judgement.verdict in ("none", "refine"):
        stands = as_modelled(
            investigation.problem,
            investigation.selection,
            investigation.measure,
            offers=judgement.verdict == "none",
        )
        judgement = refined(judgement, stands, investigation.measure)
    made, fits = None if confirmation is None else confirmation.fitted, fits_of(())

    def refit(some: Sequence[CandidateEffect]) -> FittedResponse:
        return made if made is not None else fits.of(some)

    judgement = told_by_versions(judgement, fits.of, usable)

    # errors on left-out tests are told beside the slips, with what is named and without
    as_told = refit if beside.level is None else Fits(fitted.spec, index, beside.level, usable, (), beside.fitted).of
    version = left_with_named(investigation, judgement, as_told, data, usable)
    investigation = told_alike(investigation, judgement, version)
    terms = [t.id for t in refitted.responses[index].terms]
    found = _diagnosis(investigation, judgement, confirmation, data, model_id, terms, on_locked=on_locked)
    left_out = [*asked_of.put_right.left_out, *opened.turned]
    further = {
        "named_rmse_um": None if version is None else float(np.sqrt(np.mean(version))),
        "modelled_rmse_um": None if stands is None else stands.left,
        "locked_rmse_um": known,
        "put_right": told(asked_of.put_right.model_copy(update={"left_out": left_out})),
        "fitted_rmse_um": as_fitted(response, tests),
        "started_on": started_with(response, tests),
        "responses": [
            ResponseLeft(response=r.name, left=left) for r, left in zip(fitted.responses, shares, strict=True)
        ],
        "by_choice": name is not None,
    }
    return Answer(found.model_copy(update=further), opened.looks)


def _asked(claims: Sequence[Judged]) -> frozenset[tuple[str, str]] | None:
    """The keys of the locked tests in which one of them acts; None: all."""
    tests = [c.scored.looked.foretold.tests for c in claims if c.scored.looked is not None]
    found = [t for t in tests if t is not None]
    return frozenset[tuple[str, str]]().union(*found) if found and len(found) == len(tests) else None


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


def _diagnosis(
    investigation: Investigation,
    judgement: Judgement,
    confirmation: Confirmation | None,
    data: Dataset,
    model_id: str,
    terms: Sequence[str],
    *,
    on_locked: bool,
) -> Diagnosis:
    """terms: ids of the model's effects. on_locked: whether it is only the locked tests that miss something."""
    problem = investigation.problem
    shown = listed(investigation, judgement)
    head = first_cause(shown)
    told_with = with_probability(shown, investigation, judgement)
    likely, plausible = suspect(judgement, head, investigation.measure, problem.unit), first(head, problem)
    most, most_by = explainable([s for s, _ in shown], investigation)
    alone = investigation.selection
    return Diagnosis(
        model=model_id,
        response=problem.response,
        verdict=judgement.verdict,
        noise_um=noise_with_treads(problem) if np.isfinite(problem.noise) else None,
        noise_over_s=next((float(b.test.t_s[1] - b.test.t_s[0]) for b in problem.blocks if len(b.test.t_s) > 1), None),
        left_out_over_s=problem.step_s,
        rmse_um=alone.left if alone is not None else _left(problem),
        explainable=most,
        explainable_by=most_by,
        weak_spots=investigation.spots,
        candidates=alike_both_ways(
            [
                candidate(i + 1, s, member, s is head, told_with, investigation, judgement, confirmation, data)
                for i, (s, member) in enumerate(shown)
            ]
        ),
        artefacts=investigation.artefacts,
        unknown=characterise(
            problem,
            investigation.spots,
            likely,
            plausible or nearest([s for s, _ in shown[:1] if s is head], problem),
            doubt_of_heat(
                alone.left if alone is not None else np.inf,
                investigation.measure,
                known=on_locked or likely is not None or plausible is not None,
            ),
        )
        if judgement.verdict == "unknown"
        else None,
        next_test=advice(investigation, judgement, confirmation, shown[0][0] if shown else None, data, terms),
        response_um=investigation.measure.spread,
        limits=[] if judgement.claims else [_limit(one, terms, investigation) for one in investigation.limits],
        at_rest=[] if judgement.claims else _at_rest(investigation.at_rest, data),
        chance=ladder.chance(investigation.measure),
    )


def _limit(one: Limit, terms: Sequence[str], investigation: Investigation) -> DetectionLimit:
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


def _left(problem: Problem) -> float | None:
    """The error of the model as it is fitted, where no candidate asked for left-out tests."""
    whole = np.concatenate([b.residual for b in problem.blocks]) if problem.blocks else np.empty(0)
    return float(np.sqrt(np.mean(whole**2))) if len(whole) else None
