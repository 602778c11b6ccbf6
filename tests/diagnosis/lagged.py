"""An effect with a time constant, on drivers of one sample a minute."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from thermodata.effect.lag import lag
from thermodata.plugin import Drivers, Float2D

from .hand_made import STEP_S, PlainEffect


@dataclass(frozen=True)
class Lagged(PlainEffect):
    """Its first gain answers late, a second one answers to the square of the driver, late."""

    def basis(self, drivers: Drivers, p: Mapping[str, float]) -> Float2D:
        u = drivers.values["u"]
        both = [lag(v - v[0], p["tau"] * 60.0, STEP_S) for v in (u, u**2 / 10)]
        return np.column_stack(both[: len(self.gains)])
