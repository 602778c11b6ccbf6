"""What `thermodata diagnose` and `thermodata confirm` answer."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BeforeValidator

from thermodata.schema.answers.candidate import Candidate
from thermodata.schema.answers.missing_heat import Unknown
from thermodata.schema.answers.result import Result
from thermodata.schema.answers.undetermined import Undetermined


class WeakSpot(Result):
    """A window in which the residual stands out of its noise.

    campaign: id
    test: id
    from_s: from the test's start [s]
    to_s: the same, where its last sample ends [s]
    rmse_um: error in the window, in the response's unit
    state: what the machine did, in words
    after_warm_start: whether the model fails there from the start of a test on that began warm: what warmed the
        machine before is in no log of that test
    """

    campaign: str
    test: str
    from_s: float
    to_s: float
    rmse_um: float
    state: str
    after_warm_start: bool = False


Named = Annotated[str | None, BeforeValidator(lambda name: name or None)]


class Artefact(Result):
    """A fault of the logs, beside any verdict.

    kind: step, repeated_step, clock_offset, sign, gain, parameters, sensor, sensor_gain, exchanged or copy
    campaign: id
    test: id; null where all tests share it
    at_s: from the test's start [s]
    size_um: of a step its size, in the response's unit; of a sign or a gain the RMS error of the test as it stands; of
        parameters by how much the error of the model as fitted is larger than that of a refit; null for all else
    why: the evidence in a sentence
    """

    kind: str
    campaign: str
    test: Named
    at_s: float | None
    size_um: float | None
    why: str


class ClockMoved(Result):
    """A clock that was moved before the question was asked.

    source: whose
    campaign: of the test; '' for all
    test: in which; '' for all
    moved_s: by how much later all that it logged is taken to have happened [s]
    """

    source: str
    campaign: str = ""
    test: str = ""
    moved_s: float


class PutRight(Result):
    """What was put right in the logs before the question was asked; the logs themselves stay as they are.

    left_out: (campaign, test) of each test in which a probe is turned
    clocks: those that were moved
    """

    left_out: list[tuple[str, str]] = []
    clocks: list[ClockMoved] = []


class DetectionLimit(Result):
    """How large an effect that is not named would have to be to be claimed on these tests.

    id: of the candidate
    effect: of the library
    family: its family, of the place that it is bound to
    drivers: channels
    least_um: RMS where it acts, in the response's unit, of the least that would be claimed; null where none would
    seen: share of what it does that the model's effects can't do, 0 to 1
    behind: id of the effect of the model that would take it for its own; null where slow noise covers it
    large: whether it would have to be larger than a third of the response
    evidence: log Bayes factor of the model with it against the model without; null where it was not asked
    """

    id: str
    effect: str
    family: str
    drivers: list[str]
    least_um: float | None
    seen: float
    behind: str | None = None
    large: bool = False
    evidence: float | None = None


class ResponseLeft(Result):
    """A response of the model, and how much of it the model leaves.

    response: name
    left: share of its variance in each test that is left over by the model as it is fitted; 0 to 1, more where it is
        worse than the mean; null where nothing counts
    """

    response: str
    left: float | None


class AtRest(Result):
    """A command that moves in no open test, and in another one: what it warms was never heated where it is asked for.

    channel: the command
    warms: temperatures at its place
    effects: of the library, which the model lacks and one of them drives
    moves_in: the other tests that move it; campaign/test where there are several campaigns
    """

    channel: str
    warms: list[str] = []
    effects: list[str]
    moves_in: list[str]


class StartedOn(Result):
    """An open test that begins with something on; most of its error is the level of what may have run before.

    campaign: its id
    test: its id
    on: what is on at the first sample, and its value: Coolant at 1
    channels: the same, each channel or expression with its value; empty in an answer of an older version
    rmse_um: error of the test by the model as it is fitted, in the response's unit
    left_um: the same, had it run before
    of_squares: share of the squared error on all open tests that this makes; 0 to 1
    """

    campaign: str
    test: str
    on: str
    channels: dict[str, str] = {}
    rmse_um: float
    left_um: float
    of_squares: float


class NotAsked(Result):
    """An effect of the library that was not asked: its plugin failed.

    effect: name
    why: what it broke, and whose it is
    """

    effect: str
    why: str


class LockedUnasked(Result):
    """A locked test that can say nothing of this response.

    campaign: id
    test: id
    why: what it lacks: "no driver for ambient_frame (T_hall)", or whose copy it is
    """

    campaign: str
    test: str
    why: str


class Diagnosis(Result):
    """Answer of diagnose.

    model: id
    response: name
    verdict: effect: one is missing; refine: none is missing, but an effect that is there acts otherwise than modelled;
        none: what is left is noise; unknown: something is left, and nothing logged may be named for it; not_testable:
        the tests cannot tell
    noise_um: short-term noise of the response, in its unit; of a staircase at least what its treads leave
    noise_over_s: averaging time of the samples that the noise lies between [s]; null where it was not kept
    left_out_over_s: averaging time of the samples that errors on left-out tests are of [s], over which noise is less;
        null in an answer of an older version
    rmse_um: error on left-out tests without any candidate, where the effects of the model may act otherwise than by
        their one lag
    named_rmse_um: the same with all claims added, or where nothing is claimed with the refinements that let an error
        fall; null where nothing is named, or in an answer of an older version
    modelled_rmse_um: error on left-out tests without any candidate, where the effects of the model act as it has them;
        for the verdicts none and refine
    fitted_rmse_um: error of the model as it is fitted, on the open tests as they are scored: calibration tests about
        levels fitted to them, others from their first samples on
    locked_rmse_um: error on the locked tests, known from when claims that the model has were confirmed; null where
        none were, or in another fit, on other tests or other data
    locked_shape_um: the same over those in which they act, a free offset for each, as left-out tests have it; null
        where it is not known
    explainable: largest fall of the squared error that a candidate gives, 0 to 1
    explainable_by: id of that candidate; null where none is known, or in an answer of an older version
    weak_spots: where the model fails, by cost
    candidates: best first
    artefacts: faults of the logs
    put_right: those that the answer was found without; null where the logs were taken as they are
    made_without: a sentence for each test that the model's version, or one that it came from, was made without, for its
        log was found wrong: nothing is asked of it
    unknown: for the verdict unknown
    next_test: which test to run, or which sensor to add
    response_um: RMS of the response about each test's mean, in its unit
    limits: what was not claimed and could have been, the one that could hide most first; where nothing is claimed
    at_rest: commands that no open test moves; where nothing is claimed
    chance: quantiles (0 to 1 in even steps) of the best log evidence in responses in which nothing is missing
    responses: all of the model, in its order: the one with the largest share left is diagnosed, where none is asked for
    by_choice: whether the response was asked for
    not_asked: effects of the library whose plugins failed
    open_tests: how many tests are open; null in an answer of an older version
    open_tests_asked: how many of them took part: the others lack samples or a channel of the model, or are left out for
        what is wrong with their logs; null in an answer of an older version
    locked_unasked: locked tests of the model that could not be asked: what the model or a claim reads was not logged
        there, or they repeat an open test; empty in an answer of an older version
    locked_tests: how many tests are locked, with those that could not be asked; null in an answer of an older version
    doubtful_clocks: a sentence for each source whose clock could not be aligned in open tests, and on which the answer
        hangs: it was asked as the logs are dated; empty in an answer of an older version
    started_on: open tests that begin with something on that may have run before
    undetermined: effects of the model whose gain its tests do not determine; empty in an answer of an older version
    data_version: digest of the data that it was asked on; null in an answer of an older version
    """

    model: str
    response: str
    verdict: Literal["effect", "refine", "none", "unknown", "not_testable"]
    noise_um: float | None
    noise_over_s: float | None = None
    left_out_over_s: float | None = None
    rmse_um: float | None
    named_rmse_um: float | None = None
    modelled_rmse_um: float | None = None
    fitted_rmse_um: float | None = None
    locked_rmse_um: float | None = None
    locked_shape_um: float | None = None
    explainable: float | None
    explainable_by: str | None = None
    weak_spots: list[WeakSpot]
    candidates: list[Candidate]
    artefacts: list[Artefact]
    put_right: PutRight | None = None
    made_without: list[str] = []
    unknown: Unknown | None = None
    next_test: str | None = None
    response_um: float | None = None
    limits: list[DetectionLimit] = []
    at_rest: list[AtRest] = []
    chance: list[float] = []
    responses: list[ResponseLeft] = []
    by_choice: bool = False
    not_asked: list[NotAsked] = []
    open_tests: int | None = None
    open_tests_asked: int | None = None
    locked_unasked: list[LockedUnasked] = []
    locked_tests: int | None = None
    doubtful_clocks: list[str] = []
    started_on: list[StartedOn] = []
    undetermined: list[Undetermined] = []
    data_version: str | None = None
