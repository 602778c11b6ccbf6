"""Temperatures that step: what heat can do between two samples, and what only a sensor does."""

from __future__ import annotations

import numpy as np
import pytest
from quality_data import clock, kinds, noisy, run

from thermodata.calibration.quality.event import QualityEvent
from thermodata.plugin import Float1D
from thermodata.schema.flag import Flag

N = 1500
AT = 900


def part(seed: int = 0) -> Float1D:
    """A bed or a heater at rest."""
    return 22 + noisy(seed, N, noise=0.05) / 40


def stepped(size: float, step_s: float, pause_s: float = 0.0, tau_s: float = 0.0) -> tuple[bool, list[QualityEvent]]:
    """(whether the step is flagged from where it is on, all events); tau_s: of the heat that makes it, 0: none."""
    t = clock(N, step_s)
    t[AT:] += round(pause_s * 1e9)
    x = part()
    later = (t[AT:] - t[AT - 1]) / 1e9
    x[AT:] += size * (1 - np.exp(-later / tau_s)) if tau_s else size
    flags, events = run(t, T=("temperature", x))
    off = np.flatnonzero(flags["T"] & Flag.OFFSET).tolist()
    assert off in ([], list(range(AT, N)))
    return bool(off), events


@pytest.mark.parametrize(
    ("size", "step_s", "flagged"),
    [
        *((5.6, 1.0, True), (4.6, 1.0, False), (13.0, 60.0, False), (16.0, 60.0, True)),
        *((21.5, 600.0, True), (18.0, 600.0, False), (-30.0, 600.0, True)),
    ],
)
def test_a_step_is_more_than_heat_can_do_in_the_time(size: float, step_s: float, flagged: bool) -> None:
    assert stepped(size, step_s)[0] is flagged


@pytest.mark.parametrize("pause_s", [30.0, 600.0, 7200.0])
@pytest.mark.parametrize(("size", "flagged"), [(13.0, False), (-13.0, False), (30.0, True)])
def test_a_bed_that_warms_by_13_kelvin_while_nobody_logged_is_sound(pause_s: float, size: float, flagged: bool) -> None:
    assert stepped(size, 1.0, pause_s)[0] is flagged


@pytest.mark.parametrize(("tau_s", "flagged"), [(90.0, False), (20.0, False), (5.0, True)])
def test_what_goes_on_the_same_way_is_heat(tau_s: float, flagged: bool) -> None:
    """40 K by a heater, logged every 30 s; within 5 s nobody can tell it from a plug."""
    assert stepped(40.0, 30.0, tau_s=tau_s)[0] is flagged


def test_a_set_point_steps_and_is_sound() -> None:
    x = np.repeat([20.0, 36.0, 28.0, 60.0, 45.0, 20.0], N // 6)
    assert run(clock(N, 10.0), T_set=("temperature", x), T=("temperature", part()))[1] == []


def whole_kelvin(stood: bool, *, neighbour_k: float = 12.0) -> tuple[list[int], list[tuple[str | None, str]]]:
    """6.25 h at 15 s: a motor in whole kelvin that warms by 16 K with its neighbours, or stands for 5 h and then reads
    what it should have read."""
    n = 1500
    warm = 1 - np.exp(-np.arange(n) / 300)
    motor = np.round(24 + 0.3 * np.sin(np.arange(n) / 7) + 16 * warm + 3 * np.sin(np.arange(n) / 60))
    if stood:
        motor[:1200] = np.round(24.4 + 0.2 * np.sin(np.arange(1200) / 50))
    flags, events = run(
        clock(n, 15.0),
        T_motor=("temperature", motor),
        T_bed=("temperature", 22 + neighbour_k * warm + noisy(1, n, 0.05) / 40),
    )
    assert not flags["T_bed"].any()
    return np.flatnonzero(flags["T_motor"]).tolist(), kinds(events)


def test_whole_kelvins_that_stand_for_hours_and_then_jump_were_held() -> None:
    assert whole_kelvin(True) == (list(range(1200)), [("T_motor", "held")])
    assert whole_kelvin(False) == ([], [])


def test_where_no_neighbour_moved_the_jump_itself_is_the_fault() -> None:
    assert whole_kelvin(True, neighbour_k=2.0) == (list(range(1200, 1500)), [("T_motor", "offset")])
