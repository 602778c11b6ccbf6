"""A log that in one test begins and ends as much later beside another is told (told/clocks/beside_each_other.py)."""

from __future__ import annotations

from typing import Any

import pytest

from thermodata.store.ingest.told.clocks.beside_each_other import odd_clocks, together
from thermodata.store.ingest.told.clocks.ends import with_pauses
from thermodata.store.ingest.told.clocks.ends_apart import ends_apart
from thermodata.store.ingest.told.clocks.offset_apart import offsets_apart
from thermodata.store.ingest.told.clocks.whole_hours import whole_hours

DAY, MINUTE = 86_400.0, 60.0


def row(source: str, start_s: float, lasts_s: float, step_s: float | None = 10.0) -> dict[str, Any]:
    rows = round(lasts_s / (step_s or 10.0)) + 1
    return {"source": source, "start_ns": round(start_s * 1e9), "rows": rows, "step_s": step_s}


def days(moved_s: float = 50 * MINUTE, longer_s: float = 0.0, count: int = 5, late_s: float = 0.0) -> dict[str, Any]:
    """A test a day; on the third the control's log stands elsewhere. late_s: how much it differs from day to day."""
    found = {}
    for day in range(count):
        start, off = 1.76e9 + day * DAY, moved_s if day == 2 else late_s * (-1) ** day
        lasts = 5 * 3600.0 + 900.0 * day
        extra = longer_s if day == 2 else 0.0
        found[f"d{day}"] = [row("daq", start, lasts), row("nc", start + off - 20.0, lasts + extra + 100.0)]
    return found


def test_a_clock_that_is_off_in_one_test_is_told() -> None:
    said = odd_clocks(days())
    assert len(said) == 1
    assert str(said[0]).startswith(
        "test 'd2': source 'nc' begins and ends 50 min later beside 'daq' than in the 4 other tests"
    )
    assert "clocks: {nc: -3000 s}" in str(said[0])
    assert "source 'daq' begins and ends 50 min later beside 'nc'" in str(odd_clocks(days(-50 * MINUTE))[0])


def test_a_log_that_runs_through_all_tests_tells_no_clock() -> None:
    tests = {f"d{day}": [row("daq", 1.76e9 + day * DAY, 18000.0), row("hall", 1.76e9, 60 * DAY)] for day in range(4)}
    late = {
        f"e{day}": [row("daq", 1.76e9 + (50 + day) * DAY, 18000.0), row("hall", 1.76e9, 60 * DAY)] for day in (0, 1)
    }
    assert odd_clocks({**tests, **late}) == []


def test_what_a_declared_clock_did_is_not_advised_to_be_undone() -> None:
    """The samples of a log came late within it: its ends agree as logged, and no longer with the clock declared."""
    [told] = odd_clocks(days(-30 * MINUTE))
    assert told.beside({}) == [str(told)]
    [said] = told.beside({"d2": {"nc": -1800.0}})
    assert "clocks: {nc: -1800 s} at this test moved: as logged, both ends agree here too" in said
    assert "contradict" in said
    assert "try" not in said
    assert told.beside({"d2": {"nc": 0.0}}) == [], "somebody's word that the clock was right"
    # what is declared and not enough is put in its place as a whole, for the line adds nothing to another
    [said] = told.beside({"d2": {"nc": 600.0}})
    assert "clocks: {nc: 2400 s}" in said
    assert "clocks: {nc: 600 s, daq: -1800 s}" in said
    [told] = odd_clocks(from_a_day_on(5, 9))
    assert [s.split(":")[0] for s in told.beside({"d6": {"nc": 1560.0}})] == ["tests 'd5', 'd7' and 'd8'", "test 'd6'"]


def test_the_line_to_try_stands_in_place_of_the_offset_that_is_declared_for_all_tests() -> None:
    tests = days()
    for _, nc in tests.values():
        nc["offset_ns"] = 89 * 10**9
    [told] = odd_clocks(tests)
    assert "clocks: {nc: -2911 s} or clocks: {daq: 3000 s}" in str(told)
    [said] = told.beside({"d2": {"daq": 600.0}})
    assert "clocks: {daq: 600 s, nc: -2911 s} or clocks: {daq: 3600 s}" in said


def from_a_day_on(day: int, count: int, moved_s: float = 26 * MINUTE, last_s: float = 0.0) -> dict[str, Any]:
    """last_s: by how much it is off more on the last day."""
    off = [moved_s * (i >= day) + last_s * (i == count - 1) for i in range(count)]
    starts = [1.76e9 + i * DAY for i in range(count)]
    return {
        f"d{i}": [row("daq", start, 18_000.0), row("nc", start + by, 18_000.0)]
        for i, (start, by) in enumerate(zip(starts, off, strict=True))
    }


def test_a_clock_that_is_off_from_one_day_on_is_told_of_these_days() -> None:
    [told] = odd_clocks(from_a_day_on(5, 9))
    assert (told.tests, told.others, told.shift_s) == (("d5", "d6", "d7", "d8"), 5, 26 * MINUTE)
    assert str(told).startswith("tests 'd5', 'd6', 'd7' and 'd8': source 'nc' begins and ends 26 min later")
    assert "try at each of these tests clocks: {nc: -1560 s}" in str(told)
    # of the first days, if these are fewer: which of the two clocks is right nobody knows
    assert [(t.tests, t.late) for t in odd_clocks(from_a_day_on(2, 9))] == [(("d0", "d1"), "daq")]
    assert odd_clocks(from_a_day_on(3, 6))[0].tests == ("d3", "d4", "d5"), "of two alike the first part is right"
    assert odd_clocks(from_a_day_on(2, 4)) == [], "nobody knows of so few"
    assert odd_clocks(from_a_day_on(5, 9, last_s=10 * MINUTE)) == [], "it is off by another time each day"


@pytest.mark.parametrize(
    ("of", "told"),
    [
        ({"moved_s": 130.0}, True),
        ({"moved_s": 110.0}, False),  # two loggers are switched on within two minutes
        ({"longer_s": -50 * MINUTE}, False),  # switched on late, and off as ever
        ({"longer_s": 50 * MINUTE}, False),  # the end is later still: nobody knows
        ({"count": 4}, True),
        ({"count": 3}, False),  # which of so few is the odd one?
        ({"late_s": 290.0}, True),
        ({"late_s": 310.0}, False),  # they never begin together
    ],
)
def test_only_where_both_ends_are_off_alike_and_the_other_tests_agree(of: dict[str, Any], told: bool) -> None:
    assert bool(odd_clocks(days(**of))) is told


def test_what_has_no_even_steps_or_no_time_is_not_asked() -> None:
    for changed in ({"step_s": None}, {"start_ns": None}, {"rows": 0}):
        tests = {name: [rows[0], {**rows[1], **changed}] for name, rows in days().items()}
        assert odd_clocks(tests) == []


def test_streams_of_one_source_are_one_log() -> None:
    tests = {name: [*rows, row("nc", rows[1]["start_ns"] / 1e9 + 600.0, 60.0)] for name, rows in days().items()}
    assert len(odd_clocks(tests)) == 1


def test_logs_that_begin_and_end_together_agree() -> None:
    """Within two minutes of each other, or of what they do in most tests."""
    both = frozenset({"daq", "nc"})
    assert together(days(0.0)) == {f"d{i}": both for i in range(5)}
    assert together(days()) == {f"d{i}": both for i in (0, 1, 3, 4)}, "not where one stands elsewhere"
    assert together(days(longer_s=600.0, moved_s=0.0)) == {f"d{i}": both for i in (0, 1, 3, 4)}, "nor ends later"


@pytest.mark.parametrize(("later_s", "agree"), [(119.0, True), (121.0, False)])
def test_in_few_tests_logs_agree_that_begin_and_end_at_once(later_s: float, agree: bool) -> None:
    rows = {
        f"d{i}": [row("daq", 1e9 + i * DAY, 18_000.0), row("nc", 1e9 + i * DAY + later_s, 18_000.0)] for i in (0, 1)
    }
    assert bool(together(rows)) is agree


def test_a_log_that_agrees_with_one_and_not_with_another_tells_nothing() -> None:
    rows = {"d0": [row("daq", 1e9, 18_000.0), row("nc", 1e9, 18_000.0), row("log", 1e9 + 600, 18_000.0)]}
    assert together(rows) == {}
    assert together({"d0": [row("daq", 1e9, 18_000.0)]}) == {}
    assert together({"d0": [row("daq", 1e9, 18_000.0), row("nc", 1e9, 18_000.0, step_s=None)]}) == {}


def test_logs_in_seconds_from_nowhere_tell_nothing_of_clocks() -> None:
    rows = {f"d{i}": [row("daq", 0.0, 18_000.0), row("nc", 0.0, 18_000.0)] for i in range(5)}
    relative = {test: [{**r, "clock": "relative"} for r in some] for test, some in rows.items()}
    assert len(together(rows)) == 5
    assert together(relative) == {}
    assert odd_clocks({t: [{**r, "clock": "relative"} for r in some] for t, some in days().items()}) == []


def hours_apart(hours: float, *, late_s: float = 0.0, longer_s: float = 0.0, count: int = 3) -> dict[str, Any]:
    """late_s, longer_s: of the control's log on the last day."""
    found = {}
    for day in range(count):
        start, lasts, last = 1.76e9 + day * DAY, 5 * 3600.0 + 900.0 * day, day == count - 1
        begins = start - hours * 3600 - 20.0 + late_s * last
        found[f"d{day}"] = [row("daq", start, lasts), row("nc", begins, lasts + 100.0 + longer_s * last)]
    return found


@pytest.mark.parametrize(
    ("of", "told"),
    [
        ({"hours": 1.0}, "'daq' begins and ends 1 h later than 'nc'"),
        ({"hours": -2.0, "count": 12}, "'nc' begins and ends 2 h later than 'daq'"),
        ({"hours": 5.5}, "'daq' begins and ends 5.5 h later"),
        ({"hours": 0.0}, None),
        ({"hours": 0.75}, None),  # no zones differ by so much
        ({"hours": 27.0}, None),  # nor by so much
        ({"hours": 1.0, "count": 1}, None),  # one log begun later, once
        ({"hours": 1.0, "late_s": 35.0}, "'daq' begins"),
        ({"hours": 1.0, "late_s": 45.0}, None),
        ({"hours": 1.0, "longer_s": 10.0}, "'daq' begins"),
        ({"hours": 1.0, "longer_s": 30.0}, None),
        ({"hours": 1.0, "longer_s": 3600.0}, None),  # it goes on: longer on both sides
    ],
)
def test_logs_of_one_length_that_are_whole_hours_apart_in_all_tests_are_told(of: Any, told: str | None) -> None:
    said = [str(one) for one in whole_hours(hours_apart(**of))]
    assert len(said) == (told is not None)
    assert all(f"source {told}" in one for one in said)


def test_what_to_declare_is_told_and_what_was_declared_is_not_asked() -> None:
    rows = hours_apart(1.0, count=4)
    [said] = whole_hours(rows)
    assert "in all 4 tests" in str(said)
    assert "timezone" in str(said)
    assert "clock: {offset: 3600 s} at 'nc'" in str(said)
    assert "clock: {offset: -3600 s} at 'daq'" in str(said)
    assert whole_hours(rows, {test: {"nc"} for test in rows}) == []
    [others] = whole_hours(rows, {"d0": {"nc"}, "d1": {"hall"}})
    assert "in all 3 tests that have both, and in which no clock of them is declared, though" in str(others)
    assert odd_clocks(rows) == [], "no test is odd beside the others"


def test_logs_that_are_whole_hours_apart_in_all_tests_do_not_agree() -> None:
    """So heat is asked which of them is off; what somebody declared is his word."""
    both = frozenset({"daq", "nc"})
    rows = hours_apart(1.0, count=6)
    assert together(rows) == {}
    assert together(rows, {test: {"nc"} for test in rows}) == dict.fromkeys(rows, both)
    assert together(hours_apart(0.25, count=6)) == dict.fromkeys(rows, both), "people begin one of them earlier"


def test_a_log_that_ends_or_begins_long_before_another_is_told_with_its_tests() -> None:
    tests = {f"d{day}": [row("daq", 1.76e9 + day * DAY, 18000.0)] for day in range(4)}
    for day, (late_s, lasts_s) in enumerate([(0.0, 18000.0), (0.0, 16680.0), (0.0, 17820.0), (900.0, 17000.0)]):
        tests[f"d{day}"].append(row("nc", 1.76e9 + day * DAY + late_s, lasts_s))
    ends, begins = ends_apart(tests, {"daq"})
    assert ends.startswith("source 'nc' ends long before 'daq': 22 min in d1; ")
    assert "its last value" in ends
    assert begins.startswith("source 'nc' begins long after 'daq': 15 min in d3; ")
    assert "its first value" in begins
    assert ends_apart({"d0": tests["d0"], "d2": tests["d2"]}, {"daq"}) == [], (
        "within 5 min people switch two loggers off"
    )


def test_of_a_log_that_runs_through_the_tests_no_end_is_told() -> None:
    """It is cut to each; and a workbook that is written during tests only pauses where nobody looks."""
    whole = row("daq", 1.76e9, 3 * DAY)
    tests = {f"d{day}": [whole, row("nc", 1.76e9 + day * DAY, 18000.0)] for day in range(3)}
    assert ends_apart(tests, {"daq"}) == []
    assert len(ends_apart({"d0": tests["d0"]}, {"daq"})) == 1
    hall = row("hall", 1.76e9, DAY)
    each = {f"d{day}": [row("daq", 1.76e9 + day * DAY, 18000.0), hall] for day in range(3)}
    assert ends_apart(each, {"daq"}) == []
    assert len(ends_apart({"d2": each["d2"]}, {"daq"})) == 1, "in one test alone, rows and pauses tell its end"


def apart(by_s: float, count: int = 3, late_s: float = 0.0, longer_s: float = 0.0) -> dict[str, Any]:
    """A test a day, in each of which the control's log stands by_s later than the recorder's."""
    starts = [1.76e9 + day * DAY for day in range(count)]
    return {
        f"d{i}": [row("daq", t, 18000.0), row("nc", t + by_s + late_s * i, 18000.0 + longer_s)]
        for i, t in enumerate(starts)
    }


@pytest.mark.parametrize(
    ("logged_s", "offset_s", "fits_s"),
    [
        (-37 * MINUTE, -37 * MINUTE, 37 * MINUTE),  # slow, and declared the wrong way
        (37 * MINUTE, 37 * MINUTE, -37 * MINUTE),
        (0.0, 37 * MINUTE, 0.0),  # right as logged
        (-37 * MINUTE, 37 * MINUTE, None),  # right as declared
        (-20 * MINUTE, 37 * MINUTE, None),  # neither none nor the opposite sets it right
        (-37 * MINUTE, -35 * MINUTE, 35 * MINUTE),
    ],
)
def test_an_offset_of_the_wrong_sign_is_told(logged_s: float, offset_s: float, fits_s: float | None) -> None:
    said = offsets_apart(apart(logged_s + offset_s), {"nc": offset_s})
    assert [one.fits_s for one in said] == ([] if fits_s is None else [fits_s])
    if fits_s == 37 * MINUTE:
        assert "begins and ends 74 min earlier than 'daq' in all 3 tests" in str(said[0])
        assert "with clock: {offset: 2220 s} both ends agree" in str(said[0])
        assert "of a clock that is slow is positive" in str(said[0])


@pytest.mark.parametrize(
    "rows", [apart(-74 * MINUTE, count=1), apart(-74 * MINUTE, late_s=300.0), apart(-74 * MINUTE, longer_s=900.0)]
)
def test_logs_that_do_not_stand_alike_in_all_tests_tell_of_no_offset(rows: dict[str, Any]) -> None:
    assert offsets_apart(rows, {"nc": -37 * MINUTE}) == []
    assert offsets_apart(apart(-74 * MINUTE), {}) == []


def test_only_what_ends_before_the_displacement_does_is_told_and_a_pause_is_no_end() -> None:
    day = {"d0": [row("daq", 1.76e9, 18000.0), row("hall", 1.76e9 - 2 * DAY, 7 * DAY)]}
    assert ends_apart(day, {"daq"}) == [], "a log of the whole week lasts longer than any test"
    begun = {"d0": [row("daq", 1.76e9 + 900.0, 17000.0), row("nc", 1.76e9, 18000.0)]}
    assert ends_apart(begun, {"daq"}) == [], "no model holds a response"
    short = {"d0": [{**row("daq", 1.76e9, 18000.0), "stream": ""}, {**row("nc", 1.76e9, 16200.0), "stream": ""}]}
    gap = {"source": "nc", "stream": "", "flag": "gap", "from_s": 3600.0, "to_s": 5400.0}
    assert len(ends_apart(short, {"daq"})) == 1
    assert ends_apart(with_pauses(short, {"d0": [gap, gap]}), {"daq"}) == []
