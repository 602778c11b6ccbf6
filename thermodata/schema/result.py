"""What fit, add, compare and diagnose answer, as JSON. Keys that don't apply are null, never absent."""

from __future__ import annotations

from typing import Literal

from pydantic import BaseModel, ConfigDict


class Result(BaseModel):
    model_config = ConfigDict(extra="forbid")


class Parameter(Result):
    value: float
    unit: str
    low: float | None = None
    high: float | None = None


class Score(Result):
    """rmse_um etc. are in the response's canonical unit. fit in %, free-run, not clipped."""

    model: str
    campaign: str
    test: str
    role: str
    response: str
    phase: str
    fit: float | None
    rmse_um: float | None
    ptp_um: float | None
    ptp_residual_um: float | None
    max_um: float | None
    n: int


class Check(Result):
    name: str
    value: float | None
    threshold: float | None
    passed: bool
    advice: str


class FitResult(Result):
    model: str
    name: str
    parent: str | None
    campaigns: list[str]
    response: str | list[str]
    parameters: dict[str, Parameter]
    scores: list[Score]
    checks: list[Check]
    before: list[Score] | None = None


class WeakSpot(Result):
    campaign: str
    test: str
    from_s: float
    to_s: float
    rmse_um: float
    state: str


class Candidate(Result):
    rank: int
    id: str
    effect: str
    family: str
    drivers: list[str]
    claimed: bool
    p_value: float | None
    rmse_um_before: float | None
    rmse_um_after: float | None
    fit_before: float | None
    fit_after: float | None
    locked_rmse_um_before: float | None = None
    locked_rmse_um_after: float | None = None
    parameters: dict[str, Parameter] = {}
    equivalent: list[str] = []
    why: str = ""


class Artefact(Result):
    kind: str
    campaign: str
    test: str
    at_s: float | None
    size_um: float | None
    why: str


class Unknown(Result):
    time_constants_h: list[float]
    hours_of_day: list[float]
    states: list[str]


class Diagnosis(Result):
    model: str
    response: str
    verdict: Literal["effect", "none", "unknown", "not_testable"]
    noise_um: float | None
    rmse_um: float | None
    explainable: float | None
    weak_spots: list[WeakSpot]
    candidates: list[Candidate]
    artefacts: list[Artefact]
    unknown: Unknown | None = None
    next_test: str | None = None
