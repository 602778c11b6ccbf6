"""The pieces: grids and weak spots."""

from __future__ import annotations

import numpy as np

from thermodata.diagnosis.candidates.grid import grid
from thermodata.diagnosis.question.weak import weak_spots
from thermodata.plugin import Param

from .conftest import STEP_S, make_test


def test_time_constants_are_searched_in_their_logarithm_within_bounds() -> None:
    points = grid([Param("tau", "min", 30, 1, 360, ""), Param("p", "1", 1.5, 1, 2.5, "")], 60.0)
    taus = sorted({p["tau"] for p in points})
    assert taus[0] >= 1
    assert taus[-1] <= 360
    np.testing.assert_allclose(np.diff(np.log(taus)), np.diff(np.log(taus))[0])
    assert {p["p"] for p in points} == {1.0, 1.5, 2.0, 2.5}


def test_the_window_that_costs_most_comes_first_with_its_state() -> None:
    test = make_test("t", "calibration", 1, None)
    residual = np.full(len(test.t_s), 0.01)
    residual[100:130] = 5.0
    residual[255:270] = 3.0
    spots = weak_spots([(test, residual, np.ones(len(residual), bool))], 0.01)
    assert len(spots) == 2
    assert spots[0].from_s <= 100 * STEP_S <= spots[0].to_s
    assert spots[0].rmse_um > spots[1].rmse_um
    assert "spindle" in spots[0].state
