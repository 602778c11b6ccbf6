"""The letter of a unit that may be that of an axis: taken for the unit, asked, or left to the axis."""

from __future__ import annotations

import numpy as np
import pytest

from thermodata.draft.campaign.among_channels.siblings import beside_each_other
from thermodata.draft.campaign.parts import DraftChannel
from thermodata.draft.signals.guess import guess
from thermodata.draft.signals.values import values_of

WARM = values_of(21 + 15 * (1 - np.exp(-np.arange(400) / 100.0)))
CURRENT = values_of(3 + np.random.default_rng(0).normal(size=400))


@pytest.mark.parametrize(
    ("name", "at"),
    [
        ("temp_c/motor", None),
        ("motor_temp_c", None),
        ("bearing_temp_c", "spindle.bearing"),
        ("Bearing_Temp_C", "spindle.bearing"),
        ("spindle_temp_c", "spindle"),
        ("spindle_current_a", "spindle"),
        ("current_a/spindle", "spindle"),
    ],
)
def test_a_letter_behind_its_quantity_at_the_end_is_the_unit(name: str, at: str | None) -> None:
    found = guess(name, None, "float64", CURRENT if "current" in name else WARM)
    assert found.at == at
    assert "rotary" not in found.comment()


@pytest.mark.parametrize("name", ["temp_c_motor", "T_C_motor", "motor_c", "tempC_motor", "T_mot_C", "deg_c_motor"])
def test_a_letter_that_may_be_both_is_asked(name: str) -> None:
    found = guess(name, None, "float64", WARM)
    assert found.at is None
    asked = "at: rotary.c.motor, of the C axis? or, where the letter is the unit degC, of what else"
    assert any(q.startswith(asked) for q in found.questions)


@pytest.mark.parametrize(
    ("name", "unit", "at"),
    [
        ("T_C_motor", "°C", "rotary.c.motor"),
        ("T_C_motor [°C]", None, "rotary.c.motor"),
        ("C_motor_temp", None, "rotary.c.motor"),
        ("temp_C_axis_motor", None, "rotary.c.motor"),
        ("temp_C1_motor", None, "rotary.c.motor"),
        ("T_X_motor", None, "axis.x.motor"),
        ("temp_c_front_bearing", None, "spindle.bearing.front"),
    ],
)
def test_a_letter_that_is_no_unit_is_the_axis(name: str, unit: str | None, at: str) -> None:
    found = guess(name, unit, "float64", WARM)
    assert (found.at, found.questions) == (at, ())


@pytest.mark.parametrize(("others", "at"), [(("current_x", "current_c"), "rotary.a"), (("T_x",), None)])
def test_the_letter_of_an_axis_among_those_of_others_is_one(others: tuple[str, ...], at: str | None) -> None:
    names = ("current_a", *others)
    guesses = [guess(n, None, "float64", CURRENT if "current" in n else WARM) for n in names]
    channels = [DraftChannel(n, "log", n, None, g) for n, g in zip(names, guesses, strict=True)]
    found = beside_each_other(channels)[0].said
    assert found.at == at
    assert (not found.questions) == (at is not None)
