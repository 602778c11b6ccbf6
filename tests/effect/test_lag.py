"""The lag against closed forms: steps, ramps, and what a wrong step size would show."""

from __future__ import annotations

import numpy as np
import pytest

from thermodata.effect.lag import SHORT, WIDE, lag, lag_along, lags, lags_at


def test_a_ramp_is_exact_at_any_step() -> None:
    tau = 1200.0
    for step in (1.0, 60.0, 1800.0):
        t = np.arange(0.0, 36000.0, step)
        exact = t - tau * (1.0 - np.exp(-t / tau))
        assert np.allclose(lag(t, tau, step), exact, rtol=1e-10, atol=1e-6)


def test_a_held_input_is_reached_to_63_percent_after_one_time_constant() -> None:
    u = np.ones(121)
    x = lag(u, 3600.0, 60.0)
    # the input jumps before the first sample, the state starts in balance
    assert x[0] == 0.0
    assert x[60] == pytest.approx(1.0 - np.exp(-1.0), rel=1e-9)


def test_the_state_at_the_start_is_kept_and_fades() -> None:
    x = lag(np.zeros(61), 3600.0, 60.0, start=5.0)
    assert x[0] == pytest.approx(5.0)
    assert x[60] == pytest.approx(5.0 / np.e)


def test_splitting_a_record_and_carrying_the_state_changes_nothing() -> None:
    u = np.random.default_rng(0).normal(size=400).cumsum()
    whole = lag(u, 900.0, 60.0)
    first = lag(u[:200], 900.0, 60.0)
    second = lag(u[199:], 900.0, 60.0, start=float(first[-1]))
    assert np.allclose(np.concatenate([first, second[1:]]), whole)


def test_a_time_constant_that_changes_is_as_the_parts_one_by_one() -> None:
    u = np.random.default_rng(2).normal(size=400).cumsum()
    first = lag(u[:200], 900.0, 60.0)
    second = lag(u[199:], 5400.0, 60.0, start=float(first[-1]))
    taus = np.where(np.arange(400) < 200, 900.0, 5400.0)
    assert np.allclose(lag_along(u, taus, 60.0), np.concatenate([first, second[1:]]), rtol=1e-12)


def test_no_lag_and_nothing() -> None:
    assert np.array_equal(lag(np.arange(3.0), 0.0, 60.0), [0, 1, 2])
    assert lag(np.zeros(0), 10.0, 60.0).shape == (0,)
    assert lag_along(np.zeros(0), np.zeros(0), 60.0).shape == (0,)


def test_the_same_curve_sampled_coarser_gives_the_same_answer() -> None:
    t = np.arange(0, 86400, 60.0)
    u = np.interp(t, [0, 20000, 40000, 86400], [0, 5, 1, 3])
    coarse = lag(u[::10], 5400.0, 600.0)
    corners = np.isin(t[::10], [20000.0, 40000.0])
    # the corners at 20000 s and 40000 s lie between coarse samples; the rest runs straight
    assert not corners.any()
    assert np.max(np.abs(coarse - lag(u, 5400.0, 60.0)[::10])) < 0.01


def test_lags_behind_each_other_in_one_pass_are_the_lags_one_by_one() -> None:
    u = 3.0 + np.random.default_rng(1).normal(size=500).cumsum()
    taus = (30.0, 900.0, 9000.0)
    one_by_one = u
    for tau in taus:
        one_by_one = lag(one_by_one, tau, 60.0)
    assert np.allclose(lags(u, taus, 60.0), one_by_one, rtol=1e-9, atol=1e-12)
    assert np.array_equal(lags(u, (), 60.0), u)


@pytest.mark.parametrize("taus", [1, 12])
@pytest.mark.parametrize(
    "sizes",
    [[1], [50] * 40, [2, 1, 7], [9, 300, *range(5, 60)], [40, SHORT + 1]],
    ids=["one", "many", "few", "odd", "long"],
)
@pytest.mark.parametrize("alike", [True, False])
def test_many_lags_are_each_by_itself_to_the_last_digit(sizes: list[int], taus: int, alike: bool) -> None:
    rng = np.random.default_rng(2)
    series = [rng.normal(size=n) for n in sizes]
    steps_s = [60.0 if alike else float(rng.choice([60.0, 59.5, 1.0])) for _ in sizes]
    taus_s = [float(tau) for tau in np.geomspace(20.0, 1e5, taus)]
    for found, u, step_s in zip(lags_at(series, taus_s, steps_s), series, steps_s, strict=True):
        assert np.array_equal(found, np.stack([lag(u, tau_s, step_s) for tau_s in taus_s], axis=1))


def test_many_lags_of_which_one_is_none() -> None:
    u = np.arange(5.0)
    (found,) = lags_at([u], [0.0, 60.0], [60.0])
    assert np.array_equal(found[:, 0], u)
    assert lags_at([], [60.0], []) == []
    assert [f.shape for f in lags_at([u, np.empty(0)], [60.0] * WIDE, [60.0] * 2)] == [(5, WIDE), (0, WIDE)]
