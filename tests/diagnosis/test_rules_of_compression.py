"""Which tests take part and how much of each (question/problem.py)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import pytest

from thermodata.diagnosis.question.problem import Explained, Problem, build_problem
from thermodata.plugin import Float2D
from thermodata.view.grid.dataset import TestData

from .hand_made import STEP_S, Parts, a_test, problem


def built(counts: Sequence[int], n: int = 600, step_s: float = STEP_S, **of: Any) -> Problem:
    """Tests of n samples of which the first `counts` count."""
    tests = [a_test(f"t{i}", n, step_s=step_s) for i in range(len(counts))]
    masks = {t.test: np.arange(n) < c for t, c in zip(tests, counts, strict=True)}
    values = of.get("values", np.random.default_rng(0).normal(size=n))

    def none(test: TestData) -> Float2D:
        return np.zeros((n, 0))

    explained = Explained(
        "dZ",
        "um",
        measured=lambda t: values,
        residual=lambda t: values,
        mask=lambda t: masks[t.test],
        base=none,
        slack=none,
    )
    return build_problem(explained, tests, step_s, **({"rows": of["rows"]} if "rows" in of else {}))


@pytest.mark.parametrize(("counted", "tests"), [(10, 4), (9, 3)])
def test_a_test_with_under_ten_samples_takes_no_part(counted: int, tests: int) -> None:
    assert len(built([600, 600, 600, counted]).blocks) == tests


@pytest.mark.parametrize(("tests", "parts"), [(1, 4), (2, 4), (3, 3), (5, 5)])
def test_parts_in_time_stand_for_tests_where_there_are_under_three(tests: int, parts: int) -> None:
    assert len(built([600] * tests).blocks) == parts


@pytest.mark.parametrize(("counted", "parts"), [(400, 4), (399, 3), (200, 2), (199, 1)])
def test_a_part_has_a_hundred_samples(counted: int, parts: int) -> None:
    found = built([counted])
    assert len(found.blocks) == parts
    assert sum(len(b.t_s) for b in found.blocks) == counted
    assert all(abs(b.residual.mean()) < 1e-9 for b in found.blocks), "each has an offset of its own"


@pytest.mark.parametrize(
    ("n", "rows", "every"), [(3000, {}, 1), (3001, {}, 2), (800, {"rows": 2400}, 1), (801, {"rows": 2400}, 2)]
)
def test_nine_thousand_samples_or_what_is_asked_for_are_enough(n: int, rows: dict[str, int], every: int) -> None:
    found = built([n] * 3, n, **rows)
    assert (found.step_s, found.averaged) == (60.0 * every, every)
    assert found.rows == 3 * -(-n // every)


def test_the_noise_is_that_between_neighbours_whatever_is_slow() -> None:
    rng = np.random.default_rng(0)
    slow = 50.0 * np.sin(np.arange(3000) / 300)
    assert built([3000] * 3, 3000, values=slow + 0.3 * rng.normal(size=3000)).noise == pytest.approx(0.3, rel=0.1)
    assert np.isnan(built([], 10).noise)


def test_a_step_that_was_found_gives_the_rest_of_the_test_an_offset_of_its_own() -> None:
    y = np.where(np.arange(100) < 40, 0.0, 5.0)
    whole = problem(Parts(y, base=y[:, None], slack=y[:, None]), Parts(y))
    cut = whole.split({("c", "t0"): [39.5 * STEP_S]})
    for columns in (
        cut.blocks[0].response,
        cut.blocks[0].residual,
        cut.blocks[0].base[:, 0],
        cut.blocks[0].slack[:, 0],
    ):
        np.testing.assert_allclose(columns, 0.0, atol=1e-12)
    assert np.ptp(cut.blocks[1].residual) == 5.0, "another test has no step"


@pytest.mark.parametrize(("parted_s", "left_out"), [(0.0, []), (29.0, []), (31.0, [39, 40]), (91.0, [38, 39, 40, 41])])
def test_samples_that_a_step_parts_are_left_out(parted_s: float, left_out: list[int]) -> None:
    """Nearer to it than the means are long; what a candidate does is taken at the others."""
    y = np.where(np.arange(100) < 40, 0.0, 5.0) - 2.5 * (np.arange(100) == 40)
    whole = problem(Parts(y, base=y[:, None], slack=y[:, None]), Parts(y))
    cut = whole.split({("c", "t0"): [39.5 * STEP_S]}, parted_s=parted_s).blocks[0]
    kept = np.setdiff1d(np.arange(100), left_out)
    assert cut.t_s.tolist() == (kept * STEP_S).tolist()
    assert np.abs(cut.residual).max() == pytest.approx(0.0 if left_out else 2.5, abs=0.1)
    assert cut.size == len(cut.residual) == len(cut.base) == len(cut.slack) == len(cut.segment) == len(kept)
    column = np.sin(np.arange(100.0))
    of_kept = column[kept] - np.where(kept < 40, column[kept[kept < 40]].mean(), column[kept[kept >= 40]].mean())
    assert cut.compress(column[:, None])[:, 0] == pytest.approx(of_kept)
