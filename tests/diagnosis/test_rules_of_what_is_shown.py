"""Weak spots, what is said of the unknown, and which test comes next: weak.py, unexplained.py, next_test.py,
to_find.py."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from thermodata.diagnosis.claims.probability import probability
from thermodata.diagnosis.locked.confirmation import Confirmation
from thermodata.diagnosis.question.weak import describe_state, weak_spots
from thermodata.diagnosis.tell.advising.next_test import (
    to_bear_out,
    to_decide,
    to_exclude,
    to_separate,
    to_tell_apart,
    to_tell_parts,
)
from thermodata.diagnosis.tell.advising.to_find import to_find
from thermodata.diagnosis.tell.candidate.ladder import of_probability
from thermodata.diagnosis.tell.candidate.of_claim import in_spite_of, placeless_limit
from thermodata.diagnosis.tell.candidate.of_locked import said_by_locked
from thermodata.diagnosis.tell.candidate.row import alike_both_ways
from thermodata.diagnosis.tell.candidate.told import Told, as_ranked
from thermodata.diagnosis.tell.candidate.why import _not_claimed, _of_all
from thermodata.diagnosis.tell.listing.errors_told import as_told
from thermodata.diagnosis.unlogged.not_logged import not_logged
from thermodata.diagnosis.unlogged.unexplained import characterise
from thermodata.diagnosis.verdict.judged import Judged, Judgement
from thermodata.diagnosis.verdict.suspect import suspect
from thermodata.diagnosis.weigh.foretold import Foretold, Looked
from thermodata.plugin import Float1D
from thermodata.schema.answers.candidate import Candidate
from thermodata.schema.answers.diagnosis import WeakSpot
from thermodata.view.grid.dataset import ChannelInfo, TestData

from .hand_made import Parts, a_test, candidate, measure, problem, scored

# ---- weak spots: windows of half an hour, 30 samples of 60 s


def spots(residual: Float1D, noise: float = 0.0, mask: Any = None) -> list[WeakSpot]:
    n = len(residual)
    return weak_spots([(a_test(n=n), residual, np.ones(n, bool) if mask is None else mask)], noise)


def raised(level: float, windows: tuple[int, ...] = (5,), n: int = 600) -> Float1D:
    r = np.ones(n)
    for w in windows:
        r[30 * w : 30 * (w + 1)] = level
    return r


@pytest.mark.parametrize(("level", "shown"), [(1.33, True), (1.29, False)])
def test_a_window_stands_out_by_1_3_times_the_error_of_all(level: float, shown: bool) -> None:
    """The raised window is part of all, so that all is 1.02 where it is 1.33."""
    found = spots(raised(level))
    assert bool(found) is shown
    assert all((s.from_s, s.to_s) == (150 * 60.0, 180 * 60.0) for s in found)


@pytest.mark.parametrize(("noise", "shown"), [(0.99, True), (1.01, False), (float("nan"), True)])
def test_a_window_stands_out_by_three_times_the_noise(noise: float, shown: bool) -> None:
    assert bool(spots(raised(3.0), noise)) is shown


def test_windows_that_touch_are_one_spot_and_the_dearest_comes_first() -> None:
    found = spots(raised(3.0, (2,)) + raised(2.0, (8, 9, 10)) - 1.0)
    assert [(s.from_s / 1800, s.to_s / 1800) for s in found] == [(8, 11), (2, 3)]
    assert found[1].rmse_um == pytest.approx(3.0)


@pytest.mark.parametrize(("n", "width"), [(720, 30), (240, 20)])
def test_a_window_is_half_an_hour_or_a_twelfth_of_a_short_test(n: int, width: int) -> None:
    r = np.ones(n)
    r[width : 2 * width] = 5.0
    assert [(s.from_s, s.to_s) for s in spots(r)] == [(60.0 * width, 60.0 * 2 * width)]


@pytest.mark.parametrize(("left", "first"), [(1, 570), (14, 570), (15, 600), (29, 600)])
def test_what_is_left_of_half_a_window_or_more_is_one(left: int, first: int) -> None:
    """A shorter rest belongs to the window before it, with which it stands out."""
    r = np.ones(600 + left)
    r[600:] = 9.0
    assert [(s.from_s, s.to_s) for s in spots(r)] == [(60.0 * first, 60.0 * (600 + left))]


@pytest.mark.parametrize(("counts", "shown"), [(1, False), (2, True)])
def test_a_single_sample_is_no_spot(counts: int, shown: bool) -> None:
    mask = np.ones(600, bool)
    mask[150 + counts : 180] = False
    assert bool(spots(raised(5.0), mask=mask)) is shown
    r = np.full(600, 5.0)
    assert spots(r, mask=np.arange(600) == 7) == [], "nor where it is all that the test has"


def test_what_does_not_count_is_no_spot_and_windows_begin_with_what_counts() -> None:
    r = raised(5.0, (0,))
    mask = np.arange(600) >= 40
    assert spots(r, mask=mask) == []
    r = np.ones(600)
    r[40:70] = 5.0
    assert [s.from_s for s in spots(r, mask=np.arange(600) >= 40)] == [2400.0]
    assert spots(r, mask=np.zeros(600, bool)) == []


@pytest.mark.parametrize(("begins", "at", "told"), [("warm", 0, True), ("warm", 3, False), ("balance", 0, False)])
def test_what_fails_from_a_warm_start_on_is_told_so(begins: str, at: int, told: bool) -> None:
    test = replace(a_test(n=600), start_state=begins)
    [spot] = weak_spots([(test, raised(5.0, (at,)), np.ones(600, bool))], 0.0)
    assert spot.after_warm_start is told
    assert spot.state == ("after a warm start, idle" if told else "idle")
    # by the fact, not by its words
    advice = to_find(8, [spot.model_copy(update={"state": "idle"})], {})
    assert ("run it again from a cold start" in advice) is told
    assert ("log what is not logged" in advice) is not told


def test_twelve_spots_are_shown() -> None:
    assert len(spots(raised(9.0, tuple(range(0, 28, 2)), n=2400))) == 12


def state(quantity: str, values: Float1D, at: str | None = None, unit: str = "x") -> str:
    test: TestData = a_test(
        n=len(values), values={"u": values}, channels={"u": ChannelInfo("u", quantity, unit, at=at)}
    )
    return describe_state(test, 50, 100)


def after(level: float) -> Float1D:
    """1 first, then the level."""
    return np.where(np.arange(100) < 50, 1.0, level)


@pytest.mark.parametrize(
    ("quantity", "level", "said"),
    [
        ("feed", 0.011, "u 0.011 x"),
        ("feed", 0.009, "idle"),
        ("state", 0.96, "u on"),
        ("state", 0.51, "u on 51 % of the time"),
        ("state", 0.04, "idle"),
        ("rotational_speed", 0.5, "spindle at rest"),
        ("rotational_speed", 0.0, "spindle at rest"),
        ("temperature", 5.0, "idle"),
    ],
)
def test_a_state_is_said_in_words(quantity: str, level: float, said: str) -> None:
    assert state(quantity, after(level)) == said


@pytest.mark.parametrize(
    ("level", "at", "said"),
    [
        (5.1, "spindle", "u 5.1 rpm"),
        (4.9, "spindle", "spindle at rest"),  # noise of an analogue speed
        (4.9, None, "spindle at rest"),
        (4.9, "table", "u 4.9 rpm"),
        (0.0, "table", "idle"),
    ],
)
def test_a_spindle_turns_from_five_rpm_on_and_a_table_is_none(level: float, at: str | None, said: str) -> None:
    assert state("rotational_speed", np.where(np.arange(100) < 50, 60.0, level), at, "rpm") == said


def test_a_table_that_turns_does_not_hide_that_the_spindle_rests() -> None:
    values = {"S_speed": after(0.0) * 900, "C_speed": np.full(100, 60.0)}
    places = {"S_speed": "spindle", "C_speed": "table"}
    channels = {n: ChannelInfo(n, "rotational_speed", "rpm", at=at) for n, at in places.items()}
    test: TestData = a_test(n=100, values=values, channels=channels)
    assert describe_state(test, 50, 100) == "spindle at rest, C_speed 60 rpm"


@pytest.mark.parametrize(
    ("levels", "said"),
    [
        ([0.0] * 25 + [3000.0] * 25, "u 0 to 3000 rpm"),  # whose median is 1500, which never was
        ([0.0] * 24 + [1500.0] + [3000.0] * 25, "u 0 to 3000 rpm"),  # a mean of 60 s over the change
        ([0.0] * 2 + [3000.0] * 48, "u 3000 rpm"),
        ([0.0] * 12 + [3000.0] * 38, "u 3000 rpm from 62 min on"),
        ([0.0] * 13 + [3000.0] * 37, "u 0 to 3000 rpm"),  # under three quarters of the window
        ([3000.0] * 38 + [0.0] * 12, "u 3000 rpm until 87 min"),
        ([3000.0] * 20 + [0.0] * 10 + [3000.0] * 20, "u 3000 rpm for 80 % of the time"),
        ([0.0] * 38 + [3000.0] * 12, "spindle at rest until 87 min"),
        ([3000.0] * 10 + [0.0] * 40, "spindle at rest from 60 min on"),
        ([0.0] * 20 + [3000.0] * 10 + [4.0] * 20, "spindle at rest for 80 % of the time"),
        ([0.0] * 49 + [3000.0], "spindle at rest"),
        ([2990.0] * 20 + [3000.0] * 10 + [3010.0] * 20, "u 3000 rpm"),
        ([1000.0] * 20 + [2000.0] * 15 + [6000.0] * 15, "u 1000 to 6000 rpm"),
    ],
)
def test_a_speed_that_is_said_is_one_that_was(levels: list[float], said: str) -> None:
    assert state("rotational_speed", np.array([9000.0] * 50 + levels), "spindle", "rpm") == said


@pytest.mark.parametrize(("low", "said"), [(23.4, "u 24 V"), (23.6, "idle")])
def test_a_supply_that_stays_as_it_is_says_nothing(low: float, said: str) -> None:
    assert state("voltage", np.where(np.arange(100) < 50, low, 24.0), unit="V") == said


@pytest.mark.parametrize(("rise", "said"), [(0.31, "u rising"), (-0.31, "u falling"), (0.29, "idle"), (-0.29, "idle")])
def test_the_air_rises_by_a_third_of_a_kelvin(rise: float, said: str) -> None:
    values = np.where(np.arange(100) < 75, 20.0, 20.0 + rise)
    assert state("temperature", values, at="hall.top") == said
    assert state("temperature", values, at="table") == "idle"


# ---- what is not explained


def wave(period: int, n: int = 480) -> Float1D:
    return np.sin(2 * np.pi * np.arange(n) / period)


def test_a_time_constant_is_where_the_correlation_falls_to_a_third() -> None:
    """cos(x) = 1/e at x = 1.19 of a wave: sample 46 of a period of 240, for a wave that is long."""
    found = characterise(problem(Parts(wave(240, 4800))), [])
    assert found.time_constants_h == [pytest.approx(46 / 60, abs=1.1 / 60)]


def test_white_flat_and_short_residuals_have_no_time_constant() -> None:
    white = np.random.default_rng(0).normal(size=480)
    for residual in (white, np.ones(480), wave(4, 6)):
        assert characterise(problem(Parts(residual)), []).time_constants_h == []
    assert characterise(problem(), []).time_constants_h == []


def day(at_h: float, size: float, start: float | None = 0.0) -> Parts:
    """A day of a sample each 3 min that is raised during one hour."""
    t = np.arange(480) * 180.0
    r = 0.1 * wave(7)
    r[(t / 3600 >= at_h) & (t / 3600 < at_h + 1)] += size
    return Parts(r, start_unix_s=start)


def hours(*days: Parts) -> list[float]:
    return characterise(problem(*days, step_s=180.0), []).hours_of_day


def test_an_hour_of_the_day_stands_out_over_three_days() -> None:
    assert hours(*[day(5, 3.0)] * 3) == [5.0]
    assert hours(*[day(5, 3.0)] * 2) == []
    assert hours(*[day(5, 3.0)] * 2, day(5, 3.0, None)) == [], "a relative clock has no hour of the day"
    assert hours(*[day(5, 3.0, 7200.0)] * 3) == [7.0], "hours are those of the clock, not of the test"


@pytest.mark.parametrize(("signs", "found"), [((1,) * 9 + (-1,), [5.0]), ((1,) * 8 + (-1,) * 2, [])])
def test_an_hour_stands_out_in_the_same_direction(signs: tuple[int, ...], found: list[float]) -> None:
    """Nine to one is a sum of signs of 8 in 10; eight to two is 6."""
    assert hours(*(day(5, 3.0 * s) for s in signs)) == found


@pytest.mark.parametrize(("start", "found"), [(5.0, [5.0]), (6.0, [])])
def test_an_hour_stands_out_where_three_days_cover_it(start: float, found: list[float]) -> None:
    """The third log begins at that hour or after it, and ends before it comes again."""
    t = np.arange(440) * 180.0
    third = Parts(0.1 * wave(7, 440) + 3.0 * (t < 3600), start_unix_s=3600 * start)
    assert [h for h in hours(day(5, 3.0), day(5, 3.0), third) if h == 5.0] == found


def test_an_hour_stands_out_by_more_than_the_error_of_all() -> None:
    rough = [Parts(d.residual + 2.0 * wave(5), start_unix_s=0.0) for d in [day(5, 1.0)] * 3]
    assert hours(*rough) == []


def test_the_states_of_the_five_worst_spots_are_said_once() -> None:
    worst = [
        WeakSpot(campaign="c", test="t", from_s=0, to_s=1, rmse_um=1.0, state=s) for s in ["a", "b", "a", "c", "d", "e"]
    ]
    assert characterise(problem(Parts(wave(240))), worst).states == ["a", "b", "c", "d"]


# ---- the next test


@pytest.mark.parametrize(("tests", "said"), [(1, "add tests"), (7, "add tests"), (8, "log what is not logged")])
def test_eight_tests_are_enough_to_look_for_a_sensor(tests: int, said: str) -> None:
    spot = WeakSpot(campaign="c", test="t", from_s=0, to_s=1, rmse_um=1.0, state="coolant on")
    advice = to_find(tests, [spot], CHANNELS)
    assert said in advice
    assert advice.startswith("1 test took part" if tests == 1 else f"{tests} tests took part")
    where = "near the parts that work where the model fails most, which is in t from 0.0 h to 0.0 h (then: coolant on)"
    assert (where in advice) == (tests == 8), "a state is no part"
    assert to_find(8, [], CHANNELS).endswith("where the model fails most (in no state in particular)")


def test_tests_that_are_too_short_are_told_to_be_longer() -> None:
    assert to_find(0, [], CHANNELS).startswith("no test took part, for none has 10 samples at the model's step: longer")


@pytest.mark.parametrize(("tests", "told"), [(3, True), (4, False), (7, False), (8, False)])
def test_what_more_tests_gave_elsewhere_is_told_of_few_tests_only(tests: int, told: bool) -> None:
    advice = to_find(tests, [], CHANNELS)
    assert ("72 % with 3, 86 % with 8 and 80 % with 16 tests" in advice) is told
    until = "add tests until each source (spindle, one axis, table, hall air) acts in two at least"
    assert (until in advice) is (tests < 8)


@pytest.mark.parametrize(("drop", "named"), [(0.31, True), (0.29, False)])
def test_a_channel_that_is_logged_and_ranks_first_comes_before_a_new_sensor(drop: float, named: bool) -> None:
    first = scored("screw", channels=("T_nut",), after=1 - drop)
    advice = to_find(8, [], CHANNELS, first)
    assert ("T_nut is logged and ranks first" in advice) is named
    assert ("thermodata confirm" in advice) is named
    assert "log what is not logged yet" in advice


def test_several_channels_that_rank_first_are_told_as_several() -> None:
    advice = to_find(8, [], CHANNELS, scored("bend", channels=("T_a", "T_b"), after=0.4))
    assert "T_a and T_b are logged and rank first, so run a test that moves them alone" in advice
    decide = to_decide([candidate("bend", channels=("T_a", "T_b"))], CHANNELS)
    assert "in which T_a and T_b move much (one side heated through by its own source while the others rest" in decide
    both = to_decide([candidate("gain", channels=("T_a", "n"))], CHANNELS)
    assert "in which T_a and n move much (heated through by its own source" in both


UNKNOWN = Judgement("unknown", (), (), (), "because")
CHANNELS = {
    "T_a": ChannelInfo("T_a", "temperature", "degC", at="axis.x.nut"),
    "T_b": ChannelInfo("T_b", "temperature", "degC", at="axis.x.nut"),
    "n": ChannelInfo("n", "rotational_speed", "rpm", at="spindle"),
    "n_set": ChannelInfo("n_set", "rotational_speed", "rpm", at="spindle"),
    "T_spindle": ChannelInfo("T_spindle", "temperature", "degC", at="spindle"),
    "T_free": ChannelInfo("T_free", "temperature", "degC"),
    "T_loose": ChannelInfo("T_loose", "temperature", "degC"),
    "f": ChannelInfo("f", "feed", "m/min", at="axis.z"),
    "g": ChannelInfo("g", "feed", "m/min"),
}


def test_twins_are_told_apart_by_what_drives_the_claimed_one() -> None:
    def advice(mine: str, other: str, same_effect: bool = False) -> str | None:
        twin = scored("a" if same_effect else "b", channels=(other,))
        return to_separate(scored("a", channels=(mine,)), [twin], CHANNELS)

    assert "same place: not separable by another test" in (advice("T_a", "T_b") or "")
    assert "to tell a:n from b:T_a: short pulses of speed" in (advice("n", "T_a") or "")
    by_heat = advice("T_a", "n") or ""
    assert "n may be what warms T_a, so warm that by itself (a heating foil, n at rest), or let all cool" in by_heat
    assert by_heat.endswith("one goes with T_a, the other with n"), "nobody heats the one and not the other"
    at_spindle = advice("n", "T_spindle") or ""
    assert at_spindle.startswith("to tell a:n from b:T_spindle: n may be what warms T_spindle, so warm that by itself")
    assert "to tell a:n from b:n_set: short pulses of speed" in (advice("n", "n_set") or ""), "a speed is no sensor"
    assert "to tell a:f from b:T_a: Z moving alone at two feeds" in (advice("f", "T_a") or "")
    assert "the axis of g moving alone at two feeds" in (advice("g", "T_a") or ""), "nobody said where it is"
    assert "one is heated and the other is not" in (advice("T_free", "T_loose") or ""), "nowhere is not the same place"
    assert advice("T_a", "T_b", same_effect=True) is None
    assert advice("T_a", "T_a") is None, "one channel by another name is no rival"
    assert to_separate(scored("a"), [], CHANNELS) is None
    switch, its_lag = scored("a", channels=("n",)), scored("lag", family="generic", channels=("n",))
    assert to_separate(scored("a", channels=("T_a",)), [its_lag, switch], CHANNELS) is None, "the same effect, twice"
    assert to_separate(scored("a", channels=("T_a",)), [its_lag], CHANNELS) is not None


PARTS = {
    name: ChannelInfo(name, quantity, "", at=at)
    for name, quantity, at in [
        ("n", "rotational_speed", "table"),
        ("T_bearing", "temperature", "table.bearing"),
        ("T_motor", "temperature", "table.motor"),
        ("T_rear", "temperature", "table.bearing.rear"),
        ("T_rear_2", "temperature", "table.bearing.rear"),
        ("T_hall", "temperature", "hall"),
        ("T_hall_top", "temperature", "hall.top"),
        ("T_free", "temperature", None),
    ]
}


@pytest.mark.parametrize(
    ("mine", "twins", "said"),
    [
        (("n",), [("T_bearing",), ("T_motor",)], "a motor warms by its load"),
        (("T_motor",), [("n",), ("T_bearing",)], "a motor warms by its load"),
        (("T_bearing",), [("T_rear",)], "warm one by itself"),
        (("n",), [("T_bearing",)], None),
        (("T_rear",), [("T_rear_2",)], None),
        (("T_rear",), [("T_free",)], None),
        (("T_hall",), [("T_hall_top",)], None),
        (("T_rear", "T_bearing"), [("T_rear",)], None),
    ],
)
def test_one_effect_that_several_parts_say_alike_asks_which_part(
    mine: tuple[str, ...], twins: list[tuple[str, ...]], said: str | None
) -> None:
    """A motion is of all parts, one place of one, the air of none; two temperatures together are a difference."""
    found = to_tell_parts(
        scored("a", channels=mine).candidate, [scored("a", channels=t).candidate for t in twins], PARTS
    )
    assert (found is None) == (said is None)
    assert (said or "") in (found or "")
    if mine == ("n",) and said:
        assert (found or "").startswith("a:n may be heat of T_bearing (table.bearing) or T_motor (table.motor)")


def told_apart(*twins: tuple[str, str]) -> str:
    """twins: effect and channel, of a claim by the temperature of the bearing."""
    some = [scored(effect, channels=(channel,)) for effect, channel in twins]
    return to_tell_apart(scored("a", channels=("T_bearing",)), some, PARTS) or ""


def test_the_other_part_that_a_claim_may_be_is_named_before_another_effect() -> None:
    """Of a front bearing that may as well be the rear one the advice told the motion from it, and no word of the
    rear."""
    both = told_apart(("b", "n"), ("a", "T_rear"))
    parts, _, other = both.partition("; and to tell ")
    assert parts.startswith(
        "a:T_bearing may be heat of T_bearing (table.bearing) or T_rear (table.bearing.rear); to tell"
    )
    assert other.startswith("a:T_bearing from b:n: n may be what warms T_bearing")


def test_an_effect_that_a_named_part_drives_is_told_from_it_once() -> None:
    said = told_apart(("b", "T_rear"))
    assert said.startswith("a:T_bearing may be heat of T_bearing (table.bearing) or T_rear")
    assert "; and to tell" not in said


def test_where_no_other_part_or_no_other_effect_says_the_same_nothing_is_told_of_it() -> None:
    assert told_apart(("b", "n")).startswith("to tell a:T_bearing from b:n: ")
    assert told_apart(("a", "T_rear")) == "", "a sensor that is not there may come first"
    assert told_apart() == ""


@pytest.mark.parametrize(
    ("channels", "moved"),
    [
        (("T_a",), "in which T_a moves much (heated through by its own source"),
        (("n", "T_a"), "in which n and T_a move much (speeds in steps"),
        (("T_hall",), "in which T_hall moves much (through a day and a night, the machine at rest)"),
        (("P",), "in which P moves much (at a high load"),
        (("unknown",), "in which unknown moves much (heated through"),
    ],
)
def test_a_refusal_is_decided_by_a_locked_test_that_moves_its_channels(channels: tuple[str, ...], moved: str) -> None:
    more = {"T_hall": ChannelInfo("T_hall", "temperature", "degC", at="hall.top"), "P": ChannelInfo("P", "power", "kW")}
    advice = to_decide([candidate("a", channels=channels)], CHANNELS | more)
    assert f"run a test with the role locked, from a cold start, {moved}" in advice
    assert "If the error there falls with it" in advice


@pytest.mark.parametrize("kind", ["of_holder", "passive"])
def test_what_has_no_source_of_its_own_is_warmed_from_outside(kind: str) -> None:
    advice = to_exclude(candidate("probe", **{kind: True}), "frame", CHANNELS)
    assert "a test in which T_a moves much (warmed by itself from outside, by a heating foil or a fan heater" in advice
    assert "its own source" not in advice


def test_claims_that_were_refused_together_are_each_moved() -> None:
    advice = to_decide([candidate("a"), candidate("b", channels=("n",)), candidate("c")], CHANNELS)
    assert "point to a:T_a with b:n with c:T_a, the locked ones do not bear them out" in advice
    assert advice.count("in which T_a moves much") == 1
    assert "; and one in which n moves much" in advice
    assert "they are what is missing" in advice


@pytest.mark.parametrize(
    ("names", "words"),
    [
        ("a", "a:T_a hardly acts in the locked tests; to bear it out, run a test"),
        ("ab", "hardly act in the locked tests; to bear them out, run a test"),
    ],
)
def test_a_claim_that_rests_in_the_locked_tests_asks_for_one_that_moves_it(names: str, words: str) -> None:
    advice = to_bear_out([candidate(n) for n in names], CHANNELS)
    assert words in advice
    assert "with the role locked, from a cold start, in which T_a moves much" in advice


# ---- what is likely it


@pytest.mark.parametrize(
    ("evidence", "said"),
    [
        (14.0, None),  # 29 %: less is not plausible
        (18.0, "causes like it were right in 34 % of cases only (limit 65 %)"),
        (69.0, "causes like it were right in 64.8 % of cases only (just under the limit of 65 %)"),
        (390.0, "alone it keeps the rules of a claim, but not beside what else was chosen"),
    ],
)
def test_what_only_its_probability_or_the_choice_stopped_is_likely_it(evidence: float, said: str | None) -> None:
    found = suspect(UNKNOWN, scored("a", evidence=evidence, after=0.35), measure(), "um")
    assert (found and found.told.startswith("It may be a:T_a: ")) == (True if said else None)
    assert said is None or (found is not None and said in found.told)


def test_what_breaks_a_rule_of_a_claim_is_not_likely_it() -> None:
    assert suspect(UNKNOWN, scored("a", after=0.95, evidence=80.0), measure(), "um") is None
    assert suspect(UNKNOWN, None, measure(), "um") is None


def test_what_the_locked_tests_refused_is_likely_it_before_what_heads_the_list() -> None:
    one = scored("a", channels=("T_a", "n"))
    refused = Judgement("unknown", (), (), (), "", (Judged(one, one, None, ()),))
    found = suspect(refused, scored("b"), measure(), "um")
    assert found is not None
    assert found.told == "It may be a:T_a,n: the open tests say so, the locked ones do not bear it out"
    assert found.channels == {"T_a", "n"}


@pytest.mark.parametrize(
    ("after", "spread", "said"),
    [
        (0.4, 0.1, []),
        (1.0, 0.1, ["that the error does not fall", "that it explains so little"]),
        (0.998, 0.1, ["that the error hardly falls"]),
        (0.95, 0.1, ["that the error falls by 5 % only"]),
        (0.7, 1.0, ["that its gain differs"]),
    ],
)
def test_a_claim_says_what_outweighs_the_figures_against_it(after: float, spread: float, said: list[str]) -> None:
    words = in_spite_of(scored(after=after, spread=spread, evidence=900.0), measure(), "um")
    assert [one for one in said if one in words] == said
    assert ("its evidence, 0.90 a sample, outweighs" in words) is bool(said)
    assert ("that its gain differs" in words) is (spread > 0.5)


def test_locked_tests_that_speak_against_a_claim_are_told_with_what_outweighs_them() -> None:
    against = Foretold(1.25, 1.20, 1.0)
    one = replace(scored(after=0.4, evidence=2000.0), looked=Looked(against, against, 0.1))
    held = Confirmation(4.0, 2.5, 1.25, 1.20, 1.0, {})
    told = said_by_locked(one, held, "um", "tests", together=False)
    assert (
        "which is less than a cause mostly takes away, but the open ones outweigh that: there the error falls" in told
    )
    weighed = "by 60 % in the 10 tests in which it acts, with a gain that differs by 10 %, so that, all weighed, its"
    assert weighed in told
    assert told.endswith(f"its probability is {100 * probability(one):.0f} %")
    for_it = replace(one, looked=Looked(*[Foretold(1.25, 0.2, 1.0)] * 2, 0.1))
    assert "outweigh" not in said_by_locked(for_it, held, "um", "tests", together=False)


def test_errors_of_all_tests_are_told_beside_those_in_which_it_acts_where_they_differ() -> None:
    one = scored("one", after=0.5)
    other = replace(one, sse_before=4 * one.own_before, sse_after=one.own_after)
    said = _of_all(one, other, "tests", "um")
    assert said.startswith(" (over all tests, with these fitted to the other tests too, it goes 2.00 -> 0.50 um")
    assert _of_all(one, replace(one, sse_before=one.own_before, sse_after=one.own_after), "tests", "um") == ""
    assert _of_all(one, None, "tests", "um") == ""


def test_a_claim_below_the_limit_of_a_declared_place_says_by_which_limit_it_stands() -> None:
    one = scored("one", after=0.9, evidence=30.0)
    bare = replace(one, candidate=replace(one.candidate, placeless=True))
    assert "a claim asks 50 % in place of 65 %" in placeless_limit(bare)
    assert placeless_limit(one) == ""
    assert placeless_limit(replace(bare, evidence=3000.0)) == ""


def test_what_cant_be_told_apart_says_so_of_both() -> None:
    def row(rank: int, name: str, *twins: str) -> Any:
        return Candidate(
            rank=rank, id=name, effect=name, family="", drivers=[], claimed=False, p_value=None, rmse_um_before=None,
            rmse_um_after=None, fit_before=None, fit_after=None, equivalent=list(twins),
        )  # fmt: skip

    found = alike_both_ways([row(1, "a", "b", "x"), row(2, "b"), row(3, "c", "a", "b")])
    assert [one.equivalent for one in found] == [["b", "x"], ["a"], []]


def test_what_was_dropped_is_alike_as_the_ranking_has_it_that_the_others_stand_in() -> None:
    ranked = scored("one")
    dropped = replace(ranked, shape=np.array([0.0, 1.0]))
    assert as_ranked(dropped, [scored("other"), ranked]) is ranked
    assert as_ranked(dropped, []) is dropped


class TestHowProbableItIsThatNothingLoggedReadsIt:
    @pytest.mark.parametrize(
        ("explainable", "likeliest", "probable"),
        [
            (0.0, 0.0, 0.79),  # nothing that is logged goes with what is left
            (1 / 3, 0.1, 0.5),
            (0.8, 0.1, 0.14),  # some channel takes most of it away
            (0.0, 0.6, 0.4),  # what is likely to be a logged cause is no other
        ],
    )
    def test_what_candidates_take_away_speaks_against_it(
        self, explainable: float, likeliest: float, probable: float
    ) -> None:
        assert not_logged(explainable, likeliest) == pytest.approx(probable, abs=0.005)

    def test_where_nothing_was_weighed_nobody_knows(self) -> None:
        assert not_logged(None, 0.0) is None


@pytest.mark.parametrize(("stated", "share"), [(True, 1), (False, 0)])
def test_a_row_has_one_probability_whatever_it_is_told_as(stated: bool, share: int) -> None:
    """41.8 % in its column and in the head stood above "right in 5 % of cases only", that of its equation's row."""
    likely, other = scored("lag", evidence=100.0), scored("feed_screw", evidence=20.0)
    given: dict[str, Any] = {
        "member": None,
        "judged": None,
        "others": (),
        "errors": other,
        "of_model": True,
        "by_name": None,
    }
    row = Told(likely, one=other, stated=stated, twins=(), against="", held=None, **given)
    shown = (likely, other)[1 - share]
    rule = of_probability(row.one, row.sure)
    assert rule.value == probability(shown)
    assert rule.fails.startswith(f"causes like it were right in {100 * probability(shown):.0f} % of cases only")
    assert ("its evidence is" in rule.fails) is not stated, "what it hangs on is of another row"


def test_what_is_told_as_another_is_not_told_beside_itself() -> None:
    """The other's own row was judged beside the lag that is told as it: "beside lag:rate_x" stood in that lag's."""
    other, listed = scored("feed_screw"), scored("lag")
    dropped = replace(other, others=(listed.candidate.id,))
    given: Any = SimpleNamespace(selection=SimpleNamespace(dropped=(dropped,)))
    judgement = Judgement("unknown", (), (), (), "")
    assert as_told(listed, None, other, given, judgement)[0] is other
    beside = replace(dropped, others=("lag:T_c",))
    given = SimpleNamespace(selection=SimpleNamespace(dropped=(beside,)))
    assert as_told(listed, None, other, given, judgement)[0] is beside


def test_that_it_is_too_improbable_is_said_beside_the_rule_that_it_breaks_and_what_locked_tests_say() -> None:
    one = scored("screw", evidence=20.0, after=0.8, spread=0.9)
    looked = replace(one, looked=Looked(Foretold(1.0, 0.5, 0.8), None, 0.1))
    given: dict[str, Any] = {"member": None, "judged": None, "others": (), "of_model": True, "by_name": None}
    told = Told(looked, one=looked, errors=looked, stated=True, twins=(), against="", held=None, **given)
    outcome: Any = SimpleNamespace(
        judgement=Judgement("unknown", (), (), (), ""), measure=measure(), unit="um", tests="tests"
    )
    said = _not_claimed(told, outcome)
    assert said.startswith("its gain differs between tests by 90 %")
    assert (
        f"; and causes like it were right in {100 * probability(looked):.0f} % of cases only (limit 65 %); on " in said
    )
    assert said.endswith("with a free offset a test, the error falls by 50 % (1.00 -> 0.50 um)")
