"""Units that only values suggest: asked where they suit another one, on both sides of each limit."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from thermodata.draft.signals.guess import guess
from thermodata.draft.signals.values import values_of


def asked(name: str, *readings: float, unit: str | None = None) -> str:
    """The questions of a unit; readings: of a course that goes from the first to the last of them."""
    course = np.concatenate([np.linspace(a, b, 50) for a, b in pairwise(readings)])
    found = guess(name, unit, "float64", values_of(course))
    return "; ".join(q for q in found.questions if q.startswith("unit"))


@pytest.mark.parametrize(
    ("name", "readings", "question"),
    [
        ("Spindle speed", (0, 8, 0, 12), "unit: krpm, 1/s, or rpm? (values 0 to 12)"),
        ("Spindle speed", (0, 60), "unit: krpm, 1/s, or rpm? (values 0 to 60)"),
        ("Spindle speed", (0, 61), ""),
        ("Spindle speed", (0, 0), ""),
        ("table_speed", (0, 8), ""),
        ("T_bearing", (69.6, 104), "unit: degF, or degC? (values 69.6 to 104)"),
        ("T_bearing", (60, 104), "unit: degF, or degC? (values 60 to 104)"),
        ("T_bearing", (59.9, 104), ""),
        ("hall temperature", (45, 70), "unit: degF, or degC? (values 45 to 70)"),
        ("hall temperature", (44, 70), ""),
        ("OilTemp_F", (72, 90, 0, 90), "unit: degF, or degC? (values 0 to 90)"),
        ("OilTemp_F", (20, 90), ""),
        ("OilTemp_F", (0, 40, 90), ""),
    ],
)
def test_a_unit_that_values_suggest_is_asked_where_they_suit_another(
    name: str, readings: tuple[float, ...], question: str
) -> None:
    assert asked(name, *readings) == question


def test_a_unit_that_is_stated_is_not_asked() -> None:
    assert asked("Spindle speed", 0, 8, unit="rpm") == ""
    assert asked("T_bearing", 70, 104, unit="°C") == ""
    assert asked("Spindle speed_krpm", 0, 8) == ""


@pytest.mark.parametrize(
    ("name", "unit", "low", "high", "asked"),
    [
        ("dZ", "mm", 0.0, 19.0, "unit: mm? it goes over 19 mm"),
        ("dZ", "mm", 0.0, 0.3, ""),
        ("dZ", "um", 2000.0, 2300.0, ""),  # an offset of the probe is none
        ("Bett", "°C", 70.0, 87.0, "unit: °C? no reading is below 70 degC"),
        ("Bett", "°F", 70.0, 87.0, ""),
        ("Bett", "°C", 21.0, 87.0, ""),
        ("T Motor Z", "°C", 70.0, 87.0, ""),
    ],
)
def test_a_unit_of_the_file_that_no_machine_suits_is_asked(
    name: str, unit: str, low: float, high: float, asked: str
) -> None:
    said = guess(name, unit, "float64", values_of(np.linspace(low, high, 200))).comment()
    assert asked in said if asked else "unit:" not in said
