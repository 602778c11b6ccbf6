"""A log that dies whole repeats its last row; one that comes to rest, or of which one sensor dies, does not."""

from __future__ import annotations

import numpy as np
import pytest

from thermodata.calibration.quality.column import ColumnInput
from thermodata.calibration.quality.flags import flag_stream
from thermodata.plugin import Array
from thermodata.schema.flag import Flag

N, DIES, STEP_S = 4000, 3000, 5.0


def log(tread_k: float = 0.1, noise_k: float = 0.1) -> dict[str, tuple[Array, str]]:
    """Three temperatures, a displacement in 10 nm and a speed, every 5 s."""
    rng, t_s = np.random.default_rng(1), np.arange(N) * STEP_S
    columns: dict[str, tuple[Array, str]] = {}
    for k in range(3):
        x = 20 + 10 * (1 - np.exp(-t_s / 3600 / (1 + k))) + rng.normal(0, noise_k, N)
        columns[f"T{k}"] = (np.round(x / tread_k) * tread_k, "temperature")
    x = 30 * (1 - np.exp(-t_s / 5000)) + rng.normal(0, 0.2, N)
    columns["dZ"] = (np.round(x, 2), "displacement")
    columns["n"] = (np.where(t_s % 7200 < 3600, 3000.0, 0.0), "rotational_speed")
    return columns


def held(columns: dict[str, tuple[Array, str]], step_s: float = STEP_S, on_change: tuple[str, ...] = ()) -> set[str]:
    """The channels that are held from the row on in which the log died to its end, and in no other."""
    t_ns = (np.arange(N) * step_s * 1e9).astype(np.int64)
    made = {k: ColumnInput(x, q, held=k in on_change) for k, (x, q) in columns.items()}
    flags, _ = flag_stream(t_ns, made)
    hit = {k: (f & np.uint16(Flag.HELD)) != 0 for k, f in flags.items()}
    assert not any(h[: DIES - 1].any() for h in hit.values())
    return {k for k, h in hit.items() if h[DIES:].all()}


def dead(columns: dict[str, tuple[Array, str]], *names: str) -> dict[str, tuple[Array, str]]:
    for name in names or columns:
        columns[name][0][DIES:] = columns[name][0][DIES - 1]
    return columns


def test_all_of_a_log_that_repeats_its_last_row_is_held() -> None:
    assert held(dead(log())) == {"T0", "T1", "T2", "dZ", "n"}
    assert held(dead(log()), on_change=("n",)) == {"T0", "T1", "T2", "dZ"}


def test_one_that_goes_on_tells_that_the_log_lives() -> None:
    assert held(dead(log(), "T0", "T1", "dZ", "n")) == {"dZ"}
    assert held(log()) == set()


def test_coarse_readings_that_rest_beside_a_probe_that_is_held_are_left() -> None:
    assert held(dead(log(tread_k=1.0, noise_k=0.02))) == {"dZ"}


def test_readings_of_one_quantity_are_left() -> None:
    columns = dead(log())
    assert held({k: columns[k] for k in ("T0", "T1", "T2")}) == set()
    assert held({k: columns[k] for k in ("dZ", "n")}) == {"dZ"}


@pytest.mark.parametrize(("minutes", "told"), [(29, False), (31, True)])
def test_it_takes_half_an_hour(minutes: float, told: bool) -> None:
    assert ("T0" in held(dead(log()), step_s=60 * minutes / (N - DIES))) is told
