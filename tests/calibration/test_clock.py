"""The clocks of two logs, from a spindle speed that both have."""

from __future__ import annotations

import numpy as np
import pytest

from thermodata.calibration.clock.estimate import ClockEstimate, estimate_offset
from thermodata.errors import CalibrationError
from thermodata.plugin import Float1D, Int1D

T0 = 1_700_000_000_000_000_000


def speed(t_s: Float1D, seed: int = 0, events: int = 25, length_s: float = 30_000.0, ramp_s: float = 3.0) -> Float1D:
    rng = np.random.default_rng(seed)
    at = np.sort(rng.uniform(0.02, 0.98, events)) * length_s
    levels = np.concatenate([[0.0], rng.permutation(events) * 12_000.0 / events])
    return sum((b - a) * np.clip((t_s - e) / ramp_s, 0, 1) for a, b, e in zip(levels, levels[1:], at, strict=False))


def estimate(
    offset_s: float,
    *,
    drift_ppm: float = 0.0,
    rate_here: float = 1.0,
    rate_there: float = 1.0,
    part: tuple[float, float] = (0.0, 30_000.0),
    noise: float = 0.0,
    **more: float,
) -> tuple[ClockEstimate, Int1D, Float1D]:
    """(estimate, times of here, true seconds): there shows true time, here is behind by offset and drift."""
    rng = np.random.default_rng(7)
    there = np.arange(0.0, 30_000.0, 1 / rate_there) + 0.31 / rate_there
    true = np.arange(*part, 1 / rate_here) + 0.77 / rate_here
    here_ns = np.rint((true - offset_s) / (1 + drift_ppm * 1e-6) * 1e9).astype(np.int64) + T0
    a = speed(true, **more) / 1000 + 3 + noise / 1000 * rng.standard_normal(len(true))
    b = speed(there, **more) + noise * rng.standard_normal(len(there))
    got = estimate_offset(here_ns, a, np.rint(there * 1e9).astype(np.int64) + T0, b)
    return got, here_ns, true


@pytest.mark.parametrize("offset_s", [0.0, 3.2, -0.45, 3600.0, -7200.3, 3e7])
def test_finds_the_offset_below_a_sample(offset_s: float) -> None:
    got, here, true = estimate(offset_s)
    assert got.offset_ns / 1e9 == pytest.approx(offset_s, abs=0.15)
    assert abs(got.offset_ns / 1e9 - offset_s) < 4 * got.uncertainty_ns / 1e9
    assert got.drift_ppm == 0.0
    assert got.correlation > 0.99
    assert np.abs((got.apply(here) - T0) / 1e9 - true).max() < 0.15


@pytest.mark.parametrize(
    "more",
    [
        {"rate_there": 10.0},
        {"rate_here": 0.2, "ramp_s": 10.0},
        {"noise": 60.0},
        {"part": (8000.0, 21_000.0)},
        {"ramp_s": 0.01},
    ],
)
def test_other_rates_noise_and_parts(more: dict) -> None:
    got, here, true = estimate(12.5, **more)
    assert np.abs((got.apply(here) - T0) / 1e9 - true).max() < 0.5
    assert got.uncertainty_ns < 1_500_000_000


@pytest.mark.parametrize("drift_ppm", [80.0, -150.0])
def test_finds_a_drift(drift_ppm: float) -> None:
    got, here, true = estimate(5.0, drift_ppm=drift_ppm)
    assert got.drift_ppm == pytest.approx(drift_ppm, abs=15)
    assert np.abs((got.apply(here) - T0) / 1e9 - true).max() < 0.4


def refused(a: Float1D, b: Float1D, match: str) -> None:
    t = np.arange(len(a), dtype=np.int64) * 1_000_000_000
    with pytest.raises(CalibrationError, match=match):
        estimate_offset(t, a, t, b)


def test_thin_evidence_is_refused() -> None:
    t = np.arange(30_000.0)
    rng = np.random.default_rng(0)
    refused(np.zeros(len(t)), speed(t), "never changes")
    refused(speed(t), np.full(len(t), np.nan), "hardly any")
    refused(speed(t, seed=1), speed(t, seed=2), "look alike")
    refused(rng.normal(size=len(t)), rng.normal(size=len(t)), "look alike")
    refused((t // 600) % 2, (t // 600) % 2, "equally well")
    refused((t > 9000) * 1.0, (t > 9000) * 1.0, r"one event|equally well")


def test_missing_backward_and_short_input() -> None:
    t = np.arange(30_000.0)
    ns = (t * 1e9).astype(np.int64)
    a = speed(t)
    a[1000:1100] = np.nan
    shuffled = ns.copy()
    shuffled[[5, 6]] = shuffled[[6, 5]]
    got = estimate_offset(shuffled, a, ns + 2_000_000_000, speed(t))
    assert got.offset_ns == pytest.approx(2e9, abs=1e8)
    with pytest.raises(CalibrationError):
        estimate_offset(ns[:5], a[:5], ns, speed(t))
    with pytest.raises(CalibrationError, match="length"):
        estimate_offset(ns[:50], a, ns, speed(t))


def test_steps_that_fall_on_the_samples_are_no_better_known_than_a_sample() -> None:
    """A programme of whole minutes: every step is seen equally late, so more of them tell no more."""
    levels = np.random.default_rng(3).permutation(33) * 1000.0
    t_a, t_b = np.arange(0.0, 86_400.0, 5.0), np.arange(0.0, 86_400.0, 10.0)
    got = estimate_offset(
        np.rint((t_a + 73.0) * 1e9).astype(np.int64) + T0,
        levels[(t_a // 2700).astype(int)],
        np.rint(t_b * 1e9).astype(np.int64) + T0,
        levels[(t_b // 2700).astype(int)],
    )
    assert got.uncertainty_ns / 1e9 >= np.hypot(5.0, 10.0) / np.sqrt(12)
    assert abs(got.offset_ns / 1e9 + 73.0) < 2 * got.uncertainty_ns / 1e9
