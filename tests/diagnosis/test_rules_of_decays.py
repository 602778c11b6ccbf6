"""What decays is no step, and what is said of how long one takes (steps/sudden.py), on both sides of each limit."""

from __future__ import annotations

import numpy as np
import pytest

from thermodata.diagnosis.steps.artefact import as_artefacts, find_steps
from thermodata.diagnosis.steps.step import Step
from thermodata.diagnosis.steps.sudden import comes_back
from thermodata.plugin import Float1D

from .hand_made import Parts, problem


def rough(n: int, of: float = 0.05) -> Float1D:
    return of * np.random.default_rng(0).normal(size=n)


def found_in(residual: Float1D, noise: float = 0.05) -> list[Step]:
    return find_steps(problem(Parts(residual), noise=noise))


def decaying(over_min: float, size: float = 9.0, n: int = 300) -> Float1D:
    """Up at once before sample 100, down again with this time constant; one to a warm machine that moves slowly."""
    i = np.arange(n)
    return rough(n) + 3.0 * np.sin(i / 60) + size * (i >= 100) * np.exp(-np.maximum(i - 100, 0) / over_min)


@pytest.mark.parametrize("size", [9.0, -9.0])
@pytest.mark.parametrize(("over_min", "found"), [(1, 0), (3, 0), (6, 0), (8.5, 0), (20, 1), (60, 1), (1e9, 1)])
def test_what_decays_to_a_tenth_in_twenty_minutes_is_no_slip(over_min: float, found: int, size: float) -> None:
    """8.7 min is the slowest that does."""
    assert len(found_in(decaying(over_min, size))) == found


@pytest.mark.parametrize("side", [4, 5, 10, 20])
def test_what_comes_back_is_told_from_what_stays_in_few_samples(side: int) -> None:
    """A window every 5 min is four samples on either side."""
    t = np.arange(3 * side) * 1200.0 / side
    since = np.maximum(t - t[side], 0.0) / 360.0
    for course in (0.0, t / 600, (t / 1200) ** 2):
        noise = rough(3 * side, 0.01)
        assert comes_back(noise + course + 5.0 * (t >= t[side]) * np.exp(-since), t, side, side)
        assert not comes_back(noise + course + 5.0 * (t >= t[side]), t, side, side)


@pytest.mark.parametrize(("parts", "within_s"), [((1.0,), 60), ((0.5,), 120), ((0.95,), 60), ((0.3, 0.7), 180)])
def test_a_step_says_how_long_it_takes(parts: tuple[float, ...], within_s: int) -> None:
    """parts: of it, that is there in the first samples."""
    course = 5.0 * (np.arange(300) >= 100)
    course[100 : 100 + len(parts)] = 5.0 * np.array(parts)
    [artefact] = as_artefacts(found_in(rough(300, 0.01) + course, 0.01), "um")
    assert f"within {within_s} s, " in artefact.why
    assert "and does not decay" in artefact.why
