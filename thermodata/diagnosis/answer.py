"""The answer in the contract's form, from a fitted model and its data. Pure: no store."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from thermodata.diagnosis import next_test
from thermodata.diagnosis.confirm import Confirmation, confirm, on_all_open
from thermodata.diagnosis.evidence import passes
from thermodata.diagnosis.investigate import Investigation, investigate
from thermodata.diagnosis.judge import Judgement, equivalents
from thermodata.diagnosis.problem import Problem
from thermodata.diagnosis.scored import Scored
from thermodata.diagnosis.unexplained import characterise
from thermodata.modelling.fit import fit_model
from thermodata.modelling.fitted import FittedModel
from thermodata.plugin import Effect
from thermodata.schema.result import Candidate, Diagnosis
from thermodata.view.dataset import Dataset, TestData

SHOWN = 15


@dataclass(frozen=True, slots=True)
class Answer:
    diagnosis: Diagnosis
    locked: tuple[TestData, ...]  # the locked tests that were looked at


def answer(fitted: FittedModel, data: Dataset, library: Mapping[str, Effect], model_id: str, seed: int = 0) -> Answer:
    """Diagnose the response that the model predicts worst; locked tests are opened for a claim only, once."""
    tests = fitted.tests(data)
    index = worst_response(fitted, tests)
    response = fitted.responses[index]
    usable = [t for t in tests if response.can_predict(t)]
    # the choice takes part in all open tests: gains that only a verification test excites must not be guesses
    open_spec = on_all_open(fitted.spec, usable, fitted.tests(data, "locked"))
    refitted = fit_model(open_spec, data, uncertainty=False) if usable else fitted
    investigation = investigate(refitted.responses[index], data, usable, library, seed, as_fitted=response)
    judgement, confirmation = investigation.judgement, None
    locked: list[TestData] = []
    if judgement.claimed is not None:
        locked = [t for t in fitted.tests(data, "locked") if response.can_predict(t)]
        confirmation = confirm(
            fitted.spec,
            index,
            data,
            judgement.claimed.candidate,
            usable,
            locked,
            judgement.second.candidate if judgement.second else None,
            refitted,
        )
        judgement = kept_where_it_holds(judgement, confirmation, response.unit)
    return Answer(_diagnosis(investigation, judgement, confirmation, data, model_id), tuple(locked))


def kept_where_it_holds(judgement: Judgement, confirmation: Confirmation, unit: str) -> Judgement:
    """The claim, or "unknown" where the locked tests contradict it. unit: of the response."""
    if confirmation.holds or judgement.claimed is None:
        return judgement
    return Judgement(
        "unknown",
        None,
        f"{judgement.claimed.candidate.id} explains the open tests, but on the "
        f"locked ones the error does not fall ({confirmation.before:.2f} -> "
        f"{confirmation.after:.2f} {unit})",
    )


def worst_response(fitted: FittedModel, tests: Sequence[TestData]) -> int:
    """The number of the response with the largest share of its variance left."""
    left = []
    for response in fitted.responses:
        over, under = 0.0, 1e-300
        for test in tests:
            if response.can_predict(test) and (m := response.mask(test)).any():
                y, r = response.measured(test)[m], response.residual(test)[m]
                over += float(np.sum((r - r.mean()) ** 2))
                under += float(np.sum((y - y.mean()) ** 2))
        left.append(over / under)
    return int(np.argmax(left))


def _diagnosis(
    investigation: Investigation, judgement: Judgement, confirmation: Confirmation | None, data: Dataset, model_id: str
) -> Diagnosis:
    problem, ranked = investigation.problem, investigation.ranked
    claimed = judgement.claimed
    order = list(ranked)
    if claimed is not None:
        order = [claimed, *(s for s in ranked if s is not claimed)]
    twins = [] if claimed is None else equivalents(claimed, ranked)
    best = order[0] if order else None
    before = _rmse(best.sse_before, problem) if best else _left(problem)
    advice = next_test.to_separate(claimed, twins, data.channels) if claimed else None
    if claimed is None and judgement.verdict != "none":
        advice = next_test.to_find(len({b.test.key for b in problem.blocks}), investigation.spots, best)
    return Diagnosis(
        model=model_id,
        response=problem.response,
        verdict=judgement.verdict,
        noise_um=problem.noise if np.isfinite(problem.noise) else None,
        rmse_um=before,
        explainable=None if best is None else float(np.clip(max(s.drop for s in ranked), 0.0, 1.0)),
        weak_spots=investigation.spots,
        candidates=[
            _candidate(
                i + 1,
                s,
                s is claimed,
                investigation,
                confirmation if s is claimed else None,
                equivalents(s, ranked) if i < 5 else [],
                judgement,
            )
            for i, s in enumerate(order[:SHOWN])
        ],
        artefacts=investigation.artefacts,
        unknown=characterise(problem, investigation.spots) if judgement.verdict == "unknown" else None,
        next_test=advice,
    )


def _candidate(
    rank: int,
    s: Scored,
    claimed: bool,
    investigation: Investigation,
    confirmation: Confirmation | None,
    twins: Sequence[Scored],
    judgement: Judgement,
) -> Candidate:
    problem = investigation.problem
    energy = float(sum(np.sum(y**2) for y in problem.response_blocks))
    return Candidate(
        rank=rank,
        id=s.candidate.id,
        effect=s.candidate.effect.name,
        family=s.candidate.family,
        drivers=list(s.candidate.channels),
        claimed=claimed,
        p_value=s.p_value,
        rmse_um_before=_rmse(s.sse_before, problem),
        rmse_um_after=_rmse(s.sse_after, problem),
        fit_before=_fit(s.sse_before, energy),
        fit_after=_fit(s.sse_after, energy),
        locked_rmse_um_before=confirmation.before if confirmation else None,
        locked_rmse_um_after=confirmation.after if confirmation else None,
        parameters=confirmation.parameters if confirmation else {},
        equivalent=[t.candidate.id for t in twins],
        why=_why(s, claimed, investigation, confirmation, judgement),
    )


def _why(
    s: Scored, claimed: bool, investigation: Investigation, confirmation: Confirmation | None, judgement: Judgement
) -> str:
    problem = investigation.problem
    numbers = (
        f"on left-out tests the error falls from {_rmse(s.sse_before, problem):.2f} to "
        f"{_rmse(s.sse_after, problem):.2f} {problem.unit}; it would act with {s.size:.1f} {problem.unit} RMS"
    )
    if claimed:
        locked = ""
        if confirmation and confirmation.before is not None and confirmation.after is not None:
            locked = f"; on the locked tests from {confirmation.before:.2f} to {confirmation.after:.2f} {problem.unit}"
        beside = judgement.second
        two = (
            f"; a second effect is missing too: with {beside.candidate.id} beside it "
            f"{_rmse(beside.sse_after, problem):.2f} {problem.unit} are left; add this one and diagnose again"
            if beside
            else ""
        )
        return f"{numbers}; chance does as well in {s.p_value:.1%} of surrogate residuals{locked}{two}"
    failed = passes(s, investigation.measure)
    if not failed and judgement.claimed is None:
        return f"{numbers}; {judgement.reason}"
    return f"{numbers}; not claimed: " + ("; ".join(failed) if failed else "the claimed effect explains it better")


def _rmse(sse: np.ndarray, problem: Problem) -> float:
    return float(np.sqrt(sse.sum() / max(problem.rows, 1)))


def _left(problem: Problem) -> float | None:
    """The error of the model as it is fitted, where no candidate asked for left-out tests."""
    whole = np.concatenate([b.residual for b in problem.blocks]) if problem.blocks else np.empty(0)
    return float(np.sqrt(np.mean(whole**2))) if len(whole) else None


def _fit(sse: np.ndarray, energy: float) -> float | None:
    return float((1 - np.sqrt(sse.sum() / energy)) * 100) if energy > 0 else None
