from __future__ import annotations

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from thermodata.chart import columns_in, min_max, shortened


def test_no_peak_is_lost_and_the_order_follows_the_samples() -> None:
    x = np.arange(1000.0)
    y = np.zeros(1000)
    y[437], y[438] = 50.0, -20.0
    at, shown = min_max(x, y, (0.0, 1000.0), 10)
    assert shown.shape == at.shape == (20,)
    assert shown.max() == 50.0
    assert shown.min() == -20.0
    assert at[0] == pytest.approx(25.0)
    rising = min_max(x, x, (0.0, 1000.0), 10)[1]
    falling = min_max(x, -x, (0.0, 1000.0), 10)[1]
    assert list(rising[:4]) == [0.0, 99.0, 100.0, 199.0]
    assert list(falling[:4]) == [0.0, -99.0, -100.0, -199.0]


@settings(deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(
    st.lists(st.floats(0, 100), min_size=1, max_size=200),
    st.integers(1, 30),
    st.floats(0, 50),
    st.floats(1, 60),
    st.integers(0, 10_000),
)
def test_each_stretch_holds_the_extremes_of_its_samples(
    times: list[float], bins: int, low: float, width: float, seed: int
) -> None:
    rng = np.random.default_rng(seed)
    x = np.sort(np.array(times))
    y = np.where(rng.random(len(x)) < 0.2, np.nan, rng.normal(size=len(x)))
    span = (low, low + width)
    _, shown = min_max(x, y, span, bins)
    edges = np.linspace(*span, bins + 1)
    for i in range(bins):
        last = i == bins - 1
        inside = (x >= edges[i]) & ((x <= edges[i + 1]) if last else (x < edges[i + 1])) & np.isfinite(y)
        pair = shown[2 * i : 2 * i + 2]
        if inside.any():
            assert (pair.min(), pair.max()) == (y[inside].min(), y[inside].max())
        else:
            assert np.isnan(pair).all()


def test_few_samples_come_as_they_are_with_holes_opened() -> None:
    x = np.array([0.0, 1.0, 2.0, 3.0, 50.0, 51.0])
    at, made = columns_in(x, {"a": np.arange(6.0), "b": -np.arange(6.0)}, None)
    assert list(at) == [0.0, 1.0, 2.0, 3.0, 26.5, 50.0, 51.0]
    assert np.isnan(made["a"][4])
    assert np.isnan(made["b"][4])
    assert list(made["a"][[3, 5]]) == [3.0, 4.0]


def test_a_window_brings_a_neighbour_on_either_side() -> None:
    x = np.arange(100.0)
    at, made = columns_in(x, {"a": x}, (40.5, 42.5))
    assert list(at) == [40.0, 41.0, 42.0, 43.0]
    assert list(made["a"]) == list(at)


def test_many_samples_become_as_many_as_asked_for() -> None:
    x = np.arange(1_000_000) / 3600
    at, made = columns_in(x, {"a": np.sin(x), "b": np.cos(x)}, (10.0, 200.0), 2000)
    assert len(at) == 2000
    assert made.keys() == {"a", "b"}
    assert shortened(x, np.sin(x), 100)[1].shape == (100,)


def test_nothing_stays_nothing() -> None:
    none = np.empty(0)
    assert len(columns_in(none, {"a": none}, None)[0]) == 0
    assert np.isnan(min_max(none, none, (0.0, 1.0), 3)[1]).all()
