"""What fit, add, compare and diagnose answer, as JSON. Keys that don't apply are null, never absent."""

from __future__ import annotations

from typing import Literal

from pydantic import BaseModel, ConfigDict


class Result(BaseModel):
    """Base of what is answered as JSON. Keys that don't apply are null, never absent."""

    model_config = ConfigDict(extra="forbid")


class Parameter(Result):
    """A fitted parameter or gain, with its interval of 95 %.

    value: in `unit`
    unit: as the effect states it
    low: lower end; null at a bound, where held, or where these tests set none
    high: upper end; likewise
    """

    value: float
    unit: str
    low: float | None = None
    high: float | None = None


class Score(Result):
    """Errors of one model in one test, response and phase, by free-run simulation, in the response's canonical
    unit.

    model: id
    campaign: id
    test: id
    role: of the test in this model
    response: name
    phase: all is the whole test
    fit: FIT [%], not clipped: below 0 the mean would be better
    rmse_um: root mean square of the residual
    ptp_um: peak to peak of the response (max - min)
    ptp_residual_um: peak to peak of the residual
    max_um: largest absolute residual
    n: samples that count
    """

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
    """One thing that a fit says of itself.

    name: what was checked
    value: found
    threshold: limit
    passed: whether it holds
    advice: what to do, or what it means
    """

    name: str
    value: float | None
    threshold: float | None
    passed: bool
    advice: str


class FitResult(Result):
    """Answer of fit, add and compare.

    model: id
    name: of the model file
    parent: id of the version before
    campaigns: ids
    response: name or names
    parameters: effect.parameter -> value with its interval
    scores: a row a test, response and phase
    checks: what the fit says of itself
    before: of add: the parent's scores
    added: of add: ids of the effects that the parent has not; a second lag of an effect is one of its own
    notes: of add: which second lags were taken in and why, in sentences
    """

    model: str
    name: str
    parent: str | None
    campaigns: list[str]
    response: str | list[str]
    parameters: dict[str, Parameter]
    scores: list[Score]
    checks: list[Check]
    before: list[Score] | None = None
    added: list[str] | None = None
    notes: list[str] = []


class WeakSpot(Result):
    """A window in which the residual stands out of its noise.

    campaign: id
    test: id
    from_s: from the test's start [s]
    to_s: from the test's start [s]
    rmse_um: error in the window, in the response's unit
    state: what the machine did, in words
    """

    campaign: str
    test: str
    from_s: float
    to_s: float
    rmse_um: float
    state: str


class Rung(Result):
    """One rule of a claim.

    name: of the rule: chance, fall, tests, gain, others, worth and more
    asks: what is measured
    value: measured; null where it can't be
    limit: of the rule
    unit: of value and limit; 1 for shares
    at: whether the value has to be at least or at most the limit
    holds: whether the rule is met
    """

    name: str
    asks: str
    value: float | None
    limit: float
    unit: str
    at: Literal["least", "most"]
    holds: bool


class LeftOut(Result):
    """A test, or a part of one, as the others foretell it.

    campaign: id
    test: id
    from_s: where the part begins, from the test's start [s]
    to_s: where it ends [s]
    acts: whether the candidate does something in it
    rmse_um_before: error without the candidate, in the response's unit
    rmse_um_after: with it
    """

    campaign: str
    test: str
    from_s: float
    to_s: float
    acts: bool
    rmse_um_before: float
    rmse_um_after: float


class CandidateCourse(Result):
    """What a candidate would take of the residual in one test, free offsets removed; lists have one entry a sample.

    campaign: id
    test: id
    t_s: from the test's start [s]
    residual_um: what the model leaves over, in the response's unit
    contribution_um: the candidate's, with its gains as all open tests give them
    """

    campaign: str
    test: str
    t_s: list[float]
    residual_um: list[float]
    contribution_um: list[float]


class Candidate(Result):
    """An effect, bound to channels, that may be missing; with its evidence on left-out tests.

    rank: 1 is the head
    id: effect:channels; gain_by:effect,condition; or phases:effect,phase,phase
    effect: its name
    family: effects of one cause share it
    drivers: channels, in the order of the effect's roles
    gain_by: the effect is in the model, and would have a gain for each value of this condition; null for all others
    phases: the effect is in the model, and would have a function for each of these phases; empty for all others
    claimed: whether the evidence suffices for a missing cause
    refinement: whether it refines an effect that the model has (a second mode, a switch, a lead), which is never a
        missing cause
    probability: posterior probability that this cause is missing, given the data; null where none is stated
    p_value: share of responses in which nothing is missing on which the best of all candidates does as well
    rmse_um_before: error on left-out tests without it, in the response's unit
    rmse_um_after: with it
    fit_before: the same as FIT [%]
    fit_after: with it
    locked_rmse_um_before: error on the locked tests without it; for a claimed one only
    locked_rmse_um_after: with it
    parameters: of the effect, fitted to all open tests; for a claimed one only
    equivalent: ids that the data cannot tell from it
    why: the evidence in a sentence
    evidence: log Bayes factor of the model with it against the model without
    rungs: every rule of a claim with its value and limit
    left_out: each left-out test before and after; beside the user's own model, or beside all that is chosen
    courses: the residual and the contribution; for claims, refinements and the head of the list only
    """

    rank: int
    id: str
    effect: str
    family: str
    drivers: list[str]
    gain_by: str | None = None
    phases: list[str] = []
    claimed: bool
    refinement: bool = False
    probability: float | None = None
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
    evidence: float | None = None
    rungs: list[Rung] = []
    left_out: list[LeftOut] = []
    courses: list[CandidateCourse] = []


class Artefact(Result):
    """A fault of the logs, beside any verdict.

    kind: step, clock_offset, sign, gain, parameters or sensor
    campaign: id
    test: id; empty where all tests share it
    at_s: from the test's start [s]
    size_um: its size, in the response's unit; null for a sensor
    why: the evidence in a sentence
    """

    kind: str
    campaign: str
    test: str
    at_s: float | None
    size_um: float | None
    why: str


class HeatCourse(Result):
    """The estimated missing heat in one test, in even steps; all lists have one entry a step, in the response's unit.

    campaign: id
    test: id
    from_s: where the first step begins, from the test's start [s]
    step_s: length of a step [s]
    source_um: the source: where its contribution would come to rest if it stayed so
    contribution_um: what it does to the response, from its mean
    residual_um: what the model leaves over, from its mean; null where nothing was measured
    """

    campaign: str
    test: str
    from_s: float
    step_s: float
    source_um: list[float]
    contribution_um: list[float]
    residual_um: list[float | None]


class HeatCompanion(Result):
    """A logged channel beside the estimated missing heat.

    channel: name
    at: its place
    on_with: share of the time in which the channel runs that the source is on; null for a temperature
    on_without: share of the time in which it rests that the source is on; null for a temperature
    follows: share of the contribution that one lag of this temperature gives; null for all else
    """

    channel: str
    at: str | None
    on_with: float | None
    on_without: float | None
    follows: float | None


class MissingHeat(Result):
    """The heat that nobody logged, estimated: a source that is never below zero, through one first-order lag.

    time_constant_h: of the lag [h]
    time_constant_low_h: lower end over tests drawn anew (5 %) [h]; null where nothing bounds it
    time_constant_high_h: upper end (95 %) [h]; null where nothing bounds it
    direction: where the response goes when it is heated, + or -; null where it goes both ways, as with a temperature
    agreed: share of the draws of tests in which the direction is the same; null where it goes both ways
    explained: share of the squared residual that it explains
    left_out: the same in parts of the tests that were left out in turn
    hours_of_day: hours (UTC) at which it is on in most of the days
    strong_tests: ids of the tests in which it moves the response most, the strongest first
    weak_tests: ids of the tests in which it hardly does
    goes_with: channels that it goes with, the closest first
    goes_not_with: channels that run without it, or that it does not follow
    where: what kind of body it is, and where a sensor would see it first
    courses: of each test
    """

    time_constant_h: float
    time_constant_low_h: float | None
    time_constant_high_h: float | None
    direction: Literal["+", "-"] | None
    agreed: float | None
    explained: float
    left_out: float
    hours_of_day: list[float]
    strong_tests: list[str]
    weak_tests: list[str]
    goes_with: list[HeatCompanion]
    goes_not_with: list[HeatCompanion]
    where: str
    courses: list[HeatCourse]


class Unknown(Result):
    """What can be said of a residual that nothing logged explains.

    time_constants_h: where its autocorrelation falls to 1/e [h]
    hours_of_day: hours (UTC) at which it stands out
    states: what the machine did in the weak spots
    heat: the missing heat, estimated; null where none is worth its changes
    """

    time_constants_h: list[float]
    hours_of_day: list[float]
    states: list[str]
    heat: MissingHeat | None = None


class Diagnosis(Result):
    """Answer of diagnose.

    model: id
    response: name
    verdict: effect: one is missing; refine: none is missing, but an effect that is there acts otherwise than modelled;
        none: what is left is noise; unknown: something is left that nothing logged explains; not_testable: the tests
        cannot tell
    noise_um: short-term noise of the response, in its unit; of a staircase at least what its treads leave
    noise_over_s: averaging time of the samples that the noise lies between [s]; null where it was not kept
    rmse_um: error on left-out tests without any candidate
    explainable: largest fall of the squared error that a candidate gives, 0 to 1
    weak_spots: where the model fails, by cost
    candidates: best first
    artefacts: faults of the logs
    unknown: for the verdict unknown
    next_test: which test to run, or which sensor to add
    chance: quantiles (0 to 1 in even steps) of the best log evidence in responses in which nothing is missing
    """

    model: str
    response: str
    verdict: Literal["effect", "refine", "none", "unknown", "not_testable"]
    noise_um: float | None
    noise_over_s: float | None = None
    rmse_um: float | None
    explainable: float | None
    weak_spots: list[WeakSpot]
    candidates: list[Candidate]
    artefacts: list[Artefact]
    unknown: Unknown | None = None
    next_test: str | None = None
    chance: list[float] = []


class TestConfirmed(Result):
    """One locked test of a confirmation.

    campaign: id
    test: id
    rmse_um_before: free-run error without the effect, in the response's unit
    rmse_um_after: with it
    """

    campaign: str
    test: str
    rmse_um_before: float
    rmse_um_after: float


class Confirmed(Result):
    """Answer of confirm: the locked tests, opened for a choice of the user's own.

    model: id of the model that the effect was tried on
    response: name
    candidate: effect:channels
    holds: whether the locked error falls by the share that a claim of the diagnosis must show
    locked_rmse_um_before: error over all locked tests without the effect, in the response's unit
    locked_rmse_um_after: with it
    locked_shape_um_before: the same with a free offset for each test, which is what `holds` goes by
    locked_shape_um_after: with it
    parameters: of the effect, fitted to all open tests
    tests: each locked test
    looks: how often the locked tests have been opened so far, this look included; the most of any test
    """

    model: str
    response: str
    candidate: str
    holds: bool
    locked_rmse_um_before: float | None
    locked_rmse_um_after: float | None
    locked_shape_um_before: float | None = None
    locked_shape_um_after: float | None = None
    parameters: dict[str, Parameter]
    tests: list[TestConfirmed]
    looks: int
