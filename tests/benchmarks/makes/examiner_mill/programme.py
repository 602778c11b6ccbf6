"""What machine and hall do in a test, a value each minute: blocks of work; air of a day, fans, door, sun.

Speed, cut, feeds, rotary table, coolant, pump and the chiller's set point are drawn in blocks of 25 to 150 min; the
hall swings with the day and wanders, lies in layers while its fans rest, and cools while its door is open.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime, timedelta

import numpy as np

from ..bodies import Array
from ..run import TestRun

REST = 14 * 60  # minutes before each test
STILL = 300  # of these, at their end, nothing moves
SHORT = ("const", "steps", "heavy", "axes", "table", "cutting", "flood", "chill", "pump")
HOURS = {"idle": (22, 28), "day": (14, 20), **dict.fromkeys(SHORT, (8, 14))}
TITLES = {
    "idle": "etve",
    "const": "spindle",
    "steps": "spectrum",
    "heavy": "spectrum",
    "axes": "linear_axis",
    "table": "rotary_axis",
    "cutting": "cutting",
    "flood": "other",
    "chill": "other",
    "pump": "other",
    "day": "mixed",
}
INPUTS = ("n", "cut", "torque", "vx", "vy", "vz", "na", "kss", "hyd", "set")
DAY = ("steps", "axes", "cutting", "cutting", "table", "heavy", "flood", "rest")  # blocks of a day
PAUSED = ("axes", "day", "table")
AWAY = ("axes", "table", "day", "cutting")  # what leaves the measuring position


@dataclass(frozen=True)
class Run(TestRun):
    """One test. steps: its minutes. inputs: speeds [1/min], cut and power [kW], feeds [m/min], switches, set point and
    airs [K], sun [W/m2]; all with the rest before it, shape (REST + steps,)."""

    steps: int

    def during(self) -> dict[str, Array]:
        """Inputs of the test itself, shape (steps,)."""
        return {name: x[-self.steps :] for name, x in self.inputs.items()}


def lagged(x: Array, tau: float) -> Array:
    """First-order lag of tau minutes."""
    y, out = float(x[0]), np.empty_like(x)
    for i, v in enumerate(x):
        y += (v - y) / max(tau, 1.0)
        out[i] = y
    return out


def campaign(rng: np.random.Generator, plan: Sequence[tuple[str, str]], top_rpm: float, most_kw: float) -> list[Run]:
    """Tests of these kinds and roles, one after the other from mornings of a January on."""
    day, runs = datetime(2026, 1, 12) + timedelta(days=int(rng.integers(0, 25))), []
    for j, (kind, role) in enumerate(plan):
        start = day + timedelta(minutes=int(rng.uniform(300, 660)))
        n = int(60 * rng.uniform(*HOURS[kind]))
        before = work(rng, "day" if rng.random() < 0.25 and kind != "idle" else "idle", REST, top_rpm, most_kw)
        for name, x in before.items():
            x[-STILL:] *= name in ("on", "meas")
        now = work(rng, kind, n, top_rpm, most_kw)
        inputs = {name: np.concatenate([before[name], x]) for name, x in now.items()}
        inputs |= _hall(rng, REST + n, start - timedelta(minutes=REST))
        runs.append(Run(f"{j + 1:02d}_{kind}", kind, role, start, inputs, n))
        day = (start + timedelta(minutes=n)).replace(hour=0, minute=0) + timedelta(days=1)
    return runs


def work(rng: np.random.Generator, kind: str, n: int, top_rpm: float, most_kw: float) -> dict[str, Array]:
    """Inputs of n minutes."""
    u: dict[str, Array] = {k: np.zeros(n) for k in INPUTS} | {"on": np.ones(n), "meas": np.ones(n)}
    t, end = int(rng.integers(10, 40)), int(n * rng.uniform(0.62, 0.8))
    if kind == "const":
        u["n"][t : int(n * rng.uniform(0.45, 0.6))] = top_rpm * rng.uniform(0.5, 0.9)
    axes = list(map(str, rng.permutation(["vx", "vy", "vz"])))
    while t < end and kind not in ("idle", "const"):
        span = int(rng.uniform(*((70, 150) if kind == "axes" else (25, 110))))
        job = slice(t, min(t + span, end))
        what = kind if kind != "day" else str(rng.choice(DAY))
        if what == "axes":
            for axis in axes[:1] if kind == "axes" else rng.choice(axes, 2, replace=False):
                u[axis][job] = rng.uniform(5, 22)
            axes = axes[1:] + axes[:1]
        else:
            _block(rng, u, what, job, axes, top_rpm, most_kw)
        if what not in ("steps", "rest") and kind in AWAY:
            u["meas"][job] = (np.arange(n)[job] + t) % 12 < 2
        t += span + int(rng.uniform(*((10, 90) if kind in PAUSED else (0, 25))))
    t = int(rng.uniform(0, 120))
    while t < n and (kind in ("pump", "day", "cutting") or rng.random() < 0.3):
        span = int(rng.uniform(60, 260))
        u["hyd"][t : t + span] = 1
        t += span + int(rng.uniform(60, 240))
    u["P"] = u["cut"] + u.pop("torque") + 0.12 * most_kw * (u["n"] / top_rpm) ** 1.5 + 0.1 * (u["n"] > 0)
    if kind == "day" or rng.random() < 0.3:
        u["on"][int(n * rng.uniform(0.85, 0.97)) :] = 0
    return u


def _block(
    rng: np.random.Generator,
    u: Mapping[str, Array],
    what: str,
    job: slice,
    axes: Sequence[str],
    top_rpm: float,
    most_kw: float,
) -> None:
    """Set the inputs of a block of work that is no motion of axes alone."""
    if what in ("steps", "chill"):
        u["n"][job] = top_rpm * rng.choice([0, 0.15, 0.3, 0.5, 0.75, 1])
    if what == "chill" and rng.random() < 0.6:
        u["set"][job.start :] = rng.uniform(1.5, 4) * rng.choice([-1, 0, 1])
    if what == "heavy":  # much torque at low speed: the motor warms, the bearings stay cool
        u["n"][job] = top_rpm * rng.uniform(0.06, 0.15)
        u["cut"][job] = rng.uniform(0, 0.8)
        u["torque"][job] = rng.uniform(0.2, 0.8) * most_kw * 0.4
    if what == "table":
        u["na"][job] = rng.choice([0, 5, 10, 20])
    if what == "cutting":
        u["n"][job] = top_rpm * rng.uniform(0.25, 0.7)
        u["cut"][job] = rng.uniform(0.08, 0.35) * most_kw * (rng.random() < 0.8)
        u["kss"][job] = rng.random() < 0.55
        for axis in axes:
            u[axis][job] = rng.uniform(0.3, 3)
    if what == "flood":
        u["kss"][job] = rng.random() < 0.6


def _hall(rng: np.random.Generator, n: int, start: datetime) -> dict[str, Array]:
    """Air of the hall, its layers, the door's draught [K], the sun [W/m2], the scale's air [1], humidity [%]."""
    h = (start.hour + start.minute / 60 + np.arange(n) / 60) % 24
    shift, wander = ((h > 6) & (h < 22)).astype(float), np.zeros(n)
    for i in range(1, n):
        wander[i] = 0.985 * wander[i - 1] + 0.03 * rng.normal()
    hall = rng.uniform(0.6, 2.2) * np.sin(2 * np.pi * (h - rng.uniform(8, 10)) / 24) + wander
    hall = hall + 0.1 * np.sin(2 * np.pi * np.arange(n) / rng.uniform(25, 50))
    hall = hall + lagged(np.linspace(0, rng.uniform(-1.2, 1.2), n), 60)
    fans = _spells(rng, n, 90, 400, lambda: float(rng.random() < 0.5))
    cloud = _spells(rng, n, 10, 120, lambda: rng.uniform(0.1, 1))
    air = _spells(rng, n, 60, 300, lambda: float(rng.random() < 0.6))
    door = np.zeros(n)
    for t in rng.integers(0, n, max(1, n // 220)):
        door[t : t + int(rng.uniform(8, 50))] = shift[t]
    layer = lagged(0.4 + rng.uniform(1.2, 2.6) * (1 - fans) + 0.3 * shift, 35)
    sun = np.clip(np.sin(np.pi * (h - 9) / 7), 0, 1) * (h > 9) * (h < 16) * cloud * rng.uniform(250, 650)
    draught = -lagged(door * rng.uniform(3, 8), 9)
    return {
        "hall": hall,
        "layer": layer,
        "sun": sun,
        "open": door,
        "draught": draught,
        "air": lagged(air * shift, 25),
        "top": hall + layer,
        "bottom": hall - 0.6 * layer + 0.25 * draught,
        "doorair": hall + draught - 0.4,
        "rh": 42 - 2.2 * hall + 3 * wander,
    }


def _spells(rng: np.random.Generator, n: int, low: int, high: int, draw: Callable[[], float]) -> Array:
    """Spells of low to high minutes, each of a value that is drawn, shape (n,)."""
    x, t = np.ones(n), 0
    while t < n:
        span = int(rng.uniform(low, high))
        x[t : t + span] = draw()
        t += span
    return x
