"""Ohms of a platinum thermometer are a temperature at a place, and what turns them into degrees is asked."""

from __future__ import annotations

import numpy as np
import pytest

from thermodata.draft.signals.guess import Guess, guess
from thermodata.draft.signals.values import values_of


def _of(name: str, low: float, high: float) -> Guess:
    return guess(name, "Ohm", "float64", values_of(np.linspace(low, high, 60)))


@pytest.mark.parametrize(
    ("name", "low", "high", "at", "kind"),
    [
        ("Messung/Pt01_Lager_vorn", 107.0, 112.0, "spindle.bearing.front", "pt100"),
        ("Pt08_Bett", 1070.0, 1120.0, "bed", "pt1000"),
        ("Bett", 94.2, 149.7, "bed", "pt100"),
        ("T_bed", 1e4, 2e4, "bed", None),  # of no platinum thermometer, but of one by its name
        ("Pt08_Bett", 90.0, 112.0, "bed", None),  # -26 degC
    ],
)
def test_ohms_of_a_thermometer_are_a_temperature_whose_curve_is_asked(
    name: str, low: float, high: float, at: str, kind: str | None
) -> None:
    found = _of(name, low, high)
    assert (found.quantity, found.unit, found.at, found.sure) == ("temperature", "Ohm", at, False)
    assert [q.partition("?")[0] for q in found.questions] == ["calibration"]
    assert (f"{{kind: {kind}}}" in found.questions[0]) == (kind is not None)


@pytest.mark.parametrize(
    ("name", "low", "high"), [("Widerstand_1", 107.0, 112.0), ("Bett", 90.0, 112.0), ("Bett", 100.0, 152.0)]
)
def test_ohms_that_are_called_so_or_lie_elsewhere_stay_a_resistance(name: str, low: float, high: float) -> None:
    assert _of(name, low, high).quantity == "resistance"
