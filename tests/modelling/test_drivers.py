"""Drivers: relative to the start, gaps filled, and honest about what was filled."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from thermodata.effect import effect
from thermodata.errors import UsageError
from thermodata.modelling.inputs.drivers import has_drivers, make_drivers, names_of, start_value
from thermodata.view.grid.dataset import Dataset

from .conftest import Spec, make_test


def test_temperatures_count_from_the_start_and_speeds_from_zero() -> None:
    test = make_test(1, "calibration")
    warmth = make_drivers(test, effect("lag"), {"u": "T_nut"}).values["u"]
    assert abs(warmth[:5].mean()) < 0.05
    assert np.allclose(warmth - warmth[100], test.values["T_nut"] - test.values["T_nut"][100])
    assert np.array_equal(make_drivers(test, effect("lag"), {"u": "speed"}).values["u"], test.values["speed"])


def test_a_difference_of_two_temperatures_is_a_driver() -> None:
    test = make_test(1, "calibration")
    found = make_drivers(test, effect("lag"), {"u": "T_nut - T_hall"}).values["u"]
    plain = test.values["T_nut"] - test.values["T_hall"]
    assert np.allclose(found - found[7], plain - plain[7])
    assert names_of("T_nut - T_hall") == ("T_hall", "T_nut")


def test_a_condition_is_a_state() -> None:
    test = make_test(1, "calibration")
    found = make_drivers(test, effect("lag"), {"u": "speed > 1000 rpm"}).values["u"]
    assert set(np.unique(found)) == {0.0, 1.0}
    assert found.sum() == (test.values["speed"] > 1000).sum()


def test_gaps_are_bridged_by_a_straight_line_and_long_ones_do_not_count() -> None:
    test = make_test(1, "calibration")
    ramp = test.t_s / 3600.0
    broken = ramp.copy()
    broken[100:110] = np.nan
    good = np.ones(len(ramp), bool)
    good[300:400] = False
    broken[300:400] = 1e6
    test = replace(test, values={**test.values, "T_nut": broken}, valid={**test.valid, "T_nut": good})
    found = make_drivers(test, effect("lag"), {"u": "T_nut"})
    assert np.allclose(found.values["u"], ramp - ramp[0], atol=0.01)
    assert found.valid["u"][100:110].all()
    assert not found.valid["u"][350]


def test_ends_are_held() -> None:
    test = make_test(1, "calibration")
    values = np.full(len(test.t_s), 25.0)
    values[:50], values[50:60] = np.nan, 22.0
    test = replace(test, values={**test.values, "T_nut": values})
    found = make_drivers(test, effect("lag"), {"u": "T_nut"}).values["u"]
    assert not found[:60].any()
    assert np.allclose(found[60:], 3.0)


def test_a_test_without_the_channel_says_so(world: Dataset) -> None:
    test = make_test(1, "calibration")
    assert not has_drivers(test, {"u": "T_tool"})
    dead = replace(test, values={**test.values, "T_nut": np.full(len(test.t_s), np.nan)})
    assert not has_drivers(dead, {"u": "T_nut"})
    with pytest.raises(UsageError, match="no channel 'T_tool'"):
        make_drivers(test, effect("lag"), {"u": "T_tool"})


def test_a_driver_without_a_valid_sample_is_told_with_effect_channels_and_test(world: Dataset, spec: Spec) -> None:
    from thermodata.modelling import fit_model

    never = {"effect": "lag", "id": "half", "drivers": {"u": "T_nut / (T_hall - T_hall)"}}
    with pytest.raises(UsageError) as caught:
        fit_model(spec(never), world)
    error = caught.value
    assert error.what == "the driver 'T_nut / (T_hall - T_hall)' has no valid sample in test 'c/t0'"
    assert error.where == "effect 'half', driver 'u', expression 'T_nut / (T_hall - T_hall)'"
    assert "T_nut valid in 721 of 721 samples" in (error.got or "")
    assert "stays zero" in (error.hint or "")
    test = world.tests[0]
    early = np.arange(len(test.t_s)) < 300
    apart = replace(test, valid={**test.valid, "T_nut": early, "T_hall": ~early})
    with pytest.raises(UsageError) as caught:
        make_drivers(apart, effect("lag"), {"u": "T_nut - T_hall"})
    assert "T_hall valid in 421 of 721 samples, T_nut valid in 300" in (caught.value.got or "")
    assert (caught.value.got or "").endswith("never at once")


def test_the_start_value_is_a_mean_only_while_nothing_moves() -> None:
    noise = np.random.default_rng(0).normal(0, 0.05, 200)
    assert start_value(20 + noise, 60.0) == pytest.approx(20.0, abs=0.06)
    # heating from the first second on: bins of 60 s have their middle 30 s later
    rising = 20 + 0.4 * (np.arange(200) + 0.5)
    assert start_value(rising + noise, 60.0) == pytest.approx(20.0, abs=0.2)
    slow = 20 + 2.0 * (np.arange(40) + 0.5)
    assert start_value(slow, 300.0) == pytest.approx(20.0, abs=1e-9)
    assert start_value(np.array([21.0]), 60.0) == 21.0


def test_a_chiller_starts_from_the_mean_of_its_cycle() -> None:
    noise = np.random.default_rng(1).normal(0, 0.01, 300)
    minutes = np.arange(300)
    hunting = 24.0 + 0.6 * np.sin(2 * np.pi * (minutes / 20.0 - 0.1)) + noise
    assert start_value(hunting, 60.0) == pytest.approx(24.0, abs=0.1)
    # pulses from cold go up and down too, but they start at the bottom
    pulses = 22.0 + 3.0 * np.sin(np.pi * minutes / 30.0) ** 2 + noise
    assert start_value(pulses, 60.0) == pytest.approx(22.0, abs=0.1)
    # and noise on something slow is no cycle
    assert start_value(22.0 + minutes / 300.0 + noise, 60.0) == pytest.approx(22.0, abs=0.05)


def test_what_is_held_stands_through_a_gap_until_it_is_written_again() -> None:
    test = make_test(1, "calibration")
    command = np.where(np.arange(len(test.t_s)) < 105, 3000.0, 8000.0)
    broken = command.copy()
    broken[100:110] = np.nan
    broken[:3] = np.nan
    values = {**test.values, "speed": broken, "T_nut": broken}
    test = replace(test, values=values)
    lines = make_drivers(test, effect("lag"), {"u": "speed"}).values["u"]
    assert np.all(np.diff(lines[99:111]) > 0), "logged in even steps: nobody knows what was between"
    held = replace(test, channels={**test.channels, "speed": replace(test.channels["speed"], held=True)})
    found = make_drivers(held, effect("lag"), {"u": "speed"})
    assert np.array_equal(found.values["u"][:110], np.full(110, 3000.0))
    assert np.array_equal(found.values["u"][110:], command[110:])
    assert found.valid["u"][:110].all()
    state = make_drivers(held, effect("lag"), {"u": "speed > 5000 rpm"}).values["u"]
    assert set(np.unique(state)) == {0.0, 1.0}
    mixed = make_drivers(held, effect("lag"), {"u": "T_nut * speed"}).values["u"]
    assert np.all(np.diff(mixed[99:111]) > 0), "a temperature is not held"
    reading = replace(test, channels={**test.channels, "speed": replace(test.channels["speed"], quantity="state")})
    assert np.array_equal(make_drivers(reading, effect("lag"), {"u": "speed"}).values["u"][:110], np.full(110, 3000.0))
