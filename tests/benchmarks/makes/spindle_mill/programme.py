"""What the mill and the hall's gate do in a test, a value each minute."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..bodies import Array
from ..run import TestRun

DT_S = 60.0  # a step of the simulation and of the control's export
HOURS = {
    "const": (5, 9),
    "spec": (9, 14),
    "axes": (5, 9),
    "rot": (4, 8),
    "idle": (20, 30),
    "cut": (6, 11),
    "dry": (4, 8),
    "prod": (10, 16),
}
FEEDS = ("feed_x", "feed_y", "feed_z")
MOVES = ("speed", *FEEDS, "rotary")
INPUTS = (*MOVES, "cut", "coolant", "hydraulics", "gate", "standby")


@dataclass(frozen=True)
class Run(TestRun):
    """One test.

    inputs: speed, cut and rotary table (1: full), feeds [m/min], coolant, hydraulics and the chiller's standby (1: on),
    gate of the hall (1: open), shape (n,) each.
    """

    @property
    def steps(self) -> int:
        return len(self.inputs["speed"])


def programme(rng: np.random.Generator, kind: str) -> dict[str, Array]:
    """Draw the inputs of a test of this kind."""
    n = int(60 * rng.uniform(*HOURS[kind]))
    u = {name: np.zeros(n) for name in INPUTS}
    u["hydraulics"][:] = kind != "idle" and rng.random() < 0.85
    fixed, at = rng.uniform(0.4, 1.0), int(rng.uniform(12, 30))  # at rest first
    end = n if kind in ("spec", "cut", "prod") else int(n * rng.uniform(0.6, 0.8))
    while at < end and kind != "idle":
        stop = min(end, at + int(rng.uniform(15, 110)))
        block, works = slice(at, stop), rng.random() < 0.8
        if kind == "const":
            u["speed"][block] = fixed
        elif kind == "spec":
            u["speed"][block] = works * rng.uniform(0.1, 1)
        elif kind == "axes":
            for feed, top in zip(FEEDS, (24, 24, 30), strict=True):
                u[feed][block] = (rng.random() < 0.55) * rng.uniform(5, top)
        elif kind == "rot":
            u["rotary"][block] = works * rng.uniform(0.3, 1)
        elif works:
            u["speed"][block] = rng.uniform(0.15, 0.95)
            u["cut"][block] = (rng.random() < 0.75) * rng.uniform(0.2, 0.95)
            u["coolant"][block] = kind != "dry" and rng.random() < 0.75
            for feed, top in zip(FEEDS, (8, 12, 14), strict=True):
                u[feed][block] = (rng.random() < 0.8) * rng.uniform(0.5, top)
            u["rotary"][block] = (rng.random() < 0.4) * rng.uniform(0.1, 0.7)
        if kind == "prod" and rng.random() < 0.12:  # a break: pumps off
            for x in u.values():
                x[block] = 0
        at = stop
    busy = np.convolve(np.sign(np.sum([u[name] for name in MOVES], axis=0)), np.ones(25))[:n]
    u["standby"][busy < 0.5] = 1
    if rng.random() < 0.4:
        u["hydraulics"] *= np.arange(n) % 9 < 6
    while rng.random() < 0.7:
        at = int(rng.integers(0, n))
        u["gate"][at : at + int(rng.uniform(8, 50))] = 1
    return u
