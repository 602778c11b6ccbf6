"""Quality flags: each defect is found where it was put, and sound data are left alone."""

from __future__ import annotations

import numpy as np
import pytest
from quality_data import N, clock, kinds, noisy, run

from thermodata.calibration.quality.column import ColumnInput
from thermodata.calibration.quality.concise import concise
from thermodata.calibration.quality.flags import flag_stream
from thermodata.plugin import Float1D
from thermodata.schema.flag import Flag


def test_sound_data_get_no_flag() -> None:
    speed = np.repeat([0.0, 6000.0, 0.0, 9000.0], N // 4)
    flags, events = run(
        clock(),
        dZ=("displacement", noisy(0)),
        T=("temperature", noisy(1) / 10 + 25),
        T_kelvin=("temperature", np.round(noisy(2) / 5 + 25)),
        T_tenth=("temperature", np.round(noisy(3) / 5 + 25, 1)),
        n=("rotational_speed", speed),
        pos=("position", np.where(np.arange(N) % 600 < 10, 210.0, noisy(4))),
        door=("state", speed > 0),
    )
    assert events == []
    assert all(not f.any() for f in flags.values())


def test_sound_noise_free_data_get_no_flag() -> None:
    t = np.arange(N) / 3600
    heated = np.where(t > 0.2, 5 * (1 - np.exp(-(t - 0.2) / 0.3)), 0.0)  # at rest, then a smooth rise
    _, events = run(clock(), dZ=("displacement", heated), T=("temperature", 20 + 0.3 * t), dX=("displacement", 0 * t))
    assert events == []


def test_a_gap_flags_the_first_sample_after_it() -> None:
    t = clock()
    t[4000:] += 130_000_000_000
    flags, events = run(t, dZ=("displacement", noisy()), n=("rotational_speed", np.zeros(N)))
    for channel in ("dZ", "n"):
        assert np.flatnonzero(flags[channel] & Flag.GAP).tolist() == [4000]
    assert kinds(events) == [(None, "gap")]
    assert "131 s" in events[0].detail
    assert events[0].to_ns == t[4000]


def test_one_lost_sample_and_jitter_are_no_gap() -> None:
    rng = np.random.default_rng(0)
    t = clock() + rng.integers(-200_000_000, 200_000_000, N)
    keep = np.ones(N, bool)
    keep[2000] = False
    assert run(t[keep], dZ=("displacement", noisy()[keep]))[1] == []


def test_a_log_written_on_change_has_no_gaps_but_long_silences() -> None:
    rng = np.random.default_rng(1)
    t = np.cumsum(rng.exponential(5.0, N) * 1e9).astype(np.int64) + np.arange(N)
    assert [e for e in run(t, n=("rotational_speed", np.zeros(N)))[1] if e.flag == "rate_change"] == []
    t[3000:] += 3600_000_000_000
    events = run(t, n=("rotational_speed", np.zeros(N)))[1]
    assert kinds(events) == [(None, "gap")]


def test_repeated_and_backward_time() -> None:
    t = clock()
    t[100] = t[99]
    t[3000:] -= 10_500_000_000  # the clock is set back
    flags, events = run(t, dZ=("displacement", noisy()))
    assert flags["dZ"][100] == Flag.DUPLICATE_TIME
    back = np.flatnonzero(flags["dZ"] & Flag.CLOCK_SUSPECT)
    assert back.tolist() == list(range(3000, 3010))
    assert (flags["dZ"][back] & Flag.DUPLICATE_TIME).all()
    assert [k for k in kinds(events) if k[1] != "gap"] == [(None, "duplicate_time"), (None, "clock_suspect")]


def test_one_sample_from_the_future_does_not_condemn_the_rest() -> None:
    t = clock()
    t[500] += 10**16
    flags, _ = run(t, dZ=("displacement", noisy()))
    assert np.flatnonzero(flags["dZ"]).tolist() == [500]
    assert flags["dZ"][500] & Flag.CLOCK_SUSPECT


def test_a_change_of_rate_is_found_and_is_no_gap() -> None:
    t = np.concatenate([clock(3000), clock(3000)[-1] + np.arange(1, 3001) * 10_000_000_000])
    flags, events = run(t, dZ=("displacement", noisy()))
    assert np.flatnonzero(flags["dZ"]).tolist() == [3000]
    assert flags["dZ"][3000] & Flag.RATE_CHANGE
    assert kinds(events) == [(None, "rate_change")]
    assert "1 s to 10 s" in events[0].detail


def test_a_displacement_held_while_the_spindle_stands() -> None:
    x = noisy()
    x[2000:3000] = x[2000]
    flags, events = run(clock(), dZ=("displacement", x), dX=("displacement", noisy(5)))
    assert np.flatnonzero(flags["dZ"] == Flag.HELD).tolist() == list(range(2000, 3000))
    assert not flags["dX"].any()
    assert kinds(events) == [("dZ", "held")]
    assert "dX moved" in events[0].detail


def test_a_held_reading_of_a_smooth_channel_shows_by_its_jump() -> None:
    x = 30 * np.sin(np.arange(N) / 900)  # filtered: no noise left
    x[2000:2600] = x[2000]
    flags, _ = run(clock(), dZ=("displacement", x), T=("temperature", noisy(1) / 10))
    assert (flags["dZ"][2000:2600] == Flag.HELD).all()


@pytest.mark.parametrize(("every", "late"), [(1, 0), (5, 0), (10, 0), (10, 1), (15, 0), (15, 1), (60, 0), (60, 5)])
def test_a_reading_that_is_asked_less_often_than_it_is_logged_is_not_held(every: int, late: int) -> None:
    """A weather sensor that a control asks every 10 s, in a log of every second; it is held where it stands for more
    of its own readings. Where it repeats for less than ten samples nothing is said."""
    rng = np.random.default_rng(every)
    lengths = every + rng.integers(-late, late + 1, 2 * N // every)
    sun = 300 + 40 * np.sin(np.arange(len(lengths)) / 90) + rng.normal(0, 8, len(lengths))
    x = np.repeat(np.round(sun), lengths)[:N]
    asked = {"sun": ("irradiance", x), "dZ": ("displacement", noisy())}
    assert run(clock(), **asked)[1] == []
    stands = slice(2000, 2000 + 25 * every)
    x[stands] = x[2000]
    flags, events = run(clock(), **asked)
    told = every == 1 or every - late >= 10
    assert kinds(events) == [("sun", "held")] * told
    assert flags["sun"][stands].all() == told


def test_whole_kelvin_and_standing_states_are_not_held() -> None:
    slow = 25 + 3 * np.sin(np.arange(N) / 2000)
    _, events = run(
        clock(),
        T=("temperature", np.round(slow)),
        dZ=("displacement", noisy()),
        n=("rotational_speed", np.zeros(N)),
        P=("power", np.r_[noisy(3)[:3000], np.zeros(3000)]),
    )
    assert events == []


def test_a_sudden_exact_hundred_after_a_gap_is_stuck() -> None:
    t, x = clock(), 25 + noisy(noise=0.05) / 20
    t[4000:] += 130_000_000_000
    x[4000:] = 100.0
    flags, events = run(t, T=("temperature", x), dZ=("displacement", noisy()))
    assert ((flags["T"][4000:] & Flag.STUCK) > 0).all()
    assert not flags["T"][:4000].any()
    assert ("T", "stuck") in kinds(events)


@pytest.mark.parametrize("length", [1, 2, 3])
@pytest.mark.parametrize("height", [30.0, -500.0])
def test_spikes_of_one_to_three_samples(length: int, height: float) -> None:
    x = noisy()
    x[1234 : 1234 + length] += height
    flags, events = run(clock(), dZ=("displacement", x))
    assert np.flatnonzero(flags["dZ"]).tolist() == list(range(1234, 1234 + length))
    assert kinds(events) == [("dZ", "spike")]


def test_a_step_and_a_pulse_that_lasts_are_no_spikes() -> None:
    x = noisy()
    x[1000:] += 40
    x[3000:3020] += 40
    assert run(clock(), dZ=("displacement", x))[1] == []


def test_what_stands_out_all_the_time_is_no_spike() -> None:
    x = noisy()
    x[::100] += 60  # one sample of each measuring phase
    flags, events = run(clock(), dZ=("displacement", x))
    assert not flags["dZ"].any()
    assert [e.detail.split(":")[0] for e in events] == ["not flagged"]


def test_a_probe_that_reads_30_kelvin_more_ever_after() -> None:
    x = 25 + noisy(noise=0.05) / 20
    x[4000:] += 30
    flags, events = run(clock(), T=("temperature", x))
    assert np.flatnonzero(flags["T"] & Flag.OFFSET).tolist() == list(range(4000, N))
    assert "+30" in events[0].detail
    x[5000:] -= 30
    assert np.flatnonzero(run(clock(), T=("temperature", x))[0]["T"] & Flag.OFFSET).tolist() == list(range(4000, 5000))


def stepped(back_to: float) -> Float1D:
    """30 K up within a sample, then down along a slope to so many kelvin above the level before, and there it stays."""
    x = 25 + noisy(noise=0.05) / 20
    x[4000:] += np.interp(np.arange(N - 4000), [0, 500, 1500], [30.0, 30.0, back_to])
    return x


@pytest.mark.parametrize(("back_to", "flagged"), [(8.0, False), (10.0, True)])
def test_what_comes_back_by_itself_was_no_offset(back_to: float, flagged: bool) -> None:
    """To within 0.3 of the step: a machine may cool, a sensor that is off does not mend."""
    flags, _ = run(clock(), T=("temperature", stepped(back_to)))
    assert bool((flags["T"] & Flag.OFFSET).any()) is flagged


def test_a_sensor_that_fails_after_a_real_step_is_flagged_from_its_failure_on() -> None:
    x = stepped(0.0)
    x[5600:] += 30
    flags, _ = run(clock(), T=("temperature", x))
    assert np.flatnonzero(flags["T"] & Flag.OFFSET).tolist() == list(range(5600, N))


@pytest.mark.parametrize(
    ("at", "flagged"),
    [
        *(("tool", False), ("tcp", False), ("Probe", False), ("stator", False), ("tool.tip", False)),
        *(("toolchanger", True), ("spindle.bearing.front", True), ("workpiece", True), (None, True)),
    ],
)
def test_at_the_tool_a_jump_is_no_fault(at: str | None, flagged: bool) -> None:
    """A tool change does it."""
    x = 25 + noisy(noise=0.05) / 20
    x[4000:] += 30
    flags, _ = flag_stream(clock(), {"T": ColumnInput(x, "temperature", at=at)})
    assert bool((flags["T"] & Flag.OFFSET).any()) is flagged


def test_missing_values_are_flagged_and_end_with_a_gap() -> None:
    x = noisy()
    x[:50], x[100:110] = np.nan, np.nan
    flags, events = run(clock(), T=("temperature", x))
    assert np.flatnonzero(flags["T"] & Flag.OUT_OF_RANGE).tolist() == [*range(50), *range(100, 110)]
    assert np.flatnonzero(flags["T"] & Flag.GAP).tolist() == [50, 110]
    assert [e.n for e in events] == [50, 10]


def test_flags_that_are_there_are_kept_and_reported() -> None:
    given = np.zeros(N, np.uint16)
    given[10:20] = Flag.SATURATED
    flags, events = flag_stream(clock(), {"dZ": ColumnInput(noisy(), "displacement", flags=given)})
    assert np.flatnonzero(flags["dZ"] == Flag.SATURATED).tolist() == list(range(10, 20))
    assert kinds(events) == [("dZ", "saturated")]
    assert given.sum() == 10 * Flag.SATURATED


def test_a_range_flags_limits_and_beyond() -> None:
    x = noisy()
    x[100], x[200] = 300.0, 250.0
    flags, _ = flag_stream(clock(), {"pos": ColumnInput(x, "position", range=(-250.0, 250.0))})
    assert flags["pos"][100] == Flag.OUT_OF_RANGE
    assert flags["pos"][200] == Flag.SATURATED


@pytest.mark.parametrize("n", [0, 1, 2, 5])
def test_short_streams(n: int) -> None:
    flags, events = run(clock(n), dZ=("displacement", noisy(n=n)), s=("label", np.array(["a"] * n, dtype=object)))
    assert flags["dZ"].shape == flags["s"].shape == (n,)
    assert flags["dZ"].dtype == np.uint16
    assert events == []


def test_events_are_bounded() -> None:
    x = noisy()
    x[::2] = np.nan
    events = concise(run(clock(), dZ=("displacement", x))[1])
    assert len(events) == 1
    assert "stretches" in events[0].detail
    assert sum(e.n for e in events if e.flag == "out_of_range") == N // 2


def test_columns_of_another_length_are_refused() -> None:
    with pytest.raises(ValueError, match="shape"):
        run(clock(), dZ=("displacement", noisy(n=5)))
