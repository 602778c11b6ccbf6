"""A temperature that stands still through whole tests (calibration/between_tests/dead.py)."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from thermodata.calibration.between_tests.dead import dead_throughout
from thermodata.calibration.between_tests.levels import POINTS, Course, Levels
from thermodata.plugin import Float1D

T_S = np.linspace(0, 6 * 3600, POINTS)


def course(amount: float, digits: int = 1, quantity: str = "temperature", t_s: Float1D = T_S) -> Course:
    """It warms by so many kelvins."""
    return Course(t_s, np.round(20 + amount * (1 - np.exp(-t_s / 5000)), digits), quantity)


def made(dead: Course, others: float = 1.0, moves: float = 6.0, count: int = 3, digits: int = 1) -> list[Levels]:
    """Two tests in which everything moves, and one with the channel given and the others moved by a share of that."""
    usual = [
        Levels(name, None, None, {"T": course(moves, digits), **{f"T{i}": course(4.0 + i, 2) for i in range(count)}})
        for name in ("a", "b")
    ]
    return [
        *usual,
        Levels("c", None, None, {"T": dead, **{f"T{i}": course((4.0 + i) * others, 2) for i in range(count)}}),
    ]


def test_a_sensor_that_stands_while_the_machine_moves_is_dead() -> None:
    assert dead_throughout(made(course(0.0))) == {("c", "T")}
    assert dead_throughout(made(course(1.0))) == set(), "it moves"


def test_one_that_shows_other_readings_between_the_points_is_coarse_in_a_calm_place() -> None:
    calm = replace(course(0.0), flickers=0.1)
    assert dead_throughout(made(calm)) == set()
    assert dead_throughout(made(replace(calm, flickers=20.0))) == {("c", "T")}, "it drops out"
    assert dead_throughout(made(course(0.0), moves=6.0)) == {("c", "T")}


@pytest.mark.parametrize(("others", "said"), [(0.6, True), (0.4, False)])
def test_a_quiet_test_tells_nothing(others: float, said: bool) -> None:
    assert bool(dead_throughout(made(course(0.0), others))) == said


@pytest.mark.parametrize(
    ("moves", "digits", "said"), [(1.4, 1, True), (0.8, 1, False), (6.0, 0, False), (14.0, 0, True)]
)
def test_a_reading_may_stand_that_moves_by_a_few_of_its_treads(moves: float, digits: int, said: bool) -> None:
    assert bool(dead_throughout(made(course(0.0), moves=moves, digits=digits))) == said


@pytest.mark.parametrize(("moves", "said"), [(0.6, True), (0.3, False)])
def test_a_reading_may_stand_that_hardly_moved_in_another_test(moves: float, said: bool) -> None:
    """A motor at rest in a steady hall, while another axis feeds."""
    tests = made(course(0.0))
    rest = Levels("d", None, None, {"T": course(moves), **{f"T{i}": course(4.0 + i, 2) for i in range(3)}})
    assert bool(dead_throughout([*tests, rest])) == said


@pytest.mark.parametrize(("quiet", "said"), [(1.8, False), (2.2, True)])
def test_a_reading_in_whole_kelvins_may_stand_where_what_rests_moves_by_one(quiet: float, said: bool) -> None:
    """A nut whose axis stands, while spindle and table work: of eight others six do little."""
    at_rest = {f"R{i}": course(quiet, 2) for i in range(6)}
    tests = made(course(0.0), moves=14.0, digits=0)
    tests = [Levels(t.test, None, None, {**t.series, **at_rest}) for t in tests]
    assert bool(dead_throughout(tests)) == said


def test_what_can_not_be_told_is_left() -> None:
    assert dead_throughout(made(course(0.0), count=2)) == set(), "too few others"
    assert dead_throughout(made(course(0.0, quantity="displacement"))) == set()
    assert dead_throughout(made(course(0.0, t_s=T_S / 7))) == set(), "under an hour"
    assert dead_throughout(made(course(0.0, t_s=T_S[:12]))) == set(), "few points"
    assert dead_throughout(made(course(0.0))[2:]) == set(), "it never moved"
