"""Overloads that multimeters and counters of 32 bits write, and a handful of outliers of one size."""

from __future__ import annotations

import numpy as np
import pytest

from tests.calibration.quality_data import clock, noisy, run
from thermodata.schema.flag import Flag

QUANTITIES = ["displacement", "power", "current", "load", "torque", "voltage", "position", "feed", "angle", "pressure"]


@pytest.mark.parametrize("code", [1e9, -1e9, 9e9, 2147483647.0, float(np.float32(2147483647.0)), -2147483648.0])
@pytest.mark.parametrize("quantity", QUANTITIES)
def test_an_overload_is_no_reading(code: float, quantity: str) -> None:
    x = noisy()
    x[500] = code
    flags, _ = run(clock(), x=(quantity, x))
    assert np.flatnonzero(flags["x"]).tolist() == [500]
    assert flags["x"][500] & Flag.OUT_OF_RANGE


@pytest.mark.parametrize("code", [2147483.647, 214748364.7, float(np.float32(2147483.647)), 4294967.295])
@pytest.mark.parametrize("quantity", ["displacement", "position", "pressure", "flow", "resistance"])
def test_the_full_scale_of_a_long_counter_is_no_reading(code: float, quantity: str) -> None:
    x = noisy()
    x[[500, 700, 900, 1500]] = code
    flags, _ = run(clock(), x=(quantity, x))
    assert np.flatnonzero(flags["x"]).tolist() == [500, 700, 900, 1500]


@pytest.mark.parametrize(
    ("quantity", "large"),
    [("displacement", 5e6), ("position", 4e4), ("power", 3e4), ("load", 32767.0), ("current", 2e4)],
)
def test_a_scale_in_the_wrong_prefix_stays_a_reading(quantity: str, large: float) -> None:
    """An absolute scale of 5 m in um, watts declared as kW: told elsewhere, and no overload."""
    x = large * (1 + noisy() / 1e4)
    assert not run(clock(), x=(quantity, x))[0]["x"].any()


def test_a_resistance_may_be_of_gigaohms() -> None:
    x = np.linspace(2e8, 1.2e9, 6000) * (1 + noisy() / 1e5)
    x[3000] = 1e9
    assert not run(clock(), x=("resistance", x))[0]["x"].any()


@pytest.mark.parametrize("count", [1, 4, 6, 9])
@pytest.mark.parametrize("height", [-7123.0, 1234.5])
def test_as_many_outliers_of_one_size_as_there_are_are_spikes(count: int, height: float) -> None:
    x = noisy(n=2880, noise=0.05) / 3
    at = np.arange(100, 100 + 150 * count, 150)
    x[at] = height
    flags, _ = run(clock(2880, 5.0), dZ=("displacement", x))
    assert np.flatnonzero(flags["dZ"]).tolist() == at.tolist()
    assert set(flags["dZ"][at].tolist()) == {int(Flag.SPIKE)}


def test_outliers_within_the_span_of_the_rest_stay_what_the_channel_does() -> None:
    rng = np.random.default_rng(5)
    x = np.clip(22 + 0.02 * rng.standard_t(1.5, 3000), 19, 25)
    assert not (run(clock(3000), T=("temperature", x))[0]["T"] & Flag.SPIKE).any()


@pytest.mark.parametrize("quantity", ["displacement", "power", "temperature_difference", "voltage"])
@pytest.mark.parametrize("code", [-6999.0, -7999.0, 6999.0])
def test_what_a_logger_of_two_bytes_writes_beyond_its_range_is_no_reading(code: float, quantity: str) -> None:
    x = noisy()
    x[[500, 501, 900]] = code
    flags, _ = run(clock(), x=(quantity, x))
    assert np.flatnonzero(flags["x"] & Flag.OUT_OF_RANGE).tolist() == [500, 501, 900]


def _speed(low: float = 0.0, high: float = 4000.0) -> np.ndarray:
    x = np.full(6000, low)
    x[2000:4000] = high
    return x


@pytest.mark.parametrize("quantity", ["rotational_speed", "feed", "position", "angle"])
@pytest.mark.parametrize("code", [-9999.0, -99999.0, -6999.0, 99999.0, -999.9, -3276.8])
def test_a_code_where_no_drive_goes_is_no_reading(code: float, quantity: str) -> None:
    x = _speed()
    x[1000:1031] = code
    flags, _ = run(clock(), x=(quantity, x))
    assert np.flatnonzero(flags["x"] & Flag.OUT_OF_RANGE).tolist() == list(range(1000, 1031))


@pytest.mark.parametrize(
    ("low", "high", "reading"),
    [
        (0.0, 4000.0, 9999.0),  # commanded
        (-4000.0, 4000.0, -9999.0),
        (0.0, 9999.0, -9999.0),  # to and fro
    ],
)
def test_a_row_of_nines_that_somebody_may_command_is_a_reading(low: float, high: float, reading: float) -> None:
    x = _speed(low, high)
    x[1000:1031] = reading
    assert not (run(clock(), n=("rotational_speed", x))[0]["n"] & Flag.OUT_OF_RANGE).any()


def test_a_drive_that_mostly_turns_at_a_row_of_nines_does() -> None:
    x = _speed()
    x[1000:1900] = -9999.0
    assert not (run(clock(), n=("rotational_speed", x))[0]["n"] & Flag.OUT_OF_RANGE).any()
