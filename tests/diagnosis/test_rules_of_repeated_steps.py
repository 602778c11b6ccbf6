"""Steps that repeat alike are of the machine, and no slips (steps/repeating.py), on both sides of each limit."""

from __future__ import annotations

import numpy as np
import pytest

from thermodata.diagnosis.steps.artefact import find_steps
from thermodata.diagnosis.steps.repeating import as_artefacts, moved_by, repeating, single
from thermodata.diagnosis.steps.step import Step
from thermodata.view.grid.dataset import ChannelInfo, TestData

from .hand_made import Parts, a_test, problem

TESTS = [b.test for b in problem(*(Parts(np.zeros(4)) for _ in range(3)), noise=0.05).blocks]


def steps(*sizes: float, tests: tuple[int, ...] = (0,) * 6) -> list[Step]:
    return [Step(TESTS[k], 3600.0 * (i + 1), size, 20.0) for i, (size, k) in enumerate(zip(sizes, tests, strict=False))]


@pytest.mark.parametrize(
    ("sizes", "again"),
    [
        ((6.8, 6.7, 6.9), 3),
        ((-6.8, -6.7, -6.9), 3),
        ((6.0, 6.6, 5.4), 3),
        ((6.0, 6.7, 5.4), 0),
        ((6.8, 6.8), 0),
        ((6.8, -6.8, 6.8), 0),
        ((6.8, 3.0, 6.7, 6.9), 3),
        ((3.0, 6.0, 12.0), 0),
        ((6.8, -6.8, 6.7, 6.9, -3.0), 4),
        ((6.8, 6.7, 6.9, 3.0, 3.1, 2.9), 6),
        ((), 0),
    ],
)
def test_three_steps_within_a_tenth_of_their_median_repeat(sizes: tuple[float, ...], again: int) -> None:
    some = steps(*sizes)
    assert sum(map(len, repeating(some))) == again
    assert len(single(some)) == len(sizes) - again


def test_they_are_told_once_in_each_test_and_all_others_as_slips() -> None:
    some = steps(6.8, 6.7, 3.0, 6.9, tests=(0, 1, 1, 1))
    told = as_artefacts(repeating(some), "um")
    assert [(a.kind, a.test, a.at_s, a.size_um) for a in told] == [
        ("repeated_step", "t0", None, None),
        ("repeated_step", "t1", None, None),
    ]
    assert len({a.why for a in told}) == 1, "a reader is told once"
    assert "3 times by the same amount, +6.7 to +6.9 um (t0 at 1.0 h; t1 at 2.0, 4.0 h)" in told[0].why
    assert "stick-slip or backlash" in told[0].why
    assert [s.size for s in single(some)] == [3.0]
    assert as_artefacts([], "um") == []


def test_steps_to_and_fro_are_of_one_play_and_other_sizes_are_told_beside_it() -> None:
    some = steps(3.8, -3.9, 3.7, 3.8, 9.0, 9.1, 9.0, tests=(0, 0, 1, 1, 1, 1, 1))
    first, second = as_artefacts(repeating(some), "um")
    said = "4 times by the same amount to and fro, +3.7 to +3.8 and -3.9 um (t0 at 1.0, 2.0 h; t1 at 3.0, 4.0 h)"
    assert said in first.why
    assert "9.1" not in first.why
    assert second.why.startswith(first.why)
    assert "3 times by the same amount, +9.0 to +9.1 um" in second.why
    assert single(some) == []


FEED = ChannelInfo("feed", "feed", "m/min", at="axis.x")
PUMP = ChannelInfo("pump", "state", "1", at="hydraulics")


def moving(starts: int, name: str = "t0") -> TestData:
    """Of 600 min, in which an axis starts and stops as many times; a pump does so, too."""
    runs = np.arange(600) % max(600 // starts, 2) < max(300 // starts, 1)
    return a_test(
        name, 600, values={"feed": 5.0 * runs, "pump": 1.0 * runs}, channels={"feed": FEED, "pump": PUMP}, step_s=60.0
    )


def beside(test: TestData, *of: tuple[str, ...], sizes: tuple[float, ...] = (2.9, -5.5, 4.0)) -> list[Step]:
    return [
        Step(test, 3600.0 * (i + 1), size, 20.0, beside=by) for i, (size, by) in enumerate(zip(sizes, of, strict=False))
    ]


@pytest.mark.parametrize(
    ("of", "starts", "again"),
    [
        ([("feed", "pump")] * 3, 6, 3),
        ([("feed",), ("feed",), ()], 6, 0),
        ([("pump",)] * 3, 6, 0),
        ([("feed",)] * 3, 150, 0),
    ],
)
def test_jumps_of_any_size_as_one_axis_starts_or_stops_are_the_machines(
    of: list[tuple[str, ...]], starts: int, again: int
) -> None:
    """Two, or beside a pump, or where the axis starts and stops all the time, they are slips."""
    some = beside(moving(starts), *of)
    assert sum(map(len, repeating(some))) == again
    assert len(single(some)) == 3 - again
    assert moved_by(some) == (["feed"] if again else [])


@pytest.mark.parametrize(
    ("starts", "others", "again"),
    [(13, 0, 3), (14, 0, 0), (8, 1, 3), (8, 2, 0)],  # by chance in 0.99 %, 1.3 %, 0.8 % and 2.0 %
)
def test_by_chance_three_slips_in_a_hundred_campaigns_fall_beside_one_axis_at_most(
    starts: int, others: int, again: int
) -> None:
    """The more often it starts and stops, and the more slips there are, the likelier three of them are beside it."""
    sizes = (2.9, -5.5, 4.0, 10.0, 20.0)
    some = beside(moving(starts), *[("feed",)] * 3, *[()] * others, sizes=sizes)
    assert sum(map(len, repeating(some))) == again


def test_they_are_told_with_the_axis_and_nothing_that_is_untrue_of_it() -> None:
    [told] = as_artefacts(repeating(beside(moving(6), *[("feed", "pump")] * 3)), "um")
    assert told.kind == "repeated_step"
    assert "3 times, by +2.9 to +4.0 and -5.5 um (t0 at 1.0, 2.0, 3.0 h), each time just as feed changes" in told.why
    assert "stick-slip or backlash" in told.why
    assert "elsewhere" not in told.why
    assert "by the same amount" not in told.why


def test_a_slip_beside_them_stays_one() -> None:
    some = beside(moving(6), *[("feed",)] * 3, (), sizes=(2.9, -5.5, 4.0, 9.0))
    assert [s.size for s in single(some)] == [9.0]


def test_what_sticks_and_slips_is_found_as_steps_and_taken_for_none() -> None:
    course = 0.02 * np.random.default_rng(0).normal(size=400)
    course += sum(5.0 * (np.arange(400) >= i) for i in (100, 200, 300))
    found = find_steps(problem(Parts(course), noise=0.02))
    assert (len(found), single(found)) == (3, [])
