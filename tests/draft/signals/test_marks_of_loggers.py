"""Marks that loggers write for "over range" and "no value" are no readings, by which a draft would judge a channel."""

from __future__ import annotations

import numpy as np
import pytest

from thermodata.draft.signals.guess import guess
from thermodata.draft.signals.values import Values, values_of


def _with(mark: float, rows: int = 3) -> Values:
    x = np.linspace(0.0, 0.02, 360)
    x[100 : 100 + rows] = mark
    found = values_of(x)
    assert found is not None
    return found


@pytest.mark.parametrize("mark", [1e6, -9999.0, 1e38, 32767.0])
def test_a_mark_does_not_make_a_displacement_a_position(mark: float) -> None:
    seen = _with(mark)
    assert seen.high < 1.0
    said = guess("Taster_Z", "mm", "float64", seen)
    assert "displacement, or the position of the axis?" in said.comment()


@pytest.mark.parametrize("value", [2500.0, 123456.0, 100000.0])
def test_large_readings_stay(value: float) -> None:
    assert _with(value).high == value


def test_a_column_of_nothing_but_a_mark_has_its_range() -> None:
    seen = values_of(np.full(50, 1e6))
    assert seen is not None
    assert seen.high == 1e6
