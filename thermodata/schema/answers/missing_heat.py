"""What is said of heat that nobody logged. All values have units in their names."""

from __future__ import annotations

from typing import Literal

from thermodata.schema.answers.result import Result


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
    strong_tests: ids of the tests in which it moves the response most, the strongest first; campaign/test where there
        are several campaigns
    weak_tests: ids of the tests in which it hardly does, likewise
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
    not_logged: probability that no channel reads what is missing, 0 to 1; null in an answer of an older version, or
        where no candidate was weighed
    by_name: ids of effects that diagnosis does not ask for by itself, though their channels are logged
    """

    time_constants_h: list[float]
    hours_of_day: list[float]
    states: list[str]
    heat: MissingHeat | None = None
    not_logged: float | None = None
    by_name: list[str] = []
