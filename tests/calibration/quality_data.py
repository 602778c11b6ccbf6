"""Sound and noisy made-up channels for the tests of flags."""

from __future__ import annotations

import numpy as np

from thermodata.calibration.quality.column import ColumnInput
from thermodata.calibration.quality.event import QualityEvent
from thermodata.calibration.quality.flags import flag_stream
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


def gauge(
    seed: int = 0, n: int = N, tread: float = 2.0, dither: float = 0.05, noise: float = 0.1, count: float = 0.086
) -> Float1D:
    """A gauge in treads of 2 um, of which nobody sees the noise but where it flickers about a riser, behind a converter
    with noise of its own that counts in 0.086 um."""
    rng = np.random.default_rng(seed)
    slow = 15 * np.sin(np.arange(n) / 1400 + seed) + np.cumsum(rng.normal(0, 0.01, n))
    x = np.round((slow + rng.normal(0, dither, n)) / tread) * tread
    return np.asarray(np.round((x + rng.normal(0, noise, n)) / count) * count if noise else x)
