"""A vertical centre: 53 volumes of time constants from 3 min to 8 h, 21 sources of two nodes each, six media.

Linear conduction, stepped by the matrix exponential, carries a field of each source, so that temperatures and growths
are sums of fields; friction falls as grease warms, the chiller cycles, and air past the headstock goes with the speed.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from scipy.linalg import expm

from ..bodies import Array, conduction, pairs
from .causes import CAUSES
from .network import CHAINS, GROWTH, LINKS, MEDIA, SOURCES, flows
from .programme import Run

DT_S = 60.0
ROWS = [row.split() for row in CHAINS.split(",")]
AT: Mapping[str, int] = {name: k for k, name in enumerate(f"{r[0]}{i}" for r in ROWS for i in range(int(r[1])))}
SIZE = len(AT)
NODE: Mapping[str, int] = {name: k for k, name in enumerate(SOURCES)}
FIELDS = (*SOURCES, *MEDIA)
CAUSE = [SOURCES[f].cause if f in SOURCES else f for f in FIELDS]  # what each field is counted to
SHARES = {k: np.array([cause == k for cause in CAUSE], float) for k in CAUSES if k != "centri"}
AIRY = np.array([k for name, k in AT.items() if name[:2] in ("hd", "ho", "sh")])  # in the wind of the spindle
WATERED = 3  # sources whose heat goes to the chiller


class Fluid(NamedTuple):
    """heat: capacity [J/K]. surface: to the hall [W/K]. power: of the chiller or the pump [W]. by: [K]."""

    heat: float
    surface: float
    power: float
    by: float


@dataclass(frozen=True)
class State:
    """What a test makes of the machine [K]. fields: (n, volume, field). own: of the sources, (n, source). fluids: of
    the chiller's supply `chs` and return `chr`, and of the coolant's tank, shape (n,)."""

    fields: Array
    own: Array
    fluids: Mapping[str, Array]

    def last(self, n: int, size: Array) -> State:
        """Of the last n minutes. size: of each field."""
        return State(self.fields[-n:] * size, self.own[-n:], {k: x[-n:] for k, x in self.fluids.items()})


class Machine:
    """Constants of one machine, and its integration over a test."""

    def __init__(self, rng: np.random.Generator) -> None:
        heat, skin, high, links = np.zeros(SIZE), np.zeros(SIZE), np.zeros(SIZE), pairs(LINKS)
        for row, count, *numbers in ROWS:
            c, inner, h, low, top = map(float, numbers)
            names = [f"{row}{i}" for i in range(int(count))]
            own = [AT[name] for name in names]
            heat[own] = 1000 * c * rng.uniform(0.8, 1.25) / len(own)
            skin[own] = h * rng.uniform(0.8, 1.25) / len(own)
            high[own] = np.linspace(low, top, len(own))
            links |= {f"{a}-{b}": inner for a, b in pairwise(names)}
        self.heat = heat
        lead = conduction(AT, drawn(rng, links))
        self.step = expm((lead - np.diag(skin)) / heat[:, None] * DT_S)
        self.into = np.stack([_column(drawn(rng, flows(f))) for f in FIELDS], 1)
        self.into[:, FIELDS.index("hall")], self.into[:, FIELDS.index("gradient")] = skin, skin * high
        nodes = [(*s.heat, s.between, s.surface) for s in SOURCES.values()]
        self.nodes = np.array([[x * rng.uniform(0.8, 1.25) for x in node] for node in nodes]) * [1000, 1000, 1, 1]
        self.losses = [drawn(rng, pairs(s.losses)) for s in SOURCES.values()]
        self.thins = np.array([s.thins for s in SOURCES.values()])
        self.growth = {a: _column(drawn(rng, pairs(text), 0.85, 1.15)) for a, text in GROWTH.items()}
        self.top_rpm, self.most_kw = float(rng.choice([6000, 8000, 10000, 12000])), float(rng.uniform(11, 22))
        self.fan = float(rng.uniform(0.3, 1.2))
        self.chiller = _fluid(rng, (50, 90), (15, 30), (900, 1800), (0.4, 1.0))
        self.tank = _fluid(rng, (600, 1200), (30, 60), (300, 700), (0.5, 2.5))

    def run(self, u: Mapping[str, Array]) -> State:
        """u: inputs and airs, shape (n,)."""
        n, heats, surface = len(u["n"]), self._losses_w(u), self.nodes[:, 3]
        inner, outer, between = self.nodes[:, 0], self.nodes[:, 1], self.nodes[:, 2]
        a, b = np.zeros(len(NODE)), np.zeros(len(NODE))
        x = np.zeros((SIZE, len(FIELDS)))
        fields, own, supply, tank = np.zeros((n, *x.shape)), np.zeros((n, len(a))), np.zeros(n), np.zeros(n)
        cools, f, k, c, t = False, 0.0, 0.0, self.chiller, self.tank
        for i in range(n):
            loss, flow = heats[i] * np.exp(-self.thins * a), between * (a - b)
            a, b = a + DT_S * (loss - flow) / inner, b + DT_S * (flow - surface * b) / outer
            hall, wet, goal = u["hall"][i], u["kss"][i], u["set"][i]
            cools = f > goal + c.by or (cools and f > goal - c.by)
            f += DT_S * (0.3 * loss[:WATERED].sum() + c.surface * (hall + 2.5 - f) - c.power * cools) / c.heat
            k += DT_S * (t.power * wet + 120 * u["cut"][i] + t.surface * (hall - t.by * wet - k)) / t.heat
            warm = np.r_[0.5 * (a + b), f, wet * k, hall, u["layer"][i], u["sun"][i] / 500, u["draught"][i]]
            x = x + DT_S * self.into * warm / self.heat[:, None]
            x[AIRY] *= 1 - DT_S * self.fan * 2 * u["n"][i] / self.top_rpm / self.heat[AIRY, None]
            x = self.step @ x
            fields[i], own[i], supply[i], tank[i] = x, a, f, k
        back = supply + 0.3 * heats[:, :WATERED].sum(1) / 900 + 0.2
        return State(fields, own, {"chs": supply, "chr": back, "tank": tank})

    def _losses_w(self, u: Mapping[str, Array]) -> Array:
        """Heat of each source before its grease gets warm, shape (n, sources)."""

        def one(term: str) -> Array:
            name, _, power = term.partition("^")
            x = u[name] / {"n": self.top_rpm, "na": 10.0}.get(name, 1.0)
            return np.asarray(x ** float(power or 1) * (self.top_rpm / 9000 if name == "n" else 1.0))

        return np.stack([np.sum([w * one(term) for term, w in of.items()], axis=0) for of in self.losses], 1)

    def moves(self, body: Array, speed: Array, shift_um: float) -> dict[str, Array]:
        """By axis [um], and the tilt T [urad]. body: (n, volume) [K]. shift_um: of the shaft in Z at full speed."""
        move = {a: body @ growth for a, growth in self.growth.items()}
        move["Z"] = move["Z"] + shift_um * (speed / self.top_rpm) ** 2
        return move

    def parts(self, state: State, axis: str) -> dict[str, float]:
        """Range of what each cause but the shift with speed does along an axis [um or urad]."""
        return {k: float(np.ptp((state.fields @ share) @ self.growth[axis])) for k, share in SHARES.items()}


def scaled(
    m: Machine, runs: Sequence[Run], axis: str, want: Mapping[str, float]
) -> tuple[list[State], list[dict[str, float]], dict[str, float]]:
    """Bring each cause to its size along an axis. Returns states of the tests, what each cause does in each, and how
    strongly each couples to the structure."""
    states = [m.run(r.inputs).last(r.steps, np.ones(len(FIELDS))) for r in runs]
    plain = [m.parts(state, axis) for state in states]
    size = {k: want[k] / max(*(part[k] for part in plain), 1e-6) for k in SHARES}
    states = [state.last(len(state.own), np.array([size[k] for k in CAUSE])) for state in states]
    return states, [m.parts(state, axis) for state in states], size


def drawn(
    rng: np.random.Generator, numbers: Mapping[str, float], low: float = 0.8, high: float = 1.25
) -> dict[str, float]:
    """The numbers of a table as one machine has them."""
    return {name: value * float(rng.uniform(low, high)) for name, value in numbers.items()}


def _fluid(rng: np.random.Generator, kj: tuple[float, float], *ranges: tuple[float, float]) -> Fluid:
    return Fluid(float(rng.uniform(*kj)) * 1000, *(float(rng.uniform(*x)) for x in ranges))


def _column(of: Mapping[str, float]) -> Array:
    return np.array([of.get(name, 0.0) for name in AT])
