"""A temperature sensor that fails between tests or slowly within one, with clocks and without."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pytest

from thermodata.calibration.between_tests.failing import offsets_between_tests
from thermodata.calibration.between_tests.levels import POINTS, Course, Levels, _median_of_others
from thermodata.plugin import Float1D

DAY = 86_400.0


def day(
    number: int,
    *,
    hours: float = 8.0,
    heat: float = 20.0,
    start_h: float = 8.0,
    warm: bool = False,
    **off: float | Float1D,
) -> Levels:
    """A day's test: a bearing that heats up, four parts that hardly do."""
    h = np.linspace(0, hours, POINTS)
    rise = np.ones(POINTS) if warm else 1 - np.exp(-h / 0.8)
    rng = np.random.default_rng(number)
    gains = {"T_bearing": heat, "T_column": 2.0, "T_bed": 1.0, "T_hall": 0.5, "T_motor": 12.0}
    start = number * DAY + start_h * 3600
    series = {
        name: Course(3600 * h, 22 + gain * rise + rng.normal(0, 0.05, POINTS) + off.get(name, 0.0))
        for name, gain in gains.items()
    }
    return Levels(f"day{number}", start, start + hours * 3600, series)


def undated(*tests: Levels) -> list[Levels]:
    return [replace(t, start_s=None) for t in tests]


def drift(size: float, since: int, over: int = 4) -> Float1D:
    return size * np.clip((np.arange(POINTS) - since) / over, 0, 1)


def found(tests: list[Levels]) -> Mapping[tuple[str, str], float]:
    return {k: round(o.size) for k, o in offsets_between_tests(tests).items()}


@pytest.mark.parametrize("clocks", [True, False])
def test_sound_days_are_left_alone_however_hot(clocks: bool) -> None:
    tests = [day(1, heat=0), day(2, heat=0), day(3, heat=35), day(4, heat=40)]
    assert offsets_between_tests(tests if clocks else undated(*tests)) == {}


@pytest.mark.parametrize("clocks", [True, False])
def test_a_sensor_that_reads_30_kelvin_more_from_one_day_on(clocks: bool) -> None:
    tests = [day(1), day(2, heat=0), day(3, T_column=30.0), day(4, heat=5, T_column=30.0)]
    offsets = offsets_between_tests(tests if clocks else undated(*tests))
    assert sorted(offsets) == [("day3", "T_column"), ("day4", "T_column")]
    assert all(abs(o.size - 30) < 2 and o.since_s is None for o in offsets.values())
    tests = [day(1), day(2, T_bed=-15.0)]
    assert offsets_between_tests(tests if clocks else undated(*tests)).keys() == {("day2", "T_bed")}


@pytest.mark.parametrize("clocks", [True, False])
def test_a_drift_is_flagged_where_it_starts_and_in_all_later_tests(clocks: bool) -> None:
    tests = [day(1), day(2), day(3, T_column=drift(30.0, 20)), day(4, T_column=30.0), day(5, T_column=30.0)]
    offsets = offsets_between_tests(tests if clocks else undated(*tests))
    assert sorted(offsets) == [("day3", "T_column"), ("day4", "T_column"), ("day5", "T_column")]
    since = offsets["day3", "T_column"].since_s
    assert since == pytest.approx(tests[2].series["T_column"].t_s[20], abs=8 * 3600 / POINTS)
    assert offsets["day4", "T_column"].since_s is None


def test_without_clocks_the_order_of_the_file_counts() -> None:
    tests = undated(day(3, T_column=30.0), day(1), day(2))
    assert offsets_between_tests(tests) == {}
    assert found([tests[1], tests[2], tests[0]]) == {("day3", "T_column"): 30}
    # with clocks it does not
    assert found([day(3, T_column=30.0), day(1), day(2)]) == {("day3", "T_column"): 30}


@pytest.mark.parametrize("clocks", [True, False])
def test_a_sensor_that_recovers_is_not_condemned(clocks: bool) -> None:
    tests = [day(1), day(2, T_column=30.0), day(3)]
    assert offsets_between_tests(tests if clocks else undated(*tests)) == {}


def test_a_drift_within_the_last_test_may_as_well_be_heat() -> None:
    assert offsets_between_tests([day(1), day(2, T_column=drift(30.0, 20))]) == {}


def test_a_part_that_stays_hot_without_a_rest_is_not_told_from_a_failure() -> None:
    tests = [day(1, heat=0, hours=2), day(1, heat=30, hours=2, start_h=10.1, warm=True)]
    assert offsets_between_tests([tests[0], replace(tests[1], test="hot")]) == {}
    # without clocks its neighbours tell that it has not rested: the motor is hot too
    assert offsets_between_tests(undated(tests[0], replace(tests[1], test="hot"))) == {}


def test_what_is_powered_is_hot_from_the_day_on_which_it_is_switched_on() -> None:
    """A cabinet: 30 K above the others after any rest, for as long as the main switch is on."""
    tests = [day(1), day(2), day(3, T_column=drift(30.0, 20)), day(4, T_column=30.0)]

    def powered(t: Levels) -> Levels:
        return replace(t, series={**t.series, "T_column": replace(t.series["T_column"], powered=True)})

    assert offsets_between_tests([powered(t) for t in tests]) == {}
    assert offsets_between_tests(tests) != {}


@pytest.mark.parametrize(("k", "flagged"), [(9.5, True), (7.5, False)])
def test_it_is_off_by_eight_kelvin_and_more(k: float, flagged: bool) -> None:
    """The column lies within a kelvin of the others, and a tenth of noise."""
    tests = [day(n, heat=0) for n in (1, 2)] + [day(3, heat=0, T_hall=k)]
    assert bool(offsets_between_tests(tests)) is flagged


def test_streams_on_times_of_their_own_are_compared_at_the_same_moments() -> None:
    def other(t: Levels) -> Levels:
        own = t.series["T_column"]
        late = Course(
            np.linspace(1000, own.t_s[-1] + 900, 20),
            np.interp(np.linspace(1000, own.t_s[-1] + 900, 20), own.t_s, own.values),
        )
        return replace(t, series={**t.series, "T_column": late})

    tests = [other(day(1)), other(day(2)), other(day(3, T_column=30.0))]
    assert found(tests) == {("day3", "T_column"): 30}
    assert offsets_between_tests(tests[:2]) == {}


def test_streams_that_follow_each_other_are_no_neighbours() -> None:
    def in_pieces(t: Levels) -> Levels:
        """Each sensor in three streams, one a third of the day, as pieces of one log that are read as three."""
        end, series = float(t.series["T_bed"].t_s[-1]) / 3, {}
        for k in range(3):
            t_s = np.linspace(k * end, (k + 1) * end - 10, POINTS)
            for name in ("T_bearing", "T_column"):
                own = t.series[name]
                series[f"{name}_{k}"] = Course(t_s, np.interp(t_s, own.t_s, own.values))
        return replace(t, series=series)

    tests = [day(1, heat=5), day(2, heat=40), day(3, heat=40, T_column=-14.0)]
    assert offsets_between_tests([in_pieces(t) for t in tests]) == {}
    assert found(tests) == {("day3", "T_column"): -17}


def test_too_few_neighbours_and_no_data() -> None:
    lone = [
        replace(t, series={k: t.series[k] for k in ("T_column", "T_bed", "T_hall")})
        for t in (day(1), day(2, T_column=30.0))
    ]
    assert offsets_between_tests(lone) == {}
    assert offsets_between_tests([]) == {}
    empty = Levels("none", 0.0, 1.0, {"T_column": Course(np.arange(POINTS) * 1.0, np.full(POINTS, np.nan))})
    assert offsets_between_tests([empty, day(1), day(2, T_column=30.0)]).keys() == {("day2", "T_column")}


def test_displacements_are_no_neighbours() -> None:
    def with_probe(t: Levels, um: float) -> Levels:
        probe = Course(t.series["T_bed"].t_s, np.full(POINTS, um), "displacement")
        return replace(t, series={**t.series, "dZ": probe})

    assert offsets_between_tests([with_probe(day(1), 0.0), with_probe(day(2), 80.0)]) == {}


def test_the_median_of_the_others() -> None:
    rng = np.random.default_rng(0)
    x = rng.normal(size=(7, 40))
    x[rng.random(x.shape) < 0.3] = np.nan
    got = _median_of_others(x)
    for i in range(7):
        others = np.delete(x, i, axis=0)
        with np.errstate(all="ignore"):
            wanted = np.array([np.nanmedian(c) if np.isfinite(c).sum() >= 3 else np.nan for c in others.T])
        wanted[~np.isfinite(x[i])] = np.nan
        np.testing.assert_allclose(got[i], wanted)


@pytest.mark.parametrize("clocks", [True, False])
@pytest.mark.parametrize(
    ("third", "fourth", "constant"),
    [
        (30.0, 30.0, True),
        (30.0, 34.0, False),  # it comes back to no start
        (30.0 + 6 * np.sin(np.arange(POINTS)), 30.0, False),  # it wanders
        (drift(30.0, 0), 30.0, False),  # it drifted there
    ],
)
def test_only_an_offset_that_stands_is_a_constant(
    clocks: bool, third: float | Float1D, fourth: float | Float1D, constant: bool
) -> None:
    tests = [day(1), day(2), day(3, T_motor=third), day(4, T_motor=fourth)]
    offsets = offsets_between_tests(tests if clocks else undated(*tests))
    assert {t for t, _ in offsets} >= {"day4"}
    assert {o.constant for o in offsets.values()} == {constant}


def test_one_test_alone_and_a_sensor_that_sticks_tell_no_constant() -> None:
    (alone,) = offsets_between_tests([day(1), day(2), day(3, T_motor=30.0)]).values()
    assert not alone.constant
    rise = day(3).series["T_motor"].values - 22
    stuck = offsets_between_tests([day(1), day(2), day(3, T_motor=30.0 - rise), day(4, T_motor=30.0 - rise)])
    assert [o.constant for o in stuck.values()] == [False, False]
