"""Readings at and beyond the ends of a sensor's range, and sensors that step over a pause."""

from __future__ import annotations

import numpy as np
import pytest
from quality_data import N, clock, kinds, noisy, run

from thermodata.plugin import Array, Float1D
from thermodata.schema.flag import Flag


def temperature(seed: int = 1) -> Float1D:
    return noisy(seed, noise=0.05) / 20 + 25


@pytest.mark.parametrize("value", [850.0, -242.02, 3276.7, 1e38, np.inf])
def test_a_broken_pt100_is_out_of_range(value: float) -> None:
    x = temperature()
    x[3000:3050] = value
    flags, events = run(clock(), T=("temperature", x))
    assert np.flatnonzero(flags["T"] & Flag.OUT_OF_RANGE).tolist() == list(range(3000, 3050))
    assert ("T", "out_of_range") in kinds(events)
    assert len([e for e in events if e.flag == "out_of_range"]) == 1


def test_what_is_heated_may_be_hot() -> None:
    x = 25 + 700 * np.exp(-(((np.arange(N) - 3000) / 500.0) ** 2)) + noisy(1, noise=0.05) / 20
    flags, _ = run(clock(), T=("temperature", x))
    assert not flags["T"].any()


def test_a_loggers_code_for_no_value_is_out_of_range_and_a_reading_of_that_size_is_not() -> None:
    x = noisy()
    x[100:103] = -9999.0
    flags, events = run(clock(), dZ=("displacement", x), p=("pressure", np.linspace(0, 9999, N) + noisy(2)))
    assert np.flatnonzero(flags["dZ"] & Flag.OUT_OF_RANGE).tolist() == [100, 101, 102]
    assert "code" in events[0].detail
    assert not flags["p"].any()


@pytest.mark.parametrize("beside", [1e38, -1e38, 65535.0, -32768.0, 99999.0])
def test_codes_of_several_kinds_are_told_beside_each_other(beside: float) -> None:
    x = noisy()
    x[100:103], x[200:203] = 32767.0, beside
    flags, _ = run(clock(), dZ=("displacement", x))
    assert np.flatnonzero(flags["dZ"] & Flag.OUT_OF_RANGE).tolist() == [100, 101, 102, 200, 201, 202]


@pytest.mark.parametrize(
    "code",
    [
        *(-99999.99999, 99999.99999, -9999.0, -9999.99, 999999.0, -999.0, -999.99, float(np.float32(999.9))),
        *(9.9e37, -9.9e37, 9.91e37, 1e308, -1e308),
    ],
)
@pytest.mark.parametrize("quantity", ["displacement", "temperature", "pressure"])
@pytest.mark.filterwarnings("error")
def test_no_value_of_an_instrument_is_none(code: float, quantity: str) -> None:
    """9.9E+37 is SCPI's overload, 9.91E+37 its "not a number"; the others are what programs write for nothing."""
    x = noisy() / 20 + 25
    x[100:103] = code
    flags, events = run(clock(), x=(quantity, x))
    assert np.flatnonzero(flags["x"] & Flag.OUT_OF_RANGE).tolist() == [100, 101, 102]
    assert [e.n for e in events if e.flag == "out_of_range"] == [3]


@pytest.mark.parametrize("value", [-999.0, 99999.99999])
def test_a_reading_of_the_size_of_a_code_is_one(value: float) -> None:
    x = np.linspace(0, 1.01 * value, N) + noisy(2)
    x[3000] = value
    flags, _ = run(clock(), p=("pressure", x))
    assert not (flags["p"] & Flag.OUT_OF_RANGE).any()


def test_what_passes_through_a_code_on_its_way_to_another_is_a_reading() -> None:
    x = np.linspace(0, 65535, N) + noisy(2)
    x[3000:3003], x[-1] = 32767.0, 65535.0
    x[4000:4003] = 1e38
    flags, _ = run(clock(), p=("pressure", x))
    assert np.flatnonzero(flags["p"] & Flag.OUT_OF_RANGE).tolist() == [4000, 4001, 4002]


def test_a_noisy_probe_that_runs_into_its_limit_is_saturated() -> None:
    x = noisy()
    limit = float(np.quantile(x, 0.9))
    sound = x < limit
    flags, events = run(clock(), dZ=("displacement", np.minimum(x, limit)))
    assert ((flags["dZ"] & Flag.SATURATED) > 0).tolist() == (~sound).tolist()
    assert not (flags["dZ"] & (Flag.HELD | Flag.STUCK)).any()
    assert "upper limit" in events[0].detail


def test_a_probe_that_comes_back_to_full_scale_is_saturated_not_stuck() -> None:
    x = noisy()
    for start in range(500, 5000, 900):
        x[start : start + 40] = 480.0  # the axis leaves the probe: full scale
    flags, _ = run(clock(), dZ=("displacement", x))
    assert np.flatnonzero(flags["dZ"] & Flag.SATURATED).size == 6 * 40 - 40 * (6 - len(range(500, 5000, 900)))
    assert not (flags["dZ"] & Flag.STUCK).any()


def test_rest_at_zero_and_coarse_readings_are_no_limit() -> None:
    slow = np.round(25 + 3 * np.sin(np.arange(N) / 2000))
    cut = np.maximum(noisy(), 0.0)
    flags, events = run(clock(), T=("temperature", slow), dZ=("displacement", cut))
    assert not (flags["T"] | (flags["dZ"] & Flag.SATURATED)).any()
    assert [k for k in kinds(events) if k[1] == "saturated"] == []


def test_a_sensor_that_reads_30_kelvin_more_after_a_weekend() -> None:
    x = temperature()
    t = clock()
    t[4000:] += 60 * 3600 * 10**9
    x[4000:] += 30
    flags, events = run(t, T=("temperature", x))
    assert np.flatnonzero(flags["T"] & Flag.OFFSET).tolist() == list(range(4000, N))
    assert any("pause" in e.detail for e in events if e.flag == "offset")


def test_a_machine_that_cooled_over_a_weekend_is_sound() -> None:
    x = temperature() + 25 * (1 - np.exp(-np.arange(N) / 1500))
    x[4000:] -= 25
    t = clock()
    t[4000:] += 60 * 3600 * 10**9
    flags, _ = run(t, T=("temperature", x))
    assert not (flags["T"] & Flag.OFFSET).any()


def test_a_probe_that_stands_from_the_first_row_on_is_held_not_saturated() -> None:
    x, speed = noisy(noise=0.05), np.full(N, 8000.0) + noisy(3)
    x = x - np.ptp(x) * np.arange(N) / N
    x[:1000], speed[:1000] = x[1000:].max(), 0.0
    t = noisy(4, noise=0.05) / 20 + 25
    flags, events = run(clock(), dZ=("displacement", x), T=("temperature", t), n=("rotational_speed", speed))
    assert "saturated" not in {flag for _, flag in kinds(events)}
    assert (flags["dZ"][10:990] & (Flag.HELD | Flag.STUCK)).all()


def day(seed: int = 1) -> Float1D:
    """A pyranometer in steps of 0.1 W/m2 that reads 5 W/m2 by night, for 48 h; thin clouds pass."""
    hours = np.linspace(0, 48, N)
    sun = np.clip(np.sin(2 * np.pi * (hours - 6) / 24), 0, None)
    clouds = 1 + 0.03 * np.random.default_rng(seed).standard_normal(N)
    return np.asarray(5 + np.round(600 * sun * clouds, 1), dtype=np.float64)


def test_the_night_of_an_irradiance_is_neither_held_nor_saturated() -> None:
    x, moved = day(), temperature()
    flags, events = run(clock(), G=("irradiance", x), T=("temperature", moved))
    assert not flags["G"].any(), events
    for other in ("humidity", "pressure"):
        flags, _ = run(clock(), G=(other, x / 8), T=("temperature", moved))
        assert (flags["G"] & (Flag.HELD | Flag.SATURATED)).any(), "these are never that constant"


def test_a_lamp_by_night_is_no_fault_either() -> None:
    x = day()
    x[100:400] = 17.0
    flags, events = run(clock(), G=("irradiance", x), T=("temperature", temperature()))
    assert not flags["G"].any(), events
    x[100:400] = 60.0
    flags, _ = run(clock(), G=("irradiance", x), T=("temperature", temperature()))
    assert (flags["G"][100:400] & (Flag.HELD | Flag.STUCK)).all()


@pytest.mark.parametrize(("times", "flagged"), [(3, False), (14, True)])
def test_a_highest_reading_that_is_logged_often_is_one_reading(times: int, flagged: bool) -> None:
    """A pyranometer that is asked every tenth sample comes to its highest reading three times by chance."""
    rng = np.random.default_rng(5)
    asked = 300 + 90 * np.sin(np.arange(N // 10) / 60) + rng.normal(0, 12, N // 10)
    asked[rng.choice(len(asked), times, replace=False)] = top = np.ceil(asked.max())
    asked = np.where(asked < top, np.round(asked), top)
    flags, _ = run(clock(), G=("irradiance", np.repeat(asked, 10)[:N]), T=("temperature", temperature()))
    assert bool((flags["G"] & Flag.SATURATED).any()) is flagged


@pytest.mark.parametrize("code", [None, 32767.0])
def test_an_irradiance_that_stands_still_by_day_is_held(code: float | None) -> None:
    """Also where a logger's code makes its range a wide one."""
    x = day()
    if code is not None:
        x[2000:2010] = code
    noon = slice(N // 8 * 2 - 150, N // 8 * 2 + 150)
    x[noon] = 400.0
    flags, _ = run(clock(), G=("irradiance", x), T=("temperature", temperature()))
    assert (flags["G"][noon] & (Flag.HELD | Flag.STUCK)).all()
    assert not flags["G"][: noon.start].any()
    night = (flags["G"] & Flag.OUT_OF_RANGE) == 0
    night[noon.start : noon.stop + 1] = False
    assert not (flags["G"][night] & (Flag.HELD | Flag.STUCK | Flag.SATURATED)).any()


def irradiance_flags(x: Float1D) -> Array:
    flags, _ = run(clock(), G=("irradiance", x), T=("temperature", temperature()))
    return np.asarray(flags["G"] & (Flag.HELD | Flag.STUCK | Flag.SATURATED))


@pytest.mark.parametrize("reading", [0.0, 5.0, 20.0])
def test_a_cable_that_is_off_by_day_is_no_night(reading: float) -> None:
    """It leaps to a night's reading, and back."""
    x = day()
    noon = slice(N // 4 - 150, N // 4 + 150)
    x[noon] = reading
    assert irradiance_flags(x)[noon].all()
    x[: noon.start] = reading  # off from the night on
    assert not irradiance_flags(x).any(), "its night may have been as long"


def test_the_lowest_reading_of_a_day_is_no_night() -> None:
    hours = np.linspace(8, 16, N)
    x = np.round(600 * np.sin(2 * np.pi * (hours - 6) / 24) + np.random.default_rng(3).normal(0, 5, N), 1)
    for low in (250.0, 400.0):
        stands = x.copy()
        stands[1000:2200] = low
        assert irradiance_flags(stands)[1000:2200].all()


@pytest.mark.parametrize("seed", range(6))
def test_an_extreme_that_was_only_reached_is_no_end_of_a_range(seed: int) -> None:
    """A bounded noise comes to its extreme again; what is cut off there piles up."""
    rng = np.random.default_rng(seed)
    x = np.round(20.5 + 2 * np.clip((np.arange(N) - 1500) / 3000, 0, None) ** 2 + rng.uniform(-0.05, 0.05, N), 2)
    columns = {"p": ("displacement", noisy(2))}
    assert "saturated" not in {flag for _, flag in kinds(run(clock(), T=("temperature", x), **columns)[1])}
    cut = np.maximum(x, 20.5)
    flags, _ = run(clock(), T=("temperature", cut), **columns)
    assert (flags["T"][:1500][cut[:1500] == 20.5] & Flag.SATURATED).all()


def clear(seed: int, coarse: float = 1.0, hours: float = 6.0, clouds: int = 12) -> Float1D:
    """A clear sky about noon in whole W/m2, every 5 s for 6 h; clouds pass and make it darker."""
    rng = np.random.default_rng(seed)
    t_s = np.arange(int(hours * 720)) * 5.0
    x = 550 * np.cos(2 * np.pi * (t_s - 3 * 3600) / 86400)
    for at in rng.integers(0, len(x), clouds):
        n = int(rng.integers(10, 60))
        dim = 1 - 0.4 * np.abs(rng.normal(0, 1, len(x[at : at + n]))) * np.hanning(n)[: len(x[at : at + n])]
        x[at : at + n] *= dim
    return np.asarray(np.round(x / coarse) * coarse)


def of_clear_sky(x: Float1D) -> Array:
    others = {"T": ("temperature", noisy(1, len(x), noise=0.05) / 20 + 25)}
    return np.asarray(run(clock(len(x), 5.0), G=("irradiance", x), **others)[0]["G"] & (Flag.HELD | Flag.SATURATED))


@pytest.mark.parametrize("seed", range(8))
def test_a_clear_sky_about_noon_is_neither_held_nor_saturated(seed: int) -> None:
    """It goes through its highest readings slowly, and comes there again after each cloud."""
    rng = np.random.default_rng(seed)
    for clouds in (0, 5, 12, 40):
        x = clear(seed, clouds=clouds)
        x[: len(x) // 4] = np.round(x[: len(x) // 4] * (1 - np.abs(rng.normal(0, 0.02, len(x) // 4))))
        assert not of_clear_sky(x).any()
        means = x.copy()
        means[1::2] = (x[:-1:2] + x[1::2]) / 2  # as where it is brought to the rows of another logger
        assert not of_clear_sky(means).any()


@pytest.mark.parametrize(("start", "minutes", "flagged"), [(2160, 15, False), (2160, 55, True), (3000, 55, True)])
def test_the_sun_stands_for_half_an_hour_at_most(start: int, minutes: int, flagged: bool) -> None:
    """By whole W/m2 it stands for so long about noon, at 550 W/m2."""
    rng = np.random.default_rng(1)
    x = clear(1, clouds=0)
    passing = slice(len(x) // 8, len(x) // 3)
    x[passing] = np.round(x[passing] * (1 - 0.1 * np.abs(rng.normal(0, 1, passing.stop - passing.start))))
    half = minutes * 6
    x[start - half : start + half] = x[start - half]
    assert bool((of_clear_sky(x)[start - half : start + half] != 0).all()) is flagged


def test_a_reading_below_others_about_it_is_no_clear_sky() -> None:
    x = np.round(400 + np.random.default_rng(2).normal(0, 12, 4320))
    x[2000:2040] = 396.0
    assert of_clear_sky(x)[2000:2040].all()


def drive(low: float, high: float, seed: int = 5) -> Float1D:
    """What follows a spindle that is switched on and off, with the noise of its reading."""
    on = (np.arange(N) // 700) % 2
    x = low + (high - low) * on + 0.02 * (high - low) * np.random.default_rng(seed).standard_normal(N) * on
    return np.round(x, 3)


@pytest.mark.parametrize(
    ("quantity", "low", "high", "code"),
    [
        ("rotational_speed", 0, 8000, 65535.0),
        ("rotational_speed", 0, 0, 32767.0),  # it never turns
        ("power", 0.12, 3.2, 3276.7),
        ("load", 0.4, 15, 255.0),
        ("current", 1, 7, -3276.8),
        ("flow", 6, 9, 999.9),
        ("torque", 0, 20, -9999.0),
        ("feed", 0, 10, 6553.5),
        ("position", -300, 300, 32767.0),
    ],
)
def test_a_code_for_no_value_is_out_of_range_in_a_drive_too(
    quantity: str, low: float, high: float, code: float
) -> None:
    x = drive(low, high)
    x[1000:1003] = code
    flags, events = run(clock(), d=(quantity, x))
    assert np.flatnonzero(flags["d"] & Flag.OUT_OF_RANGE).tolist() == [1000, 1001, 1002]
    assert [e.detail for e in events if e.flag == "out_of_range"] == ["a logger's code for 'no value'"]


@pytest.mark.parametrize(
    ("quantity", "x"),
    [
        ("rotational_speed", np.where(np.arange(N) % 1000 > 500, 9999.0, 0.0)),
        ("rotational_speed", np.where(np.arange(N) == 3000, 9999.0, 100.0)),
        ("position", np.where(np.arange(N) % 1000 > 500, 9999.0, 0.0)),
        ("load", np.maximum(3.0, 255.0 - np.abs(np.arange(N) - 3000.0))),  # by a ramp
        ("load", np.where(np.arange(N) % 1000 > 500, 255.0, 110.0) + drive(0, 60) * (np.arange(N) % 1000 < 500)),
        ("power", np.linspace(0, 9999.0, N)),
    ],
)
def test_what_a_drive_comes_to_is_data(quantity: str, x: Float1D) -> None:
    flags, _ = run(clock(), d=(quantity, x))
    assert not (flags["d"] & Flag.OUT_OF_RANGE).any()
