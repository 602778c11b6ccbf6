"""What the machine, its chiller and cabinet, and the hall do in a test, a value each step."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime

import numpy as np

from ..bodies import Array
from ..run import TestRun

DT_S = 30.0  # a step of all logs and of the simulation
REST = 360  # steps at rest before each test


@dataclass(frozen=True)
class Run(TestRun):
    """One test. inputs: shape (REST + n,) each, the rest before it included.

    Of the machine: speed [rpm], feed_z and feed_y [m/min], load [kW of cutting], wet (1: coolant flows), table [rpm],
    oil (1: the ram's oil is warm). Around it: swing of the hall's air and its layer above the middle [K at strength 1],
    cabinet and pump (1: on), chiller [K beside its set point], sun [W/m2].
    """

    @property
    def logged(self) -> dict[str, Array]:
        """The inputs from the start of the test on, shape (n,) each."""
        return {name: x[REST:] for name, x in self.inputs.items()}


def wander(rng: np.random.Generator, n: int, tau_s: float) -> Array:
    """A slow noise of unit size from 0 on, shape (n,): white noise behind a lag."""
    a = float(np.exp(-DT_S / tau_s))
    x: Array = rng.normal(0, 1, n) * np.sqrt(1 - np.exp(-2 * DT_S / tau_s))
    for k in range(1, n):
        x[k] += a * x[k - 1]
    x -= x[0]
    return x


def programme(
    rng: np.random.Generator, name: str, kind: str, role: str, start: datetime, top_rpm: float, hours: float
) -> Run:
    """Draw what a test of this kind does."""
    n = int(hours * 3600 / DT_S)
    u = {name: np.zeros(n) for name in ("speed", "feed_z", "feed_y", "load", "wet", "table", "oil")}
    if kind in ("const", "repeat"):
        u["speed"][10 : int(n * 0.62)] = round(top_rpm * rng.uniform(0.5, 0.95), -2)
    k = int(rng.integers(10, 30))
    while k < n and kind not in ("const", "repeat", "etve"):
        end, work = min(n, k + int(rng.uniform(20, 80) * 60 / DT_S)), rng.random() > 0.25
        go = np.arange(k, end) % 20 >= 4
        if kind in ("spectrum", "cutting", "mixed") and work:
            u["speed"][k:end] = round(top_rpm * rng.choice([0.15, 0.3, 0.5, 0.75, 1.0]), -1)
        if kind in ("axes", "cutting", "mixed") and rng.random() < 0.7:
            both = rng.random()
            u["feed_z"][k:end] = go * (both < 0.65) * rng.uniform(3, 16)
            u["feed_y"][k:end] = go * (both > 0.35) * rng.uniform(3, 16)
        if kind in ("table", "mixed") and rng.random() < (0.75 if kind == "table" else 0.35):
            u["table"][k:end] = go * rng.uniform(5, 30)
        if kind in ("cutting", "mixed") and work and rng.random() < 0.6:
            u["load"][k:end] = go * rng.uniform(2, 9)
        if kind in ("cutting", "mixed", "table"):
            u["wet"][k:end], u["oil"][k:end] = float(rng.random() < 0.5), float(rng.random() < 0.5)
        k = end
    if kind == "axes":
        u["oil"] = (np.arange(n) // int(90 * 60 / DT_S) % 2).astype(float)
    u = {name: np.r_[np.zeros(REST), x] for name, x in u.items()}
    return Run(name, kind, role, start, u | _around(rng, n + REST, start, hours))


def _around(rng: np.random.Generator, n: int, start: datetime, hours: float) -> dict[str, Array]:
    """Hall, cabinet, pump, chiller and sun, shape (n,) each."""
    clock = start.hour + (np.arange(n) - REST) * DT_S / 3600
    swing = 1.2 * np.sin(2 * np.pi * (clock - 9) / 24) + 0.4 * wander(rng, n, 5400)
    for at in rng.uniform(0, n, rng.poisson(hours * 0.2)):  # the gate opens
        x = np.arange(n) - at
        swing -= rng.uniform(0.3, 0.9) * (x > 0) * np.where(x < 20, 1 - np.exp(-x / 8), np.exp(-(x - 20) / 35))
    cloud = np.clip(0.6 + 0.5 * wander(rng, n, 2400), 0.05, 1)
    heater = np.repeat(rng.random(n // 100 + 1) < 0.5, 100)[:n]
    begun = np.arange(n) > REST
    cabinet = np.repeat(rng.random(n // 200 + 1) < 0.45, 200)[:n] * begun
    pump = np.repeat(rng.random(n // 240 + 1) < 0.55, 240)[:n] * begun
    levels = np.repeat(rng.choice([-2.0, 0, 0, 2.0], n // 300 + 1), 300)[:n]
    chiller = levels + 0.5 * np.sign(np.sin(np.arange(n) / 5))
    height = np.clip(np.sin(np.pi * (clock % 24 - 7.5) / 9), 0, 1)
    sun = 500 * height**1.5 * (abs(clock % 24 - 12) < 4.5) * cloud
    return {
        "swing": swing,
        "layer": 0.9 * heater + 0.4 * wander(rng, n, 3600),
        "cabinet": cabinet,
        "pump": pump,
        "chiller": chiller * begun,
        "sun": sun * begun,
    }
