"""What is a step of a probe and what is not (diagnosis/artefact.py), just inside and just outside each limit."""

from __future__ import annotations

import numpy as np
import pytest

from thermodata.diagnosis.artefact import _commanded, _step_score, find_steps, is_a_step
from thermodata.plugin import Float1D
from thermodata.view.dataset import ChannelInfo

from .hand_made import Parts, a_test, problem

SIDE = 20  # samples of 60 s in 1200 s


@pytest.mark.parametrize(
    ("z", "size", "noise", "step"),
    [
        (9.01, 5.0, 0.1, True),
        (8.99, 5.0, 0.1, False),
        (20.0, 0.301, 0.1, False),
        (20.0, 0.501, 0.1, True),
        (20.0, -0.501, 0.1, True),
        (20.0, 0.499, 0.1, False),
        (20.0, 3.01, 1.0, True),
        (20.0, 2.99, 1.0, False),
    ],
)
def test_a_step_is_nine_times_the_usual_change_three_noises_and_half_a_um(
    z: float, size: float, noise: float, step: bool
) -> None:
    assert is_a_step(z, size, noise) is step


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
    assert bool(score.max() > 9) is sharp


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
    assert bool(score[100] > 9) is found


def commanded(quantity: str, at_s: float, changes_at_s: float, change: float = 1.0) -> bool:
    """A test of a command that has been between 0 and 1, with a change of its own."""
    t = np.arange(300) * 60.0
    values = change * (t >= changes_at_s)
    values[-30:] = 1.0
    values[-10:] = 0.0
    test = a_test(
        n=300, values={"u": values.astype(float)}, channels={"u": ChannelInfo("u", quantity, "1", at="spindle")}
    )
    return _commanded(test, at_s, 60.0)


@pytest.mark.parametrize("quantity", ["rotational_speed", "feed", "power", "state", "load", "flow"])
def test_a_command_near_by_explains_a_step(quantity: str) -> None:
    assert commanded(quantity, 6000.0, 6000.0)


@pytest.mark.parametrize("quantity", ["temperature", "position", "pressure"])
def test_what_is_no_command_explains_no_step(quantity: str) -> None:
    assert not commanded(quantity, 6000.0, 6000.0)


@pytest.mark.parametrize(("after_s", "explained"), [(660.0, True), (720.0, False)])
def test_a_command_counts_for_ten_minutes(after_s: float, explained: bool) -> None:
    """And the sample that they end in."""
    assert commanded("feed", 6000.0, 6000.0 + after_s) is explained
    assert commanded("feed", 6000.0, 6000.0 - after_s + 60.0) is explained


@pytest.mark.parametrize(("change", "explained"), [(0.21, True), (0.19, False)])
def test_a_command_must_change_by_a_fifth_of_its_range(change: float, explained: bool) -> None:
    assert commanded("feed", 6000.0, 6000.0, change) is explained


def test_a_step_with_a_command_is_no_artefact() -> None:
    speed = {"n": ChannelInfo("n", "rotational_speed", "rpm", at="spindle")}
    values = {"n": np.where(np.arange(300) >= 100, 9000.0, 0.0)}
    assert steps(stepped(100), values=values, channels=speed) == []
    assert len(steps(stepped(200), values=values, channels=speed)) == 1
