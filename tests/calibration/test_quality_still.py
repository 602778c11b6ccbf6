"""A channel that stood in one test is judged by how it reads in the others."""

from __future__ import annotations

from dataclasses import replace

import pytest

from thermodata.calibration.quality.ends.still import Reading, read_elsewhere

FINE = Reading(step=0.2, finest=0.005, chance=0.01, alternates=0.66, moving=5000, stood_s=0.0)
STOOD = Reading(step=0.0, finest=0.0, chance=1.0, alternates=0.0, moving=0, stood_s=3600.0)


@pytest.mark.parametrize(
    ("stood", "judged"),
    [
        (STOOD, True),
        (replace(STOOD, stood_s=61.0), True),
        (replace(STOOD, stood_s=59.0), False),
        (replace(STOOD, moving=8, step=0.15, finest=0.01), True),
        (replace(STOOD, moving=8, step=2.0, finest=2.0), False),  # logged in treads of 2 um in this test
        (replace(FINE, stood_s=3600.0), False),  # tells for itself
    ],
)
def test_a_minute_of_one_value(stood: Reading, judged: bool) -> None:
    found = read_elsewhere({("day1", "dZ"): FINE, ("day2", "dZ"): stood, ("day3", "dX"): STOOD})
    assert list(found) == ([("day2", "dZ")] if judged else [])
    if judged:
        assert found["day2", "dZ"].stats().float_like


@pytest.mark.parametrize(
    "other",
    [
        replace(FINE, alternates=0.1),  # smooth: filtered, or simulated without noise
        replace(FINE, finest=0.2),  # coarse
        replace(FINE, chance=0.3),
        replace(FINE, moving=150),
    ],
)
def test_only_a_fine_and_noisy_reading_tells(other: Reading) -> None:
    assert read_elsewhere({("day1", "dZ"): other, ("day2", "dZ"): STOOD}) == {}
