"""Units at the end of names, as ROS and pandas have them, and which units a question offers."""

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
    ("name", "low", "high", "quantity", "unit"),
    [
        ("/drive.motor_power_kw", 1, 7, "power", "kW"),
        ("power_hp", 1, 9, "power", "hp"),
        ("/probe.probe_z_m", 0, 3e-5, "displacement", "m"),  # asked: or a displacement?
        ("probe_z_m", 0, 30, "displacement", None),  # no tool is displaced by 30 m
        ("mc/probe/dZ_um/value", 0, 30, "displacement", "um"),
        ("/probe/dZ_um.data", 0, 30, "displacement", "um"),
        ("T_spindle_m", 20, 30, "temperature", "degC"),  # of a motor
        ("T_kw", 20, 30, "temperature", "degC"),  # cooling water
        ("/drive.power_w", 0, 9000, "power", "W"),
        ("drive_power_w", 0, 9, "power", None),  # of a phase
        ('displacement_um {axis="X"}', 0, 30, "displacement", "um"),
        ('power {unit_w="X"}', 0, 9000, "power", None),
        ("X_ERR(IN)", 0, 0.003, "position", "in"),  # asked: or a displacement?
        ("COOLANT (IN)", 20, 30, "temperature", "degC"),  # an inlet
        ("pump_hp", 1, 9, None, None),  # high pressure
        ("Log/n [1/s]", 0, 66, "rotational_speed", "1/s"),
        ("Spindle [Hz]", 0, 66, "rotational_speed", "Hz"),  # asked: or another frequency?
        ("Supply [Hz]", 49, 51, None, "Hz"),
        ("spindle frequency [Hz]", 0, 66, None, "Hz"),
        ("IDS axis 1 (Z) [pm]", 0, 3e7, "displacement", "pm"),
        ("block number [um]", 0, 30, "displacement", "um"),
        ("/d.pos_X [m]", 0.1, 0.4, "position", "m"),
        ("ns=2;s=torque_S [kNm]", 0, 0.04, "torque", "kNm"),
        ("feed_X [mm/s]", 0, 100, "feed", "mm/s"),
        ("P_spindle [kW]", 0, 4, "power", "kW"),
        ("T_front [2]", 20, 30, "temperature", "degC"),  # the second of them
    ],
)
def test_the_end_of_a_name_is_its_unit_beside_a_quantity_that_has_it(
    name: str, low: float, high: float, quantity: str | None, unit: str | None
) -> None:
    said = guess(name, None, "float64", _seen(low, high))
    assert (said.quantity, said.unit) == (quantity, unit)


def test_a_question_offers_horsepower_and_metres() -> None:
    assert "kW, W or hp?" in guess("spindle_power", None, "float64", _seen(1, 7)).comment()
    assert "um, mm, m or V?" in guess("dX", None, "float64", _seen(0, 3e-5)).comment()


def test_turns_a_second_are_asked_and_drafted_of_a_tacho() -> None:
    assert (said := guess("AI/tacho", "1/s")).quantity == "rotational_speed"
    assert said.unit == "1/s"
    assert "quantity: rotational_speed, in turns a second" in guess("AI/ch3", "1/s").comment()
    assert "no quantity has the unit Hz" in guess("AI/ch3", "Hz").comment()


@pytest.mark.parametrize("name", ["/temps.temps[0]", "/thermo.temps", "mc/temps"])
def test_temps_in_a_message_are_temperatures(name: str) -> None:
    said = guess(name, None, "float64", _seen(294.0, 299.5))
    assert (said.quantity, said.unit) == ("temperature", "K")


@pytest.mark.parametrize(("name", "unit"), [("temps", None), ("Temps", "s"), ("mc/temps", "s")])
def test_temps_of_a_table_or_in_seconds_is_time(name: str, unit: str | None) -> None:
    said = guess(name, unit, "float64", _seen(0.0, 3590.0))
    assert said.quantity is None


def test_a_long_name_in_capitals_is_read_at_once() -> None:
    assert units.inches("V" + "O" * 60) is None
    assert units.inches("X_ERR(IN)") == "in"
    assert units.inches("X_AIR (IN)") is None


def test_an_in_behind_the_letter_of_an_axis_alone_is_asked() -> None:
    values = _seen(21.0, 24.0)
    assert any("inlet" in q for q in guess("Z(IN)", None, "float64", values).questions)
    assert not any("inlet" in q for q in guess("X_ERR(IN)", None, "float64", values).questions)


@pytest.mark.parametrize(
    ("low", "high", "span"), [(19.84, 34.5, "19.84 to 34.5"), (250.003, 250.021, "250 to 250.02"), (7, 7, "7")]
)
def test_a_span_tells_its_ends_apart(low: float, high: float, span: str) -> None:
    assert _seen(low, high).span() == span
