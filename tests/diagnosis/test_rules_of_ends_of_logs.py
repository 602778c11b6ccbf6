"""Clocks by how logs begin and end beside each other (clocks/ends_of_logs.py): what is moved, and what is told."""

from __future__ import annotations

import pytest

from thermodata.diagnosis.clocks.ends_of_logs import Ends, OddEnds, is_alike, meets
from thermodata.diagnosis.clocks.heat_balance import UNMOVED_S
from thermodata.diagnosis.tell.advising.next_test import after_clocks
from thermodata.schema.answers.diagnosis import ClockMoved
from thermodata.store.ingest.told.clocks.whole_hours import HoursApart

SHIFT_S = 1560.0


def odd(test: str, late: str = "nc", early: str = "daq") -> OddEnds:
    return OddEnds("c", test, late, early, SHIFT_S, f"{late} is later beside {early}")


def move(test: str, by_s: float = -SHIFT_S, source: str = "nc") -> ClockMoved:
    return ClockMoved(source=source, campaign="c", test=test, moved_s=by_s)


@pytest.mark.parametrize(
    ("home", "expected"),
    [("daq", move("t1")), ("nc", move("t1", SHIFT_S, "daq")), ("other", None), (None, None)],
)
def test_the_log_that_the_response_is_not_in_is_moved(home: str | None, expected: ClockMoved | None) -> None:
    assert odd("t1").move(home) == expected


def test_the_tests_of_one_log_are_moved_together() -> None:
    ends = Ends((odd("t1"), odd("t2"), odd("t1", late="daq", early="log")))
    assert ends.moves("daq") == [[move("t1"), move("t2")], [move("t1", SHIFT_S, "log")]]
    assert Ends().moves("daq") == []


def test_what_was_moved_is_told_and_what_was_not() -> None:
    ends = Ends((odd("t1"), odd("t2")))
    moved, kept = ends.artefacts("daq", [move("t1")])
    assert (moved.kind, moved.campaign, moved.test) == ("clock_offset", "c", "t1")
    assert moved.why == (
        "nc is later beside daq. The choice is made with 'nc' moved by -26 min there, for what the commands of one log "
        "warm, by the other one, comes at the right time so. "
        "To mend the log too, declare at this test clocks: {nc: -1560 s}; "
        "if the log's own clock was right, clocks: {nc: 0 s}, and it is not asked again"
    )
    assert "Nothing was moved for it here, for what the commands of one log warm" in kept.why
    assert "too little warms in the test" in kept.why
    (neither,) = Ends((odd("t1"),)).artefacts("other", [])
    assert neither.why.endswith(
        "Nothing was moved for it here, for the response is in neither log, and nothing tells which of them is off"
    )


def test_two_logs_that_agree_once_a_third_is_moved_are_not_told_beside_it() -> None:
    ends = Ends((odd("t1"), odd("t1", late="nc", early="log")))
    (told,) = ends.artefacts("daq", [move("t1")])
    assert told.why.startswith("nc is later beside daq. The choice is made with 'nc' moved by -26 min there")
    assert len(ends.artefacts("daq", [])) == 2


@pytest.mark.parametrize(
    ("clock", "met"),
    [
        (move("t1", -SHIFT_S + UNMOVED_S), True),
        (move("t1", -SHIFT_S + UNMOVED_S + 1), False),
        (move("t3", -SHIFT_S), False),
        (move("t1", -SHIFT_S, "log"), False),
    ],
)
def test_heat_meets_the_ends_where_it_says_nearly_the_same_of_one_of_the_tests(clock: ClockMoved, met: bool) -> None:
    assert meets([move("t1"), move("t2")], [clock]) is met
    near = clock.model_copy(update={"moved_s": clock.moved_s + 1e-3})
    assert Ends((odd("t1"), odd("t2"))).is_met([near]) is meets([move("t1"), move("t2")], [near])


def test_what_the_ends_moved_themselves_is_not_asked_again() -> None:
    assert not Ends((odd("t1"), odd("t2"))).is_met([move("t1"), move("t2")])


def test_clocks_agree_where_logs_begin_and_end_together() -> None:
    ends = Ends(together={("c", "t1"): frozenset({"nc", "daq"})})
    assert ends.agree([("c", "t0"), ("c", "t1")], {"nc", "daq"})
    assert not ends.agree([("c", "t1")], {"nc", "log"})
    assert not ends.agree([("c", "t0")], {"nc", "daq"})


@pytest.mark.parametrize(
    ("other", "alike"),
    [
        ([move("t1", source="log"), move("t2", source="log")], True),
        ([move("t1", -SHIFT_S + UNMOVED_S, "log"), move("t2", -SHIFT_S + UNMOVED_S, "log")], True),
        ([move("t1", -SHIFT_S + UNMOVED_S + 1, "log"), move("t2", -SHIFT_S + UNMOVED_S + 1, "log")], False),
        ([move("t1", source="log")], False),
    ],
)
def test_logs_that_stand_elsewhere_in_the_same_tests_by_the_same_are_moved_together(
    other: list[ClockMoved], alike: bool
) -> None:
    """Then the clock of the response is off, and one log without commands would be left behind."""
    assert is_alike([move("t1"), move("t2")], other) is alike


def test_where_heat_moved_what_the_ends_tell_too_nothing_is_said_of_it_twice() -> None:
    """The response is in neither log."""
    ends = Ends((odd("t1"),))
    assert ends.artefacts("other", [move("t1", -SHIFT_S + 100.0)]) == []
    assert len(ends.artefacts("other", [])) == 1


def test_a_hint_that_was_not_acted_upon_says_which_line_to_try() -> None:
    odd = OddEnds("c", "feed20", "nc", "log", 2405.0, "odd ends")
    (told,) = Ends((odd,)).artefacts("log", [])
    assert "write clocks: {nc: -2405 s} into the line of test 'feed20'" in told.why
    (elsewhere,) = Ends((odd,)).artefacts("third", [])
    assert "To try it" not in elsewhere.why


def test_which_line_to_try_is_said_once() -> None:
    odd = OddEnds(
        "c", "feed20", "nc", "log", 2405.0, "odd ends: try clocks: {nc: -2405 s} or {log: 2405 s}", "odd ends"
    )
    (told,) = Ends((odd,)).artefacts("log", [])
    assert told.why.startswith("odd ends. Nothing was moved for it here")
    assert told.why.count("clocks: {") == 1
    (moved,) = Ends((odd,)).artefacts("log", [ClockMoved(source="nc", campaign="c", test="feed20", moved_s=-2405.0)])
    assert moved.why.startswith("odd ends. The choice is made with 'nc' moved by -40.1 min there")
    (elsewhere,) = Ends((odd,)).artefacts("third", [])
    assert elsewhere.why.startswith("odd ends: try clocks: {nc: -2405 s}"), "there nobody knows which"


def test_a_clock_in_doubt_comes_before_the_next_test() -> None:
    assert after_clocks(["t1"], "to exclude it: heat it") == (
        "first try the clock in t1 as the artefact says, for all else hangs on it; then to exclude it: heat it"
    )
    assert after_clocks([], "heat it") == "heat it"
    assert after_clocks(["t1"], None) is None, "the verdict says it"


def test_logs_that_are_hours_apart_in_all_tests_are_told_unless_heat_moved_one() -> None:
    ends = Ends(hours={"c": [HoursApart("daq", "nc", 3600.0, 8)]})
    (told,) = ends.artefacts("daq", [])
    assert (told.kind, told.campaign, told.test) == ("clock_offset", "c", None)
    assert told.why.startswith("source 'daq' begins and ends 1 h later than 'nc' in all 8 tests")
    assert "Nothing was moved for it here" in told.why
    by_heat = ClockMoved(source="nc", campaign="", test="", moved_s=3600.0)
    assert ends.artefacts("daq", [by_heat]) == []


def test_a_clock_that_is_declared_for_all_tests_is_told_of_the_one_that_stands_elsewhere_and_not_moved() -> None:
    """The line of that test stands in place of the declared 89 s."""
    odd = OddEnds("c", "stair", "nc", "daq", 1500.0, "said", "seen", {"nc": 89.0 - 1500.0, "daq": 1500.0}, stays=True)
    ends = Ends((odd,))
    assert ends.moves("daq") == []
    (told,) = ends.artefacts("daq", [])
    assert told.why.startswith("seen. Nothing was moved for it here, for the campaign file declares one of the two")
    assert "write clocks: {nc: -1411 s} into the line of test 'stair'" in told.why
