"""Every check of a fit, just inside and just outside its limit. Limits stand here as numbers, not as constants."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from thermodata.modelling.model_file.shaped import DEAD_TIME
from thermodata.modelling.terms import parameters
from thermodata.modelling.terms.fitted_response import Values
from thermodata.modelling.terms.parameters import gain_unit
from thermodata.modelling.trust.checks import bound_checks, term_checks
from thermodata.modelling.trust.checks import of_every_fit as checks
from thermodata.plugin import Drivers, Float2D, Gain, Need, Param
from thermodata.report.text.fit import span
from thermodata.schema.answers.result import Check
from thermodata.view.grid.dataset import ChannelInfo, TestData

TAU = Param("tau", "min", 30.0, 10.0, 100.0, "the time constant")
SECOND = Param("tau2", "min", 60.0, 10.0, 100.0, "the second time constant")
EXPONENT = Param("p", "1", 1.0, 0.0, 2.0, "the exponent")
GAIN = Gain("gain", "um/K", (0.5, 10.0), "any", "")
UM: Any = SimpleNamespace(unit="um", bound=SimpleNamespace(units={"T": "degC", "P": "kW", "n": "rpm"}))


@dataclass(frozen=True)
class Straight:
    """The driver times a gain of its own."""

    name: str = "straight"
    family: str = "feed"
    meaning: str = ""
    source: str = ""
    needs: tuple[Need, ...] = (Need("u", "temperature"),)
    params: tuple[Param, ...] = (TAU,)
    gains: tuple[Gain, ...] = (GAIN,)

    def basis(self, drivers: Drivers, p: Mapping[str, float]) -> Float2D:
        return drivers.values["u"][:, None]


def a_test(hours: float = 10.0, resolution: float | None = None) -> TestData:
    t = np.linspace(0.0, hours * 3600.0, 101)
    info = {"T": ChannelInfo("T", "temperature", "degC", resolution=resolution)}
    return TestData("c", "t", "mixed", "calibration", t, {"T": t * 0}, {"T": t == t}, np.ones(101, bool), channels=info)


def term(
    effect: Straight | None = None,
    params: Mapping[str, float] | None = None,
    gain: float = 1.0,
    *,
    sd: Mapping[str, float] | None = None,
    fixed: Sequence[str] = (),
    silent: Sequence[str] = (),
    bounds: Mapping[str, tuple[float, float]] | None = None,
    held: bool = False,
    driver: str = "T",
    also: Sequence[str] = (),
) -> Any:
    """A fitted term as the checks see it."""
    effect = effect or Straight()
    values = Values(dict(params or {"tau": 30.0}), {"gain": gain}, dict(sd or {}), silent=frozenset(silent))
    bound = SimpleNamespace(
        spec=SimpleNamespace(fixed=dict.fromkeys(fixed, 1.0), bounds=dict(bounds or {}), also=list(also)),
        covers=lambda test: True,
        has=lambda test: True,
        calibrate=frozenset({("c", "t")}) if held else None,
        drivers=lambda test: Drivers(test.t_s, {"u": test.values["T"]}, {"u": test.valid["T"]}, {}),
    )
    return SimpleNamespace(
        id="straight",
        effect=effect,
        binding={n.role: driver for n in effect.needs},
        bound=bound,
        groups={"": values},
        params=values.params,
        gains=values.gains,
        sd=values.sd,
        held=held,
    )


def names(found: list[Check]) -> list[str]:
    assert not any(c.passed for c in found)
    return [c.name for c in found]


@pytest.mark.parametrize(("samples", "passed"), [(15, True), (14, False)])
def test_five_independent_samples_a_parameter(samples: int, passed: bool) -> None:
    """A residual that turns with every sample is worth as many as it has."""
    design: Any = SimpleNamespace(n=samples, parts=[slice(0, samples)])
    (found,) = checks._samples((-1.0) ** np.arange(samples), design, 3)
    assert (found.value, found.threshold, found.passed) == (samples, 15.0, passed)
    assert ("add tests" in found.advice) is not passed


@pytest.mark.parametrize(("samples", "passed"), [(5, True), (4, False)])
def test_a_model_without_parameters_counts_as_one(samples: int, passed: bool) -> None:
    design: Any = SimpleNamespace(n=samples, parts=[slice(0, samples)])
    assert checks._samples((-1.0) ** np.arange(samples), design, 0)[0].passed is passed


def at_angle(cosine: float) -> Float2D:
    """Two columns of different size with this correlation."""
    return np.array([[3.0, cosine], [0.0, np.sqrt(1.0 - cosine**2)]])


def conditioning(matrix: Float2D) -> dict[str, Check]:
    return {c.name: c for c in checks._conditioning(matrix, ["a", "b", "c"][: matrix.shape[1]])}


@pytest.mark.parametrize(("cosine", "named"), [(0.981, True), (-0.981, True), (0.979, False), (-0.979, False)])
def test_effects_that_move_together_are_named(cosine: float, named: bool) -> None:
    found = conditioning(at_angle(cosine))
    assert ("collinear:a:b" in found) is named
    assert found["condition_number"].passed


@pytest.mark.parametrize(("condition", "passed"), [(999.0, True), (1001.0, False)])
def test_a_condition_number_of_a_thousand(condition: float, passed: bool) -> None:
    """Two unit columns at cosine c have the condition sqrt((1 + c) / (1 - c))."""
    cosine = (condition**2 - 1) / (condition**2 + 1)
    found = conditioning(at_angle(cosine))["condition_number"]
    assert found.value == pytest.approx(condition, rel=1e-4)
    assert found.passed is passed


def test_a_column_that_never_moves_is_named_and_left_out() -> None:
    found = conditioning(np.array([[1.0, 0.0], [2.0, 0.0]]))
    assert list(found) == ["not_excited:b"]
    assert "condition_number" in conditioning(np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]))


def by_tool(shared: bool) -> Any:
    """Two groups whose first parameter stands at its bound, and whose second one is not determined."""
    found = term(Straight(params=(TAU, SECOND)))
    values = Values({"tau": 100.0, "tau2": 30.0}, {"gain": 1.0}, half={"tau2": 1e9})
    found.groups = {"A": values, "B": values}
    found.bound.spec.shares = lambda name: shared
    found.bound.spec.one_gain = False
    return found


@pytest.mark.parametrize(("shared", "tags"), [(True, [""]), (False, ["[A]", "[B]"])])
def test_what_groups_share_is_said_once_by_the_name_that_its_row_has(shared: bool, tags: list[str]) -> None:
    found = by_tool(shared)
    said = names(bound_checks.at_bounds(UM, found))
    assert said == [
        f"{what}{tag}" for what in ("at_bound:straight.tau", "not_determined:straight.tau2") for tag in tags
    ]
    response: Any = SimpleNamespace(name="Z", unit="um", terms=[found], scale=0.0)
    rows = parameters.parameters([response])
    assert {name.partition(":")[2] for name in said} <= set(rows)
    checks_of = [Check(name=name, value=1.0, threshold=None, passed=False, advice="") for name in said]
    result: Any = SimpleNamespace(parameters=rows, checks=checks_of)
    assert [span(result, f"straight.tau2{tag}") for tag in tags] == ["not determined"] * len(tags)


@pytest.mark.parametrize(
    ("value", "at"),
    [(99.91, True), (99.89, False), (10.009, True), (10.011, False), (100.0, True), (10.0, True), (30.0, False)],
)
def test_a_parameter_at_its_bound(value: float, at: bool) -> None:
    """Within a thousandth of the bound."""
    assert names(bound_checks.at_bounds(UM, term(params={"tau": value}))) == (["at_bound:straight.tau"] if at else [])


def test_a_bound_that_bodies_reach_beyond_is_told_with_what_to_write() -> None:
    reaching = Straight(params=(replace(TAU, reach=(1.0, 360.0)),))
    [told] = bound_checks.at_bounds(UM, term(reaching, {"tau": 100.0}))
    assert "in the effect: bounds: {tau: [1, 360]}" in told.advice
    [plain] = bound_checks.at_bounds(UM, term(params={"tau": 100.0}))
    assert plain.advice.endswith("or the bound is wrong")
    assert bound_checks._wider(replace(TAU, reach=(1.0, 360.0)), 360.0) == "", "it stands at the end of that"


@pytest.mark.parametrize(("value", "at"), [(0.0019, True), (0.0021, False), (1.9981, True), (1.9979, False)])
def test_a_parameter_that_may_be_zero_is_at_its_bound_by_its_range(value: float, at: bool) -> None:
    effect = Straight(params=(EXPONENT,))
    assert names(bound_checks.at_bounds(UM, term(effect, {"p": value}))) == (["at_bound:straight.p"] if at else [])


def test_what_lies_next_to_a_bound_is_not_said_to_stand_at_it() -> None:
    late = Straight(params=(DEAD_TIME,))
    [near] = bound_checks.at_bounds(UM, term(late, {"dead_time": 0.275}, also=["dead_time"]))
    assert "is 0.275, as good as its bound 0 s" in near.advice
    assert near.advice.endswith("leave dead_time out of 'also'")
    [at] = bound_checks.at_bounds(UM, term(late, {"dead_time": 0.0}, also=["dead_time"]))
    assert "stands at its bound 0 s" in at.advice
    [longest] = bound_checks.at_bounds(UM, term(late, {"dead_time": 1200.0}, also=["dead_time"]))
    assert longest.advice.endswith("or the bound is wrong")


def test_a_bound_is_the_users_where_there_is_one_and_fixed_and_silent_ones_have_none() -> None:
    assert bound_checks.at_bounds(UM, term(params={"tau": 100.0}, bounds={"tau": (10.0, 200.0)})) == []
    assert names(bound_checks.at_bounds(UM, term(params={"tau": 200.0}, bounds={"tau": (10.0, 200.0)})))
    assert bound_checks.at_bounds(UM, term(params={"tau": 100.0}, fixed=["tau"])) == []
    assert bound_checks.at_bounds(UM, term(params={"tau": 100.0}, silent=["tau"])) == []


@pytest.mark.parametrize(("tau", "long"), [(600.5, True), (599.5, False)])
def test_a_time_constant_longer_than_the_longest_test(tau: float, long: bool) -> None:
    """Ten hours are 600 min; a shorter test beside takes nothing away."""
    found = term_checks.longer_than_record(term(params={"tau": tau}), [a_test(10.0), a_test(1.0)])
    assert names(found) == (["tau_longer_than_record:straight.tau"] if long else [])
    assert term_checks.longer_than_record(term(params={"tau": tau}, held=True), [a_test(1.0)]) == [], (
        "identified on other tests"
    )


@pytest.mark.parametrize(("gain", "named"), [(10.01, True), (-10.01, True), (9.99, False), (-9.99, False)])
def test_a_gain_larger_than_anything_known(gain: float, named: bool) -> None:
    assert names(bound_checks._plausible(UM, term(gain=gain))) == (["implausible:straight.gain"] if named else [])
    assert bound_checks._plausible(UM, term(gain=gain, fixed=["gain"])) == []


@pytest.mark.parametrize(
    ("value", "half", "left_open"), [(20.0, 10.1, True), (20.0, 9.9, False), (-20.0, 10.1, True), (-20.0, 9.9, False)]
)
def test_a_gain_that_the_tests_leave_open_is_told_so(value: float, half: float, left_open: bool) -> None:
    """Where sizes of 10 and less lie within its interval."""
    found = term(gain=value)
    found.groups[""].half["gain"] = half
    [said] = bound_checks._plausible(UM, found)
    assert ("leave it open" in said.advice) is left_open
    [unknown] = bound_checks._plausible(UM, term(gain=value))
    assert "leave it open" not in unknown.advice


@dataclass(frozen=True)
class Turned(Straight):
    """Its gain is what it does at 10000 rpm."""

    needs: tuple[Need, ...] = (Need("u", "rotational_speed"),)
    gains: tuple[Gain, ...] = (Gain("gain", "um", (0.5, 30.0), "any", "displacement at 10000 rpm"),)
    raises: bool = False

    def basis(self, drivers: Drivers, p: Mapping[str, float]) -> Float2D:
        if self.raises:
            raise ValueError("three samples are too few")
        return (drivers.values["u"][:, None] / 10000.0) ** 2


def at_speed(rpm: float) -> TestData:
    test = a_test()
    channels = {"n": ChannelInfo("n", "rotational_speed", "rpm")}
    return replace(test, values={"T": test.t_s * 0 - rpm}, channels=channels)


@pytest.mark.parametrize(
    ("rpm", "gain", "limit"),
    [
        (4000.0, -84.7, None),  # 13.6 um at 4000 rpm
        (4000.0, -187.4, None),
        (4000.0, -187.6, 187.5),
        (10000.0, 30.1, 30.0),
        (20000.0, 29.9, None),  # sizes are known at 10000 rpm
        (20000.0, 30.1, 30.0),
        (0.0, 30.1, 30.0),
    ],
)
def test_a_gain_at_a_reference_is_judged_at_what_was_logged(rpm: float, gain: float, limit: float | None) -> None:
    found = bound_checks.at_bounds(UM, term(Turned(), gain=gain, driver="n"), [at_speed(rpm / 2), at_speed(rpm)])
    assert [c.threshold for c in found] == ([] if limit is None else [pytest.approx(limit)])
    there = ", which is -30 um at the 4000 rpm that were logged, is larger than anything known"
    assert all((there in c.advice) is (rpm == 4000.0) for c in found)


def test_an_effect_that_no_constant_driver_suits_is_judged_by_its_gain() -> None:
    assert names(bound_checks.at_bounds(UM, term(Turned(raises=True), gain=40.0, driver="n"), [at_speed(4000.0)]))


@pytest.mark.parametrize(("half", "left_open"), [(10.0, False), (15.0, True)])
def test_a_gain_at_a_reference_is_left_open_to_what_is_usual_there(half: float, left_open: bool) -> None:
    """Of 200 um at 10000 rpm, usual are 187.5 where the machine reaches 4000."""
    found = term(Turned(), gain=200.0, driver="n")
    found.groups[""].half["gain"] = half
    [said] = bound_checks.at_bounds(UM, found, [at_speed(4000.0)])
    assert ("leave it open" in said.advice) is left_open


@pytest.mark.parametrize(("quantity", "named", "unit"), [("temperature", True, "um/K"), ("feed", False, "um")])
def test_a_gain_a_kelvin_is_one_where_a_temperature_drives_it(quantity: str, named: bool, unit: str) -> None:
    """A screw that is driven by its feed grows by 20 um at 10 m/min, which is no 20 um/K."""
    kelvin = replace(GAIN, unit="um/K", magnitude=(0.5, 5.0))
    found = term(Straight(needs=(Need("u", quantity),), gains=(kelvin,)), gain=20.0)
    assert bool(bound_checks._plausible(UM, found)) == named
    assert gain_unit(UM, found, "um/K") == unit


@pytest.mark.parametrize(
    ("driver", "gain", "said"),
    [
        ("P", -12521.0, "-12521 um/kW is larger than anything known for any effect with a gain in um/kW (5 to 300"),
        ("P", 300.1, "300 um/kW is larger"),
        ("P", 299.9, None),
        ("T", 60.1, "60.1 um/K is larger than anything known for any effect with a gain in um/K (0.1 to 60 um/K)"),
        ("T", -59.9, None),
        ("n", 1e6, None),
    ],
)
def test_a_gain_of_no_physics_is_held_against_all_in_its_unit(driver: str, gain: float, said: str | None) -> None:
    """What nothing has a gain in, as um/rpm, is left alone."""
    plain = Straight(needs=(Need("u", "*"),), gains=(replace(GAIN, unit="um/u", magnitude=(0.0, float("inf"))),))
    found = bound_checks._plausible(UM, term(plain, gain=gain, driver=driver))
    assert names(found) == (["implausible:straight.gain"] if said else [])
    assert all(c.advice.startswith(said or "") for c in found)


@pytest.mark.parametrize(("unit", "named"), [("um", True), ("degC", False), ("urad", False)])
def test_nothing_is_known_of_a_response_that_is_no_displacement(unit: str, named: bool) -> None:
    response: Any = SimpleNamespace(unit=unit, bound=UM.bound)
    assert bool(bound_checks._plausible(response, term(gain=1e4))) is named


@pytest.mark.parametrize("largest", [float("inf"), 0.0])
def test_a_gain_without_a_known_magnitude_is_plausible(largest: float) -> None:
    effect = Straight(gains=(Gain("gain", "um/K", (0.0, largest), "any", ""),))
    assert bound_checks._plausible(UM, term(effect, gain=1e6)) == []


@pytest.mark.parametrize(
    ("second", "sd", "passed"), [(45.1, 0.1, True), (44.9, 0.1, False), (60.0, 0.99, True), (60.0, 1.01, False)]
)
def test_two_lags_are_apart_by_half_and_sure(second: float, sd: float, passed: bool) -> None:
    effect = Straight(params=(TAU, SECOND))
    for params in ({"tau": 30.0, "tau2": second}, {"tau": second, "tau2": 30.0}):
        (found,) = term_checks.lags_apart(term(effect, params, sd={"tau2": sd}))
        assert (found.name, found.passed) == ("lags_apart:straight", passed)
    assert term_checks.lags_apart(term()) == []
    air = Straight(family="ambient", params=(TAU, SECOND))
    assert term_checks.lags_apart(term(air, {"tau": 30.0, "tau2": second})) == []


@pytest.mark.parametrize(("resolution", "passed"), [(0.0999, True), (0.1001, False)])
def test_one_step_of_a_coarse_sensor_moves_the_prediction_by_a_um(resolution: float, passed: bool) -> None:
    """A gain of 10 um/K times 0.1 K."""
    response: Any = SimpleNamespace(unit="um")
    (found,) = term_checks.ripple(response, term(gain=-10.0), [a_test(resolution=resolution)])
    assert found.passed is passed
    assert found.value == pytest.approx(10 * resolution)
    assert term_checks.ripple(response, term(gain=-10.0), [a_test()]) == []


@pytest.mark.parametrize(("param", "end"), [(TAU, "bound 100 min:"), (EXPONENT, "bound 2:")])
def test_a_bound_is_told_with_its_unit_where_it_has_one(param: Param, end: str) -> None:
    effect = Straight(params=(param,))
    [told] = bound_checks.at_bounds(UM, term(effect, {param.name: param.upper}))
    assert end in told.advice
