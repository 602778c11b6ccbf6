"""Intervals of the difference between two models' errors hold the true one as often as they say."""

from __future__ import annotations

import numpy as np
import pytest

from thermodata.effect.lag import lag
from thermodata.modelling.compare.difference import difference, difference_of_tests
from thermodata.plugin import Float1D

N, STEP = 1440, 30.0


def slow(rng: np.random.Generator, n: int = N, tau_s: float = 900.0) -> Float1D:
    """Noise that remembers itself for a quarter of an hour, of size 1."""
    raw = lag(rng.standard_normal(n + 500), tau_s, STEP)[500:]
    return np.asarray(raw / np.sqrt(STEP / (2 * tau_s)))


def rms(x: Float1D) -> float:
    return float(np.sqrt(np.mean(x**2)))


def test_the_interval_holds_the_true_difference() -> None:
    rng, held, told = np.random.default_rng(4), 0, 0
    # the errors of two models in common, and what each has of its own
    truth = np.sqrt(1.0 + 0.25) - np.sqrt(1.0 + 1.0)
    for _ in range(300):
        common = slow(rng)
        found = difference(common + slow(rng), common + 0.5 * slow(rng))
        assert found is not None
        assert found.low is not None
        assert found.high is not None
        held += found.low <= truth <= found.high
        told += found.sure
    assert 0.88 <= held / 300 <= 0.99
    assert told / 300 > 0.5


def test_models_that_are_alike_do_not_differ() -> None:
    rng = np.random.default_rng(5)
    sure = 0
    for _ in range(200):
        common = slow(rng)
        found = difference(common + 0.3 * slow(rng), common + 0.3 * slow(rng))
        sure += found is not None and found.sure
    assert sure / 200 < 0.12
    same = slow(rng)
    found = difference(same, same)
    assert found is not None
    assert (found.value, found.low, found.high, found.sure) == (0.0, 0.0, 0.0, False)


def test_only_samples_that_both_have_count() -> None:
    rng = np.random.default_rng(6)
    a, b = slow(rng), slow(rng)
    a[:300], b[1000:] = np.nan, np.nan
    found = difference(a, b)
    assert found is not None
    assert found.value == pytest.approx(rms(b[300:1000]) - rms(a[300:1000]))
    assert difference(np.full(5, np.nan), np.ones(5)) is None


def test_too_few_independent_samples_give_no_interval() -> None:
    t = np.linspace(0, 1, 200)
    found = difference(np.sin(2 * t), 0.5 * t)
    assert found is not None
    assert found.low is None
    assert not found.sure


def test_over_tests_the_tests_themselves_are_what_spreads() -> None:
    rng, held = np.random.default_rng(7), 0
    for _ in range(200):
        pairs = []
        for _ in range(8):
            common = rng.uniform(0.5, 1.5) * slow(rng, 480)
            pairs.append((common + slow(rng, 480), common + 0.5 * slow(rng, 480)))
        found = difference_of_tests(pairs)
        assert found is not None
        assert found.low is not None
        assert found.high is not None
        truth = np.sqrt(np.mean(np.linspace(0.5, 1.5, 99) ** 2) + 0.25) - np.sqrt(
            np.mean(np.linspace(0.5, 1.5, 99) ** 2) + 1
        )
        held += found.low <= truth <= found.high
    assert 0.85 <= held / 200 <= 0.995
    few = difference_of_tests(pairs[:3])
    assert few is not None
    assert few.low is None
