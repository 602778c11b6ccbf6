"""Intervals of 95 %: on machines that are integrated by themselves, and on noise whose covariance is known."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from thermodata.modelling.trust.intervals.slow_noise import scatter
from thermodata.plugin import Float1D, Float2D

SCRIPT = Path(__file__).parents[1] / "benchmarks" / "coverage.py"


def test_intervals_hold_the_truth_on_simulated_machines() -> None:
    """200 machines: docs/model.md. Of these six a Bartlett window over the residual's correlations reaches 86 %."""
    words = [sys.executable, str(SCRIPT), "--seeds", "0:6", "--check", "0.90:0.99"]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


def test_bands_hold_a_test_that_was_locked_on_simulated_machines() -> None:
    words = [sys.executable, str(SCRIPT), "--ahead", "--seeds", "0:2", "--only", "two effects", "--check", "0.90:1.0"]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


def test_a_share_outside_of_the_limits_is_an_exit_code() -> None:
    words = [sys.executable, str(SCRIPT), "--seeds", "0:1", "--only", "lag", "--noise", "white", "--check", "0:0.5"]
    assert subprocess.run(words, capture_output=True, check=False).returncode == 1


def _freed(columns: Float2D, parts: list[slice]) -> Float2D:
    return np.concatenate([columns[p] - columns[p].mean(axis=0) for p in parts])


def _columns(n: int, rng: np.random.Generator) -> Float2D:
    t = np.linspace(0, 1, n)
    return np.column_stack([np.sin(5 * t), np.cumsum(rng.normal(size=n)) / 10])


PARTS = [slice(0, 700), slice(700, 1200)]


def test_of_white_noise_they_are_those_of_least_squares() -> None:
    rng = np.random.default_rng(1)
    x = _freed(_columns(1200, rng), PARTS)
    r = _freed(rng.normal(size=(1200, 1)), PARTS)[:, 0]
    found = scatter(x, r, PARTS)
    plain = np.sqrt(np.diag(np.linalg.inv(x.T @ x)) * (r @ r) / (1200 - 2 - 2))
    # a little wider: that there is no slow noise beside the white is not known either
    assert np.all((plain <= found.half / 1.96) & (found.half / 1.96 < 1.5 * plain))


def _wandering(n: int, memory: float, rng: np.random.Generator) -> Float1D:
    keep, x = np.exp(-1 / memory), np.zeros(n)
    x[0] = rng.normal()
    for i in range(1, n):
        x[i] = keep * x[i - 1] + np.sqrt(1 - keep**2) * rng.normal()
    return x


@pytest.mark.parametrize("memory", [5.0, 40.0])
def test_of_slow_noise_they_are_those_of_its_covariance(memory: float) -> None:
    """(X'X)^-1 X' S X (X'X)^-1 with the true S, freed of each test's mean; the median over draws."""
    rng = np.random.default_rng(2)
    x = _freed(_columns(1200, rng), PARTS)
    inverse, meat = np.linalg.inv(x.T @ x), np.zeros((2, 2))
    for p in PARTS:
        rows = np.arange(p.stop - p.start)
        meat += x[p].T @ np.exp(-np.abs(rows[:, None] - rows) / memory) @ x[p]
    true = np.sqrt(np.diag(inverse @ meat @ inverse))
    drawn = []
    for _ in range(12):
        noise = _freed(np.concatenate([_wandering(p.stop - p.start, memory, rng) for p in PARTS])[:, None], PARTS)
        fitted = noise[:, 0] - x @ (inverse @ (x.T @ noise[:, 0]))
        drawn.append(scatter(x, fitted, PARTS).sd)
    middle = np.median(drawn, axis=0)
    assert np.all((0.95 * true < middle) & (middle < 1.5 * true))


def test_what_is_known_to_be_wrong_with_a_row_widens_them() -> None:
    rng = np.random.default_rng(3)
    x = _freed(_columns(1200, rng), PARTS)
    r = _freed(rng.normal(size=(1200, 1)), PARTS)[:, 0]
    step = x[PARTS[0], 0] * 0.5
    plain, more = scatter(x, r, PARTS), scatter(x, r, PARTS, [(PARTS[0], step)])
    pull = (np.linalg.inv(x.T @ x) @ (x[PARTS[0]].T @ step))[0]
    assert more.sd[0] ** 2 == pytest.approx(plain.sd[0] ** 2 + pull**2, rel=1e-6)


def test_without_samples_to_spare_there_is_none() -> None:
    found = scatter(np.eye(3)[:, :2], np.zeros(3), [slice(0, 3)])
    assert np.isnan(found.half).all()
