"""Flags of readings in treads: flickers, levels and coarse steps are no defects; what is beyond them is one."""

from __future__ import annotations

import numpy as np
import pytest
from quality_data import N, clock, gauge, kinds, noisy, run

from thermodata.calibration.tread import tread_of
from thermodata.calibration.tread_noisy import noisy_tread_of
from thermodata.schema.flag import Flag

SEEDS = range(12)


@pytest.mark.parametrize("dither", [0.02, 0.05, 0.2])
@pytest.mark.parametrize("noise", [0.0, 0.05, 0.1])
def test_a_gauge_in_treads_gets_no_flag(dither: float, noise: float) -> None:
    for seed in SEEDS:
        x = gauge(seed, dither=dither, noise=noise)
        assert tread_of([x]) == pytest.approx(2.0, rel=0.03)
        _, events = run(clock(), dZ=("displacement", x), T=("temperature", noisy(seed) / 10 + 25))
        assert events == []


@pytest.mark.parametrize("per_bin", [2, 5, 10])
def test_means_of_treads_get_no_flag(per_bin: int) -> None:
    """They repeat exactly, but for the bins that a riser falls into."""
    for seed in SEEDS:
        x = gauge(seed, n=N * per_bin, noise=0.0).reshape(-1, per_bin).mean(axis=1)
        assert run(clock(), dZ=("displacement", x), T=("temperature", noisy(seed) / 10 + 25))[1] == []


@pytest.mark.parametrize(("height", "flagged"), [(3.0, False), (19.0, False), (21.0, True), (-60.0, True)])
def test_a_spike_stands_out_by_ten_treads(height: float, flagged: bool) -> None:
    x = gauge(3)
    x[2502:2504] += height
    flags, events = run(clock(), dZ=("displacement", x))
    assert np.flatnonzero(flags["dZ"] & Flag.SPIKE).tolist() == ([2502, 2503] if flagged else [])
    assert kinds(events) == ([("dZ", "spike")] if flagged else [])


def test_a_gauge_with_noise_of_its_own_that_repeats_exactly_is_held() -> None:
    """Its treads repeat to within the noise of the converter, never to the last digit."""
    x = gauge(1, count=1e-6)
    x[2000:2600] = x[2000]
    flags, events = run(clock(), dZ=("displacement", x), T=("temperature", noisy(1) / 10 + 25))
    assert np.flatnonzero(flags["dZ"] & Flag.HELD).tolist() == list(range(2000, 2600))
    assert kinds(events) == [("dZ", "held")]


def test_what_comes_in_all_sizes_is_no_spike() -> None:
    """A sensor in a draught: puffs of a few samples, from small to large, all the time; a spike is beyond them."""
    for seed in SEEDS:
        rng = np.random.default_rng(seed)
        x = 26 + noisy(seed, noise=0.05) / 20
        for at in rng.integers(20, N - 20, N // 30):
            x[at : at + rng.integers(1, 4)] += rng.exponential(0.5) * (abs(at - 3000) > 12)
        assert not run(clock(), T=("temperature", x))[0]["T"].any()
        x[3000] = 60.0
        assert np.flatnonzero(run(clock(), T=("temperature", x))[0]["T"] & Flag.SPIKE).tolist() == [3000]


def switched(seed: int, tau: float) -> np.ndarray:
    """A machine that is switched between a few speeds: it shifts at once, and drifts after it."""
    rng = np.random.default_rng(seed)
    speed = rng.integers(0, 6, N // 300 + 1)[np.arange(N) // 300].astype(float)
    lag = np.zeros(N)
    for i in range(1, N):
        lag[i] = lag[i - 1] + (speed[i] - lag[i - 1]) / tau
    return np.asarray(rng.uniform(0.5, 3) * speed + rng.uniform(0.3, 3) * lag + rng.normal(0, 0.05, N))


@pytest.mark.parametrize("tau", [20.0, 200.0, 1500.0])
def test_a_machine_that_is_switched_is_no_staircase(tau: float) -> None:
    assert [noisy_tread_of([switched(seed, tau)]) for seed in SEEDS] == [0.0] * len(SEEDS)


@pytest.mark.parametrize(("resolution", "noise"), [(0.001, 0.02), (0.01, 0.05), (0.1, 5.0)])
def test_a_sensor_that_is_stuck_for_long_makes_no_staircase_of_its_noise(resolution: float, noise: float) -> None:
    """Nearly all samples that equal the one before are of that one stretch, and it is on any spacing."""
    x = noisy(5, noise=0) / 5 + 25 + np.random.default_rng(5).normal(0, noise, N)
    x = np.round(x / resolution) * resolution
    x[1000:2200] = x[1000]
    flags, events = run(clock(), T=("temperature", x), dZ=("displacement", noisy(2)))
    assert (flags["T"][1000:2200] & (Flag.HELD | Flag.STUCK)).all(), events
    assert not flags["T"][2201:].any()
