"""A campaign of half a year: 18 to 43 tests of 2 to 26 h, most partly idle, and what lathe and door do in each."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import UTC, datetime, timedelta

import numpy as np

from ..bodies import Array
from ..run import TestRun

COUNT = (18, 44)  # tests of a campaign, the last not
LENGTH = (130, 1560)  # of a test [min]
TITLES = {
    "idle": "etve",
    "spin": "spindle",
    "steps": "spectrum",
    "rapid": "linear_axis",
    "live": "other",
    "wet": "other",
    "cut": "cutting",
    "day": "mixed",
}
HOURS = {  # of work
    "idle": (0, 0),
    "spin": (1.5, 5),
    "steps": (3, 8),
    "rapid": (1.5, 4),
    "live": (1.5, 5),
    "wet": (2, 5),
    "cut": (2, 7),
    "day": (5, 9),
}
AFTER = {  # hours of rest after it
    "idle": (10, 26),
    "spin": (0.5, 9),
    "steps": (0.5, 12),
    "rapid": (0.5, 6),
    "live": (0.5, 5),
    "wet": (0, 6),
    "cut": (0, 8),
    "day": (1, 16),
}
MOVES: dict[str, tuple[str, ...]] = {  # inputs that move in it
    "idle": (),
    "spin": ("n",),
    "steps": ("n",),
    "rapid": ("fx", "fz"),
    "live": ("live",),
    "wet": ("cool",),
    "cut": ("n", "cut", "fx", "fz", "cool", "tail"),
    "day": ("n", "cut", "fx", "fz", "cool", "tail", "live"),
}
OFTEN = {"idle": 3, "spin": 4, "steps": 4, "rapid": 3, "live": 1, "wet": 1, "cut": 3, "day": 2}
INPUTS = ("n", "cut", "live", "fx", "fz", "hyd", "cool", "tail", "door")
DRIVEN_BY = {
    "hydraulics": "hyd",
    "zscrew": "fz",
    "guide": "fz",
    "xscrew": "fx",
    "turret": "live",
    "coolant": "cool",
    "belt": "n",
}


def campaign(rng: np.random.Generator, hidden: Sequence[str], half: bool) -> list[TestRun]:
    """Draw all tests, the last three locked. half: the hidden causes do not act in every other test."""
    kinds, count = list(HOURS), int(rng.integers(*COUNT))
    mine = [DRIVEN_BY[k] for k in hidden if k in DRIVEN_BY]
    asked = [any(x in MOVES[k] for x in mine) and k not in ("cut", "day") for k in kinds]
    often = np.array([OFTEN[k] * (2.5 if more else 1) for k, more in zip(kinds, asked, strict=True)])
    drawn = [str(rng.choice(kinds, p=often / often.sum())) for _ in range(count - 7)]
    start, runs = datetime(2026, 1, 12, 7, tzinfo=UTC), []
    for k, kind in enumerate(["spin", "idle", "steps", "rapid", *drawn, "day", "cut", "day"]):
        rest = float(rng.uniform(*AFTER[kind])) * (1 if rng.random() < 0.7 else 0.3)
        work = int(60 * rng.uniform(*HOURS[kind]))
        n = int(min(max(work + 60 * rest, LENGTH[0]), LENGTH[1]))
        u = programme(rng, kind, work, n, 0.75 if "door" in hidden else 0.35)
        if half and k % 2:
            u |= {DRIVEN_BY[h]: np.zeros(n) for h in hidden}
        role = "locked" if k >= count - 3 else "verification" if k > 4 and rng.random() < 0.3 else "calibration"
        runs.append(TestRun(f"{k + 1:02d}_{kind}", kind, role, start, u))
        start += timedelta(minutes=n + int(rng.uniform(60, 900)))
        if rng.random() < 0.8:  # another day or week, at the hour the laboratory begins
            start += timedelta(days=float(rng.exponential(1 + 150 / count)))
            hour = int(rng.integers(5, 9 if kind != "idle" else 17))
            start = start.replace(hour=hour, minute=int(rng.integers(0, 60))) + timedelta(days=1)
    return runs


def programme(rng: np.random.Generator, kind: str, work: int, n: int, door: float) -> dict[str, Array]:
    """Inputs of n minutes, shape (n,), of which the first are work: speeds, loads, feeds as shares of the largest, and
    states. door: how often it opens once more."""
    u: dict[str, Array] = {k: np.zeros(n) for k in INPUTS}
    fixed, at = rng.uniform(0.35, 1), 0
    working, resting = kind not in ("spin", "idle") or rng.random() < 0.6, rng.random() < 0.25
    u["hyd"][:] = np.where(np.arange(n) < work, working, resting)
    often = {"n": 1, "cut": 0.7, "fx": 0.7, "fz": 0.8, "cool": 0.8, "tail": 0.3, "live": 0.35 if kind == "day" else 1}
    while at < work:
        s, busy = slice(at, min(work, at + int(rng.uniform(12, 80)))), rng.random() < 0.75
        for k in MOVES[kind] if busy or kind == "spin" else ():
            if rng.random() >= often[k]:
                continue
            if k in ("cool", "tail"):
                u[k][s] = 1
            elif kind == "spin":
                u[k][s] = fixed
            else:
                u[k][s] = rng.uniform(0.25, 1) * (0.6 if k[0] == "f" and kind != "rapid" else 1)
        at = s.stop
    if kind == "day":  # the turret's drive and the spindle never turn together
        u["n"] = np.where(u["live"] > 0, 0, u["n"])
    u["cut"] *= u["n"] > 0
    while rng.random() < door:
        opens = int(rng.integers(0, n))
        u["door"][opens : opens + int(rng.uniform(10, 75))] = 1
    return u
