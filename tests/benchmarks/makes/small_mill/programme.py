"""What the machine and the hall do in a test, a value each step."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime

import numpy as np

from ..bodies import Array
from ..run import TestRun

DT_S = 10.0  # a step of all logs and of the simulation
REST = 5 * 360  # steps of idling before each test
HOURS = {"idle": (4, 6), "const": (3, 5), "steps": (3, 6), "axis": (2.5, 4), "cut": (3, 5), "mixed": (4, 6)}


@dataclass(frozen=True)
class Run(TestRun):
    """One test of n steps.

    inputs: speed [rpm], feed_z and feed_y [m/min], load of the spindle (1: full), wet (1: coolant flows); shape (n,).
    moving: whether an axis is away from where the probe reads, shape (n,).
    swing, layer: of the hall's air, and of its top above its middle, at strength 1 [K]; shape (REST + n,).
    """

    moving: Array
    swing: Array
    layer: Array


def wander(rng: np.random.Generator, n: int, tau_s: float) -> Array:
    """A slow random course of unit size, shape (n,)."""
    a, last = float(np.exp(-DT_S / tau_s)), rng.normal()
    course: Array = rng.normal(0, np.sqrt(1 - a * a), n)
    for k in range(n):
        last = course[k] = course[k] + a * last
    return course


def programme(
    rng: np.random.Generator, kind: str, name: str, role: str, start: datetime, top_rpm: float, wet: bool
) -> Run:
    """Draw what a test of this kind does. wet: whether the shop uses coolant."""
    n = int(rng.uniform(*HOURS[kind]) * 360)
    u = {name: np.zeros(n) for name in ("speed", "feed_z", "feed_y", "load", "wet")}
    moving = np.zeros(n, bool)
    if kind == "const":
        u["speed"][12 : int(n * rng.uniform(0.6, 0.8))] = round(top_rpm * rng.uniform(0.5, 1), -2)
    k = int(rng.uniform(6, 20))
    while k < n and kind not in ("idle", "const"):
        end = min(n, k + int(rng.uniform(20, 55) * 6))
        block, work = slice(k, end), rng.random() > 0.2
        if kind in ("steps", "cut", "mixed") and work:
            u["speed"][block] = round(top_rpm * rng.choice([0.15, 0.3, 0.5, 0.75, 1]), -2)
        if kind == "axis" or (kind in ("cut", "mixed") and work and rng.random() < 0.75):
            go = moving[block] = np.arange(k, end) % 84 >= 9
            both = rng.random()
            u["feed_z"][block] = go * (both < 0.7) * rng.uniform(3, 12) * (1 if kind == "axis" else 0.5)
            u["feed_y"][block] = go * (both > 0.4) * rng.uniform(3, 12) * (1 if kind == "axis" else 0.6)
            if kind == "cut" or (kind == "mixed" and rng.random() < 0.4):
                u["load"][block] = go * rng.uniform(0.15, 0.7)
        u["wet"][block] = float(wet and kind in ("cut", "mixed") and rng.random() < 0.6)
        k = end
    u["load"] += 0.02 * (u["speed"] > 0) + 0.03 * u["speed"] / top_rpm
    return Run(name, kind, role, start, u, moving, *_hall(rng, n + REST, start))


def _hall(rng: np.random.Generator, n: int, start: datetime) -> tuple[Array, Array]:
    """Swing of the air and its layer [K], shape (n,) each: the day, gates that open, a heater under the roof."""
    hour = (np.arange(n) - REST) * DT_S / 3600 + start.hour
    swing = 0.5 * np.sin(2 * np.pi * (hour - 9) / 24) + 0.25 * wander(rng, n, 3600)
    for at in rng.uniform(0, n, rng.poisson(n / 360 * 0.35)):  # the gate opens, the draught comes
        x = np.arange(n) - at
        swing -= rng.uniform(0.2, 0.6) * (x > 0) * np.where(x < 60, 1 - np.exp(-x / 20), np.exp(-(x - 60) / 90))
    heater = np.repeat(rng.random(n // 180 + 1) < 0.5, 180)[:n].astype(float)
    return swing, 0.6 * heater + 0.3 * wander(rng, n, 1800)
