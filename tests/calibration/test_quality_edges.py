"""Spikes beside longer dropouts, and beside pauses."""

from __future__ import annotations

import numpy as np
import pytest

from tests.calibration.quality_data import clock, kinds, run
from thermodata.calibration.quality.sudden.edges import across_steps, without_pauses
from thermodata.plugin import Float1D
from thermodata.schema.flag import Flag

MINUTE = 60_000_000_000


def bearing(n: int = 300) -> Float1D:
    """A bearing that warms and cools over hours, once a minute, in tenths."""
    hours = np.arange(n) / 60
    rng = np.random.default_rng(3)
    return np.round(29 + 9 * np.sin(hours * 2.1) + rng.normal(0, 0.02, n), 1)


@pytest.mark.parametrize("code", [85.0, 0.0])
def test_one_lost_reading_is_a_spike_though_many_are_lost_later(code: float) -> None:
    x = bearing()
    x[40] = x[120:135] = code
    flags, _ = run(clock(300, 60.0), T=("temperature", x))
    assert flags["T"][40] == Flag.SPIKE
    assert flags["T"][120:135].all()
    assert np.flatnonzero(flags["T"]).tolist() == [40, *range(120, 135)]


def test_air_that_comes_in_all_sizes_keeps_its_gusts_beside_a_dropout() -> None:
    rng = np.random.default_rng(5)
    x = 22 + 0.02 * rng.standard_t(1.5, 3000)
    x = np.clip(x, 19, 25)
    x[1000:1030] = 85.0
    assert not (run(clock(3000), T=("temperature", x))[0]["T"] & Flag.SPIKE).any()


def test_a_step_is_clean_where_both_levels_are_still() -> None:
    x = np.full(20, 30.0)
    x[10:] = 85.0
    assert np.flatnonzero(across_steps(x, 5.0)).tolist() == list(range(7, 13))
    assert not across_steps(x, 60.0).any()
    x[13] = 30.0  # three samples may be a puff of air
    assert not across_steps(x, 5.0)[:13].any()


def test_what_went_on_in_a_pause_is_no_spike() -> None:
    t = clock(100, 60.0)
    t[50:] += 40 * MINUTE
    x = 38.5 + 0.01 * np.arange(100.0)
    x[40:50] = np.linspace(38.5, 32.1, 10)  # falls before the pause, rises after it
    x[50:] = 35.5 + 0.15 * np.arange(50)
    assert kinds(run(t, T=("temperature", np.round(x, 1)))[1]) == [(None, "gap")]


@pytest.mark.parametrize("at", [49, 50])
def test_a_spike_beside_a_pause_is_one(at: int) -> None:
    t, x = clock(300, 60.0), bearing()
    t[50:] += 2 * MINUTE
    x[at] += 40
    flags, _ = run(t, T=("temperature", x))
    assert np.flatnonzero(flags["T"] & Flag.SPIKE).tolist() == [at]


def test_a_spike_beside_a_pause_is_one_though_nothing_was_read_before_it() -> None:
    t, x = clock(300, 60.0), bearing()
    t[50:] += 2 * MINUTE
    x[49], x[50] = np.nan, x[50] + 40
    flags, _ = run(t, T=("temperature", x))
    assert flags["T"][50] & Flag.SPIKE


def test_a_sample_between_two_pauses_says_nothing() -> None:
    hit, after, x = np.zeros(9, bool), np.zeros(9, bool), np.full(9, 20.0)
    hit[4], x[4] = True, 60.0
    assert without_pauses(hit, x, after)[4]
    after[[4, 5]] = True
    assert not without_pauses(hit, x, after)[4]
