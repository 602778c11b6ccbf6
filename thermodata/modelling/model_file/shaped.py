"""What a driver may do before it reaches any effect: come late, or be read by a slow sensor.

    dead time    u(t - L)               the heat has a way to go
    sensor lag   u + tau du/dt          the sensor shows F_tau{u} of what it measures

Source: docs/model.md#the-model; bounds: docs/model.md#bounds-of-the-effects
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from thermodata.effect.guard import guarded_basis, read_only
from thermodata.effect.lag import step_of
from thermodata.errors import unknown_name
from thermodata.plugin import Drivers, Effect, Float1D, Float2D, Param

DEAD_TIME = Param("dead_time", "s", 120.0, 0.0, 1200.0, "time until the driver begins to act")
SENSOR_LAG = Param("sensor_lag", "s", 60.0, 10.0, 600.0, "time constant of the driver's own sensor")
KNOWN = {p.name: p for p in (DEAD_TIME, SENSOR_LAG)}


class Shaped:
    """An effect with its drivers late, or freed of their sensor's lag; parameters beside its own."""

    def __init__(self, effect: Effect, also: Sequence[str], where: str) -> None:
        for name in also:
            if name not in KNOWN:
                raise unknown_name("shape of a driver", name, list(KNOWN), where=where)
        self.effect, self.also = effect, tuple(dict.fromkeys(also))
        self.name, self.family, self.meaning = effect.name, effect.family, effect.meaning
        self.source, self.needs, self.gains = effect.source, effect.needs, effect.gains
        self.params = (*effect.params, *(KNOWN[name] for name in self.also))

    def basis(self, drivers: Drivers, p: Mapping[str, float]) -> Float2D:
        step = step_of(drivers)
        values = dict(drivers.values)
        if SENSOR_LAG.name in self.also:
            values = {role: unlagged(u, p[SENSOR_LAG.name], step) for role, u in values.items()}
        if DEAD_TIME.name in self.also:
            values = {role: late(u, p[DEAD_TIME.name], step) for role, u in values.items()}
        return guarded_basis(self.effect, read_only(replace(drivers, values=values)), p)


def late(u: Float1D, dead_s: float, step_s: float) -> Float1D:
    """u(t - dead_s), shape (n,); before the record as at its first sample."""
    rows = np.arange(len(u), dtype=np.float64)
    return np.interp(rows - dead_s / step_s, rows, u)


def unlagged(u: Float1D, sensor_s: float, step_s: float) -> Float1D:
    """u + sensor_s du/dt, shape (n,); the slope is that to the sample before, so that it looks only back."""
    return np.asarray(u + sensor_s * np.diff(u, prepend=u[:1]) / step_s)
