"""One machine: what the diagnosis says, what the truth would give, what simple methods would name."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from time import process_time
from typing import Any

from thermodata.diagnosis.answer import answer
from thermodata.diagnosis.confirm import on_all_open, rmse
from thermodata.effect import effects
from thermodata.modelling.candidate import candidate_spec
from thermodata.modelling.fit import fit_model
from thermodata.schema.model import EffectSpec, Model
from thermodata.schema.result import Candidate, Diagnosis
from thermodata.view.dataset import Dataset
from thermodata.virtual.blind.rivals import RIVALS, ask
from thermodata.virtual.lathe.data import channels_of, contribution, model_of, right_effect, to_dataset
from thermodata.virtual.lathe.right_names import Mark, mark, right_channel
from thermodata.virtual.lathe.strata import STRATA
from thermodata.virtual.lathe.world import World, make_world

ORDER: tuple[Mark, ...] = ("exact", "equivalent", "family", "wrong")
NEAR_S = 1200.0  # a fault is found where it is named within 20 min


@dataclass(frozen=True, slots=True)
class Trial:
    """One machine.

    claims: ids; marks: of each. known_again: claims that name a cause which the model has. first: mark of the candidate
    ranked first. outcome: right, equivalent, told (a twin is claimed, the cause named beside it), family, wrong,
    abstained, some (of several hidden), silent (rightly), false claim. rmse: on locked tests [um]: of the model, with
    the claims, with what is hidden by its right names, and with the true contribution taken away. share: of the drop
    that the right names give; None where they give less than a tenth. faults, faults_found: slips and a wrong clock.
    rivals: method -> whether its first channel is the cause's. seconds: processor time of the first verdict.
    """

    stratum: str
    seed: int
    hidden: tuple[str, ...]
    base: tuple[str, ...]
    response: str
    verdict: str
    claims: tuple[str, ...]
    marks: tuple[str, ...]
    known_again: int
    first: str | None
    outcome: str
    rmse_um: float | None
    rmse_um_claimed: float | None
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


def judge(stratum: str, seed: int, *, rivals: bool = True, hours: float = 9.0) -> Trial:
    """The verdict on the machine of a seed, marked. seconds: processor time of the first verdict alone."""
    world = make_world(stratum, seed, hours=hours)
    data, spec = to_dataset(world), model_of(world)
    start = process_time()
    found = answer(fit_model(spec, data, uncertainty=False), data, effects(), "benchmark").diagnosis
    seconds = process_time() - start
    claims, said, last = [], found, spec
    while (claimed := next((c for c in said.candidates if c.claimed), None)) is not None:
        claims.append(claimed)
        last = _with(last, [candidate_spec(claimed.id, data.channels)])
        if len(claims) >= max(1, len(world.hidden)):
            break
        said = answer(fit_model(last, data, uncertainty=False), data, effects(), "benchmark").diagnosis
    blind = STRATA[stratum].blind or STRATA[stratum].outside
    marks, missed = _marks(world.hidden, claims)
    before, after = _locked(spec, data), _locked(last, data)
    named = None if blind or not world.hidden else _locked(_with(spec, _right(world)), data)
    fell = None if named is None or before is None or named > 0.9 * before else before - named
    return Trial(
        stratum,
        seed,
        world.hidden,
        world.base,
        f"d{world.axis}",
        found.verdict,
        tuple(c.id for c in claims),
        marks,
        sum(_best(world.base, c) in ("exact", "equivalent") for c in claims),
        None if not world.hidden or not found.candidates else _best(world.hidden, found.candidates[0]),
        _outcome(marks, missed, not world.hidden or blind),
        before,
        after,
        named,
        _without_truth(world, data, spec),
        None if fell is None or before is None or after is None else (before - after) / fell,
        sum(f.kind in ("step", "clock_offset") for f in world.faults),
        _faults_found(world, found),
        len(found.artefacts),
        _rivals(world, data, spec) if rivals and world.hidden and not blind else {},
        seconds,
    )


def _with(spec: Model, more: Sequence[EffectSpec]) -> Model:
    return spec.model_copy(update={"effects": [*spec.effects, *more]})


def _right(world: World) -> list[EffectSpec]:
    channels = channels_of(world)
    return [right_effect(world, c, channels) for c in world.hidden]


def _best(causes: Sequence[str], c: Candidate) -> Mark:
    """The best mark of a candidate against any of the causes."""
    return min((mark(cause, c.effect, c.drivers, c.family) for cause in causes), key=ORDER.index, default="wrong")


def _marks(hidden: Sequence[str], claims: Sequence[Candidate]) -> tuple[tuple[str, ...], int]:
    """(mark of each claim against what was still hidden, how many causes no claim found)."""
    left: list[str] = list(hidden)
    marks: list[str] = []
    for claim in claims:
        best: str = _best(left, claim)
        if best == "wrong" and any(_told(cause, claim) for cause in left):
            best = "told"
        marks.append(best)
        if best in ("exact", "equivalent", "told"):
            hit = min(left, key=lambda cause: (ORDER.index(_best([cause], claim)), not _told(cause, claim)))
            left.remove(hit)
    return tuple(marks), len(left)


def _told(cause: str, claim: Candidate) -> bool:
    """Whether the claim names the cause among those that it can't be told from."""
    for name in claim.equivalent:
        effect, _, channels = name.partition(":")
        if mark(cause, effect, channels.split(","), "") == "exact":
            return True
    return False


def _outcome(marks: Sequence[str], missed: int, nothing: bool) -> str:
    if nothing:
        good = all(m in ("equivalent", "told", "family") for m in marks)
        return "silent" if not marks else "family" if good else "false claim"
    if not marks:
        return "abstained"
    if "wrong" in marks:
        return "wrong"
    if missed:
        return "family" if "family" in marks else "some"
    if "told" in marks:
        return "told"
    return "right" if all(m == "exact" for m in marks) else "equivalent"


def _locked(spec: Model, data: Dataset) -> float | None:
    """Error on the locked tests of a model fitted to all open ones, scored from the first samples on [um]."""
    opened = [t for t in data.tests if t.role != "locked"]
    locked = [t for t in data.tests if t.role == "locked"]
    fitted = fit_model(on_all_open(spec, opened, locked), data, uncertainty=False).responses[0]
    return rmse(fitted, [t for t in locked if fitted.can_predict(t)])


def _without_truth(world: World, data: Dataset, spec: Model) -> float | None:
    """The same, where what is hidden never acted: what no knowledge of it could better."""
    name = f"d{world.axis}"
    tests = tuple(
        replace(t, values={**t.values, name: t.values[name] - contribution(world, r)})
        for t, r in zip(data.tests, world.runs, strict=True)
    )
    return _locked(spec, replace(data, tests=tests))


def _faults_found(world: World, found: Diagnosis) -> int:
    """Slips named in their test and near their time, and a clock that is said to be off."""
    hits = 0
    for fault in world.faults:
        if fault.kind == "step":
            hits += any(
                a.test == fault.test and a.at_s is not None and abs(a.at_s - (fault.at_s or 0)) <= NEAR_S
                for a in found.artefacts
                if a.kind == "step"
            )
        elif fault.kind == "clock_offset":
            hits += any(a.kind == "clock_offset" for a in found.artefacts)
    return hits


def _rivals(world: World, data: Dataset, spec: Model) -> dict[str, bool]:
    opened = [t for t in data.tests if t.role != "locked"]
    fitted = fit_model(on_all_open(spec, opened, []), data, uncertainty=False).responses[0]
    question = ask(fitted, data, opened)
    found = {}
    for name, method in RIVALS.items():
        channel = method(question)
        found[name] = channel is not None and any(right_channel(cause, channel) for cause in world.hidden)
    return found
