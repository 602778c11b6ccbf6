"""A unit at the end of a name that its quantity has decides; one that it has not is asked."""

from __future__ import annotations

import numpy as np
import pytest

from thermodata.draft.signals import units
from thermodata.draft.signals.guess import guess
from thermodata.draft.signals.values import Values, values_of


def _seen(low: float, high: float) -> Values:
    found = values_of(np.linspace(low, high, 360))
    assert found is not None
    return found


@pytest.mark.parametrize(
    ("name", "high", "quantity", "unit"),
    [
        ("spindle_speed_Hz", 66.7, "rotational_speed", "Hz"),
        ("/drive.spindle_speed_hz", 66.7, "rotational_speed", "hz"),
        ("spindle_speed_rad_s", 418, "rotational_speed", "rad/s"),
        ("spindle_speed_radps", 418, "rotational_speed", "rad/s"),
        ("torque_spindle_kNm", 0.06, "torque", "kNm"),
        ("torque_spindle_Ncm", 600, "torque", "Ncm"),
        ("coolant_flow_m3_h", 2, "flow", "m3/h"),
        ("feed_x_mm_s", 160, "feed", "mm/s"),
        ("tilt_mm_m", 0.1, "tilt", "mm/m"),
        ("T_HP", 25, "temperature", "degC"),  # of high pressure
        ("T_Oil", 25, "temperature", "degC"),
        ("pressure_at", 6, "pressure", None),  # at what?
        ("spindle_speed_act", 4000, "rotational_speed", "rpm"),
    ],
)
def test_a_unit_of_its_quantity_at_the_end_of_a_name_decides(
    name: str, high: float, quantity: str, unit: str | None
) -> None:
    said = guess(name, None, "float64", _seen(high / 2, high))
    assert (said.quantity, said.unit) == (quantity, unit)


@pytest.mark.parametrize(("name", "end"), [("spindle_speed_m_s", "m/s"), ("spindle_speed_1_s", "1_s")])
def test_another_unit_at_the_end_of_a_name_is_asked(name: str, end: str) -> None:
    said = guess(name, None, "float64", _seen(0.0, 90.0))
    assert not said.sure
    assert f"the name ends with '{end}'" in said.comment()


@pytest.mark.parametrize(
    ("name", "high"),
    [("spindle_power_MW", 8.0), ("spindle_power_HP", 8.0)],  # a mean; of high pressure
)
def test_two_capitals_at_the_end_of_a_name_decide_nothing(name: str, high: float) -> None:
    said = guess(name, None, "float64", _seen(0.0, high))
    assert not said.sure
    assert said.unit is None


@pytest.mark.parametrize(
    "name", ["T_degC_min", "pressure_bar_min", "spindle_power_kW_min", "T_Sp_l_h", "T_Lager_V_h", "Temp_B_m"]
)
def test_a_least_value_and_a_side_of_the_machine_are_no_rates(name: str) -> None:
    assert "the name ends with" not in guess(name, None, "float64", _seen(15.0, 25.0)).comment()


def test_a_delta_in_an_absolute_unit_asks_and_a_rise_is_a_difference() -> None:
    assert "quantity: temperature_difference" in guess("dT_front", "°F", "float64", _seen(0.0, 8.0)).comment()
    assert "temperature_difference" not in guess("dT_front", "°F", "float64", _seen(68.0, 80.0)).comment()
    assert guess("T_rise_rear", "°F", "float64", _seen(0.0, 8.0)).quantity == "temperature_difference"


@pytest.mark.parametrize(
    ("name", "quantity", "axis"),
    [
        ("/probes.x_volt", "displacement", "X"),  # a field of a message
        ("probe_x_volts", "displacement", "X"),
        ("dz_volt", "displacement", "Z"),
        ("bus_volt", "voltage", None),
        ("drives.x_volt", "voltage", None),
    ],
)
def test_volts_at_the_end_of_a_name_are_its_unit_and_say_no_quantity(
    name: str, quantity: str, axis: str | None
) -> None:
    said = guess(name, None)
    assert (said.quantity, said.axis) == (quantity, axis)
    assert units.converts(said.unit or "", "voltage")
    assert bool(said.questions) is (quantity == "voltage"), "what does it measure?"


@pytest.mark.parametrize(("name", "unit"), [("x drive voltage", "V"), ("Spannung X", "V"), ("Volt", None)])
def test_a_name_that_says_a_voltage_is_one(name: str, unit: str | None) -> None:
    assert guess(name, unit).quantity == "voltage"
