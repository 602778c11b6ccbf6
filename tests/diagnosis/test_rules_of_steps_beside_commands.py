"""A step where a command changes just then, and one that only commands outdo (steps/artefact.py, steps/sudden.py)."""

from __future__ import annotations

import numpy as np
import pytest

from thermodata.diagnosis.steps.artefact import as_artefacts, find_steps
from thermodata.diagnosis.steps.step import Step
from thermodata.diagnosis.steps.sudden import is_quick, smooth_but_for
from thermodata.plugin import Float1D
from thermodata.view.grid.dataset import ChannelInfo

from .hand_made import Parts, problem

MINUTES = np.arange(300) * 60.0
SIDE = 20


def rough(n: int, seed: int = 0) -> Float1D:
    return 0.05 * np.random.default_rng(seed).normal(size=n)


def found(*tests: tuple[Float1D, Float1D]) -> list[Step]:
    channel = {"pump": ChannelInfo("pump", "state", "1", at="coolant")}
    parts = (Parts(r, values={"pump": u}, channels=channel) for r, u in tests)
    return find_steps(problem(*parts, noise=0.05))


def on_from(at: int, n: int = 300) -> Float1D:
    return np.where(np.arange(n) >= at, 1.0, 0.0)


def spread(over: int, at: int = 100, size: float = 6.0) -> Float1D:
    """A fall over so many intervals."""
    return -size * np.clip((np.arange(300) - at + 1) / over, 0.0, 1.0)


@pytest.mark.parametrize(("over", "quick"), [(1, True), (2, True), (3, False), (4, False)])
@pytest.mark.parametrize("slope", [-0.5, 0.0, 0.5])
def test_what_two_intervals_hold_is_quick(over: int, quick: bool, slope: float) -> None:
    """A mean parts it into two at most."""
    course = rough(300) * 0.2 + spread(over) + slope * np.arange(300)
    middle = 100 + (over - 1) // 2
    assert is_quick(course, MINUTES, middle, -6.0, SIDE, 0.15) is quick


@pytest.mark.parametrize(("noise", "quick"), [(0.9, False), (1.1, True)])
def test_what_noise_does_is_not_asked_of_a_quick_step(noise: float, quick: bool) -> None:
    """A sixth of 6 um happens beside it."""
    course = -np.interp(np.arange(300), [98, 99, 100, 101], [0.0, 1.0, 5.0, 6.0])
    assert is_quick(course, MINUTES, 100, -6.0, SIDE, noise) is quick


def test_a_fall_of_minutes_as_a_pump_switches_on_is_its_doing_though_elsewhere_it_does_nothing() -> None:
    """Coolant through a warm spindle; where it was switched before, the spindle was cold."""
    cold = (rough(300, 1), on_from(150))
    falls = rough(300) - np.interp(np.arange(300), [98, 99, 100, 101], [0.0, 1.5, 4.5, 6.0])
    assert found((falls, on_from(100)), cold) == []
    [unswitched] = found((falls, on_from(200)), cold)
    assert unswitched.beside == (), "nothing changes there: a logger that smooths"


@pytest.mark.parametrize("over", [1, 2])
def test_a_quick_step_as_a_pump_switches_is_told_with_it(over: int) -> None:
    cold = [(rough(300, k), on_from(150)) for k in (1, 2)]
    [step] = found((rough(300) + spread(over), on_from(100)), *cold)
    [told] = as_artefacts([step], "um")
    assert "pump changes just then and makes no such step elsewhere: a probe or fixture slipped, or it acts" in told.why
    [alone] = as_artefacts(found((rough(300) + spread(over), on_from(200)), *cold), "um")
    assert "no speed, feed, position or switch does that elsewhere: a probe or fixture slipped, or a body" in alone.why


def missing_quick(slip: float = 3.0, other: float = 0.0, at: int = 140) -> tuple[Float1D, Float1D]:
    """A quick cause is missing: 10 um within minutes at each change of the pump, and a bend at each; between two of
    them a slip, and something else that comes and goes."""
    i = np.arange(400)
    pump = np.where((i // 60) % 2 == 1, 1.0, 0.0)
    quick = np.zeros(400)
    for k in range(1, 400):
        quick[k] = quick[k - 1] + (10.0 * pump[k] - quick[k - 1]) * (0.6 if pump[k] != pump[k - 1] else 0.05)
    return rough(400) + quick + slip * (i >= at) + other * ((i >= 330) & (i < 332)), pump


def test_a_slip_that_only_commands_outdo_is_found_and_says_so() -> None:
    sound = [missing_quick(0.0) for _ in range(2)]
    assert found(*sound) == []
    [step] = [s for s in found(missing_quick(), *sound) if s.test.test == "t0"]
    assert step.bare
    assert step.at_s / 60 == pytest.approx(139.5)
    assert step.size == pytest.approx(3.0, abs=0.3)
    [told] = as_artefacts([step], "um")
    assert "times as suddenly as anything else in this test that no command makes" in told.why


@pytest.mark.parametrize(("other", "many"), [(1.3, 1), (1.7, 0)])
def test_it_is_twice_as_sudden_as_all_else_that_no_command_makes(other: float, many: int) -> None:
    sound = [missing_quick(0.0) for _ in range(2)]
    assert len(found(missing_quick(other=other), *sound)) == many


@pytest.mark.parametrize(("bend", "smooth"), [(0.0, True), (0.5, False)])
def test_a_course_is_smooth_but_for_a_step(bend: float, smooth: bool) -> None:
    """A parabola may run through it; a kink beside it may not."""
    i = np.arange(300)
    course = rough(300) + 3.0 * (i >= 100) + 0.01 * (i - 100.0) ** 2 + bend * np.maximum(i - 110, 0)
    assert smooth_but_for(course, MINUTES, 100, 3.0, SIDE, 12.0) is smooth


@pytest.mark.parametrize(("told", "smooth"), [(2.3, True), (2.2, False), (4.4, True), (4.6, False)])
def test_its_size_is_the_same_on_that_course_give_or_take_a_third(told: float, smooth: bool) -> None:
    course = 0.01 * rough(300) + 3.0 * (np.arange(300) >= 100)
    assert smooth_but_for(course, MINUTES, 100, told, SIDE, 12.0) is smooth


@pytest.mark.parametrize(("of", "smooth"), [(1.5, True), (4.5, False)])
def test_it_is_twelve_times_its_standard_error(of: float, smooth: bool) -> None:
    course = of * rough(300) + 1.0 * (np.arange(300) >= 100)
    assert smooth_but_for(course, MINUTES, 100, 1.0, SIDE, 12.0) is smooth
    assert not smooth_but_for(course[98:103], MINUTES[98:103], 2, 1.0, SIDE, 12.0), "too few samples to tell"
