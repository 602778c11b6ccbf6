"""A probe that is out of reach between two measurements: short stays at its end, in its converter's noise."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from thermodata.calibration.quality.ends.stays import stays_at_extreme
from thermodata.plugin import Float1D

N, CYCLE, MEASURES = 2400, 120, 24
HERE = np.arange(N) % CYCLE < MEASURES
RAIL, NOISE = 10.0, 0.0008
STEP = NOISE / 4  # of the converter


def probe(*, rail: Float1D | float = RAIL, noise: float = NOISE, own: float = 0.0025, at: float = 4.5) -> Float1D:
    """Growth [V] about `at`, read for 2 of 10 min; else at `rail`."""
    rng = np.random.default_rng(5)
    growth = at + 0.4 * (1 - np.exp(-np.arange(N) / 800)) + rng.normal(0, own, N)
    x = np.where(HERE, growth, rail + rng.normal(0, noise, N))
    return np.asarray(np.round(x / STEP) * STEP)


@pytest.mark.parametrize("side", [-1, 1])
def test_short_stays_on_one_level_within_a_converters_noise(side: int) -> None:
    found = stays_at_extreme(side * probe())
    assert found is not None
    level, noise, which, times = found
    assert level == pytest.approx(side * RAIL, abs=NOISE / 4)
    assert noise == pytest.approx(NOISE, rel=0.1)
    assert (which, times) == (side, 20)


@pytest.mark.parametrize("side", [-1, 1])
def test_short_stays_on_one_reading_of_a_probe_that_flickers_by_its_counts(side: int) -> None:
    """Two counts of noise are too few for an extreme to tell by itself that it comes again."""
    found = stays_at_extreme(side * np.round(probe(noise=0.0, own=0.0005) / 0.00025) * 0.00025)
    assert found == (pytest.approx(side * RAIL), 0.0, side, 20)


def test_a_row_on_the_way_there_and_back_is_none_of_them() -> None:
    x = probe()
    x[MEASURES::CYCLE] = 9.7
    found = stays_at_extreme(x)
    assert found is not None
    assert found[3] == 20


def _stroke(x: Float1D) -> Float1D:
    return x + np.where(HERE, 0, 0.006 * np.arange(N) / N)


@pytest.mark.parametrize(
    "make",
    [
        lambda: probe(own=NOISE),  # as noisy as it measures: another place of the axis
        lambda: _stroke(probe()),  # drifts over the stays
        lambda: probe(at=9.8),  # no jump: a shift by the speed
        lambda: probe(at=RAIL - 250 * NOISE),
        lambda: np.where(np.arange(N) == 50, 11.0, probe()),  # it reads beyond
        lambda: probe(rail=RAIL + 0.5 * np.repeat(np.arange(N // CYCLE) % 2, CYCLE)),  # two levels
        lambda: probe(rail=0.0, noise=0.0, own=0.0005),  # at exactly 0 it rests
        lambda: np.round(probe(noise=0.0) / 0.5) * 0.5,  # in treads, of which each is read again and again
        lambda: probe(rail=RAIL + 0.2 * np.sin(np.arange(N) / 7)),
    ],
)
def test_what_may_be_measured_is_no_end(make: Callable[[], Float1D]) -> None:
    assert stays_at_extreme(make()) is None
