"""A temperature sensor whose starts after a rest leave the others' from one test on (between_tests/starts.py)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pytest

from thermodata.calibration.between_tests.failing import offsets_between_tests
from thermodata.calibration.between_tests.levels import Levels
from thermodata.calibration.between_tests.starts import Start, off_from_start
from thermodata.plugin import Float1D

from .test_quality_between import POINTS, day, found, undated

# the motor was as far from the others in the first test as it reads too much later
HOT = 24.0
HEATED, TAU = 16, 2.0  # points of a day up to which the motor is heated; points in which it follows


def run(rise: float, warm: float = 0.0) -> Float1D:
    """What a motor does that starts warm, is heated by rise up to its rest, and cools."""
    n = np.arange(POINTS)
    heat = rise * (1 - np.exp(-np.minimum(n, HEATED) / TAU)) * np.exp(-np.maximum(n - HEATED, 0) / TAU)
    return heat + warm * np.exp(-n / TAU)  # type: ignore[no-any-return]


def motor(number: int, off: float | Float1D = 0.0, rise: float = 0.0, **more: float | Float1D) -> Levels:
    return day(number, heat=5.0, T_motor=off + run(rise) - 12.0 * still(), **more)


def still() -> Float1D:
    """What takes the heat of `day` from a motor."""
    return 1 - np.exp(-np.linspace(0, 8, POINTS) / 0.8)  # type: ignore[no-any-return]


def five(*last: Levels) -> list[Levels]:
    return [motor(1, rise=30.0), motor(2), motor(3), *last]


def test_a_sensor_that_reads_more_from_one_day_on_though_it_was_as_hot_before() -> None:
    tests = five(motor(4, 30.0, rise=HOT), motor(5, 30.0, rise=HOT))
    assert found(tests) == {("day4", "T_motor"): 30, ("day5", "T_motor"): 30}
    assert offsets_between_tests(five(motor(4), motor(5, rise=HOT))) == {}
    assert found([*tests[:3], *undated(*tests[3:])]) == {}, "without clocks nobody knows of a rest"


def test_one_that_reads_less() -> None:
    tests = five(motor(4, -20.0, rise=HOT), motor(5, -20.0, rise=HOT))
    assert found(tests) == {("day4", "T_motor"): -20, ("day5", "T_motor"): -20}
    cold = five(*(motor(i, run(0.0, -20.0), rise=HOT) for i in (4, 5)))
    assert offsets_between_tests(cold) == {}, "it warms up to where it used to stand"


def test_where_it_was_shorter_than_a_rest_a_start_may_be_warm() -> None:
    """Two tests a day, an hour apart: the second begins warm, and says nothing of the sensor."""
    late = replace(day(4, start_h=17.0, heat=5.0, T_motor=30.0 + run(HOT) - 12.0 * still()), test="late")
    tests = five(motor(4, 30.0, rise=HOT), late)
    assert offsets_between_tests(tests) == {}
    assert offsets_between_tests([*tests, motor(5, 30.0, rise=HOT)]) != {}


def test_tests_that_are_said_to_start_warm_say_nothing() -> None:
    tests = five(motor(4, 30.0, rise=HOT), motor(5, 30.0, rise=HOT))
    assert offsets_between_tests([*tests[:3], *(replace(t, warm=True) for t in tests[3:])]) == {}
    leaves_all = [motor(1), motor(2), motor(3, 30.0)]
    assert found(leaves_all) == {("day3", "T_motor"): 30}
    assert found([*leaves_all[:2], replace(leaves_all[2], warm=True)]) == {}
    undated_ones = undated(*leaves_all[:2], replace(leaves_all[2], warm=True))
    assert found(undated(*leaves_all)) != {}
    assert found(undated_ones) == {}


@pytest.mark.parametrize("warm", [10.0, 12.0, 20.0, 30.0])
@pytest.mark.parametrize("rise", [0.0, 12.0, 24.0, 40.0])
@pytest.mark.parametrize("rests", [True, False])
def test_a_motor_that_was_warmed_up_while_nobody_logged(warm: float, rise: float, rests: bool) -> None:
    """Alone, and alike each day: heated further it may never fall below its start."""

    def warmed(number: int) -> Levels:
        n = np.arange(POINTS)
        course = run(rise, warm) if rests else warm + (rise - warm) * (1 - np.exp(-n / TAU)) * (rise > warm)
        return motor(number, course)

    tests = five(motor(4, rise=HOT), *map(warmed, (5, 6, 7)))
    assert offsets_between_tests(tests) == {}


def test_a_machine_that_was_warmed_up_while_nobody_logged() -> None:
    """The bearing is warm, too; or a motor is warm by another time each day."""
    hot = {"rise": HOT, "T_bearing": 4.0}
    assert offsets_between_tests(five(motor(4, 30.0, **hot), motor(5, 30.0, **hot))) == {}
    assert offsets_between_tests(five(motor(4, 30.0, rise=HOT), motor(5, 34.0, rise=HOT))) == {}


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

    tests = five(motor(4, 30.0, rise=HOT), motor(5, 30.0, rise=HOT))
    assert offsets_between_tests(tests) != {}
    assert offsets_between_tests([other(t) for t in tests]) == {}


def starts(
    *at_k: float,
    beyond: float = 0.0,
    hall: float = 0.0,
    asked: bool = True,
    back: float = 0.0,
    rate: float = 1.0,
    rise: float = HOT / 2,
    level: float | None = None,
) -> list[Mapping[str, Start]]:
    """Starts of a motor beside a bed. Up to the third the motor is heated by HOT and cools to its start, where the rest
    is rate 1; from then on by rise, cools at its own rate to a level (its start) and stops at back from its start;
    beyond: how far it falls below that."""
    t_s = np.arange(7.0)

    def motor_at(k: float, late: bool) -> Float1D:
        high, to = k + (rise if late else HOT), k if level is None or not late else level
        falls = to + (high - to) * np.exp(-(rate if late else 1.0) * np.arange(5.0))
        falls = np.maximum(falls, k + back) if late else falls
        return np.array([k, *falls, k - beyond if late and beyond else falls[-1] if back and late else k])

    return [
        {
            "motor": Start(t_s, motor_at(k, i > 2), asked),
            "bed": Start(t_s, np.full(7, hall if i > 2 else 0.0)),
        }
        for i, k in enumerate(at_k)
    ]


@pytest.mark.parametrize(
    ("asked", "off"),
    [
        (starts(0, 0, 1, 20, 20), True),
        (starts(0, 0, 1, 9.1, 9.1, rise=9, rate=0.6), True),
        (starts(0, 0, 1, 8.9, 8.9, rise=9, rate=0.6), False),
        (starts(0, 0, 1, 20, 22.9), True),
        (starts(0, 0, 1, 20, 23.1), False),
        (starts(0, 0, 1, 20), False),
        (starts(0, 1, 20, 20), False),
        (starts(0, 0, 1, 20, 20, 1), False),  # it recovers
        (starts(0, 0, 1, 20, 20, beyond=1.9), True),
        (starts(0, 0, 1, 20, 20, beyond=2.1), False),
        (starts(0, 0, 1, 20, 20, back=1.9), True),
        (starts(0, 0, 1, 20, 20, back=2.1), False),
        (starts(0, 0, 1, 20, 20, rise=8.1), True),
        (starts(0, 0, 1, 20, 20, rise=7.9), False),
        (starts(0, 0, 1, 20, 20, rise=9, rate=0.4, back=0.1), False),  # it never rests
        (starts(0, 0, 1, 20, 20, rise=9, rate=0.6, back=0.1), True),
        (starts(0, 0, 1, 20, 20, level=0.0, back=0.5), False),  # it cools to where it used to stand
        (starts(0, 0, 1, 20, 20, hall=1.9), True),
        (starts(0, 0, 1, 20, 20, hall=2.1), False),
        (starts(0, 0, 1, 20, 20, asked=False), False),
    ],
)
def test_each_limit(asked: list[Mapping[str, Start]], off: bool) -> None:
    assert (set(off_from_start(asked, [True] * len(asked))) == {"motor"}) is off


def test_what_was_never_seen_to_cool_is_not_told() -> None:
    tests = starts(0, 0, 1, 20, 20)
    still_ones = [{**t, "motor": Start(t["motor"].t_s, np.full(7, t["motor"].at_k))} for t in tests]
    assert off_from_start(tests, [True] * 5) != {}
    assert off_from_start([*still_ones[:3], *tests[3:]], [True] * 5) == {}
    assert off_from_start([*tests[:3], *still_ones[3:]], [True] * 5) == {}, "nor what is never heated"


def test_two_that_fail_on_different_days_are_no_company_to_each_other() -> None:
    def at(motor_k: float, bed_k: float) -> Mapping[str, Start]:
        heat = HOT / 2 * np.exp(-np.arange(6.0))
        return {
            name: Start(np.arange(7.0), k + np.array([0.0, *heat])) for name, k in (("motor", motor_k), ("bed", bed_k))
        }

    tests = [at(0, 0)] * 3 + [at(20, 0)] * 2 + [at(20, 20)] * 2
    assert off_from_start(tests, [True] * 7) == {"motor": (3, 20.0), "bed": (5, 20.0)}
