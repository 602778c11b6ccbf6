"""A test that begins with a jump test is asked for its window; one that only warms up is not."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from thermodata.draft.make import draft_files

from .labs import numbers, text


@pytest.mark.parametrize(
    ("moves", "turns_from_s", "asked"),
    [
        ((0.0, 1.0, 0.0), 300, True),
        ((0.0, 1.0, 0.0), 30, False),  # they come while it turns
        ((0.0, 1.0, 1.0), 300, False),  # one step that stays
        ((0.0, 0.0, 0.0), 300, False),
    ],
)
def test_a_log_that_begins_with_a_jump_test(
    tmp_path: Path, moves: tuple[float, ...], turns_from_s: int, asked: bool
) -> None:
    t = np.arange(3600) * 2.0
    volts = (
        5 + 0.3 * (1 - np.exp(-np.maximum(t - 300, 0) / 1500)) + 0.001 * np.random.default_rng(1).normal(size=t.size)
    )
    volts += np.select([t < 60, t < 120], moves[:2], moves[2])
    speed = np.where(t > turns_from_s, 6000.0, 0.0)
    for test in ("W01", "W02"):
        own = volts if test == "W01" else volts - np.select([t < 60, t < 120], moves[:2], moves[2])
        columns = [numbers(t, 0), numbers(own, 4), numbers(speed, 0)]
        text(tmp_path / f"{test}.csv", ["t [s]", "Z [V]", "n [rpm]"], columns, mark=",")
    drafted = {x.id: [d for d in x.doubts if d.startswith("window: 'Z")] for x in draft_files(tmp_path).draft.tests}
    assert {k for k, v in drafted.items() if v} == ({"W01"} if asked else set())
    if asked:
        assert "in the first 120 s of W01.csv" in drafted["W01"][0] or "121 s" in drafted["W01"][0]
        assert "7198 s]" in drafted["W01"][0]


@pytest.mark.parametrize(("digits", "of_drift", "asked"), [(1, 0.5, False), (20, 0.5, True), (20, 0.02, False)])
def test_steps_of_the_last_digit_or_of_little_are_no_jump_test(
    tmp_path: Path, digits: int, of_drift: float, asked: bool
) -> None:
    t = np.arange(3600) * 2.0
    step = digits * 1e-4
    volts = 5 + step / of_drift * (1 - np.exp(-np.maximum(t - 300, 0) / 1500)) + np.where((t > 60) & (t < 120), step, 0)
    columns = [numbers(t, 0), numbers(volts, 4), numbers(np.where(t > 300, 6000.0, 0.0), 0)]
    text(tmp_path / "W01.csv", ["t [s]", "Z [V]", "n [rpm]"], columns, mark=",")
    (test,) = draft_files(tmp_path).draft.tests
    assert any(d.startswith("window: 'Z") for d in test.doubts) is asked
