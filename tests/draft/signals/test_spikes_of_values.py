"""What a sample tells of a quantity, though a sensor once failed in it."""

from __future__ import annotations

import numpy as np
import pytest

from thermodata.draft.signals.guess import guess
from thermodata.draft.signals.values import in_unit, joined, values_of

SLOW = np.linspace(18.0, 24.0, 2000) + 0.01 * np.sin(np.arange(2000))


@pytest.mark.parametrize("spikes", [0, 1, 3])
def test_a_spike_leaves_a_temperature_one(spikes: int) -> None:
    x = SLOW.copy()
    x[100 : 100 + spikes] = 850.0
    said = guess("nut_z", None, "float64", values_of(x))
    assert (said.quantity, said.unit) == ("temperature", "degC")
    assert "850" not in "".join(said.questions)


def test_what_is_often_so_high_is_no_spike() -> None:
    x = SLOW.copy()
    x[::50] = 850.0
    assert guess("nut_z", None, "float64", values_of(x)).quantity is None


@pytest.mark.parametrize(("between", "is_switch"), [(1.0, True), (0.5, False)])
def test_a_switch_is_one_however_rarely_it_is_on(between: float, is_switch: bool) -> None:
    x = np.zeros(100_000)
    x[50_001:50_011] = np.linspace(between, 1.0, 10)
    seen = values_of(x)
    assert seen is not None
    assert seen.switch is is_switch
    assert (guess("M8", None, "float64", seen).quantity == "state") is is_switch


def test_the_usual_range_is_joined_and_converted() -> None:
    one, few = values_of(SLOW), values_of(np.array([30.0, 31.0]))
    both = joined(one, few)
    assert both is not None
    assert both.usual[1] == 31.0
    kelvin = in_unit(one, "degC", "K")
    assert kelvin is not None
    assert one is not None
    assert kelvin.usual[0] == pytest.approx(one.usual[0] + 273.15)


@pytest.mark.parametrize(("name", "at"), [("MotorTempC", "rotary.c.motor"), ("MotorTempB", "rotary.b.motor")])
def test_a_rotary_axis_behind_the_temperature_of_its_motor_is_its_place(name: str, at: str) -> None:
    assert guess(name, "degC").at == at
