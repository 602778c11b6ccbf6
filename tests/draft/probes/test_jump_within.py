"""A test that begins with a jump test is asked for its window; one that only warms up is not."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tests.draft.labs import numbers, text
from thermodata.draft.make import draft_files


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


@pytest.mark.parametrize("noise", [0.0, 4e-4])
@pytest.mark.parametrize("jumps", [False, True])
def test_a_probe_that_goes_to_its_rail_and_back_is_in_no_jump_test(tmp_path: Path, noise: float, jumps: bool) -> None:
    """jumps: it begins with a jump test, before the machine goes to and fro."""
    rng = np.random.default_rng(3)
    t = np.arange(2900) * 10.0
    volts = 5 + 0.3 * (1 - np.exp(-np.maximum(t - 1800, 0) / 9000)) + rng.normal(0, 0.002, t.size)
    volts += np.where(jumps & (t > 150) & (t < 300), 2.0, 0.0)
    away = (t > 860) & (t % 300 > 40) & (t < 26_000)
    volts = np.where(away, 9.998 + noise * rng.normal(size=t.size), volts)
    columns = [numbers(t, 0), numbers(volts, 5), numbers(np.where(t > 1800, 6000.0, 0.0), 0)]
    text(tmp_path / "W01.csv", ["t [s]", "Z [V]", "n [rpm]"], columns, mark=",")
    (test,) = draft_files(tmp_path).draft.tests
    asked = [d for d in test.doubts if d.startswith("window: 'Z")]
    assert bool(asked) is jumps
    assert not jumps or "in the first 3" in asked[0]


def test_readings_that_are_missing_are_no_rail(tmp_path: Path) -> None:
    t = np.arange(2900) * 10.0
    volts = 5 + 0.3 * (1 - np.exp(-np.maximum(t - 1800, 0) / 9000)) + np.random.default_rng(3).normal(0, 0.002, t.size)
    volts += np.where((t > 150) & (t < 300), 2.0, 0.0)
    cells = ["" if k % 20 == 3 else cell for k, cell in enumerate(numbers(volts, 5))]
    columns = [numbers(t, 0), cells, numbers(np.where(t > 1800, 6000.0, 0.0), 0)]
    text(tmp_path / "W01.csv", ["t [s]", "Z [V]", "n [rpm]"], columns, mark=",")
    (test,) = draft_files(tmp_path).draft.tests
    assert any(d.startswith("window: 'Z") for d in test.doubts)


@pytest.mark.parametrize(("dwell_s", "asked"), [(20, True), (2, False)])
def test_a_short_jump_test_at_the_head_of_a_long_log(tmp_path: Path, dwell_s: int, asked: bool) -> None:
    """Of three hours at 1 Hz each dwell of 20 s has three points in a course; a hand at a probe makes no plateau."""
    t = np.arange(11_000) * 1.0
    rng = np.random.default_rng(4)
    grown = 0.4 * (1 - np.exp(-np.maximum(t - 180, 0) / 3000))
    probes = [
        1 + grown + rng.normal(0, 0.001, t.size) + np.where((t >= at_s) & (t < at_s + dwell_s), 1.0, 0.0)
        for at_s in (20, 80, 140)
    ]
    columns = [numbers(t, 0), *(numbers(x, 4) for x in probes), numbers(np.where(t > 180, 6000.0, 0.0), 0)]
    text(tmp_path / "W01.csv", ["t [s]", "X [V]", "Y [V]", "Z [V]", "n [rpm]"], columns, mark=",")
    (test,) = draft_files(tmp_path).draft.tests
    doubts = [d for d in test.doubts if d.startswith("window: ")]
    assert bool(doubts) is asked
    if asked:
        assert doubts[0].startswith("window: 'X [V]', 'Y [V]', 'Z [V]' go up and down")
        assert "window: [160 s, 10999 s]" in doubts[0]
