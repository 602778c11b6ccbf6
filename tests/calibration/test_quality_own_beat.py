"""Cells that are empty because the row is another logger's are no fault (quality/own_beat.py)."""

from __future__ import annotations

import numpy as np
import pytest
from quality_data import kinds, run

from thermodata.plugin import Float1D, Int1D
from thermodata.schema.flag import Flag

S = 1_000_000_000


def recorder(late_s: float = 0.026) -> tuple[Int1D, Float1D, Float1D]:
    """(times, probe, temperature): probes every 3 s and temperatures every 30 s, in rows of their own."""
    rng = np.random.default_rng(1)
    probe = 10 * S + (np.arange(1200) * 3 * S)
    warm = 10 * S + round(late_s * S) + (np.arange(120) * 30 * S)
    t = np.sort(np.concatenate([probe, warm]))
    is_warm = np.isin(t, warm)
    x = np.where(is_warm, np.nan, rng.normal(0, 0.1, len(t)))
    y = np.where(is_warm, 20 + rng.normal(0, 0.02, len(t)), np.nan)
    return t, x, y


def test_rows_of_another_logger_are_none_of_a_column() -> None:
    t, x, y = recorder()
    flags, events = run(t, dZ=("displacement", x), T=("temperature", y))
    for name, values in (("dZ", x), ("T", y)):
        between = slice(np.flatnonzero(np.isfinite(values))[0], np.flatnonzero(np.isfinite(values))[-1] + 1)
        missing = ~np.isfinite(values[between])
        assert (flags[name][between][missing] == Flag.NOT_MEASURING).all()
        assert not flags[name][between][~missing][1:].any(), "behind the first nothing is a gap"
    assert [k for k in kinds(events) if k[1] != "out_of_range"] == []


@pytest.mark.parametrize("lost", [slice(400, 401), slice(400, 480)])
def test_what_a_column_lost_at_its_own_beat_is_told(lost: slice) -> None:
    t, x, y = recorder()
    own = np.flatnonzero(np.isfinite(x))
    x[own[lost]] = np.nan
    flags, _ = run(t, dZ=("displacement", x), T=("temperature", y))
    assert (flags["dZ"][own[lost]] & Flag.OUT_OF_RANGE).all()
    assert flags["dZ"][own[lost.stop]] & Flag.GAP


def test_empty_cells_without_a_beat_or_another_column_are_told() -> None:
    t, x, y = recorder()
    rng = np.random.default_rng(2)
    torn = np.where(rng.random(len(t)) < 0.5, np.nan, 20.0 + rng.normal(0, 0.1, len(t)))
    flags, _ = run(t, dZ=("displacement", np.nan_to_num(x)), T=("temperature", torn))
    assert (flags["T"][~np.isfinite(torn)] & Flag.OUT_OF_RANGE).all()
    alone, _ = run(t, T=("temperature", y))
    assert (alone["T"][~np.isfinite(y)] & Flag.OUT_OF_RANGE).all(), "nothing was written in these rows"
