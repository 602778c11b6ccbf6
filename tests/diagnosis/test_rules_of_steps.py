"""What is a step of a probe and what is not (steps/artefact.py), just inside and just outside each limit."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from thermodata.diagnosis.steps.artefact import (
    Z_ALONE,
    _step_score,
    as_artefacts,
    find_steps,
    is_a_step,
    is_at_once,
    noise_with_treads,
    tread_of_response,
)
from thermodata.diagnosis.steps.commanded import tells, through_zero
from thermodata.diagnosis.steps.step import Step
from thermodata.diagnosis.steps.sudden import beyond_slopes, most_sudden, over_three, size_of_step, suddenly
from thermodata.diagnosis.verdict.investigate import _without_steps
from thermodata.plugin import Float1D
from thermodata.view.grid.dataset import ChannelInfo

from .hand_made import Parts, problem

SIDE = 20  # samples of 60 s in 1200 s


@pytest.mark.parametrize(
    ("z", "size", "noise", "step"),
    [
        (12.01, 5.0, 0.1, True),
        (11.99, 5.0, 0.1, False),
        (20.0, 0.301, 0.1, False),
        (20.0, 0.501, 0.1, True),
        (20.0, -0.501, 0.1, True),
        (20.0, 0.499, 0.1, False),
        (20.0, 3.01, 1.0, True),
        (20.0, 2.99, 1.0, False),
    ],
)
def test_a_step_is_twelve_times_the_usual_change_three_noises_and_half_a_um(
    z: float, size: float, noise: float, step: bool
) -> None:
    assert is_a_step(z, size, noise) is step


@pytest.mark.parametrize(("z", "step"), [(5.01, True), (4.99, False)])
def test_what_stands_alone_needs_five_times_the_usual_change(z: float, step: bool) -> None:
    assert is_a_step(z, 5.0, 0.1, least=Z_ALONE) is step


def rough(n: int, seed: int = 0) -> Float1D:
    return 0.05 * np.random.default_rng(seed).normal(size=n)


def stepped(*at: int, n: int = 300, size: float = 5.0) -> Float1D:
    return rough(n) + sum(size * (np.arange(n) >= i) for i in at)


def steps(residual: Float1D, **more: dict) -> list[tuple[float, float]]:
    found = find_steps(problem(Parts(residual, **more), noise=0.05))
    return sorted((s.at_s, round(s.size, 1)) for s in found)


def test_a_step_is_found_between_its_samples() -> None:
    assert steps(stepped(100)) == [(99.5 * 60.0, pytest.approx(5.0, abs=0.2))]
    assert steps(rough(300)) == []


def missing_much(other: float = 0.0, many: int = 2, slip: float = 5.0) -> Float1D:
    """A model that lacks 14 um: lines over 20 min differ everywhere, and a slip is 7 times what they usually do. Much
    later the probe is moved by `other`, for so many samples."""
    i = np.arange(400)
    return rough(400) + 14.0 * np.sin(i / 25) + slip * (i >= 110) + other * ((i >= 220) & (i < 220 + many))


@pytest.mark.parametrize(("other", "found"), [(0.0, [109.5]), (2.3, [109.5]), (2.7, [])])
def test_where_much_is_missing_a_slip_is_what_is_twice_as_sudden_as_all_else(other: float, found: list[float]) -> None:
    course = missing_much(other)
    score, _ = _step_score(course, np.arange(400) * 60.0, SIDE)
    assert 5 < score[110] < 12
    assert [at / 60 for at, _ in steps(course)] == found


def test_a_step_that_stands_alone_says_by_how_much() -> None:
    [artefact] = as_artefacts(find_steps(problem(Parts(missing_much(2.3)), noise=0.05)), "um")
    assert "2.3 times as suddenly as anything else in this test" in artefact.why


@pytest.mark.parametrize(("size", "many", "found"), [(5.0, 2, []), (9.0, 2, []), (5.0, 8, [109.5])])
def test_what_comes_back_stands_alone_and_is_no_slip(size: float, many: int, found: list[float]) -> None:
    """The levels on both sides differ by less than half of what happens at once."""
    blip = missing_much(slip=0.0) + size * ((np.arange(400) >= 110) & (np.arange(400) < 110 + many))
    assert [at / 60 for at, _ in steps(blip)][:1] == found


def test_how_suddenly_is_what_lies_beyond_the_slopes() -> None:
    """At each sample the same as is asked of one; nothing at ends, and in holes."""
    x, t = missing_much(2.3), np.arange(400) * 60.0
    t[300:] += 600.0
    every = suddenly(x, t, SIDE)
    for i in (50, 109, 110, 111, 221):
        rise = x[i + 1] - x[i - 2]
        assert every[i] == pytest.approx(max(beyond_slopes(x, t, i, rise, SIDE), 0.0))
    assert (every[[0, 1, 6, 399, 300]] == 0).all()
    i, times = most_sudden(x, t, np.arange(400) == 110, SIDE)
    assert (i, times) == (110, pytest.approx(every[110] / every[215:225].max()))
    assert most_sudden(x, t, np.zeros(400, dtype=bool), SIDE)[1] == 0.0


@pytest.mark.parametrize("part", [0.0, 0.3, 0.5, 0.7])
def test_the_size_of_a_step_is_that_of_its_levels_where_a_mean_parts_it(part: float) -> None:
    """Also where the machine warms quickly after it, so that lines over 20 min on both sides say half of it."""
    i = np.arange(300)
    course = 9.0 * (i >= 100) - 9.0 * part * (i == 100) - 6.0 * (1 - np.exp(-np.maximum(i - 100, 0) / 12))
    [(_, size)] = steps(rough(300) + course)
    assert size == pytest.approx(9.0, abs=0.5)


@pytest.mark.parametrize(("every", "left_out"), [(1, 2), (2, 2), (3, 1), (5, 2)])
def test_what_holds_a_part_of_a_step_is_not_weighed(every: int, left_out: int) -> None:
    """The two samples beside it, and the means that either of them is in, where candidates are weighed in fewer."""
    course = 5.0 * (np.arange(300) >= 100) - 2.0 * (np.arange(300) == 100)
    parts = course.reshape(-1, every).mean(axis=1)
    weighed = problem(Parts(parts), noise=0.05)
    t_s = (np.arange(len(parts)) * every + (every - 1) / 2) * 60.0
    weighed = replace(weighed, step_s=60.0 * every, blocks=(replace(weighed.blocks[0], t_s=t_s),))
    none: Any = SimpleNamespace(terms=())
    left = _without_steps(none, weighed, [Step(weighed.blocks[0].test, 99.5 * 60.0, 5.0, 20.0)], 60.0)
    assert left.rows == weighed.rows - left_out
    assert np.abs(left.blocks[0].residual).max() < 1e-9


@pytest.mark.parametrize("slope", [-1.0, 0.0, 1.0])
def test_a_size_is_told_beside_slopes_without_both_samples_at_the_step(slope: float) -> None:
    k = np.arange(300)
    x = slope * k + 5.0 * (k >= 100) + 40.0 * ((k == 99) | (k == 100))
    assert size_of_step(x, MINUTES, 100, SIDE) == pytest.approx(5.0)
    assert size_of_step(x[96:104], MINUTES[96:104], 4, 4) == pytest.approx(5.0), "of coarse samples a side has four"


def test_at_most_three_steps_a_test() -> None:
    assert len(steps(stepped(60, 120, 180))) == 3
    assert len(steps(stepped(60, 120, 180, 240))) == 3


@pytest.mark.parametrize(("n", "found"), [(3 * SIDE, 1), (3 * SIDE - 1, 0)])
def test_a_test_must_be_three_sides_long(n: int, found: int) -> None:
    assert len(steps(stepped(SIDE, n=n))) == found


@pytest.mark.parametrize(("shares", "sharp"), [((0.34, 0.33, 0.33), True), ((0.25, 0.25, 0.25, 0.25), False)])
def test_a_rise_over_several_samples_is_no_step(shares: tuple[float, ...], sharp: bool) -> None:
    """At least 0.4 of its size, as the means of both sides see it, happens between two samples."""
    r = sum(5.0 * share * (np.arange(300) >= 100 + k) for k, share in enumerate(shares)) + rough(300)
    score, _ = _step_score(np.asarray(r), np.arange(300) * 60.0, SIDE)
    assert bool(score.max() > 12) is sharp


def test_a_slope_and_a_bend_are_no_step() -> None:
    i = np.arange(300)
    assert steps(rough(300) + 0.5 * i) == []
    assert steps(rough(300) + 0.1 * np.maximum(i - 150, 0)) == []


@pytest.mark.parametrize(("gap", "found"), [(1.55, True), (1.65, False)])
def test_what_happens_in_a_hole_is_no_step(gap: float, found: bool) -> None:
    """A hole: 1.6 times the usual distance of samples."""
    t = np.arange(300) * 60.0
    t[100:] += (gap - 1.0) * 60.0
    score, _ = _step_score(stepped(100), t, SIDE)
    assert bool(score[100] > 12) is found


def in_windows_of(
    samples: int, pause: int, *, count: int = 30, slip_after: int | None = None, inside: int = 0
) -> list[tuple[float, float]]:
    """Steps found where a test is measured for so many samples of 60 s at a time. slip_after: so many windows; inside:
    so many samples into the next one."""
    at = np.concatenate([k * (samples + pause) + np.arange(samples) for k in range(count)])
    r = rough(len(at))
    if slip_after is not None:
        r = r + 5.0 * (np.arange(len(at)) >= slip_after * samples + inside)
    asked = problem(Parts(r), noise=0.05)
    t_s = at * 60.0
    return sorted(
        (s.at_s, round(s.size)) for s in find_steps(replace(asked, blocks=(replace(asked.blocks[0], t_s=t_s),)))
    )


@pytest.mark.parametrize(("samples", "pause"), [(1, 5), (2, 4), (4, 6)])
def test_a_slip_between_windows_is_found(samples: int, pause: int) -> None:
    """Where a machine is measured at every stop, most slips happen between two."""
    assert in_windows_of(samples, pause) == []
    period = (samples + pause) * 60.0
    [(at_s, size)] = in_windows_of(samples, pause, slip_after=15)
    assert 14 * period < at_s < 15 * period
    assert size == 5


def test_a_slip_within_a_window_is_found_once() -> None:
    assert len(in_windows_of(20, 25, slip_after=15, inside=4)) == 1


@pytest.mark.parametrize(("count", "found"), [(13, 1), (12, 0)])
def test_a_few_windows_are_holes(count: int, found: int) -> None:
    assert len(in_windows_of(2, 4, count=count, slip_after=6)) == found


def test_what_is_measured_through_has_holes_and_no_windows() -> None:
    """Where it is measured for longer than it is not."""
    assert in_windows_of(6, 4, slip_after=15) == []


def jumps_of(
    *levels: float, at: int = 100, of: float = 0.0, lag: int = 0, noise: float = 0.05
) -> tuple[Float1D, Float1D]:
    """A test of 400 samples: (residual, command). The command takes the levels every 40 samples from `at` on, and the
    residual follows with `of` times as much, `lag` samples later."""
    t = np.arange(400)
    command = np.zeros(400)
    for k, level in enumerate(levels):
        command[t >= at + 40 * k] = level
    return of * np.concatenate([np.zeros(lag), command[: 400 - lag]]) + rough(400) * noise / 0.05, command


def in_tests(*tests: tuple[Float1D, Float1D], quantity: str = "rotational_speed") -> list[tuple[str, float]]:
    """(test, size) of every step that is found, the tests' commands being of a quantity."""
    channel = {"u": ChannelInfo("u", quantity, "1", at="spindle")}
    parts = (Parts(r, values={"u": u}, channels=channel) for r, u in tests)
    found = find_steps(problem(*parts, noise=0.05))
    return sorted((s.test.test, round(s.size)) for s in found)


def slipped(test: tuple[Float1D, Float1D], at: int, size: float = 5.0) -> tuple[Float1D, Float1D]:
    residual, command = test
    return residual + size * (np.arange(len(residual)) >= at), command


@pytest.mark.parametrize("quantity", ["rotational_speed", "feed", "power", "state", "load", "flow", "temperature"])
def test_a_command_that_makes_steps_elsewhere_explains_one(quantity: str) -> None:
    """A temperature jumps where one body takes the place of another."""
    shifting = [jumps_of(1.0, of=5.0), jumps_of(1.0, 0.0, of=5.0)]
    assert in_tests(*shifting, quantity=quantity) == []


def test_a_motor_that_cools_once_its_axis_rests_excuses_no_slip() -> None:
    """It falls fast from the stop on, and nowhere else: no other body has taken its place."""
    at = 200
    cooling = np.where(np.arange(400) < at, 1.0, np.exp(-(np.arange(400) - at) / 12))
    still = (rough(400), cooling)
    assert np.ptp(cooling[at : at + 3]) > 0.1, "as far as a command has to change"
    assert in_tests(slipped(still, at + 1), jumps_of(of=0.0), quantity="temperature") == [("t0", 5)]


@pytest.mark.parametrize(("gate", "explained"), [(0.45, False), (0.6, True), (1.3, True)])
def test_air_that_a_gate_changes_explains_its_steps_though_a_day_moves_it_much_further(
    gate: float, explained: bool
) -> None:
    def opened(test: tuple[Float1D, Float1D]) -> tuple[Float1D, Float1D]:
        return test[0], gate * test[1] + np.linspace(0.0, 15.0, len(test[1]))

    days = [opened(jumps_of(1.0, 0.0, of=5.0)), opened(jumps_of(0.0, 1.0, of=5.0))]
    assert (in_tests(*days, quantity="temperature") == []) is explained
    still = opened(jumps_of(1.0, 0.0))
    assert in_tests(slipped(still, 140), still, quantity="temperature") == [("t0", 5)], "it makes no step elsewhere"


@pytest.mark.parametrize("quantity", ["humidity", "pressure"])
def test_what_is_no_command_explains_no_step(quantity: str) -> None:
    assert len(in_tests(jumps_of(1.0, of=5.0), jumps_of(1.0, of=5.0), quantity=quantity)) == 2


def test_a_command_that_makes_no_step_elsewhere_explains_none() -> None:
    """A pump that cycles is never far from a slip."""
    pump = [jumps_of(*[1.0, 0.0] * 3) for _ in range(3)]
    assert in_tests(slipped(pump[0], 140), *pump[1:]) == [("t0", 5)]
    assert in_tests(slipped(pump[0], 146), *pump[1:]) == [("t0", 5)]


def test_a_shift_that_goes_with_the_square_of_the_speed_is_explained() -> None:
    """Centrifugal force: the same in both directions, and four times as much at twice the speed."""
    speeds = [jumps_of(*some) for some in [(1.0, 0.0, -1.0), (-1.0, 0.0, 0.5), (0.5, 1.0, 0.0), (-0.5, 0.0, -1.0)]]
    assert in_tests(*((r + 8.0 * u**2, u) for r, u in speeds)) == []


def either_way(*levels: float, of: float = 5.0) -> tuple[Float1D, Float1D]:
    """What speeds up does the same as what slows down."""
    residual, command = jumps_of(*levels)
    return residual + of * np.cumsum(np.abs(np.diff(command, prepend=command[0]))), command


def test_a_shift_that_goes_with_how_far_a_command_changes_is_explained() -> None:
    """Neither a line through the changes nor through their squares foretells it: what goes up comes down."""
    moving = [(1.0, 0.0), (0.5, 1.0, 0.5), (1.0, 0.4, 1.0), (0.6, 0.0)]
    assert in_tests(*(either_way(*levels) for levels in moving), quantity="feed") == []
    assert in_tests(*(either_way(*levels) for levels in moving), quantity="temperature") != [], "a body has a sign"


def test_a_slip_when_a_command_changes_that_does_nothing_elsewhere_is_one() -> None:
    idle = [either_way(*levels, of=0.0) for levels in [(1.0, 0.0), (0.5, 1.0, 0.5), (1.0, 0.4, 1.0)]]
    assert in_tests(slipped(idle[0], 100), *idle[1:], quantity="feed") == [("t0", 5)]
    assert in_tests(slipped(idle[1], 140), idle[0], idle[2], quantity="feed") == [("t0", 5)]


@pytest.mark.parametrize(("lag", "explained"), [(0, True), (8, True), (10, True), (13, False)])
def test_a_command_may_be_late_by_ten_minutes_everywhere(lag: int, explained: bool) -> None:
    """Clocks differ; a sample of 60 s more is in the three intervals around the change."""
    late = [jumps_of(1.0, 0.0, of=5.0, lag=lag) for _ in range(3)]
    assert (in_tests(*late) == []) is explained


def test_a_slip_just_when_the_only_change_happens_is_not_told_from_it() -> None:
    """Nothing else to compare with: then only a change in the same interval, or its neighbours, excuses."""
    assert in_tests(slipped(jumps_of(1.0), 100)) == []
    assert in_tests(slipped(jumps_of(1.0), 105)) == [("t0", 5)]


@pytest.mark.parametrize(("at", "explained"), [(180, False), (181, True), (220, True), (260, True), (261, False)])
def test_what_a_command_did_while_nobody_logged_it_may_explain(at: int, explained: bool) -> None:
    """Where it makes such steps elsewhere: the model, too, does not know what it did between the last logged sample
    and the next one."""

    def unlogged(test: tuple[Float1D, Float1D]) -> tuple[Float1D, Float1D]:
        hole = (np.arange(400) > 180) & (np.arange(400) < 260)
        return test[0], np.where(hole, np.nan, test[1])

    still = jumps_of(0.0, 0.0)
    shifting, idle = jumps_of(1.0, 0.0, 1.0, of=5.0), jumps_of(1.0, 0.0, 1.0)
    found = [] if explained else [("t0", 5)]
    assert in_tests(unlogged(slipped(still, at)), shifting, shifting) == found
    assert in_tests(unlogged(slipped(still, at)), idle, idle) == [("t0", 5)]
    warm = in_tests(unlogged(slipped(still, at)), shifting, shifting, quantity="temperature")
    assert ("t0", 5) in warm, "all heat moves a temperature: what it did unseen excuses nothing"


TENS = np.array([1.0, -1.0] * 10)


@pytest.mark.parametrize(
    ("foretold", "alike", "explained"),
    [
        *((1.0, 1.0, True), (0.21, 1.0, True), (0.19, 1.0, False), (4.9, 1.0, True), (5.1, 1.0, False)),
        *((1.0, 0.16, True), (1.0, 0.14, False), (-1.0, 1.0, False)),
    ],
)
def test_the_others_must_foretell_a_fifth_of_the_step_and_agree(foretold: float, alike: float, explained: bool) -> None:
    """A fifth to five times; a line through zero takes away 0.15 of their squares at least."""
    other = np.repeat([1.0, 1.0, -1.0, -1.0], 5) * np.sqrt(1 / alike - 1)
    assert through_zero(TENS, TENS + other)[1] == pytest.approx(alike)
    assert tells(1.0, foretold, TENS, TENS + other, at_once=False) is explained


@pytest.mark.parametrize("at_once", [True, False])
def test_where_nothing_is_elsewhere_the_time_decides(at_once: bool) -> None:
    assert tells(1.0, 1.0, np.empty(0), np.empty(0), at_once=at_once) is at_once


@pytest.mark.parametrize(("change", "found"), [(0.06, []), (0.04, ["t0", "t1"])])
def test_a_command_must_change_by_a_twentieth_of_its_range_in_all_tests(change: float, found: list[str]) -> None:
    """What a channel does at rest is noise, however large a part of a quiet test it is."""
    tests = [jumps_of(change, of=5.0 / change), jumps_of(change, of=5.0 / change), jumps_of(1.0, of=5.0 / change)]
    assert [t for t, _ in in_tests(*tests)] == found


@pytest.mark.parametrize(("speed", "found"), [(0.97, []), (0.98, ["t0"])])
def test_a_twentieth_of_the_range_is_of_the_power_by_which_it_acts(speed: float, found: list[str]) -> None:
    """Of the square a spindle that slows a little changes by more: from 12,000 to 11,650 rpm by a twentieth of it."""
    t = np.arange(400)
    slows = np.where(t < 40, 0.0, np.where(t < 300, 1.0, speed))
    others = [jumps_of(1.0, 0.0, 0.7, 0.0, -1.0) for _ in range(2)]
    r = rough(400) * 0.1
    shifts = [(r + 40.0 * u**2, u) for u in (slows, *(u for _, u in others))]
    assert [name for name, _ in in_tests(*shifts)] == found


@pytest.mark.parametrize(("apart", "found"), [(19, [("t0", 5), ("t0", 5)]), (20, [])])
def test_elsewhere_is_more_than_twenty_minutes_away(apart: int, found: list[tuple[str, float]]) -> None:
    """A change counts for the sample of its own and both beside it. Nearer ones see the step itself."""
    command = (np.arange(400) >= 135) + 1.0 * (np.arange(400) >= 135 + apart)
    twice = slipped(slipped((rough(400), command), 140), 140 + apart)
    assert in_tests(twice) == found


def test_what_happens_between_two_samples_is_whole_over_three_intervals() -> None:
    t = np.arange(10) * 60.0
    x = np.where(np.arange(10) >= 5, 4.0, 0.0)
    x[5] = 2.0  # a mean over both parts it
    assert over_three(x, t)[5] == 4.0
    assert np.isnan(over_three(x, t)[[0, 1, 9]]).all()
    t[5:] += 0.65 * 60.0
    assert np.isnan(over_three(x, t)[5])


@pytest.mark.parametrize(("residual", "at_once"), [(0.71, True), (0.69, False), (2.0, True)])
def test_seven_tenths_of_a_step_stand_out_from_the_slopes_beside_it(residual: float, at_once: bool) -> None:
    for size in (4.0, -4.0):
        assert is_at_once(size, 4.0 * residual, 4.0) is at_once


@pytest.mark.parametrize(
    ("response", "at_once"), [(0.31, True), (0.29, False), (-1.0, False), (3.3, True), (3.4, False)]
)
def test_the_response_makes_the_step_and_not_a_much_larger_one(response: float, at_once: bool) -> None:
    """Three tenths of it, and its inverse."""
    for size in (4.0, -4.0):
        assert is_at_once(size, 4.0, 4.0 * response) is at_once


def test_in_a_hole_nothing_is_at_once() -> None:
    assert not is_at_once(4.0, float("nan"), 4.0)
    assert not is_at_once(4.0, 4.0, float("nan"))


MINUTES = np.arange(300) * 60.0


def beside(x: Float1D, i: int, sign: float = 1.0) -> float:
    return beyond_slopes(np.asarray(x, dtype=float), MINUTES, i, sign, SIDE)


@pytest.mark.parametrize("slope", [-3.0, -0.3, 0.3, 3.0])
@pytest.mark.parametrize("i", range(95, 107))
def test_a_bend_leaves_nothing_beyond_its_slopes(slope: float, i: int) -> None:
    k = np.arange(300)
    for bend in (slope * np.maximum(k - 100, 0), slope * np.minimum(k - 100, 0), slope * k):
        assert beside(bend, i, slope) <= 1e-9


@pytest.mark.parametrize("slope", [-1.0, 0.0, 1.0])
def test_a_step_on_a_slope_is_whole_beyond_it(slope: float) -> None:
    """Also one that goes against the slope, and one that a mean parts."""
    k = np.arange(300)
    assert beside(slope * k + 5.0 * (k >= 100), 100) == pytest.approx(5.0)
    assert beside(slope * k - 5.0 * (k >= 100), 100, -1.0) == pytest.approx(5.0)
    assert beside(slope * k + 5.0 * (k >= 100) - 2.0 * (k == 100), 100) == pytest.approx(5.0)


@pytest.mark.parametrize(("long", "beyond"), [(3, 1.0), (4, 0.75 - 3 / 28), (5, 0.6 - 6 / 70), (13, 0.0), (20, 0.0)])
def test_a_ramp_leaves_the_less_the_longer_it_lasts(long: int, beyond: float) -> None:
    """In its middle: three intervals of it, beyond the slope over the five on either side."""
    ramp = np.clip(np.arange(300) - (100 - (long + 1) // 2), 0, long) / long
    assert beside(ramp, 100) == pytest.approx(beyond, abs=1e-9)


def test_slopes_are_known_beside_a_hole() -> None:
    """By the clock: what moves on over a hole is no steeper."""
    t = MINUTES.copy()
    t[103:] += 1800.0
    assert beyond_slopes(t / 60.0 + 5.0 * (t >= t[100]), t, 100, 1.0, SIDE) == pytest.approx(5.0)


@pytest.mark.parametrize("least_side", [4, 5, 20])
def test_slopes_stay_within_the_sides_of_a_step(least_side: int) -> None:
    """Where samples are coarse a side has four of them."""
    x = 5.0 * (np.arange(2 * least_side) >= least_side)
    assert beyond_slopes(x, 60.0 * np.arange(len(x)), least_side, 1.0, least_side) == pytest.approx(5.0)


def heat_begins(slip: float = 0.0, n: int = 300) -> Float1D:
    """0.3 um a minute for a quarter of an hour, begun by a quick one, as in a sound test of a machining centre."""
    k = np.arange(n)
    course = -0.3 * np.clip(k - 100, 0, 15) - 1.2 * (1 - np.exp(-np.maximum(k - 100, 0) / 1.5))
    return rough(n) + course + slip * (k >= 104)


def test_a_bend_is_no_slip_and_a_slip_in_it_is_one() -> None:
    assert steps(heat_begins()) == []
    assert [at for at, _ in steps(heat_begins(-4.0))] == [103.5 * 60.0]
    assert [at for at, _ in steps(heat_begins(4.0))] == [103.5 * 60.0]


def test_the_shoulder_of_a_bend_is_no_slip() -> None:
    """What stands out most is judged, and nothing within ten minutes of it: a spindle that starts, and stops for every
    new tool. Residual and response of a sound machine."""
    left = [1.1, 1.8, 0.0, -0.9, -1.6, -2.0, -1.5, -0.5, -0.6, -1.1, -1.0, -0.7, 0.2, -0.2, -0.4, -0.7, -0.2]
    read = [-0.5, 0.5, 0.0, -1.2, -2.4, -3.5, -5.6, -3.6, -4.2, -5.2, -5.6, -7.6, -5.5, -6.0, -6.5, -7.0, -8.6]
    r, y = (rough(300) + np.interp(np.arange(300), np.arange(98, 98 + len(x)), x) for x in (left, read))
    _, size = _step_score(r, MINUTES, SIDE)
    assert abs(size[100]) > abs(size[101])
    assert not is_at_once(size[100], beside(r, 100, size[100]), beside(y, 100, size[100]))
    assert is_at_once(size[101], beside(r, 101, size[101]), beside(y, 101, size[101]))
    assert steps(r, response=y) == []


def test_what_only_the_model_does_is_no_slip() -> None:
    """A driver read in steps of 1 K makes the prediction jump, and so the residual."""
    slow = 3.0 * np.sin(np.arange(300) / 60)
    assert steps(stepped(100), response=slow + rough(300)) == []
    assert len(steps(stepped(100), response=slow + stepped(100))) == 1


def test_what_a_model_leaves_of_a_much_larger_jump_is_no_slip() -> None:
    assert len(steps(stepped(100), response=3.0 * stepped(100))) == 1
    assert steps(stepped(100), response=3.6 * stepped(100)) == []


@pytest.mark.parametrize(("size", "step"), [(2.51, True), (2.49, False), (-2.51, True)])
def test_a_step_is_larger_than_a_tread_by_the_same_limits(size: float, step: bool) -> None:
    """Rounding to treads moves either side's level by half a tread at most."""
    assert is_a_step(20.0, size, 0.1, tread=2.0) is step


def stairs(slip: float = 0.0) -> Float1D:
    """A slow course of 15 um, read in treads of 2 um."""
    t = np.arange(600)
    return np.round((15 * np.sin(t / 120) + slip * (t >= 300)) / 2) * 2


def test_treads_are_no_slips_and_a_slip_among_treads_is_found() -> None:
    def found(x: Float1D) -> list[int]:
        values = {"dZ": x}
        smooth = 15 * np.sin(np.arange(600) / 120)
        return [round(s.at_s / 60) for s in find_steps(problem(Parts(x - smooth, values=values)))]

    assert tread_of_response(problem(Parts(stairs(), values={"dZ": stairs()}))) == pytest.approx(2.0)
    assert found(stairs()) == []
    assert found(stairs(8.0)) == [300]


def gauges(slip: float = 0.0) -> list[Parts]:
    """Six tests of 6 h on a grid of 60 s, warming by 3 to 14 um, read in treads of 2 um behind a converter with 0.1 um
    of noise that counts in 0.086 um; in the first one the probe slips."""
    parts = []
    for seed in range(6):
        rng = np.random.default_rng(seed)
        t = np.arange(21_600)
        warm = rng.uniform(3, 14) * (1 - np.exp(-t / rng.uniform(3000, 9000)))
        read = np.round((warm + (slip if seed == 0 else 0.0) * (t >= 10_800) + rng.normal(0, 0.05, len(t))) / 2) * 2
        counted = np.round((read + rng.normal(0, 0.1, len(t))) / 0.086) * 0.086
        bins = counted.reshape(-1, 60).mean(axis=1)
        parts.append(Parts(bins - warm.reshape(-1, 60).mean(axis=1), values={"dZ": bins}))
    return parts


@pytest.mark.parametrize(("slip", "found"), [(0.0, []), (8.0, [180])])
def test_treads_behind_a_converter_with_noise_are_no_slips(slip: float, found: list[int]) -> None:
    asked = problem(*gauges(slip))
    assert tread_of_response(asked) == pytest.approx(2.0, rel=0.03)
    assert [round(s.at_s / 60) for s in find_steps(asked)] == found
    assert noise_with_treads(asked) == pytest.approx(2.0 / np.sqrt(12), rel=0.03)
    assert noise_with_treads(replace(asked, noise=0.7)) == 0.7
