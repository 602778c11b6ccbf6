"""A temperature sensor whose starts after a rest leave the others' from one test on (calibration/quality_starts.py)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pytest

from thermodata.calibration.quality_between import Levels, offsets_between_tests
from thermodata.calibration.quality_starts import Start, off_from_start
from thermodata.plugin import Float1D

from .test_quality_between import POINTS, day, found, undated

# the motor was as far from the others in the first test as it reads too much later
HOT = 24.0


def motor(number: int, off: float | Float1D = 0.0, rise: float = 0.0, **more: float | Float1D) -> Levels:
    warm = rise * (1 - np.exp(-np.linspace(0, 8, POINTS) / 0.8))
    return day(number, heat=5.0, T_motor=off + warm, **more)


def five(*last: Levels) -> list[Levels]:
    return [motor(1, rise=HOT), motor(2), motor(3), *last]


def test_a_sensor_that_reads_more_from_one_day_on_though_it_was_as_hot_before() -> None:
    tests = five(motor(4, 30.0), motor(5, 30.0, rise=HOT))
    assert found(tests) == {("day4", "T_motor"): 30, ("day5", "T_motor"): 30}
    assert offsets_between_tests(five(motor(4), motor(5, rise=HOT))) == {}
    assert found([*tests[:3], *undated(*tests[3:])]) == {}, "without clocks nobody knows of a rest"


def test_one_that_reads_less() -> None:
    cold = -np.linspace(0, 20, POINTS)
    tests = [motor(1, cold), motor(2), motor(3), motor(4, -20.0), motor(5, -20.0)]
    assert found(tests) == {("day4", "T_motor"): -20, ("day5", "T_motor"): -20}


def test_where_it_was_shorter_than_a_rest_a_start_may_be_warm() -> None:
    """Two tests a day, an hour apart: the second begins warm, and says nothing of the sensor."""
    tests = five(motor(4, 30.0), replace(day(4, start_h=17.0, heat=5.0, T_motor=30.0), test="late"))
    assert offsets_between_tests(tests) == {}
    assert offsets_between_tests([*tests, motor(5, 30.0)]) != {}


def test_a_machine_that_was_warmed_up_while_nobody_logged() -> None:
    """The bearing is warm, too; and a motor alone cools while it waits, or is warm by another time each day."""
    assert offsets_between_tests(five(motor(4, 30.0, T_bearing=4.0), motor(5, 30.0, T_bearing=4.0))) == {}
    cools = 30.0 * np.exp(-np.linspace(0, 8, POINTS) / 3)
    assert offsets_between_tests(five(motor(4, cools), motor(5, cools))) == {}
    assert offsets_between_tests(five(motor(4, 30.0), motor(5, 34.0))) == {}


def test_a_season_changes_all_of_them() -> None:
    def summer(number: int) -> Levels:
        hall = dict.fromkeys(("T_motor", "T_bearing", "T_column", "T_bed", "T_hall"), 15.0)
        return day(number, heat=5.0, **hall)

    assert offsets_between_tests(five(summer(100), summer(101))) == {}


@pytest.mark.parametrize("kind", ["powered", "around"])
def test_what_is_heated_or_around_the_machine_is_not_asked(kind: str) -> None:
    def other(test: Levels) -> Levels:
        course = replace(test.series["T_motor"], powered=kind == "powered", around=kind == "around")
        return replace(test, series={**test.series, "T_motor": course})

    tests = five(motor(4, 30.0), motor(5, 30.0))
    assert offsets_between_tests(tests) != {}
    assert offsets_between_tests([other(t) for t in tests]) == {}


def starts(*at_k: float, falls_k: float = 1.0, hall: float = 0.0, asked: bool = True) -> list[Mapping[str, Start]]:
    """Starts of a motor beside a bed; in the first three it falls by 1 K."""
    return [
        {
            "motor": Start(k, falls_k if i > 2 else 1.0, 25.0, asked),
            "bed": Start(hall if i > 2 else 0.0, 0.0, 0.0),
        }
        for i, k in enumerate(at_k)
    ]


@pytest.mark.parametrize(
    ("asked", "off"),
    [
        (starts(0, 0, 1, 9.1, 9.1), True),
        (starts(0, 0, 1, 8.9, 8.9), False),
        (starts(0, 0, 1, 20, 22.9), True),
        (starts(0, 0, 1, 20, 23.1), False),
        (starts(0, 0, 1, 20), False),
        (starts(0, 1, 20, 20), False),
        (starts(0, 0, 1, 20, 20, 1), False),  # it recovers
        (starts(0, 0, 1, 20, 20, falls_k=2.9), True),
        (starts(0, 0, 1, 20, 20, falls_k=3.1), False),
        (starts(0, 0, 1, 20, 20, hall=1.9), True),
        (starts(0, 0, 1, 20, 20, hall=2.1), False),
        (starts(0, 0, 1, 20, 20, asked=False), False),
    ],
)
def test_each_limit(asked: list[Mapping[str, Start]], off: bool) -> None:
    assert (set(off_from_start(asked, [True] * len(asked))) == {"motor"}) is off


def test_two_that_fail_on_different_days_are_no_company_to_each_other() -> None:
    def at(motor_k: float, bed_k: float) -> Mapping[str, Start]:
        return {"motor": Start(motor_k, 0, 0), "bed": Start(bed_k, 0, 0)}

    tests = [at(0, 0)] * 3 + [at(20, 0)] * 2 + [at(20, 15)] * 2
    assert off_from_start(tests, [True] * 7) == {"motor": (3, 20.0), "bed": (5, 15.0)}
