"""What machine and hall do in a test, a value each minute: blocks of work; air whose conditioning cycles and fails."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime, timedelta

import numpy as np

from ..bodies import Array
from ..run import TestRun

REST = 14 * 60  # minutes before each test
HOURS = {
    "dauer": (6, 12),
    "stufen": (8, 16),
    "achsen": (5, 12),
    "ruhe": (20, 30),
    "schwenk": (5, 10),
    "fraesen": (6, 14),
    "temper": (3, 8),
    "misch": (12, 24),
}
TITLES = {
    "dauer": "spindle",
    "stufen": "spectrum",
    "achsen": "linear_axis",
    "ruhe": "etve",
    "schwenk": "rotary_axis",
    "fraesen": "cutting",
    "temper": "other",
    "misch": "mixed",
}
INPUTS = ("n", "cut", "vx", "vy", "vz", "na", "nc", "tilt", "kss", "hyd", "set", "setl", "mess", "on")
SHORT = ("ruhe", "misch", "stufen", "temper")  # work until their end
AWAY = ("vx", "vy", "vz", "na", "nc", "cut", "tilt")  # what leaves the measuring position


@dataclass(frozen=True)
class Run(TestRun):
    """One test of n minutes. inputs: speeds [1/min], feeds [m/min], cut [1: full power], tilt [rad], set points [K] and
    switches; air: middle, layer, outside [K] and humidity; all with the rest before it, shape (REST + n,)."""

    steps: int
    air: Mapping[str, Array]

    def during(self) -> dict[str, Array]:
        """Inputs and air of the test itself, shape (n,)."""
        return {name: x[-self.steps :] for name, x in (*self.inputs.items(), *self.air.items())}


def run(
    rng: np.random.Generator, name: str, kind: str, role: str, day: datetime, top_rpm: float, hall: Mapping[str, float]
) -> Run:
    """Draw a test in the morning of a day. hall: constants of its air."""
    start, n = day + timedelta(minutes=int(rng.uniform(330, 600))), int(60 * rng.uniform(*HOURS[kind]))
    u = programme(rng, kind, n, top_rpm)
    worked = rng.random() < 0.3 and kind != "ruhe"
    before = programme(rng, "misch" if worked else "ruhe", REST, top_rpm)
    before["on"][:] = u["on"][0]
    for k, x in before.items():  # at rest for some hours at last
        at = REST - (int(rng.uniform(120, 400)) if k == "n" else 200)
        x[at:] *= k in ("on", "mess")
    inputs = {k: np.concatenate([before[k], x]) for k, x in u.items()}
    return Run(name, kind, role, start, inputs, n, _hall(rng, REST + n, start - timedelta(minutes=REST), hall))


def together(courses: Sequence[Mapping[str, Array]]) -> dict[str, Array]:
    """Courses of all tests, shape (minutes, tests); they end together, and shorter ones rest longer at first."""
    longest = max(len(x) for course in courses for x in course.values())
    return {
        k: np.stack([np.concatenate([np.repeat(c[k][:1], longest - len(c[k])), c[k]]) for c in courses], 1)
        for k in courses[0]
    }


def programme(rng: np.random.Generator, kind: str, n: int, top_rpm: float) -> dict[str, Array]:
    """Inputs of n minutes."""
    u: dict[str, Array] = {k: np.zeros(n) for k in INPUTS}
    u["mess"][:], u["on"][:] = 1, kind != "ruhe" or rng.random() < 0.5
    end = n if kind in SHORT else int(n * rng.uniform(0.55, 0.85))
    const, at, hyd = rng.uniform(0.35, 0.95) * top_rpm, int(rng.uniform(14, 30)), rng.random() < 0.5  # at rest first
    while at < end and kind != "ruhe":
        s = slice(at, min(end, at + int(rng.uniform(25, 140))))
        on, work = rng.random() < 0.8, kind in ("fraesen", "misch")
        u["hyd"][s] = hyd if rng.random() < 0.6 else 1 - hyd
        if kind in ("dauer", "stufen") or work:
            u["n"][s] = const if kind == "dauer" else on * top_rpm * rng.choice([0.1, 0.2, 0.35, 0.5, 0.65, 0.8, 1])
        if kind == "achsen" or work:
            feeds = on * (rng.random(3) < 0.6) * rng.uniform([4, 4, 2], [30, 30, 15]) * (0.6 if work else 1)
            u["vx"][s], u["vy"][s], u["vz"][s] = feeds
        if kind == "schwenk" or work:
            u["na"][s], u["nc"][s], u["tilt"][s] = on * (rng.random(3) < 0.6) * rng.uniform([2, 3, 0.2], [12, 30, 1.4])
        if work:
            u["cut"][s] = on * (rng.random() < 0.7) * rng.uniform(0.1, 0.8)
            u["kss"][s], u["set"][s] = on * (rng.random() < 0.65), rng.choice([0, 0, 0, 2])
        if kind in ("temper", "stufen"):
            u["set"][s] = rng.choice([-3, 0, 0, 3])
        if kind == "temper":
            u["kss"][s], u["setl"][s] = rng.random() < 0.5, rng.choice([-4, -2, 0, 2, 4])
        at = s.stop
    if kind in ("achsen", "schwenk", "fraesen", "misch"):  # the probes see the artefact at the measuring position only
        moved = u["vx"] + u["vy"] + u["vz"] + u["na"] + u["nc"] + u["cut"] + u["tilt"] > 0
        busy = moved & (np.arange(n) % int(rng.integers(9, 16)) > 1)
        u |= {"mess": 1.0 - busy} | {k: u[k] * busy for k in AWAY}
    return u


def _hall(rng: np.random.Generator, n: int, start: datetime, m: Mapping[str, float]) -> dict[str, Array]:
    """Air [K] over n minutes: an air-conditioning that cycles, is off at night in some halls, and fails."""
    hour = (start.hour + start.minute / 60 + np.arange(n) / 60) % 24
    day = m["day"] * np.sin((hour - 9) / 12 * np.pi)
    out = m["out"] + rng.normal(0, 1) + day + np.cumsum(rng.normal(0, 0.03, n))
    off = (m["night"] > 0) & ((hour > 22) | (hour < 5))
    for _ in range(rng.poisson(m["fail"] * n / 1440)):
        at = int(rng.uniform(0, n))
        off[at : at + int(rng.uniform(90, 420))] = True
    stir = np.repeat(rng.normal(0, m["stir"], n // 45 + 1), 45)[:n]
    mid, layer = np.zeros(n), np.zeros(n)
    t, lay, cools = float(rng.normal(0, 0.4)), m["layer"], True
    for k in range(n):
        cools = (t > m["band"] or (cools and t > -m["band"])) and not off[k]
        t += m["leak"] * (out[k] + m["load"] - t) / 60 - m["cool"] * cools / 60 + rng.normal(0, 0.008)
        lay += (m["layer"] * (2.2 if off[k] else 1) + stir[k] - lay) / 30
        mid[k], layer[k] = t, lay
    humid = np.clip(45 - 2 * mid + 6 * np.sin(np.arange(n) / 700), 15, 90)
    return {"mid": mid, "layer": layer - m["layer"], "out": out, "humid": humid}
