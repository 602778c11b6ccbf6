"""Every rule that names a fault of the logs (sensors/logging_faults.py), just inside and outside its limit."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.signal import lfilter

from thermodata.diagnosis.question.problem import Problem
from thermodata.diagnosis.sensors.logging_faults import (
    CLOCK_DROP,
    a_fault_explains,
    clock_offsets,
    clocks_beside,
    first_of_each,
    fit_percent,
    gain_is_wrong,
    shift_that_explains,
    wrong_gains,
    wrong_parameters,
)
from thermodata.diagnosis.verdict.faults import that_nothing_missing_makes
from thermodata.diagnosis.verdict.judged import Judgement
from thermodata.plugin import Float1D, Float2D
from thermodata.schema.answers.diagnosis import Artefact
from thermodata.view.grid.dataset import ChannelInfo, TestData

from .hand_made import Parts, of_one_model, of_tests, problem


def artefact(kind: str, test: str = "t0", at_s: float | None = None) -> Artefact:
    return Artefact(kind=kind, campaign="c", test=test, at_s=at_s, size_um=1.0, why="")


@pytest.mark.parametrize(("error", "expected"), [(0.599, 300.0), (0.601, None)])
def test_a_moved_clock_must_take_away_two_fifths_of_the_squared_error(error: float, expected: float | None) -> None:
    assert shift_that_explains(1.0, {-300.0: 0.9, 300.0: error, 900.0: 0.95}, 100.0, CLOCK_DROP) == expected


@pytest.mark.parametrize(("lateness", "warm", "said"), [(0.9, True, True), (1.2, True, False), (1.2, False, True)])
def test_of_temperatures_alone_three_quarters(lateness: float, warm: bool, said: bool) -> None:
    """A sensor that lags is late as a clock is."""
    asked, sources = late_by(120.0, lateness)
    found = clock_offsets(asked, driver, by_one_lag, sources, ["T"] if warm else [])
    assert bool(found) is said


@pytest.mark.parametrize(("shift", "expected"), [(600.0, 600.0), (900.0, None), (-900.0, None)])
def test_a_smallest_error_at_the_end_of_the_range_is_no_clock(shift: float, expected: float | None) -> None:
    assert shift_that_explains(1.0, {300.0: 0.5, shift: 0.1}, 100.0, CLOCK_DROP) == expected


@pytest.mark.parametrize(("energy", "expected"), [(0.626, 300.0), (0.624, None)])
def test_of_a_poor_model_no_clock_is_said_to_be_off(energy: float, expected: float | None) -> None:
    """FIT 60, moved: 1 - sqrt(0.1 / 0.625)."""
    assert shift_that_explains(1.0, {-300.0: 0.9, 300.0: 0.1, 900.0: 0.95}, energy, CLOCK_DROP) == expected


def late_by(shift_s: float, lateness: float = 0.0) -> tuple[Problem, dict[str, str]]:
    """Four tests whose response follows a driver of the source 'nc' that is late by shift_s."""
    rng = np.random.default_rng(2)

    def one() -> Parts:
        levels = np.repeat(rng.uniform(0, 10, 30), 10)
        u = np.interp(np.arange(300) * 60.0, np.arange(300) * 60.0 + shift_s, levels)
        y = levels + lateness * rng.normal(size=300)
        return Parts(y - y.mean(), values={"T": u})

    return problem(*(one() for _ in range(4))), {"T": "nc"}


def driver(test: TestData) -> Float2D:
    return test.values["T"][:, None]


def by_one_lag(test: TestData) -> Float2D:
    """Of effects that act no otherwise than as they are fitted."""
    return np.zeros((len(test.t_s), 0))


def lagged(values: Float1D, tau_s: float) -> Float1D:
    return np.asarray(lfilter([-np.expm1(-60.0 / tau_s)], [1.0, -np.exp(-60.0 / tau_s)], values))


@pytest.mark.parametrize(("passes_two_bodies", "said"), [(True, False), (False, True)])
def test_heat_that_passes_two_bodies_is_no_clock(passes_two_bodies: bool, said: bool) -> None:
    """The model has one lag of 25 min, and may act by others of 10 and 60 min. The heat passes a body of 25 min and
    one of 8; or it passes one, and its log is 8 min early."""
    rng = np.random.default_rng(3)

    def one() -> Parts:
        u = np.repeat(rng.uniform(0, 10, 12), 50)
        late = np.concatenate([np.full(8, u[0]), u[:-8]])
        y = lagged(lagged(u, 1500.0), 480.0) if passes_two_bodies else lagged(late, 1500.0)
        return Parts(y - y.mean(), values={"T": u})

    def lag(test: TestData) -> Float2D:
        return lagged(test.values["T"], 1500.0)[:, None]

    def others(test: TestData) -> Float2D:
        return np.column_stack([lagged(test.values["T"], tau_s) for tau_s in (600.0, 3600.0)])

    asked = problem(*(one() for _ in range(4)))
    assert len(clock_offsets(asked, lag, by_one_lag, {"T": "nc"}, [])) == 1
    assert bool(clock_offsets(asked, lag, others, {"T": "nc"}, [])) is said


@pytest.mark.parametrize(
    ("shift_s", "minutes"), [(0.0, None), (300.0, "-5 min"), (-600.0, "+10 min"), (900.0, None), (1800.0, None)]
)
def test_a_clock_that_is_off_is_named_with_its_shift(shift_s: float, minutes: str | None) -> None:
    asked, sources = late_by(shift_s)
    found = clock_offsets(asked, driver, by_one_lag, sources, [])
    assert [a.kind for a in found] == ([] if minutes is None else ["clock_offset"])
    assert all("source 'nc'" in a.why and minutes is not None and minutes in a.why for a in found)


def test_only_drivers_of_another_source_have_a_clock_beside_the_response() -> None:
    channels = {
        "dZ": ChannelInfo("dZ", "displacement", "um", source="daq"),
        "T": ChannelInfo("T", "temperature", "degC", source="daq"),
        "n": ChannelInfo("n", "rotational_speed", "rpm", source="nc"),
        "free": ChannelInfo("free", "temperature", "degC"),
    }
    assert clocks_beside(channels, ["T", "n", "free", "absent"], "dZ") == {"n": "nc"}


@pytest.mark.parametrize(
    ("mended", "fit", "explains"), [(0.499, 90.0, True), (0.501, 90.0, False), (0.1, 60.1, True), (0.1, 59.9, False)]
)
def test_mending_a_test_must_take_away_half_of_the_error_and_leave_a_good_model(
    mended: float, fit: float, explains: bool
) -> None:
    assert a_fault_explains(1.0, mended, fit) is explains


def test_fit_is_of_the_error_not_of_its_square() -> None:
    assert fit_percent(0.04, 1.0) == pytest.approx(80.0)
    assert fit_percent(1.0, 0.0) == 0.0


@pytest.mark.parametrize(
    ("changed", "wrong"),
    [
        ({"factor": 1.151}, True),
        ({"factor": 1.149}, False),
        ({"factor": 0.849}, True),
        ({"factor": 0.851}, False),
        ({"factor": 0.01}, True),
        ({"factor": -0.5}, False),
        ({"after": 0.099}, True),
        ({"after": 0.101}, False),
        ({"noise": 0.199}, True),
        ({"noise": 0.201}, False),
    ],
)
def test_a_gain_is_wrong_where_one_factor_explains_a_whole_test(changed: dict[str, float], wrong: bool) -> None:
    """A factor 15 % off that takes away nine tenths of an error of more than five times the noise."""
    plain = {"factor": 1.5, "before": 1.0, "after": 0.01, "rms": 1.0, "noise": 0.01}
    assert gain_is_wrong(**{**plain, **changed}) is wrong


@pytest.mark.parametrize(
    ("factors", "expected"),
    [
        ([1, 1, 1, 1], []),
        ([1, 1, 1, 1, 1.5], [("gain", "t4")]),
        ([1, 1, 1, 1, 1.1], []),
        ([1, 1, 1, 0.5], [("gain", "t3")]),
        ([1, 1, 0.5], []),
        ([1, 0.5, 1, 1, 2, 1, 1], [("gain", "t1"), ("gain", "t4")]),
    ],
)
def test_one_factor_for_a_whole_test(factors: list[float], expected: list[tuple[str, str]]) -> None:
    """Of three nobody can say which one is wrong."""
    assert [(a.kind, a.test) for a in wrong_gains(of_one_model(factors))] == expected


@pytest.mark.parametrize(("lacking", "named"), [(0.9, True), (1.1, False)])
def test_of_a_poor_model_no_gain_is_said_to_be_wrong(lacking: float, named: bool) -> None:
    """FIT 60 with the test mended, where the model lacks something in the others."""
    turns = np.arange(2000) * 2 * np.pi / 200

    def one(factor: float, lacking: float) -> Parts:
        base = np.sin(turns)[:, None]
        y: Float1D = factor * (base[:, 0] + lacking * np.cos(turns))
        return Parts(y, response=y, base=base)

    found = wrong_gains(problem(*(one(1.0, lacking if i == 0 else 0.0) for i in range(4)), one(3.0, 0.0), noise=0.01))
    assert [(a.kind, a.test) for a in found] == ([("gain", "t4")] if named else [])


@pytest.mark.parametrize(
    ("now", "refitted", "floor", "wrong"),
    [(3.01, 1.0, 0.1, True), (2.99, 1.0, 0.1, False), (3.01, 0.1, 3.0, True), (2.99, 0.1, 3.0, False)],
)
def test_parameters_are_wrong_where_a_refit_leaves_a_third(
    now: float, refitted: float, floor: float, wrong: bool
) -> None:
    """And where the error is above the floor."""
    found = wrong_parameters(of_tests(2), now, refitted, floor)
    assert [a.kind for a in found] == (["parameters"] if wrong else [])
    assert all("calibrate_on, fixed and bounds" in a.why and "a cause may be missing" in a.why for a in found)


@pytest.mark.parametrize(
    ("verdict", "at_floor", "kinds"),
    [
        ("none", True, ["gain", "sign"]),
        ("none", False, ["sign"]),
        ("effect", True, ["sign"]),
        ("unknown", False, ["sign"]),
    ],
)
def test_a_wrong_gain_is_said_only_with_the_verdict_none_at_the_floor(
    verdict: str, at_floor: bool, kinds: list[str]
) -> None:
    faults = [artefact("gain"), artefact("sign")]
    judgement = Judgement(verdict, (), (), (), "")  # type: ignore[arg-type]
    assert [a.kind for a in that_nothing_missing_makes(faults, judgement, at_floor)] == kinds


@pytest.mark.parametrize(("claims", "kinds"), [((), ["clock_offset", "sign"]), (("a claim",), ["sign"])])
def test_no_clock_is_said_to_be_off_by_a_model_that_lacks_a_cause(claims: tuple[str, ...], kinds: list[str]) -> None:
    faults = [artefact("clock_offset"), artefact("sign")]
    judgement = Judgement("effect" if claims else "unknown", claims, (), (), "")  # type: ignore[arg-type]
    assert [a.kind for a in that_nothing_missing_makes(faults, judgement, False)] == kinds


def test_a_fault_is_said_once_a_test() -> None:
    found = [artefact("step", "t1", 60.0), artefact("step", "t1", 90.0), artefact("gain", "t0"), artefact("gain", "t0")]
    assert [(a.kind, a.test, a.at_s) for a in first_of_each(found)] == [
        ("step", "t1", 60.0),
        ("step", "t1", 90.0),
        ("gain", "t0", None),
    ]
