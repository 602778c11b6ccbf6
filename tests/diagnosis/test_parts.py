"""The pieces: leave-one-out by moments against the long way, whitening, surrogates, weak spots."""

from __future__ import annotations

import numpy as np

from thermodata.diagnosis.candidates import grid
from thermodata.diagnosis.cross_validation import Engine, Priors
from thermodata.diagnosis.weak import weak_spots
from thermodata.diagnosis.whiten import fit_ar, surrogates, whiten
from thermodata.plugin import Param

from .conftest import STEP_S, make_test


def test_leaving_a_test_out_by_moments_equals_refitting_without_it() -> None:
    rng = np.random.default_rng(0)
    base = [rng.normal(size=(200, 4)) for _ in range(5)]
    column = [rng.normal(size=(200, 2)) + b[:, :1] for b in base]
    residual = [(c @ [1.0, -0.5])[:, None] + rng.normal(size=(200, 3)) for c in column]
    free = Priors(np.full(2, 1e6), np.full(2, -np.inf), np.full(2, np.inf))
    drop = Engine(base, residual, 1e-9, np.zeros(4)).score([column], free)
    for i in range(5):
        others = [j for j in range(5) if j != i]
        x = np.vstack([np.hstack([base[j], column[j]]) for j in others])
        theta = np.linalg.lstsq(x, np.vstack([residual[j] for j in others]), rcond=None)[0]
        expected = ((residual[i] - np.hstack([base[i], column[i]]) @ theta) ** 2).sum(axis=0)
        np.testing.assert_allclose(drop.after[i], expected, rtol=1e-4)


def test_a_test_without_the_effect_in_the_others_does_not_blow_up() -> None:
    rng = np.random.default_rng(1)
    base = [rng.normal(size=(100, 1)) for _ in range(3)]
    column = [np.zeros((100, 1)), np.zeros((100, 1)), rng.normal(size=(100, 1))]
    residual = [rng.normal(size=(100, 1)) for _ in range(3)]
    bounded = Priors(np.ones(1), -np.ones(1), np.ones(1))
    drop = Engine(base, residual, 1.0, np.zeros(1)).score([column], bounded)
    np.testing.assert_allclose(drop.after[2], drop.before[2], rtol=1e-6)


def test_whitening_takes_away_what_the_past_predicts() -> None:
    rng = np.random.default_rng(2)
    e = rng.normal(size=5000)
    x = np.zeros(5000)
    for i in range(1, 5000):
        x[i] = 0.95 * x[i - 1] + e[i]
    white = whiten(x[:, None], fit_ar([x]))[10:, 0]
    assert abs(np.corrcoef(white[1:], white[:-1])[0, 1]) < 0.05
    assert abs(white.std() - 1) < 0.05


def test_surrogates_keep_size_and_slowness_but_not_the_story() -> None:
    rng = np.random.default_rng(3)
    x = np.cumsum(rng.normal(size=1000))
    x -= x.mean()
    made = surrogates(x, 100, rng)
    np.testing.assert_allclose(np.sqrt(np.mean(made**2, axis=0)), np.sqrt(np.mean(x**2)), rtol=1e-9)
    steps = np.sqrt(np.mean(np.diff(made, axis=0) ** 2))
    assert 0.5 < steps / np.sqrt(np.mean(np.diff(x) ** 2)) < 2
    assert abs(np.mean([np.corrcoef(x, s)[0, 1] for s in made.T])) < 0.2


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
