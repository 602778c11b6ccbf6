"""Zeros that a program writes on all channels at once where it measured nothing (calibration/quality/zeros.py)."""

from __future__ import annotations

import numpy as np
from quality_data import N, clock, kinds, noisy, run

from thermodata.plugin import Array
from thermodata.schema.flag import Flag


def _gated(temperature: float) -> dict[str, tuple[str, Array]]:
    """A speed that stands at 0, a probe, and a temperature; from row 3000 to 3030 all are 0."""
    columns = {
        "dZ": ("displacement", noisy(0) - 20),
        "T": ("temperature", noisy(1) / 10 + temperature),
        "n": ("rotational_speed", np.repeat([4000.0, 0.0], [2000, N - 2000])),
    }
    for _, values in columns.values():
        values[3000:3030] = 0.0
    return columns


def test_a_row_in_which_all_channels_leap_to_0_is_not_measured() -> None:
    flags, events = run(clock(), **_gated(25), door=("state", np.ones(N)))
    for name in ("dZ", "T", "n"):
        assert np.flatnonzero(flags[name] & Flag.NOT_MEASURING).tolist() == list(range(3000, 3030)), name
    assert not flags["door"].any()
    assert not (flags["T"] & Flag.OFFSET).any()
    assert kinds(events) == []


def test_zeros_without_a_leap_or_of_some_channels_are_readings() -> None:
    flags, _ = run(clock(), **_gated(2))
    assert not any((f & Flag.NOT_MEASURING).any() for f in flags.values())
    flags, _ = run(clock(), **_gated(25), T_bed=("temperature", noisy(2) / 10 + 22))
    assert not any((f & Flag.NOT_MEASURING).any() for f in flags.values())
