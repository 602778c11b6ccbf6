"""Sound and noisy made-up channels for the tests of flags."""

from __future__ import annotations

import numpy as np

from thermodata.calibration.quality import ColumnInput, QualityEvent, flag_stream
from thermodata.plugin import Array, Float1D, Int1D

N = 6000


def clock(n: int = N, step_s: float = 1.0) -> Int1D:
    return (np.arange(n) * (step_s * 1e9)).astype(np.int64) + 1_700_000_000_000_000_000


def noisy(seed: int = 0, n: int = N, noise: float = 0.2) -> Float1D:
    rng = np.random.default_rng(seed)
    return 20 * np.sin(np.arange(n) / 900) + np.cumsum(rng.normal(0, 0.01, n)) + rng.normal(0, noise, n)


def run(t: Int1D, **columns: tuple[str, Array]) -> tuple[dict[str, Array], list[QualityEvent]]:
    return flag_stream(t, {k: ColumnInput(v, q) for k, (q, v) in columns.items()})


def kinds(events: list[QualityEvent]) -> list[tuple[str | None, str]]:
    return [(e.channel, e.flag) for e in events]
