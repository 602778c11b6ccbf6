"""A temperature or a probe that freezes while it is logged (calibration/quality/frozen.py)."""

from __future__ import annotations

import numpy as np
import pytest
from quality_data import clock, kinds, run

from thermodata.calibration.quality.column import ColumnInput
from thermodata.calibration.quality.flags import flag_stream
from thermodata.plugin import Array, Float1D
from thermodata.schema.flag import Flag

N = 4000  # of 10 s: 11 h
FROM, TO = 1500, 3500


def machine(
    seed: int = 0, noise: float = 0.015, count: float = 0.01, rests: bool = False, warms: float = 8.0
) -> Float1D:
    """A tank whose pump cycles, or which rests from FROM on."""
    rng = np.random.default_rng(seed)
    hours = np.arange(N) / 360
    on = np.where(hours % 0.5 < 0.25, 1.0, -0.6) if not rests else np.where(np.arange(N) < FROM, 1.0, 0.0)
    slow = np.cumsum(on) * 0.002 + warms * (1 - np.exp(-np.minimum(np.arange(N), FROM if rests else N) / 900))
    return np.asarray(np.round((21 + slow + rng.normal(0, noise, N)) / count) * count)


def stands(x: Float1D, start: int = FROM, stop: int = TO) -> Float1D:
    x = x.copy()
    x[start:stop] = x[start]
    return x


def flagged(x: Float1D, *others: Float1D, quantity: str = "temperature", at: str | None = None) -> Array:
    columns = {"T": ColumnInput(x, quantity, at=at)}
    columns |= {f"T{i}": ColumnInput(y, "temperature") for i, y in enumerate(others)}
    return np.asarray(flag_stream(clock(N, 10.0), columns)[0]["T"])


@pytest.mark.parametrize(("noise", "count"), [(0.015, 0.01), (0.015, 0.02), (0.08, 0.1), (0.004, 0.001)])
@pytest.mark.parametrize("stop", [TO, N])
def test_a_sensor_that_freezes_is_stuck_whether_it_comes_back_or_not(noise: float, count: float, stop: int) -> None:
    x = machine(1, noise, count)
    others = machine(2), machine(3, noise=0.0, count=0.1)
    assert not flagged(x, *others).any()
    flags = flagged(stands(x, stop=stop), *others)
    assert (flags[FROM:stop] & (Flag.STUCK | Flag.HELD)).all()
    assert not flags[: FROM - 5].any()


def test_a_sensor_that_is_drawn_onto_other_rows_freezes_too() -> None:
    """Every second sample is the mean of its neighbours."""
    x = stands(machine(1), stop=N)
    x[1:-1:2] = (x[:-2:2] + x[2::2]) / 2
    flags, events = run(clock(N, 10.0), T=("temperature", x), T1=("temperature", machine(2)))
    assert (flags["T"][FROM + 1 :] == Flag.STUCK).all()
    assert kinds(events) == [("T", "stuck")]
    assert "elsewhere it changes all the time" in events[0].detail


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize(("noise", "count"), [(0.0, 0.01), (0.0, 0.1), (0.02, 0.1), (0.03, 0.1), (0.1, 1.0)])
def test_a_coarse_sensor_of_a_machine_that_rests_is_left(seed: int, noise: float, count: float) -> None:
    """Also where others go on."""
    for warms in (2.0, 8.0, 30.0, 120.0):
        x = machine(seed, noise, count, rests=True, warms=warms)
        assert not (flagged(x, machine(seed + 1), machine(seed + 2)) & (Flag.STUCK | Flag.HELD)).any()


def test_a_steady_hall_in_fine_counts_flickers_on() -> None:
    rng = np.random.default_rng(4)
    x = np.round(21 + rng.normal(0, 0.01, N), 2)
    assert not flagged(x, machine(2)).any()


def test_noise_that_goes_for_all_alike_is_the_drives() -> None:
    """Main switch off: what is left counts in 0.1 K and rests."""
    x = stands(machine(1, 0.08, 0.1), FROM, N)
    assert not flagged(x, stands(machine(2, 0.08, 0.1), FROM, N), stands(machine(3, 0.08, 0.1), FROM, N)).any()
    assert (flagged(x, machine(2), machine(3))[FROM:] & Flag.STUCK).all(), "the others go on"


@pytest.mark.parametrize(("minutes", "told"), [(25, False), (40, True)])
def test_it_takes_half_an_hour(minutes: int, told: bool) -> None:
    x = stands(machine(1), FROM, FROM + minutes * 6)
    assert bool((flagged(x, machine(2)) & Flag.STUCK).any()) is told


def test_nothing_is_told_of_other_quantities_at_the_tool_or_alone() -> None:
    x = stands(machine(1))
    assert not flagged(x, machine(2), quantity="pressure").any(), "a pump that is off"
    assert not flagged(x, machine(2), at="tool").any()
    assert not flagged(x).any()


def driven(rests: list[tuple[int, int]], noise_at_rest: float = 0.0, seed: int = 5) -> tuple[Float1D, Float1D]:
    """A bed in a steady hall whose sensor counts in 0.1 K, with noise of 0.08 K while the spindle runs; and the speed.
    rests: [rows) in which the spindle stands."""
    rng = np.random.default_rng(seed)
    speed = np.full(N, 4000.0)
    for start, stop in rests:
        speed[start:stop] = 0.0
    noise = rng.normal(0, 1, N) * np.where(speed > 0, 0.08, noise_at_rest)
    return np.asarray(np.round((21.02 + noise) / 0.1) * 0.1), speed


def flagged_beside(x: Float1D, speed: Float1D, quantity: str = "rotational_speed") -> Array:
    columns = {"T": ColumnInput(x, "temperature"), "n": ColumnInput(speed, quantity)}
    columns |= {f"T{i}": ColumnInput(machine(i), "temperature") for i in (2, 3)}
    return np.asarray(flag_stream(clock(N, 10.0), columns)[0]["T"]) & Flag.STUCK


@pytest.mark.parametrize("rests", [[(FROM, TO)], [(FROM, N)], [(0, 600), (1500, 2100), (3000, 3600)]])
def test_noise_that_goes_with_the_drives_is_no_failure_when_they_stop(rests: list[tuple[int, int]]) -> None:
    x, speed = driven(rests)
    assert not flagged_beside(x, speed).any()
    assert not flagged_beside(x, speed / 1000, "feed").any()
    assert flagged_beside(x, np.full(N, 4000.0)).any(), "nothing stops"
    assert flagged_beside(x, speed, "power").any(), "what is no drive that stands says nothing"


def test_a_sensor_that_flickers_at_rest_too_is_stuck_while_the_drives_stand() -> None:
    x, speed = driven([(0, 300), (FROM, TO)], noise_at_rest=0.08)
    assert not flagged_beside(x, speed).any()
    assert flagged_beside(stands(x), speed)[FROM:TO].all()


def test_a_sensor_that_stays_frozen_as_the_drives_start_again_is_stuck() -> None:
    x, speed = driven([(FROM, TO)])
    assert not flagged_beside(stands(x, FROM, TO + 40), speed).any(), "by so little chance may"
    assert flagged_beside(stands(x, FROM, TO + 60), speed)[FROM : TO + 60].all()


def test_a_sensor_that_leaps_as_it_comes_back_is_stuck() -> None:
    x, speed = driven([(FROM, TO)])
    x[TO:] += 1.0
    assert flagged_beside(x, speed)[FROM:TO].all()


def probe(seed: int, count: float = 0.3, noise: float = 2.0) -> Float1D:
    """Displacement [um] in counts of a converter, which drifts by 20 um and flickers by some counts."""
    rng = np.random.default_rng(seed)
    drift = 20 * (1 - np.exp(-np.arange(N) / 1200)) + rng.normal(0, noise * count, N)
    return np.asarray(np.round(drift / count) * count)


def probes(*values: Float1D) -> Array:
    columns = {f"d{i}": ColumnInput(v, "displacement", at="tcp") for i, v in enumerate(values)}
    return np.asarray(flag_stream(clock(N, 10.0), columns)[0]["d0"])


@pytest.mark.parametrize("reads", [None, 0.0])
@pytest.mark.parametrize("stop", [FROM + 200, N])
def test_a_probe_that_stands_in_its_counts_is_flagged_beside_others_that_go_on(reads: float | None, stop: int) -> None:
    x = stands(probe(1), stop=stop)
    if reads is not None:
        x[FROM:stop] = reads
    assert not probes(probe(1), probe(2)).any()
    flags = probes(x, probe(2), probe(3))
    assert (flags[FROM:stop] & (Flag.STUCK | Flag.HELD)).all()
    assert not flags[: FROM - 5].any()


def test_a_probe_is_left_where_all_probes_stand_or_counts_are_coarse_or_for_minutes_only() -> None:
    stood = [stands(probe(seed), stop=N) for seed in (1, 2, 3)]
    assert not (probes(*stood) & Flag.STUCK).any()
    coarse = [np.round(probe(seed) / 2) * 2 for seed in (1, 2)]
    assert not (probes(*coarse) & (Flag.STUCK | Flag.HELD)).any()
    assert not (probes(stands(probe(1), stop=FROM + 170), probe(2)) & Flag.STUCK).any()
