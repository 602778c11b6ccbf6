"""The place of a switch: as its name says, or asked, but for what a control says of itself."""

from __future__ import annotations

import numpy as np
import pytest

from thermodata.draft.guess import guess
from thermodata.draft.values import values_of

ON_OFF = values_of(np.tile([0.0, 0.0, 1.0, 1.0], 20))


@pytest.mark.parametrize(
    ("name", "at"),
    [
        ("Pompe_lub", "lubrication"),
        ("Schmierpumpe", "lubrication"),
        ("Hydraulik Ein", "hydraulics"),
        ("coolant on", "coolant"),
        ("MQL on", "coolant"),
        ("Lüfter ein", "fan"),
        ("spindle_alarm", "spindle"),
        ("State", None),
        ("Alarm aktiv", None),
    ],
)
def test_a_switch_stands_where_its_name_says(name: str, at: str | None) -> None:
    said = guess(name, None, "float64", ON_OFF)
    assert (said.quantity, said.at, said.questions) == ("state", at, ())


@pytest.mark.parametrize(
    ("name", "at", "asked"),
    [
        ("Niebla activada", "coolant", "at: coolant, or lubrication"),
        ("Pumpe ein", "pump", "at: whose pump? coolant, hydraulics"),
        ("Abrichten aktiv", None, "at: what does it switch? e.g. coolant"),
        ("TripActive", None, "at: what does it switch?"),
    ],
)
def test_a_switch_whose_name_does_not_say_where_is_asked(name: str, at: str | None, asked: str) -> None:
    said = guess(name, None, "float64", ON_OFF)
    assert (said.quantity, said.at, said.sure) == ("state", at, False)
    assert said.questions[0].startswith(asked)
