"""A clock that is off in a part of the tests (clocks/sides.py), by heat and by what commands move at once."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest

from thermodata.diagnosis.clocks.by_commands import timings
from thermodata.diagnosis.clocks.by_heat import as_artefact, late_in_one, late_logs
from thermodata.diagnosis.clocks.logs_compared import Late, Logs, compared
from thermodata.diagnosis.clocks.moves import moved
from thermodata.diagnosis.clocks.sides import Key, ShiftedPart, Sides, in_order, in_words, part_of
from thermodata.diagnosis.clocks.timings import Timing
from thermodata.diagnosis.clocks.timings import as_artefact as by_commands
from thermodata.view.grid.dataset import TestData

from .test_rules_of_clocks_by_commands import CHANNELS as SPEED
from .test_rules_of_clocks_by_commands import off_by
from .test_rules_of_clocks_by_heat import CHANNELS, STEP_S, logged


def keys(numbers: Sequence[int]) -> tuple[Key, ...]:
    return tuple(("c", f"t{n}") for n in numbers)


def late(logs: Logs) -> list[Late]:
    """As a diagnosis asks: of all tests, then of each."""
    return late_logs(logs) or late_in_one(logs, {})


def asked(tests: list[TestData], **more: object) -> list[Late]:
    return late(compared(tests, CHANNELS, "dZ", STEP_S, **more))  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("off", "right", "taken", "plain", "since", "until"),
    [
        ((3, 4), (1, 2), (3, 4, 5), True, 3, None),  # t5 tells nothing, and comes behind those that are off
        ((3, 5), (1,), (3, 4, 5), True, 3, None),  # between two that are off, too
        ((4, 5), (1,), (4, 5), True, 4, None),  # t2 and t3 lie between: nobody knows when it changed
        ((0, 1), (4, 5), (0, 1), True, None, 1),
        ((2,), (0, 1, 3, 4), (2,), True, None, None),
        ((0, 2, 4), (1, 3), (0, 2, 4, 5), False, None, None),  # here and there, in most of them
        ((1, 4), (0, 2, 3), (1, 4, 5), True, None, None),
    ],
)
def test_which_tests_a_shift_holds_in(
    off: tuple[int, ...],
    right: tuple[int, ...],
    taken: tuple[int, ...],
    plain: bool,
    since: int | None,
    until: int | None,
) -> None:
    found = part_of(keys(range(6)), set(keys(off)), set(keys(right)))
    assert (found.off, found.right, found.plain) == (keys(taken), keys(right), plain)
    assert found.since == (None if since is None else ("c", f"t{since}"))
    assert found.until == (None if until is None else ("c", f"t{until}"))


def test_tests_lie_in_the_order_of_their_days() -> None:
    first, second, *_ = logged()
    dated = [replace(first, start_unix_s=2e5), replace(second, start_unix_s=1e5)]
    assert in_order(dated) == [second.key, first.key]
    assert in_order([first, replace(second, start_unix_s=1e5)]) == [first.key, second.key]


@pytest.mark.parametrize("only", [(5, 6), (4, 5, 6), (3, 4, 5, 6), (1, 2, 3, 4, 5, 6)])
@pytest.mark.parametrize("minutes", [-60, 40])
def test_a_clock_that_is_off_from_a_test_on_is_moved_in_these(only: tuple[int, ...], minutes: float) -> None:
    """In most tests, too: heat acts at once, so those that agree as they were logged are right."""
    [found] = asked(logged({"nc": minutes}, tests=7, only=only))
    assert found.part is not None
    assert (found.source, found.part.off, found.part.since) == ("nc", keys(only), ("c", f"t{only[0]}"))
    assert found.shift_s / 60 == pytest.approx(-minutes, abs=4)
    assert [(c.test, c.moved_s) for c in found.moves()] == [(f"t{n}", found.shift_s) for n in only]
    said = as_artefact(found, "c")
    assert said.test == f"t{only[0]}"
    assert f"from t{only[0]} on (" in said.why
    assert f"declare at these tests clocks: {{nc: {found.shift_s:.0f} s}}; if it was right" in said.why


def test_a_clock_that_was_put_right_is_off_up_to_a_test() -> None:
    [found] = asked(logged({"log": 60}, tests=4, only=(0, 1)))
    assert found.part is not None
    assert (found.source, found.part.off, found.part.until) == ("log", keys((0, 1)), ("c", "t1"))
    assert "up to t1 (t0 and t1), while in t2 and t3 they agree as they were logged" in as_artefact(found, "c").why


def test_a_clock_that_is_off_in_all_tests_is_off_in_no_part_of_them() -> None:
    [found] = asked(logged({"nc": 60}, tests=7))
    assert found.part is None
    assert [(c.source, c.test) for c in found.moves()] == [("nc", "")]
    assert asked(logged(tests=7)) == []


def test_in_most_tests_here_and_there_it_is_said_and_none_is_moved() -> None:
    found = asked(logged({"log": 60}, tests=7, only=(0, 2, 4, 6)))
    assert [(f.source, f.moves()) for f in found] == [(None, [])]
    assert "nothing tells which of the two is the rule" in as_artefact(found[0], "c").why


def test_a_test_that_tells_nothing_goes_with_those_around_it() -> None:
    def waits(test: TestData) -> TestData:
        rest = {name: np.zeros(len(test.t_s)) for name in ("n", "v")}
        rng = np.random.default_rng(2)
        cold = {name: 20 + 0.1 * rng.normal(size=len(test.t_s)) for name in ("T_front", "T_nut")}
        return replace(test, values={**test.values, **rest, **cold})

    tests = logged({"nc": 60}, tests=7, only=(3, 4, 5, 6))
    tests[1], tests[5] = waits(tests[1]), waits(tests[5])
    [found] = asked(tests)
    assert found.part is not None
    assert (found.part.off, found.part.right) == (keys((3, 4, 5, 6)), keys((0, 2)))


def test_locked_tests_are_moved_with_those_around_them_and_their_response_is_not_read() -> None:
    tests = logged({"nc": 60}, tests=7, only=(4, 5, 6))
    blind = [
        replace(tests[k], role="locked", values={**tests[k].values, "dZ": np.full(len(tests[k].t_s), np.nan)})
        for k in (4, 6)
    ]
    [found] = asked([t for k, t in enumerate(tests) if k not in (4, 6)], locked=blind)
    assert found.part is not None
    assert set(found.part.off) == set(keys((4, 5, 6)))


def test_a_test_whose_clock_somebody_declared_says_nothing_of_the_others() -> None:
    """It was put right at the third of four tests that are off: the rest are not right for that."""
    tests = logged({"nc": 60}, tests=7, only=(3, 4, 6))
    [found] = asked(tests, declared={("c", "t5"): {"nc"}})
    assert found.part is not None
    assert (found.part.off, found.part.since) == (keys((3, 4, 6)), ("c", "t3"))


@pytest.mark.parametrize("only", [(3, 4), (2, 3, 4), (1, 2, 3, 4)])
@pytest.mark.parametrize("samples", [11, -25])
def test_what_commands_move_at_once_tells_from_which_test_on(only: tuple[int, ...], samples: int) -> None:
    problem = off_by(0, apart=dict.fromkeys(only, samples))
    order = [b.test.key for b in problem.blocks]
    [found] = timings(problem, SPEED).off()
    assert found.part is not None
    assert (found.part.off, found.part.since) == (tuple(order[k] for k in only), order[only[0]])
    assert {(c.test, c.moved_s) for c in found.moves()} == {(order[k][1], -60.0 * samples) for k in only}
    said = by_commands(found, problem)
    assert said.test == order[only[0]][1]
    assert f"from {order[only[0]][1]} on" in said.why


def test_commands_that_are_off_in_all_tests_or_in_one_are_so_in_no_part() -> None:
    for problem in (off_by(11), off_by(0, apart={2: 11})):
        assert [t.part for t in timings(problem, SPEED).off()] == [None]


def test_beyond_the_end_of_a_log_that_is_moved_nothing_is_valid() -> None:
    test = logged()[0]
    earlier = moved(test, {"n": -600.0})
    assert earlier.valid["n"][:-10].all()
    assert not earlier.valid["n"][-10:].any()
    assert earlier.valid["v"].all()
    begun = replace(test, valid={**test.valid, "n": test.t_s >= 600.0})
    assert moved(begun, {"n": -600.0}).valid["n"][0], "what was logged later belongs here"


@pytest.mark.parametrize(
    ("unmoved", "moved", "off", "right"),
    [
        (0.3, 0.451, True, False),
        (0.3, 0.449, False, False),
        (0.451, 0.3, False, True),
        (0.449, 0.3, False, False),
        (-0.5, 0.19, False, False),
        (-0.5, 0.21, True, False),
    ],
)
def test_a_test_tells_where_one_time_foretells_more_than_the_other(
    unmoved: float, moved: float, off: bool, right: bool
) -> None:
    one = Sides(keys((0,)), 3600.0, np.array([0.0, 3600.0]), np.array([[unmoved, moved]]))
    assert (bool(one.off), bool(one.right)) == (off, right)


def test_a_part_in_words() -> None:
    assert in_words(None) == ""
    assert in_words(ShiftedPart(keys((1, 3)), ())) == " in t1 and t3"
    assert Timing("nc", 600.0, 0.5, 0.0, part=ShiftedPart(keys((1,)), keys((0,)))).moves()[0].test == "t1"


@pytest.mark.parametrize("failed", ["all", "none"])
def test_a_locked_test_in_which_a_logger_was_dead_takes_nothing_from_the_open_ones(failed: str) -> None:
    *tests, last = logged({"log": 40.0}, tests=5)
    dead = {
        n: replace(c, faulty="stuck" if c.quantity == "temperature" and failed == "all" else None)
        for n, c in CHANNELS.items()
    }
    [found] = late_logs(compared(tests, CHANNELS, "dZ", STEP_S, locked=[replace(last, role="locked", channels=dead)]))
    assert (found.source, round(found.shift_s / 60)) == ("log", pytest.approx(-40, abs=4))


def test_where_the_ends_of_the_logs_agree_what_is_late_is_within_a_log() -> None:
    """Else the clock that is declared is advised, and ingest advises to take it back."""
    problem = off_by(0, apart={3: 11})
    [found] = [t for t in timings(problem, SPEED).off() if t.test]
    assert "begin and end together" not in by_commands(found, problem).why
    said = by_commands(found, problem, ends_agree=True).why
    assert "declare at the test clocks: {" in said
    assert "The logs begin and end together in this test" in said
    assert "came late within their log" in said
