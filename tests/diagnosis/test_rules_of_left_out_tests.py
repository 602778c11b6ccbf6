"""How a candidate is fitted to all tests but one, and judged by that one (diagnosis/cross_validation.py)."""

from __future__ import annotations

import numpy as np
import pytest

from thermodata.diagnosis.cross_validation import Engine, Priors

FREE = Priors(np.full(1, np.inf), np.full(1, -np.inf), np.full(1, np.inf))


def test_a_gain_is_drawn_to_zero_as_if_measured_once_with_its_largest_magnitude() -> None:
    """One column of power 100 in the training test; a prior of standard deviation 2 under a variance of 400."""
    column = np.ones((100, 1))
    base, residual = np.zeros((100, 0)), np.full((100, 1), 1.0)
    found = Engine([base] * 2, [residual] * 2, 400.0, np.zeros(0)).score(
        [[column] * 2], Priors(np.full(1, 2.0), np.full(1, -np.inf), np.full(1, np.inf))
    )
    gain = 100 / (100 + 400 / 2**2)
    assert found.after[:, 0] == pytest.approx([100 * (1 - gain) ** 2] * 2)
    assert found.gain == pytest.approx([200 / (200 + 100)])
    assert found.relative == pytest.approx([1 - (1 - gain) ** 2])


@pytest.mark.parametrize(
    ("lower", "upper", "gain"), [(-np.inf, np.inf, 3.0), (0.0, 2.0, 2.0), (-5.0, 0.0, 0.0), (4.0, 9.0, 4.0)]
)
def test_a_gain_stays_within_its_bounds(lower: float, upper: float, gain: float) -> None:
    column, base = np.ones((50, 1)), np.zeros((50, 0))
    found = Engine([base] * 2, [3.0 * column] * 2, 1.0, np.zeros(0)).score(
        [[column] * 2], Priors(np.full(1, np.inf), np.full(1, lower), np.full(1, upper))
    )
    assert found.gain == pytest.approx([gain])
    assert found.after[:, 0] == pytest.approx([50 * (3.0 - gain) ** 2] * 2)


def test_a_parameter_is_chosen_without_the_test_that_is_left_out() -> None:
    """Three tests follow the first point of the grid, the fourth the second: the fourth is predicted by the first."""
    rng = np.random.default_rng(0)
    one, two = rng.normal(size=(4, 200, 1)), rng.normal(size=(4, 200, 1))
    residual = [*one[:3], two[3]]
    base = [np.zeros((200, 0))] * 4
    found = Engine(base, residual, 1e-9, np.zeros(0)).score([list(one), list(two)], FREE)
    assert found.best == 0
    assert found.after[3, 0] == pytest.approx(float(np.sum((two[3] - one[3] * 1.0) ** 2)), rel=0.05)
    assert found.after[:3, 0] == pytest.approx([0, 0, 0], abs=60)


def test_what_the_base_can_do_is_no_merit_of_a_candidate() -> None:
    rng = np.random.default_rng(0)
    base = [rng.normal(size=(200, 1)) for _ in range(4)]
    found = Engine(base, [2.0 * b for b in base], 1e-9, np.zeros(1)).score([base], FREE)
    assert found.before[:, 0] == pytest.approx([0.0] * 4, abs=1e-6)


def test_a_base_column_with_a_price_moves_less() -> None:
    column = np.ones((100, 1))
    free, dear = (Engine([column] * 2, [column] * 2, 100.0, np.array([p])).before[:, 0] for p in (0.0, 1.0))
    assert free == pytest.approx([0.0] * 2, abs=1e-6)
    assert dear == pytest.approx([25.0] * 2, rel=1e-4)
