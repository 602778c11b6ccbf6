"""Rules for a stretch: a state that tells it from the rest, and nothing where none does."""

from __future__ import annotations

import numpy as np
import pytest

from thermodata.view.curves.predictions import Prediction
from thermodata.view.curves.rule_for import rules

N = 600
T_S = np.arange(N) * 60.0
STRETCH = (T_S >= 12_000) & (T_S < 18_000)


def prediction() -> Prediction:
    residual = np.where(STRETCH, 10.0, 1.0)
    valid = np.ones(N, bool)
    valid[:10] = False
    return Prediction("c", "a", "dZ", T_S, residual, np.zeros(N), residual, valid, {})


def asked(**states: np.ndarray) -> list[str]:
    return [r.text for r in rules(prediction(), states, 12_000, 17_999)]


def test_a_state_that_stands_elsewhere_is_an_equality() -> None:
    found = rules(prediction(), {"door_open": STRETCH.astype(float)}, 12_000, 17_999)
    assert found[0].text == "door_open == 0"
    assert (found[0].n, found[0].taken, found[0].lost) == (490, 100, 0)
    assert found[0].rmse == pytest.approx(1.0)


def test_limits_are_short_numbers_between() -> None:
    rng = np.random.default_rng(0)
    position = np.where(STRETCH, 400.0, 100.0) + rng.normal(0, 5, N)
    assert asked(pos_Z=position) == ["pos_Z < 200"] or asked(pos_Z=position) == ["pos_Z < 300"]
    assert asked(load=-position)[0].startswith("load > -")


def test_both_directions_of_a_feed_are_one_size() -> None:
    rng = np.random.default_rng(1)
    feed = np.where(STRETCH, rng.choice([-10.0, 10.0], N), rng.normal(0, 0.1, N))
    assert asked(feed_Z=feed) == ["abs(feed_Z) < 5"]


def test_nothing_is_proposed_where_no_state_tells_it() -> None:
    rng = np.random.default_rng(2)
    assert asked(speed=rng.choice([0.0, 3000.0, 9000.0], N), still=np.zeros(N), none=np.full(N, np.nan)) == []


def test_what_would_take_the_rest_as_well_is_not_proposed() -> None:
    on = STRETCH | (np.arange(N) % 3 == 0)
    assert asked(pump_on=on.astype(float)) == []


def test_a_gap_of_the_state_does_not_measure() -> None:
    door = STRETCH.astype(float)
    door[500:520] = np.nan
    found = rules(prediction(), {"door_open": door}, 12_000, 17_999)
    assert found[0].lost == 20
