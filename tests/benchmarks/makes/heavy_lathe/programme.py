"""What the lathe does in a test, a value each minute."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..bodies import Array
from ..run import TestRun

DT_S = 60.0  # between two rows of all logs
INPUTS = ("speed", "range", "cut", "live", "feed_x", "feed_z", "pump")


@dataclass(frozen=True)
class Run(TestRun):
    """One test. inputs: speed and live tool [rpm], range (0 to 3), cut (1: full), feeds [m/min], pump (1: on), (n,)."""

    @property
    def steps(self) -> int:
        return len(self.inputs["speed"])


def programme(rng: np.random.Generator, kind: str, hours: float, top_rpm: float) -> dict[str, Array]:
    """Draw the inputs of a test of this kind."""
    n = int(hours * 3600 / DT_S)
    u = {name: np.zeros(n) for name in INPUTS}
    u["pump"][:] = kind != "idle"
    at, end = 0, n
    if kind not in ("spectrum", "mixed", "cutting"):
        at, end = int(0.05 * n), int(rng.uniform(0.55, 0.7) * n)
    fixed = float(rng.uniform(0.5, 1.0) * top_rpm)
    while at < end:
        stop = min(end, at + int(rng.uniform(20, 150) * (60 / DT_S)))
        block, works = slice(at, stop), rng.random() < (0.75 if kind != "spectrum" else 0.85)
        if kind in ("const", "repeat"):
            u["speed"][block] = fixed
        elif kind == "axes":
            u["feed_x"][block], u["feed_z"][block] = (rng.random(2) < 0.6) * rng.uniform([1, 2], [6, 10])
        elif kind == "live":
            u["live"][block] = works * rng.uniform(800, 3000)
        elif kind == "spectrum":
            u["speed"][block] = works * rng.uniform(0.05, 1) * top_rpm
        elif kind in ("cutting", "mixed") and works:
            mills = rng.random() < 0.3
            u["speed"][block] = 0 if mills else rng.uniform(0.1, 1) * top_rpm
            u["live"][block] = mills * rng.uniform(800, 3000)
            u["cut"][block] = 0 if rng.random() < 0.4 else rng.uniform(0.1, 0.8)
            u["feed_x"][block], u["feed_z"][block] = rng.uniform(0.1, 3), rng.uniform(0.2, 6)
        if kind == "mixed" and rng.random() < 0.15:
            u["pump"][block] = u["speed"][block] = u["cut"][block] = 0
        speed = u["speed"][block]
        turning = 1 + (rng.random() < 0.25) + (speed > 0.45 * top_rpm)
        u["range"][block] = np.where(speed > 0, turning, u["range"][max(at - 1, 0)])
        at = stop
    return u
