"""What a missing heat goes with, and what is said of it: goes_with.py, first_seen.py, unexplained.py."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from thermodata.diagnosis.unlogged.first_seen import where
from thermodata.diagnosis.unlogged.goes_with import (
    Companion,
    companions,
    hours_of_day,
    strong_and_weak_tests,
)
from thermodata.diagnosis.unlogged.missing_heat import Course, MissingHeat
from thermodata.diagnosis.unlogged.unexplained import characterise
from thermodata.diagnosis.verdict.suspect import Doubt, First, Supposed, Suspect, doubt_of_heat, first, nearest
from thermodata.effect.lag import lag
from thermodata.plugin import Float1D
from thermodata.view.grid.dataset import ChannelInfo, TestData

from .hand_made import STEP_S, Parts, a_test, candidate, measure, problem, scored

STEPS = 40  # of 10 min, ten rows each
CHANNELS = {
    "n": ChannelInfo("n", "rotational_speed", "rpm", at="spindle"),
    "pump": ChannelInfo("pump", "state", "1", at="hydraulics"),
    "load": ChannelInfo("load", "load", "%"),
    "T": ChannelInfo("T", "temperature", "degC", at="column"),
}


def course(
    source: Float1D,
    values: Mapping[str, Float1D] | None = None,
    name: str = "t0",
    contribution: Float1D | None = None,
    start_unix_s: float | None = None,
) -> Course:
    """values: a row each minute, shape (400,); a step of the source is ten rows."""
    known = {k: v for k, v in CHANNELS.items() if k in (values or {})}
    test = a_test(name, 10 * len(source), values=values, channels=known, start_unix_s=start_unix_s)
    done = source - source.mean() if contribution is None else contribution
    return Course(test, 0.0, 10 * STEP_S, source, done, done)


def heat(
    *courses: Course, sign: int = 1, agreed: float = 1.0, taus: Sequence[float] = (1200, 2400, 3600)
) -> MissingHeat:
    return MissingHeat(taus[1], (taus[0], taus[2]), sign, agreed, 0.99, 0.9, courses)


def rows(steps: Sequence[float]) -> Float1D:
    return np.repeat(np.asarray(steps, dtype=np.float64), 10)


def one(found: Sequence[Companion], name: str = "n") -> Companion:
    return next(c for c in found if c.info.name == name)


def half(on_with: int, on_without: int) -> MissingHeat:
    """Four tests; the spindle turns in 20 of 40 steps, of which the source is on in `on_with`, else in `on_without`."""
    runs = np.r_[np.ones(20), np.zeros(20)]
    source = 8.0 * np.r_[np.arange(20) < on_with, np.arange(20) < on_without]
    return heat(*(course(source, {"n": rows(3000 * runs)}, f"t{i}") for i in range(4)))


@pytest.mark.parametrize(
    ("on_with", "on_without", "verdict"),
    [
        (16, 5, "with"),
        (15, 5, "undecided"),
        (17, 12, "with"),
        (16, 12, "undecided"),
        (12, 7, "not"),
        (13, 8, "undecided"),
    ],
)
def test_a_channel_goes_with_the_source_or_not(on_with: int, on_without: int, verdict: str) -> None:
    """With: on in 80 % of its time, and by 25 % more than else. Not: on in at most 60 %, by at most 30 % more."""
    found = one(companions(half(on_with, on_without), "dZ"))
    assert (found.on_with, found.on_without) == (on_with / 20, on_without / 20)
    assert found.verdict == verdict
    assert found.follows is None


def clamped(on_with: int, on_without: int, channel: str) -> MissingHeat:
    """The same of a state that is on in 20 of 40 steps, or of a speed."""
    on = rows(np.r_[np.ones(20), np.zeros(20)])
    return heat(
        *(replace(c, test=course(c.source, {channel: on}, c.test.test).test) for c in half(on_with, on_without).courses)
    )


@pytest.mark.parametrize(
    ("on_with", "on_without", "verdict"), [(2, 18, "with"), (4, 15, "not"), (11, 16, "with"), (12, 16, "not")]
)
def test_a_source_may_be_on_while_a_state_is_off(on_with: int, on_without: int, verdict: str) -> None:
    """In 80 % of that time, and by 25 % more than else."""
    found = one(companions(clamped(on_with, on_without, "pump"), "dZ"), "pump")
    assert (found.verdict, found.is_inverse) == (verdict, True)
    assert one(companions(clamped(on_with, on_without, "n"), "dZ")).verdict == "not", "no speed heats by its rest"


def test_the_mask_of_the_measurement_is_compared_with_nothing() -> None:
    made = clamped(18, 2, "pump")
    mask = {"pump": replace(CHANNELS["pump"], is_mask=True)}
    masked = replace(made, courses=tuple(replace(c, test=replace(c.test, channels=mask)) for c in made.courses))
    assert [c.info.name for c in companions(made, "dZ")] == ["pump"]
    assert companions(masked, "dZ") == []


def test_it_is_said_that_the_source_is_on_while_the_state_is_off() -> None:
    made = clamped(2, 18, "pump")
    strong, weak = strong_and_weak_tests(made)
    said = where(made, companions(made, "dZ"), strong, weak)
    assert "On while pump is off (90 % of that time, else 10 %)" in said


def test_what_never_rests_or_never_runs_says_nothing() -> None:
    source = 8.0 * (np.arange(STEPS) < 20)
    always, never = np.full(400, 3000.0), np.zeros(400)
    assert companions(heat(course(source, {"n": always})), "dZ") == []
    assert companions(heat(course(source, {"pump": never})), "dZ") == []


@pytest.mark.parametrize(("steps", "said"), [(2, True), (1, False)])
def test_a_channel_must_run_for_a_twentieth_of_the_time(steps: int, said: bool) -> None:
    found = companions(heat(course(8.0 * (np.arange(STEPS) < 20), {"pump": rows(np.arange(STEPS) < steps)})), "dZ")
    assert bool(found) is said


def test_one_test_that_goes_along_by_chance_is_not_enough() -> None:
    """In one of four tests both are on together; in the others the source is on and the spindle rests."""
    together = np.r_[np.ones(20), np.zeros(20)]
    tests = [course(8.0 * together, {"n": rows(3000 * together)}, "t0")]
    tests += [course(8.0 * together, {"n": np.zeros(400)}, f"t{i}") for i in (1, 2, 3)]
    found = one(companions(heat(*tests), "dZ"))
    assert found.on_with == 1.0
    assert found.verdict == "undecided"


def test_a_load_rests_above_zero() -> None:
    idle = rows(30.0 + 40.0 * (np.arange(STEPS) < 20))
    found = one(
        companions(heat(*(course(8.0 * (np.arange(STEPS) < 20), {"load": idle}, f"t{i}") for i in range(4))), "dZ"),
        "load",
    )
    assert (found.on_with, found.on_without, found.verdict) == (1.0, 0.0, "with")


def test_a_source_that_goes_both_ways_is_never_on() -> None:
    both_ways = replace(half(18, 2), sign=0)
    assert companions(both_ways, "dZ") == []
    assert hours_of_day(both_ways) == []


@pytest.mark.parametrize(
    ("share", "verdict"), [(0.72, "with"), (0.68, "undecided"), (0.32, "undecided"), (0.28, "not")]
)
def test_a_temperature_goes_with_what_it_explains(share: float, verdict: str) -> None:
    """The contribution is a temperature's lag and, orthogonal to it, something else."""
    tests = []
    rng = np.random.default_rng(4)
    for i in range(4):
        T = lag(rows(rng.choice([0.0, 6.0], STEPS)), 3000.0, STEP_S)
        middle = (np.arange(STEPS) + 0.5) * 10 * STEP_S
        seen = np.interp(middle, np.arange(400) * STEP_S, lag(T, 2400.0, STEP_S))
        seen -= seen.mean()
        other = rng.standard_normal(STEPS)
        other -= other.mean()
        other -= seen * (seen @ other) / (seen @ seen)
        done = np.sqrt(share) * seen + np.sqrt(1 - share) * other * seen.std() / other.std()
        tests.append(course(np.zeros(STEPS), {"T": 20 + T}, f"t{i}", done))
    found = one(companions(heat(*tests), "dZ"), "T")
    assert found.follows == pytest.approx(share, abs=0.02)
    assert found.verdict == verdict
    assert (found.on_with, found.on_without) == (None, None)


@pytest.mark.parametrize(
    ("size", "strong", "weak"), [(0.51, True, False), (0.49, False, False), (0.16, False, False), (0.14, False, True)]
)
def test_tests_are_strong_or_weak_by_what_the_source_does_there(size: float, strong: bool, weak: bool) -> None:
    swing = np.sin(np.arange(STEPS))
    found = strong_and_weak_tests(heat(course(swing, name="most"), course(size * swing, name="other")))
    assert [t.test for t in found[0]] == ["most", *["other"] * strong]
    assert [t.test for t in found[1]] == ["other"] * weak


def day(on_at: Sequence[int], first: int = 0, hours: int = 24) -> Course:
    """A test from an hour of the day on; on in the hours told."""
    hour = first + np.arange(6 * hours) // 6
    return course(8.0 * np.isin(hour % 24, on_at), start_unix_s=3600.0 * first)


@pytest.mark.parametrize(("days", "hours"), [(3, [9.0]), (2, [])])
def test_an_hour_is_told_where_three_days_cover_it(days: int, hours: list[float]) -> None:
    rest = [day([], first=11, hours=12)] * 2
    assert hours_of_day(heat(*[day([9])] * days, *rest)) == hours


@pytest.mark.parametrize(("on_days", "hours"), [(4, [9.0]), (3, [])])
def test_an_hour_is_told_where_it_is_on_in_most_days(on_days: int, hours: list[float]) -> None:
    assert hours_of_day(heat(*[day([9])] * on_days, *[day([9 - 8 + i]) for i in range(5 - on_days)])) == hours


@pytest.mark.parametrize(("on_at", "told"), [(range(14), True), (range(15), False)])
def test_hours_are_not_told_of_what_is_mostly_on(on_at: range, told: bool) -> None:
    assert bool(hours_of_day(heat(*[day(on_at)] * 3))) is told


@pytest.mark.parametrize(("fades_to", "told"), [(0.49, True), (0.51, False)])
def test_hours_are_told_of_a_source_whose_estimate_fades_while_it_is_off(fades_to: float, told: bool) -> None:
    """For hours after eight of work it stands above where a channel's rest would count as on."""
    days = []
    for _ in range(3):
        made = day(range(8, 16))
        fading = np.where(made.source > 0, made.source, 8.0 * fades_to)
        days.append(replace(made, source=fading))
    assert hours_of_day(heat(*days)) == ([8.0, 9.0, 10.0, 11.0, 12.0, 13.0, 14.0, 15.0] if told else [])


@pytest.mark.parametrize(("level", "on_with"), [(0.16, 1.0), (0.14, 0.0)])
def test_a_source_of_several_heights_is_on_beside_a_channel_from_a_low_one_on(level: float, on_with: float) -> None:
    """A speed heats at its low steps, too, where the source is far below its largest; the rest of the time is a
    source at its largest that the channel rests in."""
    runs = np.r_[np.ones(20), np.zeros(20)]
    source = 8.0 * np.where(runs > 0, level, 1.0)
    made = heat(*(course(source, {"n": rows(3000 * runs)}, f"t{i}") for i in range(4)))
    assert one(companions(made, "dZ")).on_with == on_with


# ---- in words


def said(
    *found: Companion,
    suspect: Suspect | None = None,
    first: First | None = None,
    warm: tuple[str, str] | None = None,
    doubt: Doubt = "none",
    **changed: object,
) -> str:
    asked = replace(half(20, 0), **changed)  # type: ignore[arg-type]
    tests = [c.test for c in asked.courses]
    return where(asked, found, tests[:1], tests[1:2], Supposed(suspect, first, doubt), warm)


WITH_SPINDLE = Companion(CHANNELS["n"], "with", 0.96, 0.04, None)
NOT_COLUMN = Companion(CHANNELS["T"], "not", None, None, 0.05)


def test_where_a_sensor_would_see_it_first_is_said_with_what_it_is_not() -> None:
    text = said(WITH_SPINDLE, NOT_COLUMN)
    assert text.startswith("A body with a time constant of 40 min (20 min to 60 min)")
    assert "moves the response to plus when it is heated" in text
    assert "On while n runs (96 % of that time, else 4 %)" in text
    assert "strongest in t0 (mixed); absent in t1 (mixed)" in text
    assert "first near spindle rather than near column" in text
    assert "can't say" not in text


def test_where_nothing_goes_with_it_the_data_are_said_to_be_silent() -> None:
    text = said(NOT_COLUMN)
    assert "can't say where it is; least like it is what is logged near column" in text
    assert "note what runs in t0 and is not logged" in text


@pytest.mark.parametrize(("sign", "what"), [(1, "channel"), (-1, "channel"), (0, "temperature")])
def test_what_was_not_compared_is_not_said_to_go_with_nothing(sign: int, what: str) -> None:
    """A heat that goes both ways is never on, so that no speed, load or state was compared with it."""
    assert f"No logged {what} goes with it" in said(NOT_COLUMN, sign=sign)


@pytest.mark.parametrize(("acts_in", "logged"), [("t0", True), ("t1", False)])
def test_what_ranks_first_and_acts_where_it_is_strongest_comes_before_what_is_not_logged(
    acts_in: str, logged: bool
) -> None:
    turret = First(candidate("turret", channels=("Q",)), 0.31, frozenset({a_test(acts_in, 4).key}))
    text = said(NOT_COLUMN, first=turret)
    assert ("turret:Q is the likeliest of what is logged (31 %) and acts in t0: Q is to be looked at" in text) is logged
    assert ("note what runs in t0 and is not logged" in text) is not logged
    assert "can't say where it is; least like it is what is logged near column" in text
    assert "turret:Q is the likeliest of what is logged (31 %)" in text, "wherever it acts"
    assert "No logged channel goes with it" not in text


@pytest.mark.parametrize(("after", "is_nearest"), [(1.7, True), (1.68, True), (1.72, False)])
def test_what_ranks_first_without_being_plausible_is_told_before_what_is_not_logged(
    after: float, is_nearest: bool
) -> None:
    """A guideway of a grinder took a third of the error, at 9 %: no logged channel was said to go with the heat."""
    asked = problem(*(Parts(np.zeros(4)) for _ in range(10)), noise=0.05)
    guideway = scored("guideway", channels=("T",), before=2.0, after=after)
    found = nearest([guideway], asked)
    assert (found is not None) is is_nearest
    if found is not None:
        text = said(NOT_COLUMN, first=replace(found, acts_in=frozenset({a_test("t0", 4).key})))
        assert f"guideway:T comes nearest of what is logged (where it acts the error goes 2.00 -> {after:.2f}" in text
        assert "T is to be looked at before anything that is not logged" in text
        assert "No logged channel goes with it" not in text
        assert "column" not in text
    assert nearest([], asked) is None


@pytest.mark.parametrize(
    ("warm", "told"),
    [(a_test("t0", 4).key, True), (a_test("t1", 4).key, False), (("another", "t0"), False), (None, False)],
)
def test_what_is_strongest_where_the_model_fails_at_a_warm_start_is_laid_to_that(
    warm: tuple[str, str] | None, told: bool
) -> None:
    text = said(NOT_COLUMN, warm=warm)
    assert ("t0 is declared to start warm, and the model fails most at its start" in text) is told
    assert ("run it again from a cold start" in text) is told
    assert ("not logged" in text) is not told


def test_nothing_speaks_against_the_channels_of_what_ranks_first() -> None:
    column = First(candidate("bend", channels=("T",)), 0.31, frozenset({a_test("t0", 4).key}))
    assert "column" not in said(NOT_COLUMN, first=column)


@pytest.mark.parametrize(("sure", "is_first"), [(0.31, True), (0.29, False)])
def test_what_ranks_first_is_told_with_the_tests_in_which_it_acts_where_it_is_plausible(
    monkeypatch: pytest.MonkeyPatch, sure: float, is_first: bool
) -> None:
    monkeypatch.setattr("thermodata.diagnosis.verdict.suspect.probability", lambda scored: sure)
    asked = problem(*(Parts(np.zeros(4)) for _ in range(2)), noise=0.05)
    head = replace(scored(candidate("turret")), rows=np.ones(2), size=np.array([2.0, 0.1]))
    found = first(head, asked)
    assert (found is not None) is is_first
    if found is not None:
        assert found.acts_in == {asked.blocks[0].test.key}
    assert first(None, asked) is None


def test_a_logged_temperature_that_goes_with_it_is_no_sensor_to_add() -> None:
    text = said(Companion(CHANNELS["T"], "with", None, None, 0.9))
    assert "T is logged and already goes with it: try it as a driver before a new sensor" in text


def test_what_the_locked_tests_refused_is_pointed_to_and_nothing_is_to_be_logged() -> None:
    told = "It may be sun:S: the open tests say so"
    sun = Suspect((candidate("sun", channels=("S",)),), "the open tests say so")
    silent = said(NOT_COLUMN, suspect=sun)
    assert told in silent
    assert "Least like it is what is logged near column" in silent
    assert "can't say" not in silent
    assert "not logged" not in silent
    near = said(WITH_SPINDLE, suspect=sun)
    assert near.index(told) < near.index("If it is not, a sensor would see it first near spindle")
    assert told not in said(NOT_COLUMN)


@pytest.mark.parametrize("verdict", ["with", "not"])
def test_a_channel_of_what_was_refused_is_neither_tried_nor_ruled_out(verdict: Any) -> None:
    column = Suspect((candidate("column", channels=("T",)),), "the open tests say so")
    text = said(Companion(CHANNELS["T"], verdict, None, None, 0.5), suspect=column)
    assert text.endswith("It may be column:T: the open tests say so")


@pytest.mark.parametrize(("agreed", "told"), [(0.79, True), (0.81, False)])
def test_a_direction_that_hangs_on_single_tests_is_said_to_do_so(agreed: float, told: bool) -> None:
    assert ("agree on the direction" in said(agreed=agreed)) is told


@pytest.mark.parametrize(
    ("sign", "agreed", "weighed"), [(1, 0.81, True), (-1, 1.0, True), (1, 0.79, False), (0, 1.0, False)]
)
def test_a_direction_that_the_draws_agree_on_speaks_against_the_doubt_whether_any_heat_is_missing(
    sign: int, agreed: float, weighed: bool
) -> None:
    """What machines that lack nothing leave goes both ways."""
    text = said(sign=sign, agreed=agreed, doubt="some")
    assert text.startswith("A body with a time constant of 40 min") is weighed
    assert text.startswith("It may be no heat at all") is not weighed
    assert (f"goes one way in {100 * agreed:.0f} % of the draws of the tests, which speaks for heat" in text) is weighed
    assert "machines that lack nothing leave as much" in text
    assert "lack nothing" not in said(sign=sign, agreed=agreed)


@pytest.mark.parametrize(
    ("taus", "words"),
    [
        ((300.0, 1200.0, 2400.0), "at most 40 min"),
        ((1200.0, 2400.0, 38400.0), "at least 20 min"),
        ((300.0, 2400.0, 38400.0), "do not settle"),
        ((300.0, 600.0, 899.0), "small and thin"),
        ((5401.0, 9000.0, 20000.0), "large and thick"),
        ((5399.0, 9000.0, 20000.0), "leave open"),
        ((1200.0, 2400.0, 3600.0), "a screw, a motor or a housing"),
    ],
)
def test_a_time_constant_is_said_as_far_as_it_is_known(taus: tuple[float, float, float], words: str) -> None:
    assert words in said(tau_s=taus[1], tau_range_s=(taus[0], taus[2]))


# ---- in the answer


def test_the_unknown_has_its_missing_heat_with_every_key() -> None:
    on = np.repeat([0.0, 1.0, 0.0, 1.0, 1.0, 0.0], 80)
    rng = np.random.default_rng(1)
    d = lag(12.0 * on, 2400.0, STEP_S)
    values = {"pump": on, "n": np.repeat([0.0, 1, 0, 1, 0, 1, 0, 1], 60) * 3000.0}
    known = {k: CHANNELS[k] for k in values}
    parts = [Parts(d - d.mean() + 0.1 * rng.standard_normal(480), values=values, channels=known) for _ in range(4)]
    found = characterise(problem(*parts, noise=0.1), []).heat
    assert found is not None
    assert found.direction == "+"
    assert found.time_constant_h == pytest.approx(2400 / 3600, rel=0.2)
    assert [c.channel for c in found.goes_with] == ["pump"]
    assert [c.channel for c in found.goes_not_with] == ["n"]
    assert "near hydraulics rather than near spindle" in found.where
    assert [c.test for c in found.courses] == ["t0", "t1", "t2", "t3"]
    for c in found.courses:
        assert len(c.source_um) == len(c.contribution_um) == len(c.residual_um)
        assert min(c.source_um) >= 0
    assert "time_constant_low_h" in found.model_dump()


@pytest.mark.parametrize(("sign", "verdict"), [(1, "not"), (0, "undecided")])
def test_a_source_that_goes_both_ways_rules_no_temperature_out(sign: int, verdict: str) -> None:
    """It is what the known effects have left of the missing heat, which may look like nothing that warmed it."""
    t = np.arange(STEPS)
    apart = [course(np.sin(t), {"T": 20.0 + rows(np.cos(2.3 * t))}, f"t{i}") for i in range(3)]
    assert one(companions(heat(*apart, sign=sign), "dZ"), "T").verdict == verdict


def test_a_channel_of_what_is_likely_it_is_not_ruled_out() -> None:
    rng = np.random.default_rng(3)
    on = np.repeat([0.0, 1, 1, 0, 0, 1, 0, 0], 60)
    d = lag(10 * on, 2400.0, STEP_S)
    values = {"n": np.repeat([0.0, 1, 0, 1, 0, 1, 0, 1], 60) * 3000.0}
    parts = [Parts(d - d.mean() + 0.1 * rng.standard_normal(480), values=values, channels=CHANNELS) for _ in range(4)]
    asked = problem(*parts, noise=0.1)
    alone, likely = (
        characterise(asked, [], Supposed(s)).heat
        for s in (None, Suspect((candidate(channels=("n",)),), "it is likely"))
    )
    assert alone is not None
    assert likely is not None
    assert [c.channel for c in alone.goes_not_with] == ["n"]
    assert likely.goes_not_with == []


def test_a_residual_without_a_course_has_no_missing_heat() -> None:
    assert characterise(problem(*[Parts(np.zeros(240))] * 3), []).heat is None


@pytest.mark.parametrize(("doubt", "told"), [("none", True), ("some", True), ("all", False)])
def test_no_body_is_told_where_a_good_model_leaves_as_much(doubt: Doubt, told: bool) -> None:
    wave = lag(12.0 * np.repeat([0.0, 1.0, 0.0, 1.0, 1.0, 0.0], 80), 2400.0, STEP_S)
    found = characterise(problem(*[Parts(wave)] * 3, noise=0.1), [], Supposed(doubt=doubt))
    assert (found.heat is not None) is told
    where = found.heat.where if found.heat is not None else ""
    assert ("machines that lack nothing leave as much" in where) is (doubt == "some")


def test_of_what_goes_both_ways_the_doubt_comes_first() -> None:
    text = said(sign=0, doubt="some")
    assert "If heat is missing, it is that of a body with a time constant of " in text


@pytest.mark.parametrize(
    ("left", "known", "doubt"),
    [(5.1, False, "none"), (5.0, False, "some"), (2.6, False, "some"), (2.5, False, "all"), (0.1, True, "none")],
)
def test_what_is_left_says_whether_any_heat_is_missing(left: float, known: bool, doubt: Doubt) -> None:
    """Of a response of 10 um; a plausible cause, or locked tests, say it whatever is left."""
    assert doubt_of_heat(left, measure(spread=10.0), known=known) == doubt


def test_a_channel_that_is_not_logged_in_a_test_rests_there() -> None:
    runs = np.r_[np.ones(20), np.zeros(20)]
    tests: list[Course] = [course(8.0 * runs, {"n": rows(3000 * runs)}, f"t{i}") for i in range(3)]
    other: TestData = a_test("t3", 400)
    found = one(companions(heat(*tests, replace(tests[0], test=other)), "dZ"))
    assert found.on_with == 1.0
    assert found.on_without == pytest.approx(20 / 100)
