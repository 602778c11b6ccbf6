"""What one test left behind: the readings of its sensors and probes, and the truth behind them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from thermodata.plugin import Bool1D, Float1D, Float2D
from thermodata.virtual.lathe.campaign import Stretch


@dataclass(frozen=True, slots=True)
class Run:
    """One test. contributions: cause -> X and Z, shape (2, n) [um]. displacement: shape (2, n), as probed [um].
    readings, valid: sensor -> shape (n,). probed: where the probes logged, shape (n,)."""

    stretch: Stretch
    contributions: Mapping[str, Float2D]
    displacement: Float2D
    readings: Mapping[str, Float1D]
    valid: Mapping[str, Bool1D]
    probed: Bool1D
