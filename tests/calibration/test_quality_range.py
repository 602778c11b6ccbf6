"""The end of a range that nobody declared shows in several tests: all come to it, and none goes beyond."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from thermodata.calibration.quality.column import ColumnInput
from thermodata.calibration.quality.ends.range import End, ends_of_ranges, plateau_at_extreme
from thermodata.calibration.quality.ends.still import Reading
from thermodata.calibration.quality.flags import flag_stream
from thermodata.schema.flag import Flag

FINE = Reading(0.2, 0.005, 0.01, 0.66, moving=5000, stood_s=600.0, low=-20.3, low_n=1, high=142.067, high_n=2000)
LONG = replace(FINE, moving=110, low=-8.1, high_n=1468)
SOUND = replace(FINE, low=-30.9, high=55.1, high_n=1)


def test_the_end_of_a_range_is_told_of_the_tests_that_come_to_it() -> None:
    found = ends_of_ranges({("day1", "dZ"): FINE, ("day2", "dZ"): LONG, ("day3", "dZ"): SOUND, ("day1", "dX"): SOUND})
    assert found == {(f"day{k}", "dZ"): (None, End(142.067)) for k in (1, 2)}


def test_the_lower_end_and_a_test_that_touches_it_once() -> None:
    low = replace(FINE, low=-140.5, low_n=40, high=3.2, high_n=1)
    found = ends_of_ranges({("day1", "dZ"): low, ("day2", "dZ"): low, ("day3", "dZ"): replace(low, low_n=1)})
    assert found == {(f"day{k}", "dZ"): (End(-140.5), None) for k in (1, 2, 3)}


@pytest.mark.parametrize(
    "others",
    [
        [SOUND],  # one test alone may as well have been held
        [replace(LONG, high_n=9)],
        [replace(LONG, high=142.068)],  # goes beyond
        [LONG, replace(SOUND, high=143.0)],
        [replace(LONG, low=142.067)],  # stands throughout
    ],
)
def test_what_one_test_alone_shows_or_one_contradicts_is_no_end(others: list[Reading]) -> None:
    assert ends_of_ranges({(f"day{k}", "dZ"): r for k, r in enumerate([FINE, *others])}) == {}


@pytest.mark.parametrize("change", [{"finest": 0.2}, {"alternates": 0.1}, {"chance": 0.3}])
def test_a_coarse_or_smooth_reading_comes_to_an_extreme_as_a_matter_of_course(change: dict[str, float]) -> None:
    coarse = replace(FINE, **change)
    assert ends_of_ranges({("day1", "dZ"): coarse, ("day2", "dZ"): coarse}) == {}


def test_a_rest_at_zero_is_no_end() -> None:
    rests = replace(FINE, low=0.0, low_n=3000, high=8.0, high_n=1)
    assert ends_of_ranges({("day1", "dZ"): rests, ("day2", "dZ"): rests}) == {}


def test_what_is_flagged_at_an_end_that_other_tests_show() -> None:
    """Most of a test at its upper end is saturated, not held; a logger's code stays a code, though it is the lowest."""
    rng = np.random.default_rng(3)
    x = np.round(140.0 + rng.normal(0.0, 3.0, 400), 3)
    x[20:380], x[390:] = 142.067, -9999.0
    x[:20] = np.minimum(x[:20], 142.0)
    t_ns = np.arange(len(x), dtype=np.int64) * 10**9
    column = ColumnInput(x, "displacement", np.zeros(len(x), np.uint16), at="tcp", limits=(End(-9999.0), End(142.067)))
    flags, _ = flag_stream(t_ns, {"dZ": column})
    saturated, no_value = (((flags["dZ"] & np.uint16(f)) != 0) for f in (Flag.SATURATED, Flag.OUT_OF_RANGE))
    assert saturated.tolist() == (x == 142.067).tolist()
    assert no_value[390:].all()
    assert not no_value[:390].any()


NOISY = replace(FINE, low=-91.8, low_n=1, high=44.0, high_n=1, plateau=(-89.9, 0.5, -1, 2))


def test_two_tests_that_stand_on_one_level_within_their_noise_tell_an_end() -> None:
    readings = {
        ("day1", "dZ"): NOISY,
        ("day2", "dZ"): replace(NOISY, plateau=(-90.1, 0.5, -1, 2)),
        ("day3", "dZ"): SOUND,
    }
    found = ends_of_ranges(readings)
    assert set(found) == {("day1", "dZ"), ("day2", "dZ")}
    assert found["day1", "dZ"] == (End(-90.1, 4.0), None)


@pytest.mark.parametrize(
    "other",
    [
        SOUND,  # one test alone
        replace(NOISY, plateau=(-89.6, 0.5, -1, 2)),  # lies elsewhere by more than half the noise: a shift by the speed
        replace(NOISY, plateau=(-89.9, 0.5, 1, 2)),  # another end
        replace(NOISY, low=-99.0),  # goes beyond
    ],
)
def test_plateaus_that_differ_are_no_end(other: Reading) -> None:
    assert ends_of_ranges({("day1", "dZ"): NOISY, ("day2", "dZ"): other}) == {}


@pytest.mark.parametrize(("times", "told"), [(4, True), (3, False)])
def test_one_test_that_comes_to_one_level_again_and_again_tells_an_end(times: int, told: bool) -> None:
    readings = {("day1", "dZ"): replace(NOISY, plateau=(-89.9, 0.5, -1, times)), ("day2", "dZ"): SOUND}
    assert ends_of_ranges(readings) == ({("day1", "dZ"): (End(-89.9, 4.0), None)} if told else {})


def test_what_is_flagged_at_an_end_in_noise() -> None:
    """A probe drifts to its end, and stands there for 40 min with the noise of its converter; then it comes back."""
    rng = np.random.default_rng(3)
    t = np.arange(0.0, 7200.0, 5.0)
    course = np.where(t < 4800, -t / 20, -240 + (t - 4800) / 10)
    x = np.round(np.maximum(course, -120.0) + rng.normal(0.0, 0.3, len(t)), 3)
    end = plateau_at_extreme(t, x)
    assert end is not None
    column = ColumnInput(
        x, "displacement", np.zeros(len(x), np.uint16), at="tcp", limits=(End(end.level, 8 * end.noise), None)
    )
    flags, events = flag_stream((t * 1e9).astype(np.int64), {"dZ": column})
    saturated = (flags["dZ"] & np.uint16(Flag.SATURATED)) != 0
    assert saturated[course < -120.0].all()
    assert not saturated[course > -117.0].any()
    assert any("lower limit -1" in e.detail and "again and again" in e.detail for e in events)
