"""What the page of the spindle says was calculated by hand, beside the program's own figures."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from . import by_hand

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "real_spindle.md"


def test_a_lag_comes_to_rest_at_its_driver_and_reaches_63_percent_after_its_time_constant() -> None:
    step = np.r_[0.0, np.ones(2000)]
    through = by_hand.lag(step, 40.0)
    assert through[-1] == pytest.approx(1, abs=1e-9)
    assert through[41] == pytest.approx(1 - np.exp(-1), abs=0.01)


def test_levels_of_parts_are_found_beside_the_gain() -> None:
    speed = np.repeat([0.0, 1.0, 0.0, 1.0], 200)
    y = 3 * by_hand.lag(speed, 30.0) + np.repeat([5.0, 7.0], 400)
    fit = by_hand.search(y, [speed], [slice(0, 400), slice(400, 800)])
    assert fit.gains == pytest.approx([3], rel=1e-3)
    assert fit.taus_min[0][0] == pytest.approx(30, rel=1e-2)
    assert np.abs(fit.left).max() < 0.01


@pytest.mark.parametrize(
    ("sensors", "one_level", "halves"),
    [
        ((), ("17.71", "16.43", "16.68"), ("15.13", "13.93", "14.17")),
        ((4,), ("8.32", "8.32", "11.47"), ("8.21", "8.07", "10.91")),
    ],
)
def test_the_figures_of_ch3_on_the_page(
    sensors: tuple[int, ...], one_level: tuple[str, ...], halves: tuple[str, ...]
) -> None:
    if not by_hand.FILE.exists():
        pytest.skip("real data absent: data.xlsx of fl_thermal is not in ../shared/data")
    rows = by_hand.read()
    half, cut = (int(np.searchsorted(rows.t_h, h)) for h in (by_hand.HALF_H, by_hand.CUT_H))
    page = PAGE.read_text("utf-8")
    for parts, told in (([slice(0, cut)], one_level), ([slice(0, half), slice(half, cut)], halves)):
        left = by_hand.search(rows.ch[3], [rows.speed, *(rows.t[k] for k in sensors)], parts).left
        found = list(by_hand.scores(left, cut).values())[:3]
        assert found == pytest.approx([float(x) for x in told], abs=0.02)
        assert all(x in page for x in told)
