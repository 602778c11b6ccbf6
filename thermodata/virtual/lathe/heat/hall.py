"""The air of a small job shop: a day, a heater that cycles, a gate that opens, layers, draught, a slow floor."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from thermodata.plugin import Float1D


@dataclass(frozen=True, slots=True)
class Air:
    """Courses, each shape (n,): low, high [degC], floor [degC], draught [m/s], humidity [%]."""

    low: Float1D
    high: Float1D
    floor: Float1D
    draught: Float1D
    humidity: Float1D


@dataclass(frozen=True, slots=True)
class Hall:
    """mean_c, day_k: mean and amplitude of the day. lively: how much heater, gate and weather disturb (1 is usual)."""

    mean_c: float
    day_k: float
    layer_k: float
    lively: float

    @classmethod
    def draw(cls, rng: np.random.Generator) -> Hall:
        return cls(rng.uniform(18, 25), rng.uniform(0.4, 2.6), rng.uniform(1.0, 4.0), rng.uniform(0.5, 1.6))

    def air(self, hour: Float1D, rng: np.random.Generator) -> Air:
        """hour: local clock, shape (n,), evenly spaced, running on beyond 24."""
        n, dt_h = len(hour), float(hour[1] - hour[0])
        work = ((hour % 24 > 6.5) & (hour % 24 < 17.5)).astype(float)
        day = self.day_k * np.sin(2 * np.pi * (hour - 9.5) / 24)
        weather = 0.8 * self.lively * wander(rng, n, dt_h, 9.0)
        period = rng.uniform(0.4, 0.9)
        heater = 0.35 * self.lively * np.abs(((hour / period) % 1) - 0.5) * 4 * (1 - 0.7 * work)
        gate = np.zeros(n)
        for start in np.arange(hour[0], hour[-1], 1.0):
            if work[np.searchsorted(hour, start)] and rng.random() < 0.25 * self.lively:
                since = hour - (start + rng.random())
                open_h = rng.uniform(0.05, 0.35)
                gate -= rng.uniform(1.0, 5.0) * np.where(
                    since < 0, 0, np.where(since < open_h, 1 - np.exp(-np.maximum(since, 0) / 0.06), 0)
                )
                after = since >= open_h
                gate -= np.where(after, 2.0 * np.exp(-np.clip(since - open_h, 0, 9) / 0.25), 0) * min(open_h / 0.2, 1)
        low = self.mean_c + day + weather + heater + gate
        stir = 1 - 0.75 * work
        high = low + self.layer_k * stir * (1 + 0.5 * wander(rng, n, dt_h, 2.0)) - 0.5 * gate
        floor = self.mean_c - 1.5 + 0.25 * self.day_k * np.sin(2 * np.pi * (hour - 15) / 24)
        draught = 0.08 + 0.3 * work * rng.uniform(0.5, 1.5) + 0.25 * (gate < -0.5)
        humidity = 45 + 8 * wander(rng, n, dt_h, 6.0) - 1.5 * (low - self.mean_c)
        return Air(low, high, floor, draught, np.clip(humidity, 15, 90))


def wander(rng: np.random.Generator, n: int, dt_h: float, tau_h: float) -> Float1D:
    """An Ornstein-Uhlenbeck course of unit deviation, shape (n,)."""
    from scipy.signal import lfilter

    a = float(np.exp(-dt_h / tau_h))
    kicks = np.sqrt(1 - a * a) * rng.standard_normal(n)
    kicks[0] = rng.standard_normal()
    return np.asarray(lfilter([1.0], [1.0, -a], kicks))
