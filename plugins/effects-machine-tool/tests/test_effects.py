"""The kit on every effect of this plugin, and the physics of those that are more than one lag."""

from __future__ import annotations

from importlib.metadata import entry_points

import numpy as np
import pytest
from thermodata_effects_machine_tool.ambient import AmbientSkin
from thermodata_effects_machine_tool.axis import FeedScrew, RotaryFriction, ScrewGrowth
from thermodata_effects_machine_tool.drives import CuttingTorque, FeedMotorLosses, ScrewPower, SpindleMotorLosses
from thermodata_effects_machine_tool.generic import Step, WarmStart
from thermodata_effects_machine_tool.measuring import RunoutAlias, SensorDrift
from thermodata_effects_machine_tool.moments import Homing, Lubrication, ToolChange, rises
from thermodata_effects_machine_tool.positioned import Overhang, ScaleGrowth
from thermodata_effects_machine_tool.process import CoolantHeat, CuttingLoad
from thermodata_effects_machine_tool.spindle import (
    CentrifugalShift,
    SpindleFriction,
    SpindleHeatingCooling,
)

from thermodata.effect import all_effects, effects
from thermodata.effect.lag import lag
from thermodata.plugin import Drivers
from thermodata.testing.effect import check_effect

PACKAGE = "thermodata_effects_machine_tool"
OURS = sorted((e for e in entry_points(group="thermodata.effect") if e.value.startswith(PACKAGE)), key=lambda e: e.name)
T = np.arange(0.0, 36000.0, 60.0)


def _drivers(**values: np.ndarray) -> Drivers:
    return Drivers(T, values, {k: np.ones(len(T), bool) for k in values}, {})


@pytest.mark.parametrize("entry", OURS, ids=lambda e: e.name)
def test_it_keeps_the_contract(entry: object) -> None:
    check_effect(entry.load()())  # type: ignore[attr-defined]


def test_a_centrifugal_shift_is_quadratic_at_once_and_forgets_the_direction() -> None:
    speed = np.where(T < 6000, 0.0, np.where(T < 12000, 5000.0, -10000.0))
    column = CentrifugalShift().basis(_drivers(speed=speed), {})[:, 0]
    assert (column[0], column[100], column[200]) == (0.0, 0.25, 1.0)


def test_friction_without_a_sensor_settles_at_a_power_of_the_speed() -> None:
    speed = np.full(len(T), 5000.0)
    column = SpindleFriction().basis(_drivers(speed=speed), {"tau": 30.0, "exponent": 2.0})[:, 0]
    assert column[-1] == pytest.approx(0.25, rel=1e-3)


def test_torque_and_speed_heat_as_the_power_that_they_are() -> None:
    torque, speed = np.full(len(T), -30.0), np.full(len(T), 2000.0)  # driven the other way round
    column = CuttingTorque().basis(_drivers(torque=torque, speed=speed), {"tau": 30.0})[:, 0]
    assert column[-1] == pytest.approx(6.283, rel=1e-3)  # kW
    column = ScrewPower().basis(_drivers(torque=torque, feed=np.full(len(T), 5.0)), {"tau": 30.0})[:, 0]
    assert column[-1] == pytest.approx(1.5, rel=1e-3)


@pytest.mark.parametrize("effect", [FeedMotorLosses(), SpindleMotorLosses()], ids=lambda e: e.name)
def test_a_motor_that_takes_half_has_a_quarter_of_the_losses(effect: FeedMotorLosses | SpindleMotorLosses) -> None:
    assert {need.role for need in effect.needs} == set(effect.rated)
    for role, rated in effect.rated.items():
        column = effect.basis(_drivers(**{role: np.full(len(T), -rated / 2)}), {"tau": 30.0})[:, 0]
        assert column[-1] == pytest.approx(0.25, rel=1e-3)


def test_heating_and_cooling_each_have_their_time_constant() -> None:
    on = T < 18000
    u = np.where(on, 10.0, 0.0)
    drivers = _drivers(temperature=u, speed=np.where(on, 3000.0, 0.0))
    column = SpindleHeatingCooling().basis(drivers, {"tau_on": 20.0, "tau_off": 100.0})[:, 0]
    assert column[100] == pytest.approx(10 * (1 - np.exp(-100 * 60 / 1200)), rel=0.01)
    late = np.argmax(T >= 18000 + 6000)
    assert column[late] == pytest.approx(10 * np.exp(-1.0), rel=0.02)
    same = SpindleHeatingCooling().basis(drivers, {"tau_on": 45.0, "tau_off": 45.0})[:, 0]
    assert np.allclose(same, lag(u, 2700.0, 60.0))


def test_skin_is_gone_once_the_frame_has_followed() -> None:
    p = {"tau_fast": 10.0, "tau_slow": 100.0}
    column = AmbientSkin().basis(_drivers(temperature=np.full(len(T), 4.0)), p)[:, 0]
    assert column.max() > 2.5
    assert column[-1] < 0.02


def test_a_screw_grows_with_position() -> None:
    p = {"tau": 1.0}
    near, far = (
        ScrewGrowth().basis(_drivers(temperature=np.full(len(T), 2.0), position=np.full(len(T), x)), p)[-1]
        for x in (100.0, 600.0)
    )
    assert near == pytest.approx([0.2, 2.0])
    assert far == pytest.approx([1.2, 2.0])


def test_the_load_is_a_share_of_full_load() -> None:
    """A gain is comparable between machines."""
    by_load = CuttingLoad().basis(_drivers(load=np.full(len(T), 40.0)), {"tau": 10.0})
    assert by_load[-1, 0] == pytest.approx(0.4, rel=1e-3)


def test_warm_coolant_heats_only_while_it_flows() -> None:
    flows = (T >= 18000.0).astype(np.float64)
    warmed = CoolantHeat().basis(_drivers(temperature=np.full(len(T), 6.0), state=flows), {"tau": 20.0})[:, 0]
    assert not warmed[T < 18000.0].any()
    assert warmed[-1] == pytest.approx(6.0, rel=1e-3)


def test_friction_of_a_turning_axis_settles_at_a_power_of_its_speed() -> None:
    by_speed = RotaryFriction().basis(_drivers(speed=np.full(len(T), -5.0)), {"tau": 30.0, "exponent": 2.0})
    assert by_speed[-1, 0] == pytest.approx(0.25, rel=1e-3)


def test_the_feed_stands_in_for_a_nut_without_a_sensor() -> None:
    p = {"tau": 30.0, "exponent": 1.0}
    by_feed = FeedScrew().basis(_drivers(feed=np.full(len(T), -5.0)), p)
    assert by_feed[-1, 0] == pytest.approx(0.5, rel=1e-3)


def test_a_step_stands_and_a_warm_start_fades() -> None:
    step = Step().basis(_drivers(), {"at": 100.0})[:, 0]
    assert (step[99], step[100], step[-1]) == (0.0, 1.0, 1.0)
    warm = WarmStart().basis(_drivers(), {"tau": 60.0})[:, 0]
    assert (warm[0], warm[60]) == (1.0, pytest.approx(np.exp(-1)))


def test_a_scale_and_an_overhang_grow_with_position() -> None:
    warm = np.full(len(T), 2.0)
    for effect, roles in ((ScaleGrowth(), ("temperature", "position")), (Overhang(), ("temperature", "position"))):
        near, far = (
            effect.basis(_drivers(**dict(zip(roles, (warm, np.full(len(T), x)), strict=True))), {"tau": 1.0})[-1, 0]
            for x in (100.0, 600.0)
        )
        assert (near, far) == pytest.approx((0.2, 1.2))


def test_a_tool_starts_cold_at_each_change() -> None:
    change = np.isin(T, [12000.0, 12060.0, 24000.0]).astype(float)
    column = ToolChange().basis(_drivers(temperature=np.full(len(T), 5.0), change=change), {"tau": 20.0})[:, 0]
    first = 5 * (1 - np.exp(-T / 1200.0))
    assert column[:200] == pytest.approx(first[:200])
    assert column[200] == 0.0
    assert column[200:400] == pytest.approx(first[:200])
    assert column[400:600] == pytest.approx(first[:200])


def test_each_pulse_of_oil_adds_one_course_that_fades_however_long_the_pump_runs() -> None:
    short, long = (np.isin(T, 6000.0 + 60.0 * np.arange(k)).astype(float) for k in (1, 5))
    a, b = (Lubrication().basis(_drivers(pump=p), {"tau": 10.0})[:, 0] for p in (short, long))
    assert np.array_equal(a, b)
    assert (a[99], a[100], a[110]) == (0.0, 1.0, pytest.approx(np.exp(-1.0)))


def test_homings_are_counted_and_stay() -> None:
    command = np.isin(T, [6000.0, 6060.0, 12000.0]).astype(float)
    column = Homing().basis(_drivers(command=command), {})[:, 0]
    assert (column[99], column[101], column[150], column[-1]) == (0.0, 1.0, 1.0, 2.0)


def test_a_flag_that_is_up_from_the_start_has_not_risen() -> None:
    assert not rises(np.ones(5)).any()
    assert list(rises(np.array([0.0, 1.0, 1.0, 0.0, 1.0]))) == [0.0, 1.0, 0.0, 0.0, 1.0]


def test_run_out_is_an_offset_at_multiples_of_the_sampling_rate_only() -> None:
    speed = np.repeat([0.0, 6000.0, 6060.0, 300.0, -600.0], 120)
    column = RunoutAlias().basis(_drivers(speed=speed), {"rate": 10.0})[:, 0]
    at = column[60::120]
    assert (at[0], at[1], at[4]) == pytest.approx((0.0, 1.0, 1.0))
    assert max(at[2], at[3]) < 1e-9  # 1 % of speed, and half the rate, turn round in a second


def test_a_sensor_that_drifts_takes_its_effect_along() -> None:
    column = SensorDrift().basis(_drivers(), {"tau": 60.0})[:, 0]
    assert column[0] == 0.0
    # the lag is one hour behind in the end
    assert column[-1] == pytest.approx(T[-1] / 3600 - 1, abs=0.01)


def test_diagnosis_does_not_ask_for_them_by_itself() -> None:
    quiet = {e.name for e in OURS if getattr(e.load(), "asked", True) is False}
    assert quiet == {
        "homing",
        "lubrication",
        "overhang",
        "runout_alias",
        "scale_growth",
        "sensor_drift",
        "tool_change",
    }
    assert not quiet & set(effects())
    assert quiet <= set(all_effects())
