"""4 to 20 mA of a sensor is no current of a motor: a place, or where the values stand, says so."""

from __future__ import annotations

import numpy as np
import pytest

from thermodata.draft.signals.guess import guess
from thermodata.draft.signals.values import values_of

SENSOR = "a sensor's 4..20 mA?"


@pytest.mark.parametrize(
    ("name", "low", "high", "asked"),
    [
        ("Lager vorn", 7.3, 11.5, True),
        ("Bett", 0.0, 8.0, True),  # a wire was loose
        ("Kanal 5", 4.1, 19.0, True),
        ("Kanal 5", 0.0, 19.0, False),
        ("Kanal 5", 4.1, 900.0, False),
        ("Motor X", 4.1, 19.0, False),
        ("Spindel Lager", 7.3, 11.5, True),
    ],
)
def test_milliamperes_of_a_sensor_are_asked(name: str, low: float, high: float, asked: bool) -> None:
    found = guess(name, "mA", "float64", values_of(np.linspace(low, high, 60)))
    assert any(q.startswith(SENSOR) for q in found.questions) is asked
    assert not (asked and any(q.startswith("at:") for q in found.questions)), "where it is hangs on what it measures"


def test_a_current_that_is_called_so_is_one() -> None:
    found = guess("Strom Motor X", "mA", "float64", values_of(np.linspace(4.1, 19.0, 60)))
    assert found.quantity == "current"
    assert not any(q.startswith(SENSOR) for q in found.questions)
