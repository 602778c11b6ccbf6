"""One machine: what the diagnosis says, what the truth would give, what simple methods would name."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass, fields, replace
from time import process_time
from typing import Any

import numpy as np

from thermodata.diagnosis.answer import answer
from thermodata.diagnosis.locked.confirm import on_all_open, rmse
from thermodata.effect import effects
from thermodata.modelling.fit.model import fit_model
from thermodata.modelling.terms.fitted_response import FittedResponse
from thermodata.modelling.versions.candidate import with_candidate
from thermodata.schema.answers.candidate import Candidate
from thermodata.schema.answers.diagnosis import Diagnosis
from thermodata.schema.files.model import Model
from thermodata.view.grid.dataset import Dataset
from thermodata.virtual.blind.machines import case_of
from thermodata.virtual.blind.rivals import RIVALS, ask
from thermodata.virtual.truth.case import Case
from thermodata.virtual.truth.marking import Key, claims_of, head_of, marks_of, outcome_of, refinements_of

NEAR_S = 1200.0  # a fault is found where it is named within 20 min
# a share of the drop is told where the right names take off this share of the locked error at least, and a cause can be
# imitated where its own name takes off as much of the open one
LEAST_FALL = 0.1
ALIKE = 0.95  # of what the cause's own name takes off the squared error of the open tests


@dataclass(frozen=True, slots=True)
class Stated:
    """What the first answer says of one candidate. of: first (ranked) or claim. right: whether it is a hidden cause."""

    of: str
    id: str
    probability: float | None
    right: bool


@dataclass(frozen=True, slots=True)
class Trial:
    """One machine.

    by_speed: a thin model that knows the spindle by its speed alone. verdict: of the first answer. rounds: how often
    the diagnosis was asked. claims: ids, of all rounds; marks: of each. known_again: claims that name a cause which the
    model has. first: id of the candidate ranked first; first_mark: its mark. outcome: as `outcome_of` has it.
    refinements: ids that are offered as such; beside_the_base: of these, those that no cause of the base stands for.
    stated: probabilities of the first answer. broken: a channel that breaks; broken_claimed, broken_first: whether it
    is claimed, or ranked first.
    rmse: on locked tests [um]: of the model, with the claims, with the first refinement, with what is hidden by its
    right names, and with the true contribution taken away. share: of the drop that the right names give, whether
    something is claimed or not; None where they give less than `LEAST_FALL`. faults, faults_found: slips and a wrong
    clock. rivals: method -> whether its first channel is the cause's. seconds: processor time of the first verdict.
    """

    stratum: str
    seed: int
    hidden: tuple[str, ...]
    base: tuple[str, ...]
    by_speed: bool
    response: str
    verdict: str
    rounds: int
    claims: tuple[str, ...]
    marks: tuple[str, ...]
    known_again: int
    first: str | None
    first_mark: str | None
    outcome: str
    refinements: tuple[str, ...]
    beside_the_base: int
    stated: tuple[Stated, ...]
    broken: str | None
    broken_claimed: bool
    broken_first: bool
    rmse_um: float | None
    rmse_um_claimed: float | None
    rmse_um_refined: float | None
    rmse_um_named: float | None
    rmse_um_truth: float | None
    share: float | None
    faults: int
    faults_found: int
    artefacts: int
    rivals: dict[str, bool]
    seconds: float

    def to_json(self) -> dict[str, Any]:
        return asdict(self)


KEYS = frozenset(f.name for f in fields(Trial))


def judge(stratum: str, seed: int, *, rivals: bool = True) -> Trial:
    """The verdict on the machine of a seed, marked."""
    case = case_of(stratum, seed)
    spec, data, hidden = case.spec, case.data, case.key.hidden
    start = process_time()
    found = _ask(spec, data)
    seconds = process_time() - start
    claims, last, rounds = _all_claims(found, spec, data, case.rounds)
    fits = _Fits(data)
    key = (
        replace(case.key, alike=_claims_like_causes(case, claims, fits))
        if case.imitated and not case.nothing
        else case.key
    )
    sound = replace(key, broken=None)  # what the model has is known by a broken channel, too
    marks, missed = marks_of(key, claims)
    head, refined = head_of(found), refinements_of(found)
    before, after = fits.locked(spec), fits.locked(last)
    named = None if case.nothing else fits.locked(case.named())
    fell = None if named is None or before is None or named > (1 - LEAST_FALL) * before else before - named
    return Trial(
        stratum=case.stratum,
        seed=case.seed,
        hidden=hidden,
        base=case.base,
        by_speed=case.by_speed,
        response=case.response,
        verdict=found.verdict,
        rounds=rounds,
        claims=tuple(c.id for c in claims),
        marks=tuple(marks),
        known_again=sum(sound.best(case.base, c) in ("exact", "equivalent") for c in claims),
        first=None if head is None else head.id,
        first_mark=None if head is None or not hidden else key.best(hidden, head),
        outcome=outcome_of(found.verdict, marks, missed, case.nothing),
        refinements=tuple(c.id for c in refined),
        beside_the_base=sum(sound.best(case.base, c) == "wrong" for c in refined),
        stated=_probabilities_stated(key, head, claims_of(found)),
        broken=key.broken,
        broken_claimed=any(key.broken in c.drivers for c in claims),
        broken_first=head is not None and key.broken in head.drivers,
        rmse_um=before,
        rmse_um_claimed=after,
        rmse_um_refined=fits.locked(_with_candidates(spec, refined[:1], data)) if refined else None,
        rmse_um_named=named,
        rmse_um_truth=_without_truth(case) if hidden else before,
        share=None if fell is None or before is None or after is None else (before - after) / fell,
        faults=sum(f.kind in ("step", "clock_offset") for f in case.faults),
        faults_found=_faults_found(case, found),
        artefacts=len(found.artefacts),
        rivals=_rivals(case, fits.of(spec)) if rivals and not case.nothing else {},
        seconds=seconds,
    )


def _ask(spec: Model, data: Dataset) -> Diagnosis:
    return answer(fit_model(spec, data, uncertainty=False), data, effects(), "benchmark").diagnosis


def _all_claims(found: Diagnosis, spec: Model, data: Dataset, most: int) -> tuple[list[Candidate], Model, int]:
    """(claims, the model with them, how often was asked). An answer with fewer claims than rounds (`Case.rounds`) is
    followed: its claims are added, and the better model is asked again, as a user would."""
    new = claims_of(found)
    claims, last, rounds = list(new), _with_candidates(spec, new, data), 1
    while new and len(claims) < most:
        new = claims_of(_ask(last, data))
        claims, last, rounds = [*claims, *new], _with_candidates(last, new, data), rounds + 1
    return claims, last, rounds


def _probabilities_stated(key: Key, head: Candidate | None, claims: Sequence[Candidate]) -> tuple[Stated, ...]:
    def stated(of: str, c: Candidate) -> Stated:
        return Stated(of, c.id, c.probability, key.is_hidden(c))

    return (*([] if head is None else [stated("first", head)]), *(stated("claim", c) for c in claims))


def _with_candidates(spec: Model, some: Sequence[Candidate], data: Dataset) -> Model:
    for one in some:
        spec = with_candidate(spec, one.id, data.channels)
    return spec


class _Fits:
    """Models of one machine fitted to all its open tests, each once."""

    def __init__(self, data: Dataset) -> None:
        self.data = data
        self.opened = [t for t in data.tests if t.role != "locked"]
        self.closed = [t for t in data.tests if t.role == "locked"]
        self._kept: dict[str, FittedResponse] = {}

    def of(self, spec: Model) -> FittedResponse:
        key = spec.model_dump_json()
        if key not in self._kept:
            whole = on_all_open(spec, self.opened, self.closed)
            self._kept[key] = fit_model(whole, self.data, uncertainty=False).responses[0]
        return self._kept[key]

    def locked(self, spec: Model) -> float | None:
        """Error on the locked tests, scored from the first samples on [um]."""
        fitted = self.of(spec)
        return rmse(fitted, [t for t in self.closed if fitted.can_predict(t)])

    def opened_squares(self, spec: Model) -> float:
        """Mean square on the open tests, each about its own level [um^2]."""
        fitted = self.of(spec)
        left = rmse(fitted, [t for t in self.opened if fitted.can_predict(t)], free=True)
        return np.nan if left is None else left**2


def _claims_like_causes(case: Case, claims: Sequence[Candidate], fits: _Fits) -> frozenset[tuple[str, str]]:
    """(claim, cause) where the open tests can't tell them apart: beside all that is missing else, the claim in the
    place of the cause takes off as much of their error. A cause that takes off nothing is imitated by nothing."""
    strange = [c for c in claims if all(case.key.stands_for(cause, c) is None for cause in case.key.hidden)]
    pairs = set()
    for cause in case.key.hidden if strange else ():
        rest = case.named(without=cause)
        without, own = fits.opened_squares(rest), fits.opened_squares(case.named())
        if own > (1 - LEAST_FALL) ** 2 * without:
            continue
        for c in strange:
            instead = fits.opened_squares(_with_candidates(rest, [c], case.data))
            if without - instead >= ALIKE * (without - own):
                pairs.add((c.id, cause))
    return frozenset(pairs)


def _without_truth(case: Case) -> float | None:
    """The same, where what is hidden never acted: what no knowledge of it could better."""
    name = case.response
    tests = tuple(
        replace(t, values={**t.values, name: t.values[name] - course})
        for t, course in zip(case.data.tests, case.contribution, strict=True)
    )
    return _Fits(replace(case.data, tests=tests)).locked(case.spec)


def _faults_found(case: Case, found: Diagnosis) -> int:
    """Slips named in their test and near their time, and a clock that is said to be off."""
    hits = 0
    for fault in case.faults:
        if fault.kind == "step":
            hits += any(
                a.test == fault.test and a.at_s is not None and abs(a.at_s - (fault.at_s or 0)) <= NEAR_S
                for a in found.artefacts
                if a.kind == "step"
            )
        elif fault.kind == "clock_offset":
            hits += any(a.kind == "clock_offset" for a in found.artefacts)
    return hits


def _rivals(case: Case, fitted: FittedResponse) -> dict[str, bool]:
    question = ask(fitted, case.data, [t for t in case.data.tests if t.role != "locked"])
    found = {}
    for name, method in RIVALS.items():
        channel = method(question)
        found[name] = channel is not None and any(case.key.names[c].told_by(channel) for c in case.key.hidden)
    return found
