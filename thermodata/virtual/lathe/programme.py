"""What a laboratory lets the machine do: idle nights, steps of speed, spectra, strokes of one axis, working days."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from thermodata.plugin import Float1D

DT_S = 30.0
TOP_RPM = 4000.0
Kind = Literal["idle", "step", "spectrum", "stroke_z", "stroke_x", "wet", "tools", "day"]
TEST_KIND = {
    "idle": "etve",
    "step": "spindle",
    "spectrum": "spectrum",
    "stroke_z": "linear_axis",
    "stroke_x": "linear_axis",
    "wet": "other",
    "tools": "other",
    "day": "mixed",
}


@dataclass(frozen=True, slots=True)
class Work:
    """Courses of one test, each shape (n,) on DT_S: speed, tool_speed [rpm], feed_x, feed_z [m/min], pos_z [mm],
    cutting [kW], coolant, pump (0 or 1). hour: local clock."""

    kind: Kind
    hour: Float1D
    speed: Float1D
    tool_speed: Float1D
    feed_x: Float1D
    feed_z: Float1D
    pos_z: Float1D
    cutting: Float1D
    coolant: Float1D
    pump: Float1D
    conditions: dict[str, str] = field(default_factory=dict)

    @property
    def n(self) -> int:
        return len(self.hour)


def campaign(rng: np.random.Generator, open_tests: int, idle: bool) -> list[tuple[Kind, str]]:
    """(kind, role) of each test; locked ones last. idle: a campaign that mostly waits and watches the air."""
    first: list[Kind] = ["day", "step", "day", "stroke_z", "spectrum", "wet", "stroke_x", "idle", "tools"]
    if idle:
        kinds: list[Kind] = ["idle"] * max(1, round(0.7 * open_tests))
        kinds += first[: open_tests - len(kinds)]
    else:
        kinds = [*first, "day", "step", "spectrum", "day", "stroke_z", "idle", "wet"][:open_tests]
    order = rng.permutation(len(kinds))
    roles = ["verification" if len(kinds) > 4 and i % 4 == 3 else "calibration" for i in range(len(kinds))]
    locked = max(1, open_tests // 4)
    tests = [(kinds[j], roles[i]) for i, j in enumerate(order)]
    ends: list[Kind] = ["day", "spectrum", "day", "wet"]
    return tests + [(ends[i % 4] if i else "day", "locked") for i in range(locked)]


def work(kind: Kind, rng: np.random.Generator, hours: float) -> Work:
    """One test of a kind. It begins at balance: the machine was off for a day."""
    n = int(hours * 3600 / DT_S)
    t_h = np.arange(n) * DT_S / 3600
    start = float(rng.choice([6.0, 7.0, 8.0, 13.0, 18.0])) + rng.random()
    zero = {name: np.zeros(n) for name in ("speed", "tool_speed", "feed_x", "feed_z", "cutting", "coolant", "pump")}
    courses = zero | {"pos_z": np.full(n, 180.0)}
    _FILL[kind](courses, t_h, rng)
    if kind != "idle" or rng.random() < 0.4:  # the hydraulics are on while the machine is, and cycle with their load
        duty = 0.35 + 0.4 * (courses["speed"] > 0) if rng.random() < 0.5 else np.full(n, rng.uniform(0.3, 0.8))
        from_h, to_h = rng.uniform(0, 0.4) * hours * (rng.random() < 0.6), hours * rng.uniform(0.6, 1.0)
        phase = (t_h * 60 / rng.uniform(6, 25)) % 1
        courses["pump"] = ((phase < duty) & (t_h >= from_h) & (t_h < to_h)).astype(float)
    told: dict[str, str] = {"programme": kind}
    return Work(kind, start + t_h, conditions=told, **courses)


Courses = dict[str, Float1D]


def _step(c: Courses, t_h: Float1D, rng: np.random.Generator) -> None:
    c["speed"][:] = np.where(t_h < 0.55 * t_h[-1], rng.choice([0.35, 0.6, 0.85, 1.0]) * TOP_RPM, 0.0)


def _spectrum(c: Courses, t_h: Float1D, rng: np.random.Generator) -> None:
    c["speed"][:] = _levels(t_h, rng, 0.25, [0, 0, 0.2, 0.4, 0.7, 1.0]) * TOP_RPM * (t_h < 0.8 * t_h[-1])


def _stroke(axis: str) -> Callable[[Courses, Float1D, np.random.Generator], None]:
    def fill(c: Courses, t_h: Float1D, rng: np.random.Generator) -> None:
        on = (t_h < 0.6 * t_h[-1]) * _levels(t_h, rng, 1.0, [0.4, 0.7, 1.0])
        c[f"feed_{axis}"][:] = on * (20.0 if axis == "z" else 12.0)

    return fill


def _wet(c: Courses, t_h: Float1D, rng: np.random.Generator) -> None:
    c["coolant"][:] = _levels(t_h, rng, 0.8, [0, 1, 1])


def _tools(c: Courses, t_h: Float1D, rng: np.random.Generator) -> None:
    c["tool_speed"][:] = 5000 * _levels(t_h, rng, 0.5, [0, 0.5, 1.0]) * (t_h < 0.7 * t_h[-1])


def _day(c: Courses, t_h: Float1D, rng: np.random.Generator) -> None:
    """Batches of parts with breaks; each batch has its own speed, feeds, cutting, tools and coolant."""
    at = 0.0
    while at < t_h[-1]:
        length, pause = rng.uniform(0.4, 1.8), rng.uniform(0.1, 0.9)
        on = (t_h >= at) & (t_h < at + length)
        duty = ((t_h - at) * 60 / rng.uniform(4, 12)) % 1 < 0.8
        c["speed"][on & duty] = rng.uniform(0.2, 0.95) * TOP_RPM
        c["feed_z"][on] = rng.uniform(1, 14) * (rng.random() < 0.7)
        c["feed_x"][on] = rng.uniform(1, 9) * (rng.random() < 0.6)
        c["pos_z"][on] = rng.uniform(80, 320)
        c["cutting"][on & duty] = rng.uniform(1.0, 8.0) * (rng.random() < 0.6)
        c["coolant"][on] = float(rng.random() < 0.55)
        c["tool_speed"][on & ~duty] = rng.uniform(0.3, 1.0) * 5000 * (rng.random() < 0.5)
        at += length + pause


def _levels(t_h: Float1D, rng: np.random.Generator, mean_h: float, among: list[float]) -> Float1D:
    """Random levels, each held for 0.5 to 1.5 times mean_h."""
    edges = np.cumsum(mean_h * rng.uniform(0.5, 1.5, int(3 * t_h[-1] / mean_h) + 3))
    values = rng.choice(among, len(edges) + 1)
    return np.asarray(values[np.searchsorted(edges, t_h, side="right")], dtype=np.float64)


def _idle(c: Courses, t_h: Float1D, rng: np.random.Generator) -> None:
    """Nothing moves."""


_FILL: dict[Kind, Callable[[Courses, Float1D, np.random.Generator], None]] = {
    "idle": _idle,
    "step": _step,
    "spectrum": _spectrum,
    "stroke_z": _stroke("z"),
    "stroke_x": _stroke("x"),
    "wet": _wet,
    "tools": _tools,
    "day": _day,
}
