"""Kelvins among degrees: told with the test and the channels, and nothing said of a sensor that is hot."""

from __future__ import annotations

import numpy as np
import pytest

from thermodata.calibration.between_tests.levels import Course, Levels
from thermodata.plugin import Float1D
from thermodata.store.ingest.told.channels.other_units import other_units


def levels(test: str, **medians: float) -> Levels:
    t = np.linspace(0.0, 3600.0, 10)
    return Levels(test, None, None, {n: Course(t, m + np.linspace(-1, 1, 10)) for n, m in medians.items()})


@pytest.mark.parametrize(
    ("readings", "told"),
    [
        ([22.0, 24.0, 296.0], {"t2": "K"}),
        ([295.0, 21.0, 22.0], {"t0": "K"}),
        ([22.0, 24.0, -250.0], {"t2": "degC"}),  # declared as K, one file in degrees
        ([22.0, 24.0, 90.0], {}),
        ([22.0, 24.0, 450.0], {}),  # a heater, or a broken sensor: no kelvins
        ([295.0, 296.0, 297.0], {}),  # nothing beside it says otherwise
        ([22.0], {}),
    ],
)
def test_kelvins_among_degrees_are_told(readings: list[float], told: dict[str, str]) -> None:
    tests = [levels(f"t{i}", T_b=m, T_hall=m) for i, m in enumerate(readings)]
    losses = other_units(tests)
    assert {str(x["test"]): "K" if " in K" in str(x["reason"]) else "degC" for x in losses} == told
    assert all(str(x["reason"]).startswith("T_b, T_hall: in t") for x in losses)


@pytest.mark.parametrize(
    ("bearing", "hall", "told"),
    [
        ([22.0, 24.0, 73.0, 75.0], [21.0, 20.0, 69.0, 70.0], ["t2", "t3"]),
        ([22.0, 24.0, 73.0, 75.0], [21.0, 20.0, 20.0, 21.0], []),  # warm before its test
        ([22.0, 24.0, 110.0], [21.0, 20.0, 108.0], []),  # an oven, or what else is no Fahrenheit
        ([22.0, 24.0, 41.0], [21.0, 20.0, 38.0], []),  # a hot day
        ([73.0, 75.0], [69.0, 70.0], []),  # nothing beside it says otherwise
    ],
)
def test_fahrenheit_among_degrees_is_told_where_all_stand_so(
    bearing: list[float], hall: list[float], told: list[str]
) -> None:
    losses = other_units([levels(f"t{i}", T_b=b, T_hall=h) for i, (b, h) in enumerate(zip(bearing, hall, strict=True))])
    assert [x["test"] for x in losses] == told
    assert all("channels: {T_b: {unit: degF}}" in str(x["reason"]) for x in losses)


@pytest.mark.parametrize(
    ("readings", "told"),
    [
        ([22.0, 24.0, 73.0], ["t2"]),
        ([22.0, 24.0, 41.0], []),  # a hot day
        ([22.0, 24.0, 110.0], []),
        ([73.0, 75.0], []),
        ([22.0], []),
    ],
)
def test_a_single_temperature_that_stands_so_is_told_with_what_else_it_may_be(
    readings: list[float], told: list[str]
) -> None:
    losses = other_units([levels(f"t{i}", T_b=b) for i, b in enumerate(readings)])
    assert [x["test"] for x in losses] == told
    assert all("if it was warm before its test: start_state: warm" in str(x["reason"]) for x in losses)


def test_a_single_temperature_that_is_said_to_be_warm_before_is_not_told() -> None:
    t = np.linspace(0.0, 3600.0, 10)
    warm = Levels("t2", None, None, {"T_b": Course(t, 73 + np.linspace(-1, 1, 10))}, warm=True)
    assert other_units([levels("t0", T_b=22.0), levels("t1", T_b=24.0), warm]) == []


def test_one_of_several_temperatures_that_alone_has_others_to_compare_is_left() -> None:
    """The other sensors of that test are of it alone, and may tell of a machine that was warm."""
    tests = [levels("t0", T_b=22.0), levels("t1", T_b=24.0), levels("t2", T_b=73.0, T_hall=21.0)]
    assert other_units(tests) == []


def parts(test: str, warm: bool = False, **courses: Float1D | float) -> Levels:
    t = np.linspace(0.0, 3600.0, 33)
    heated = 6.0 * np.sin(np.pi * t / 3600.0)
    own = {f"T_{i}": Course(t, 20.0 + i / 2 + heated / (i + 2)) for i in range(4)}
    return Levels(test, None, None, own | {n: Course(t, x + heated) for n, x in courses.items()}, warm=warm)


SOUND = [parts("t0", T_nut=21.0), parts("t1", T_nut=22.0), parts("t2", T_nut=20.5)]
COOLING = 44.0 * np.exp(-np.linspace(0, 1.5, 33))


@pytest.mark.parametrize(
    ("last", "told"),
    [
        (parts("t3", T_nut=70.0), ["t3"]),
        (parts("t3", T_nut=22.0), []),
        (parts("t3", T_nut=44.0), []),  # warmer, but not as degF are
        (parts("t3", T_nut=92.0), []),
        (parts("t3", T_nut=24.0 + COOLING), []),  # warm before its test: it cools towards the others
        (parts("t3", T_nut=66.0 + COOLING), []),  # its coldest alone would be as ever
        (parts("t3", warm=True, T_nut=70.0), []),  # somebody's word
    ],
)
def test_one_column_in_fahrenheit_among_others_that_are_as_ever_is_told(last: Levels, told: list[str]) -> None:
    losses = other_units([*SOUND, last])
    assert [x["test"] for x in losses] == told
    assert all("channels: {T_nut: {unit: degF, instead_of: degC}}" in str(x["reason"]) for x in losses)


def test_several_columns_in_fahrenheit_are_one_line_and_no_measure_of_each_other() -> None:
    two = [parts(f"t{i}", T_nut=x, T_motor=x + 2.0) for i, x in enumerate((21.0, 22.0, 20.5, 70.0))]
    [loss] = other_units(two)
    assert str(loss["reason"]).startswith("T_nut, T_motor: in t3")


def test_one_column_is_not_told_without_other_tests_and_temperatures_to_compare() -> None:
    last = parts("t3", T_nut=70.0)
    assert other_units([SOUND[0], last]) == []
    few = [Levels(t.test, None, None, {n: t.series[n] for n in ("T_0", "T_1", "T_nut")}) for t in (*SOUND, last)]
    assert other_units(few) == []


def test_a_part_that_is_as_hot_in_other_tests_is_not_told() -> None:
    """Held against all that was seen of it: a motor that once ran 50 K above the others may do so again."""
    assert other_units([*SOUND, parts("t3", T_nut=70.0), parts("t4", T_nut=20.0 + 50.0 * np.linspace(0, 1, 33))]) == []
