"""A clock that is off, by what commands move at once (clocks/by_commands.py), just inside and outside each limit."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from thermodata.diagnosis.clocks.by_commands import beyond_trend, timings
from thermodata.diagnosis.clocks.moves import with_clocks_right
from thermodata.diagnosis.clocks.timings import Timing, as_artefact, clock_is_off
from thermodata.diagnosis.question.problem import Problem
from thermodata.schema.answers.diagnosis import ClockMoved
from thermodata.view.grid.dataset import ChannelInfo, Dataset

from .hand_made import Parts, problem

CHANNELS = {
    "dZ": ChannelInfo("dZ", "displacement", "um", source="daq"),
    "n": ChannelInfo("n", "rotational_speed", "rpm", source="nc"),
    "T": ChannelInfo("T", "temperature", "degC", source="nc"),
}


def off_by(
    samples: int, *, at_once: float = 5.0, lag: float = 60.0, tests: int = 5, apart: dict[int, int] | None = None
) -> Problem:
    """Tests whose response follows the speed, that many um at once and 20 um with a lag [samples]; the speed is logged
    so many samples late, in single tests (apart: number -> samples) by others. step: 60 s."""
    rng = np.random.default_rng(4)

    def one(samples: int) -> Parts:
        n = np.repeat(rng.integers(0, 5, 20), rng.integers(11, 29, 20)).astype(float) / 4
        heat = np.zeros(len(n))
        for i in range(1, len(n)):
            heat[i] = heat[i - 1] + (n[i] - heat[i - 1]) / lag
        y = at_once * n**2 + 20 * heat + 0.1 * rng.normal(size=len(n))
        logged = n[np.clip(np.arange(len(n)) - samples, 0, len(n) - 1)]
        return Parts(y - y.mean(), response=y - y.mean(), values={"n": 3000 * logged, "T": heat})

    return replace(problem(*(one((apart or {}).get(k, samples)) for k in range(tests))), response="dZ")


@pytest.mark.parametrize("samples", [-120, -60, -25, -11, -3, 3, 11, 25, 57, 65, 118])
def test_a_clock_that_is_off_is_told_by_what_the_speed_moves_at_once(samples: int) -> None:
    asked = off_by(samples)
    (found,) = timings(asked, CHANNELS).in_all
    assert (found.source, found.shift_s) == ("nc", -60.0 * samples)
    assert clock_is_off(found, asked.step_s)
    said = as_artefact(found, asked)
    assert said.kind == "clock_offset"
    assert f"source 'nc' moved by {-samples:+d} min (give or take 2)" in said.why


@pytest.mark.parametrize("samples", [-2, 0, 2])
def test_a_clock_that_is_nearly_right_is_not_off(samples: int) -> None:
    asked = off_by(samples)
    assert timings(asked, CHANNELS).off() == []


@pytest.mark.parametrize("samples", [0, 11])
def test_heat_that_lags_tells_no_clock(samples: int) -> None:
    asked = off_by(samples, at_once=0.0)
    assert timings(asked, CHANNELS).off() == []


@pytest.mark.parametrize("samples", [-120, -60, -11, -3, 3, 25, 57, 118])
def test_a_clock_that_is_off_in_one_test_is_told_by_how_its_commands_act_in_the_others(samples: int) -> None:
    asked = off_by(0, apart={2: samples})
    (found,) = timings(asked, CHANNELS).off()
    assert (found.source, found.test, found.shift_s) == ("nc", asked.blocks[2].test.test, -60.0 * samples)
    said = as_artefact(found, asked)
    assert (said.kind, said.test) == ("clock_offset", found.test)
    assert f"source 'nc' moved by {-samples:+d} min (give or take 2)" in said.why
    assert "in this test, by how they act in the others" in said.why


def test_a_clock_that_is_off_by_another_time_in_one_test_is_told_beside_the_others() -> None:
    asked, right = off_by(3, apart={2: 60}), off_by(0)
    of_all, of_one = timings(asked, CHANNELS).off()
    assert (of_all.test, of_all.shift_s) == ("", -180.0)
    assert (of_one.test, of_one.shift_s) == (asked.blocks[2].test.test, -3420.0)
    data = Dataset(60.0, tuple(b.test for b in asked.blocks), CHANNELS)
    clocks = [
        ClockMoved(source=t.source, campaign=t.campaign, test=t.test, moved_s=t.shift_s) for t in (of_all, of_one)
    ]
    for test, at in zip(with_clocks_right(data, clocks).tests, right.blocks, strict=True):
        assert np.array_equal(test.values["n"][:-60], at.test.values["n"][:-60])


def test_one_test_that_is_off_far_is_not_taken_for_the_clock_of_all() -> None:
    """Of three tests it pulls the best shift of all."""
    asked = off_by(0, tests=3, apart={1: 15})
    (found,) = timings(asked, CHANNELS).off()
    assert (found.test, found.shift_s) == (asked.blocks[1].test.test, -900.0)


@pytest.mark.parametrize("samples", [-2, 2])
def test_a_clock_that_is_nearly_right_in_one_test_is_not_off(samples: int) -> None:
    assert timings(off_by(0, apart={2: samples}), CHANNELS).off() == []


def test_of_half_of_the_tests_nobody_can_say_which_are_right() -> None:
    assert len(timings(off_by(0, apart={0: 25, 1: -20}), CHANNELS).off()) == 2
    assert timings(off_by(0, tests=4, apart={0: 25, 1: -20}), CHANNELS).off() == []


def test_what_acts_at_once_in_one_test_only_tells_no_clock() -> None:
    """A slip beside a command is foretold by no other test."""
    asked = off_by(0, at_once=0.0)
    first = asked.blocks[0]
    late = np.flatnonzero(np.diff(first.test.values["n"]))[5] + 11
    slipped = first.response + 12.0 * (np.arange(len(first.response)) >= late)
    asked = replace(asked, blocks=(replace(first, response=slipped), *asked.blocks[1:]))
    assert timings(asked, CHANNELS).off() == []


@pytest.mark.parametrize("slip", [-40.0, -12.0, 12.0, 40.0])
def test_a_slip_that_some_shift_lays_on_a_command_tells_no_clock(slip: float) -> None:
    """Of a test in which commands act at once as in all others: what is told without its largest jump counts."""
    asked = off_by(0, at_once=1.0)
    first = asked.blocks[0]
    late = np.flatnonzero(np.abs(np.diff(first.test.values["n"])) > 2000)[0] + 20
    slipped = first.response + slip * (np.arange(len(first.response)) >= late)
    asked = replace(asked, blocks=(replace(first, response=slipped), *asked.blocks[1:]))
    assert timings(asked, CHANNELS).off() == []


@pytest.mark.parametrize("samples", [-60, 25])
def test_a_clock_that_is_off_in_one_test_is_told_beside_a_slip(samples: int) -> None:
    asked = off_by(0, apart={2: samples})
    one = asked.blocks[2]
    slipped = replace(one, response=one.response + 9.0 * (np.arange(len(one.response)) >= 150))
    asked = replace(asked, blocks=(*asked.blocks[:2], slipped, *asked.blocks[3:]))
    (found,) = timings(asked, CHANNELS).off()
    assert (found.test, found.shift_s) == (one.test.test, -60.0 * samples)


def test_of_one_test_and_without_commands_of_another_source_nothing_is_said() -> None:
    assert timings(off_by(11, tests=1), CHANNELS).in_all == ()
    same = {name: replace(c, source="daq") for name, c in CHANNELS.items()}
    assert timings(off_by(11), same).in_all == ()
    assert timings(off_by(11), {"dZ": CHANNELS["dZ"], "T": CHANNELS["T"]}).in_all == ()


@pytest.mark.parametrize(
    ("changed", "step_s", "off"),
    [
        ({"share": 0.101}, 60.0, True),
        ({"share": 0.099}, 60.0, False),
        ({"share": 0.401, "unmoved": 0.2}, 60.0, True),
        ({"share": 0.399, "unmoved": 0.2}, 60.0, False),
        ({"shift_s": 151.0}, 10.0, True),
        ({"shift_s": -149.0}, 10.0, False),
        ({"shift_s": -360.0}, 120.0, True),
        ({"shift_s": 240.0}, 120.0, False),
    ],
)
def test_a_clock_is_off_where_the_others_foretell_much_more_once_it_is_moved(
    changed: dict[str, float], step_s: float, off: bool
) -> None:
    plain = {"shift_s": 300.0, "share": 0.5, "unmoved": 0.0}
    assert clock_is_off(Timing("nc", **{**plain, **changed}), step_s) is off


def test_all_that_a_source_logged_is_put_where_it_happened() -> None:
    asked, right = off_by(11), off_by(0)
    data = Dataset(60.0, tuple(b.test for b in asked.blocks), CHANNELS)
    moved = with_clocks_right(
        data, [ClockMoved(source=t.source, moved_s=t.shift_s) for t in timings(asked, CHANNELS).off()]
    )
    for test, at, as_logged in zip(moved.tests, right.blocks, asked.blocks, strict=True):
        assert np.array_equal(test.values["n"][:-11], at.test.values["n"][:-11])
        assert np.array_equal(test.values["T"][:-11], as_logged.test.values["T"][11:])
    assert with_clocks_right(data, []) is data


def test_a_jump_is_beyond_the_slope_around_it_and_none_over_a_hole() -> None:
    t = np.arange(40) * 60.0
    x = 0.5 * np.arange(40.0) + 3.0 * (np.arange(40) >= 20)
    jump = beyond_trend(x[:, None], t, 60.0)[:, 0]
    assert jump[19] == pytest.approx(3.0 - 3.0 / 5)
    assert jump[10] == pytest.approx(0.0)
    assert np.isnan(jump[:5]).all()
    assert np.isnan(beyond_trend(x[:, None], t + 600.0 * (np.arange(40) >= 20), 60.0)[15:25]).all()


def test_bursts_of_measuring_tell_no_clock_for_heat_acts_between_them() -> None:
    t = np.arange(40) * 360.0  # a minute's mean every six
    x = 3.0 * (np.arange(40) >= 20)
    assert np.isnan(beyond_trend(x[:, None], t, 60.0)).all()
    assert np.isfinite(beyond_trend(x[:, None], t, 360.0)[5:-5]).all()


@pytest.mark.parametrize(
    ("minutes", "chance", "off"),
    [
        (60, 0.0049, True),
        (60, 0.0051, False),
        (65, 0.0, True),
        (66, 0.0, False),
        (114, 0.0, False),
        (20, 0.0051, False),
    ],
)
def test_among_so_many_shifts_of_a_test_one_stands_out_by_chance(minutes: int, chance: float, off: bool) -> None:
    found = Timing("nc", 60.0 * minutes, 0.135, 0.0, "c", "t0", chance)
    assert clock_is_off(found, 60.0) is off


def with_a_stroke(seed: int, size: float = 0.0, late: int = 0, own_um: float = 4.0, minutes: int = 90) -> Problem:
    """Three tests in which the speed acts at once, and a short one of strokes of 3 to 6 min with rests between. There
    the displacement answers them by size [um], and does jumps of its own: some near-by hall crane, a few in the test;
    the strokes are logged so many samples late."""
    rng, asked = np.random.default_rng(seed), off_by(0, tests=4)
    runs = rng.integers(3, 7, 2 * minutes)
    n = np.repeat(np.arange(len(runs)) % 2, runs)[:minutes].astype(float)
    own = np.cumsum(rng.normal(size=minutes) * own_um * (rng.random(minutes) < 0.15))
    y = size * n + own + 0.1 * rng.normal(size=minutes)
    logged = n[np.clip(np.arange(minutes) - late, 0, minutes - 1)]
    one = problem(Parts(y - y.mean(), response=y - y.mean(), values={"n": 3000 * logged, "T": n})).blocks[0]
    one = replace(one, test=replace(one.test, test="strokes"))
    return replace(asked, blocks=(*asked.blocks[:3], one))


@pytest.mark.parametrize("seed", [11, 30, 41, 48])
def test_strokes_that_meet_a_few_jumps_at_some_shift_tell_no_clock(seed: int) -> None:
    """At one shift of the many a tenth to a fifth of the squared jumps is foretold, without the largest, too."""
    assert timings(with_a_stroke(seed, own_um=16.0 if seed == 30 else 10.0), CHANNELS).off() == []


@pytest.mark.parametrize("late", [-25, -12, 12, 25])
def test_strokes_that_are_followed_at_once_tell_one(late: int) -> None:
    (found,) = timings(with_a_stroke(2, size=5.0, late=late), CHANNELS).off()
    assert (found.test, found.shift_s) == ("strokes", -60.0 * late)


def test_what_to_declare_is_of_the_test_with_all_that_its_clock_is_moved_by() -> None:
    asked = off_by(3, apart={2: 60})
    of_all, of_one = timings(asked, CHANNELS).off()
    assert as_artefact(of_all, asked).why.endswith(
        "If it was off, declare at source 'nc' clock: {offset: -180 s}; if it was right, clock: {offset: 0 s}, and it "
        "is not asked again"
    )
    assert as_artefact(of_one, asked).why.endswith(
        "If it was off, declare at the test clocks: {nc: -3600 s}; if it was right, clocks: {nc: 0 s}, and it is not "
        "asked again"
    )
