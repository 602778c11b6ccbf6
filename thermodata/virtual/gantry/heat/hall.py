"""The hall: stratified air with a daily cycle, heating that switches, doors that open, and a slow floor."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.signal import lfilter

from thermodata.plugin import Float1D, Float2D
from thermodata.virtual.gantry.plan import STEP_S, Operation

BOUNDARIES = ("hall.bottom", "hall.middle", "hall.top", "floor", "fluid")


@dataclass(frozen=True, slots=True)
class Hall:
    """How one hall behaves. Temperatures [degC], amplitudes [K], hours of the day [h]."""

    mean: float
    daily: float
    warmest_h: float
    gradient: float
    heating: float
    door_drop: float
    doors_per_test: float
    wet_bulb: float

    @classmethod
    def draw(cls, rng: np.random.Generator) -> Hall:
        return cls(
            mean=float(rng.uniform(20.5, 24)),
            daily=float(rng.uniform(1.8, 3.0)),
            warmest_h=float(rng.uniform(14.5, 17)),
            gradient=float(rng.uniform(0.6, 1.4)),
            heating=float(rng.uniform(0.5, 1.2)),
            door_drop=float(rng.uniform(1.5, 3.5)),
            doors_per_test=float(rng.uniform(3, 7)),
            wet_bulb=float(rng.uniform(4.5, 6.5)),
        )


def smooth(rng: np.random.Generator, n: int, sd: float, tau_s: float) -> Float1D:
    """First-order noise of standard deviation `sd`, shape (n,), on the grid of 10 s."""
    a = float(np.exp(-STEP_S / tau_s))
    white = rng.standard_normal(n) * np.sqrt(1 - a * a)
    start = rng.standard_normal() * a
    return np.asarray(sd * lfilter([1.0], [1.0, -a], white, zi=[start])[0])


def _lagged(u: Float1D, tau_s: float) -> Float1D:
    a = float(np.exp(-STEP_S / tau_s))
    return np.asarray(lfilter([1 - a], [1.0, -a], u, zi=[u[0] * a])[0])


def air(hall: Hall, op: Operation, hour: float, day: int, rng: np.random.Generator) -> Float2D:
    """Boundary temperatures of one test [degC], shape (boundaries, n). `hour`: local time at its start.

    Opens doors too: `op.door` is filled in. The air stands still before the test: machines are left to soak.
    """
    t_h = op.t_s / 3600.0
    clock = hour + t_h
    swing = hall.daily * rng.uniform(0.6, 1.3)
    mean = hall.mean + 0.3 * rng.standard_normal() + swing * np.cos(2 * np.pi * (clock - hall.warmest_h) / 24)
    mean = mean + rng.uniform(-0.04, 0.04) * t_h
    # the thermostat heats in blocks through the working hours
    block = np.sin(2 * np.pi * clock / rng.uniform(2.5, 4.5)) > 0.2
    on = ((clock % 24 > 6) & (clock % 24 < 20) & block).astype(np.float64)
    mean = mean + hall.heating * _lagged(on, 1500.0)
    top_extra = hall.gradient * (1 + 0.5 * _lagged(on, 2400.0)) + smooth(rng, op.n, 0.25, 5400.0)
    drop = np.zeros(op.n)
    for _ in range(int(rng.poisson(hall.doors_per_test))):
        start = int(rng.uniform(0.05, 0.95) * op.n)
        length = int(rng.uniform(12, 90))
        op.door[start : start + length] = 1.0
    drop = hall.door_drop * _lagged(op.door, 500.0)
    middle = mean - 0.45 * drop + smooth(rng, op.n, 0.04, 240.0)
    bottom = mean - 0.5 * top_extra - drop + smooth(rng, op.n, 0.04, 240.0)
    top = mean + 0.5 * top_extra - 0.15 * drop + smooth(rng, op.n, 0.04, 240.0)
    floor = np.full(op.n, hall.mean - 1.5) + 0.02 * day + 0.1 * _lagged(mean - mean[0], 12 * 3600.0)
    fluid = _lagged(middle, 2400.0) - hall.wet_bulb
    return np.stack([bottom, middle, top, floor, fluid])
