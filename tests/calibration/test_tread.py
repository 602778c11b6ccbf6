"""The tread of a staircase (calibration/tread.py), on both sides of each limit."""

from __future__ import annotations

import numpy as np
import pytest

from thermodata.calibration.tread import tread_of
from thermodata.plugin import Float1D

N = 6000


def course(span: float = 15.0, noise: float = 0.02, n: int = N) -> Float1D:
    rng = np.random.default_rng(4)
    return span * np.sin(np.arange(n) / 900) + noise * rng.standard_normal(n)


def read(x: Float1D, tread: float) -> Float1D:
    return np.asarray(np.round(x / tread) * tread)


@pytest.mark.parametrize("tread", [0.001, 0.05, 0.1, 0.5, 2.0, 3.7])
def test_a_staircase_has_its_tread(tread: float) -> None:
    assert tread_of([read(course(), tread)]) == pytest.approx(tread)


def test_a_fine_reading_and_one_that_never_moves_have_none() -> None:
    assert tread_of([course()]) == 0.0
    assert tread_of([np.full(N, 3.0)]) == 0.0
    assert tread_of([]) == tread_of([np.full(N, np.nan)]) == 0.0


def test_gain_offset_and_single_precision_do_not_matter() -> None:
    assert tread_of([7.1 + 1.2345 * read(course(), 2.0)]) == pytest.approx(2.469)
    assert tread_of([np.asarray(read(course(), 0.05).astype(np.float32), dtype=np.float64)]) == pytest.approx(0.05)


@pytest.mark.parametrize("per_bin", [2, 3, 10])
def test_means_over_bins_keep_the_tread_of_what_they_are_of(per_bin: int) -> None:
    """A bin that a riser falls into lies between two treads."""
    bins = read(course(), 2.0).reshape(-1, per_bin).mean(axis=1)
    assert tread_of([bins]) == pytest.approx(2.0)


def test_holes_and_zeros_of_tests_do_not_matter() -> None:
    one, other = read(course(), 2.0), read(course(9.0), 2.0) + 0.7
    one[500:900] = np.nan
    assert tread_of([one, other]) == pytest.approx(2.0)


@pytest.mark.parametrize(("moved", "tread"), [(0.4, 2.0), (0.6, 2.0)])
def test_a_slip_does_not_hide_the_tread(moved: float, tread: float) -> None:
    """By 3.3 um, which is no multiple of it, over a part of the test."""
    slipped = read(course(), 2.0) + 3.3 * (np.arange(N) >= (1 - moved) * N)
    assert tread_of([slipped]) == pytest.approx(tread)


def levels(*some: float, each: int = 10, times: int = 8) -> Float1D:
    return np.tile(np.repeat(some, each), times)


@pytest.mark.parametrize(
    ("some", "tread"), [((0.0, 4.0, 10.0), 2.0), ((0.0, 6.0, 10.0, 4.0), 2.0), ((0.0, 3.0, 9.0), 3.0)]
)
def test_the_spacing_is_common_to_all_rises(some: tuple[float, ...], tread: float) -> None:
    """Though no rise may be a single tread."""
    assert tread_of([levels(*some)]) == pytest.approx(tread)


@pytest.mark.parametrize(("some", "tread"), [((0.0, 1.0), 0.0), ((0.0, 1.0, 2.0), 1.0)])
def test_a_switch_of_two_levels_is_no_staircase(some: tuple[float, ...], tread: float) -> None:
    assert tread_of([levels(*some)]) == tread


@pytest.mark.parametrize(("standing", "tread"), [(20, 1.0), (19, 0.0)])
def test_too_few_samples_that_stand_say_nothing(standing: int, tread: float) -> None:
    steps = np.concatenate([np.repeat([0.0, 1.0, 2.0, 3.0], 5), np.repeat(4.0, standing - 15)])
    assert tread_of([steps]) == tread


@pytest.mark.parametrize(("odd", "tread"), [(0.09, 2.0), (0.2, 1.0)])
def test_a_finer_spacing_that_holds_a_tenth_more_is_the_tread(odd: float, tread: float) -> None:
    """Where odd levels are as good as even ones, the tread is one; a few are what bins leave of risers."""
    rng = np.random.default_rng(5)
    count = 1000
    level = 2.0 * rng.integers(0, 6, count) + (np.arange(count) < odd * count)
    assert tread_of([np.repeat(rng.permutation(level), 4)]) == pytest.approx(tread)


def alike_at(levels: tuple[float, ...], noise: float) -> list[Float1D]:
    """Six tests in which the few neighbours that are alike lie on levels 12 K apart."""
    rng = np.random.default_rng(3)
    tests = []
    for _ in range(6):
        x = np.cumsum(noise * rng.standard_normal(400)) + 30.0
        for i, level in enumerate(levels):
            x[60 * i + 30 : 60 * i + 32] = level
        tests.append(x)
    return tests


@pytest.mark.parametrize("noise", [0.05, 0.5])
def test_readings_that_are_alike_by_chance_are_no_staircase(noise: float) -> None:
    """They have a spacing of 12 K, but what lies between them moves by far less."""
    tests = alike_at((24.0, 24.0, 36.0, 36.0, 48.0), noise)
    assert tread_of(tests) == 0.0
    assert tread_of([read(x, 12.0) for x in tests]) == pytest.approx(12.0)


def test_nor_where_most_of_a_test_stands() -> None:
    tests = alike_at((24.0, 24.0, 36.0, 36.0, 48.0), 0.2)
    stood = [np.concatenate([np.full(1200, 24.0), x, np.full(1200, 48.0)]) for x in tests]
    assert tread_of(stood) == 0.0


@pytest.mark.parametrize("seed", [1, 4, 5])
def test_means_that_hardly_dither_beside_a_riser_keep_the_tread(seed: int) -> None:
    """Whole kelvins with a twentieth of noise, in means of 30 s: most of what moves is a few readings of thirty."""
    rng, t = np.random.default_rng(seed), np.linspace(0, 1, 6 * 3600)
    tests = []
    for _ in range(3):
        warms = 22 + rng.random() + rng.choice([2, 3, 5, 8]) * (1 - np.exp(-3 * t))
        tests.append(np.round(warms + rng.normal(0, 0.05, len(t))).reshape(-1, 30).mean(axis=1))
    assert tread_of(tests) == pytest.approx(1.0, rel=0.01)
