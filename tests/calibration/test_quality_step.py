"""Temperatures that step: what heat can do between two samples, and what only a sensor does."""

from __future__ import annotations

import numpy as np
import pytest
from quality_data import clock, kinds, noisy, run

from thermodata.calibration.quality.column import ColumnInput
from thermodata.calibration.quality.event import QualityEvent
from thermodata.calibration.quality.flags import flag_stream
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
        *((5.6, 1.0, True), (13.0, 60.0, False), (16.0, 60.0, True)),
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


QUIET = 22 + 0.5 * np.sin(np.arange(N) / 300) + np.random.default_rng(3).normal(0, 0.012, N)
LATER = (np.arange(N - AT) + 1.0) * 10.0  # [s] behind the step, in a log of every 10 s


@pytest.mark.parametrize(
    ("follows", "flagged"),
    [
        (2.0, True),
        (-1.0, True),
        (4.0, True),
        (0.7, False),
        (2.0 * (1 - np.exp(-LATER / 2.5)), True),  # over within the sample: no body follows so fast
        (2.0 * (1 - np.exp(-LATER / 8.0)), False),  # heat goes on
        (2.0 * np.exp(-LATER / 900), False),  # wet, and dries
        (np.where(LATER < 3000, 2.0, 0.0), False),  # a valve, a drive that disturbs its sensor
        (np.where(LATER < 3000, 2.0, 2.6), False),  # it steps again
        (2.0 + 5e-3 * LATER, False),  # heat that goes on along another line
    ],
)
def test_a_small_step_is_told_where_it_is_the_only_one_and_over_at_once(
    follows: float | Float1D, flagged: bool
) -> None:
    x = QUIET.copy()
    x[AT:] += follows
    flags, events = run(clock(N, 10.0), T=("temperature", x), T_bed=("temperature", QUIET[::-1]))
    assert np.flatnonzero(flags["T"] & Flag.OFFSET).tolist() == (list(range(AT, N)) if flagged else [])
    assert not flags["T_bed"].any()
    assert all("K within one sample, the only one" in e.detail for e in events)


@pytest.mark.parametrize(
    ("case", "flagged"),
    [
        *(("as logged", True), ("every minute", False), ("noisy", False), ("coarse", False)),
        *(("in company", False), ("behind a pause", False), ("frozen before", False)),
    ],
)
def test_a_small_step_is_left_where_it_may_be_something_else(case: str, flagged: bool) -> None:
    t, x, other = clock(N, 60.0 if case == "every minute" else 10.0), QUIET.copy(), QUIET[::-1].copy()
    if case == "behind a pause":
        t[AT:] += 300 * 10**9
    if case == "noisy":
        x += np.random.default_rng(4).normal(0, 0.1, N)
    if case == "frozen before":
        x[AT - 40 : AT] = x[AT - 40]
    x[AT:] += 2.0
    if case == "coarse":
        x = np.round(x)
    if case == "in company":
        other[AT:] -= 0.8
    flags, _ = run(t, T=("temperature", x), T_bed=("temperature", other))
    assert bool((flags["T"] & Flag.OFFSET).any()) is flagged


@pytest.mark.parametrize(
    ("at", "flagged"), [("table.bearing", True), (None, True), ("hall", False), ("coolant", False), ("tool", False)]
)
def test_a_small_step_is_told_of_bodies(at: str | None, flagged: bool) -> None:
    x = QUIET.copy()
    x[AT:] += 2.0
    flags, _ = flag_stream(clock(N, 10.0), {"T": ColumnInput(x, "temperature", at=at)})
    assert bool((flags["T"] & Flag.OFFSET).any()) is flagged


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
