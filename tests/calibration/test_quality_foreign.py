"""A part of a test that belongs to another recording, and pauses over which a machine only went on."""

from __future__ import annotations

import numpy as np
import pytest

from thermodata.calibration.between_tests.foreign import foreign_part
from thermodata.calibration.between_tests.levels import Course, Levels

H = 3600.0


def recording(
    pause_h: float = 0.2,
    *,
    at_h: float = 6.0,
    stepping: int = 6,
    size: float = 40.0,
    drift_k_h: float = 0.0,
    cools: bool = False,
    hours: float = 8.0,
) -> Levels:
    """8 h of logging with a pause; six channels, so many of which lie elsewhere afterwards."""
    t = np.concatenate([np.linspace(0, at_h * H, 24), at_h * H + pause_h * H + np.linspace(0, (hours - at_h) * H, 8)])
    later = t > at_h * H
    series = {}
    for i in range(6):
        rng = np.random.default_rng(i)
        quantity = "displacement" if i < 2 else "temperature"
        x = 22 + rng.normal(0, 0.1, len(t)) + 3 * i * (1 - np.exp(-t / 5000)) + drift_k_h * t / H
        if cools:
            x = np.where(later, 22 + (x - 22) * np.exp(-(t - at_h * H) / 4000), x)
        series[f"c{i}"] = Course(t, x + size * (i < stepping) * later * (1 if i % 2 else -1), quantity)
    return Levels("one", None, None, series, ((at_h * H, (at_h + pause_h) * H),))


def test_after_a_pause_every_channel_lies_elsewhere() -> None:
    found = foreign_part(recording())
    assert found is not None
    assert found[:2] == (6.2 * H, np.inf)
    assert "6 of 6" in found[2]


def test_the_shorter_side_is_the_foreign_one() -> None:
    found = foreign_part(recording(at_h=1.5))
    assert found is not None
    assert found[:2] == (-np.inf, 1.5 * H)


@pytest.mark.parametrize(("stepping", "foreign"), [(6, True), (5, True), (4, False), (1, False)])
def test_nearly_all_channels_step(stepping: int, foreign: bool) -> None:
    assert (foreign_part(recording(stepping=stepping)) is not None) is foreign


@pytest.mark.parametrize(("size", "foreign"), [(1.0, False), (30.0, True)])
def test_by_more_than_all_that_they_do(size: float, foreign: bool) -> None:
    assert (foreign_part(recording(size=size)) is not None) is foreign


def test_a_drift_a_night_that_cools_and_a_pause_too_long_to_tell_are_none() -> None:
    assert foreign_part(recording(2.0, stepping=0, drift_k_h=2.0)) is None
    assert foreign_part(recording(3.0, stepping=0, cools=True)) is None
    assert foreign_part(recording(14.0)) is None
    assert foreign_part(recording(0.2)) is not None


def test_too_few_channels_tell_nothing() -> None:
    whole = recording()
    few = Levels("one", None, None, dict(list(whole.series.items())[:3]), whole.pauses)
    assert foreign_part(few) is None
