"""A five-axis trunnion machine: 44 bodies exchange heat with 15 sources and fluids, stepped explicitly for all tests.

A body's temperature is a sum of shares, one a cause; convection and sources see the sum, so that the shares add up
exactly. Losses hang on speed, preload, viscosity, cut, feed, tilt, resistance; the tool moves by growth of the chain.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from ..bodies import Array, conduction, pairs
from .causes import CAUSES
from .network import BODIES, CUT, GROWTH, HALL, JOINTS, MACHINE, SOURCES, ZONES, flows
from .programme import Run, together

DT_S = 30.0
NAMES = (*CAUSES, "other")
AT: Mapping[str, int] = {row.split()[0]: i for i, row in enumerate(BODIES.split(","))}
NODE: Mapping[str, int] = {name: i for i, name in enumerate(SOURCES)}
SIZE = len(AT)
OTHERS = [NODE[k] for k in ("br", "nz", "zm", "kt", "ht", "ka", "cb")]  # sources without a feedback


def drawn(rng: np.random.Generator, numbers: Mapping[str, float], spread: float = 1.3) -> dict[str, float]:
    """The numbers of a table as one machine has them, each times or by up to spread."""
    return {name: value * spread ** rng.uniform(-1, 1) for name, value in numbers.items()}


class Machine:
    """Constants of one machine, and its integration over many tests at once."""

    def __init__(self, rng: np.random.Generator) -> None:
        rows = [row.split() for row in BODIES.split(",")]
        self.c = _around(rng, [float(r[1]) for r in rows], 1e3)
        self.h = _around(rng, [float(r[2]) for r in rows])
        self.cs = _around(rng, [s.heat for s in SOURCES.values()], 1e3)
        self.hs = _around(rng, [s.surface for s in SOURCES.values()])
        self.zone = np.array([ZONES.index(r[3]) for r in rows])
        self.zone_s = np.array([ZONES.index(s.air) for s in SOURCES.values()])
        self.lead = conduction(AT, drawn(rng, pairs(JOINTS), 1.5))
        paths = [
            (NODE[name], AT[body], g, NAMES.index(s.cause))
            for name, s in SOURCES.items()
            for body, g in drawn(rng, flows(s), 1.5).items()
        ]
        self.src, self.tgt, self.g, self.tag = (np.array(x) for x in zip(*paths, strict=True))
        self.cut = _column(drawn(rng, pairs(CUT)))
        self.grow = {axis: _column(drawn(rng, pairs(text), 1.25)) for axis, text in GROWTH.items()}
        self.w = drawn(rng, pairs(MACHINE))
        self.w |= {"band": rng.uniform(0.4, 1.5), "follow": float(rng.random() < 0.5)}
        self.w["top"] = float(rng.choice([12e3, 15e3, 18e3, 24e3]))
        self.hall = drawn(rng, pairs(HALL)) | {"night": float(rng.random() < 0.35)}
        k = np.arange(len(self.g))
        self.into, self.back = np.zeros((len(NAMES) * SIZE, len(k))), np.zeros((SIZE, len(k)))
        self.out = np.zeros((len(NODE), len(k)))
        self.into[self.tag * SIZE + self.tgt, k] = self.back[self.tgt, k] = self.out[self.src, k] = 1
        self.cool = np.isin(self.src, [NODE["cw"], NODE["lw"]])[:, None]
        self.wet = (self.src == NODE["kt"])[:, None]

    def run(self, runs: Sequence[Run], size: Mapping[str, float]) -> tuple[Array, Array]:
        """Shares (minutes, causes, bodies, tests) and sources (minutes, sources, tests) [K] of the longest test."""
        u = together([r.inputs for r in runs]) | together([r.air for r in runs])
        e, keep = np.array([size[k] for k in NAMES]), max(r.steps for r in runs)
        n, tests = u["n"].shape
        ge = (self.g * e[self.tag])[:, None]
        x, s = np.zeros((len(NAMES), SIZE, tests)), np.repeat(u["mid"][:1], len(NODE), 0).copy()
        x[NAMES.index("hall")] = u["mid"][0]
        chills = np.zeros(tests, bool)
        shares, sources = np.empty((keep, *x.shape), np.float32), np.empty((keep, *s.shape), np.float32)
        for step in range(2 * n):
            i = {name: a[step // 2] for name, a in u.items()}
            zones = np.stack([s[NODE["ka"]], i["mid"], i["mid"] + i["layer"], i["mid"] - 0.4 * i["layer"]])
            link = ge * np.where(self.cool, 0.05 + 0.95 * i["on"], np.where(self.wet, 0.02 + 0.98 * i["kss"], 1))
            q = self._bodies_w(x, s, i, zones, link, e)
            p, chills = self._sources_w(x.sum(0), s, i, zones, link, chills)
            x, s = x + DT_S * q / self.c[:, None], s + DT_S * p / self.cs[:, None]
            if step % 2 and step // 2 >= n - keep:
                shares[step // 2 - n + keep], sources[step // 2 - n + keep] = x, s
        return shares, sources

    def _bodies_w(self, x: Array, s: Array, i: Mapping[str, Array], zones: Array, link: Array, e: Array) -> Array:
        """Heat into the share of each cause of each body [W]. e: size of each cause."""
        k, mid, cabin, strat = {name: j for j, name in enumerate(NAMES)}, i["mid"], NAMES.index("cabin"), "strat"
        inside, top, low = ((self.zone == z)[:, None] for z in (0, 2, 3))
        moved = np.where(inside, 1 + 0.5 * i["kss"] + 0.4 * (i["n"] / self.w["top"]), 1)
        conv = self.h[:, None] * (0.6 + 0.4 * np.abs(zones[self.zone] - x.sum(0)) ** 0.33) * moved
        q: Array = np.matmul(self.lead, x) - (conv + self.back @ link) * x
        q = q + (self.into @ (link * s[self.src])).reshape(x.shape)
        q[k["hall"]] += conv * mid
        q[k[strat]] += conv * (e[k[strat]] * i["layer"] * (top - 0.4 * low))
        q[cabin] += conv * (inside * (e[cabin] * (s[NODE["ka"]] - mid)))
        q[k["cut"]] += e[k["cut"]] * self.cut[:, None] * (self.w["kW"] * 1e3 * i["cut"]) * (1 - 0.5 * i["kss"])
        return q

    def _sources_w(
        self, T: Array, s: Array, i: Mapping[str, Array], zones: Array, link: Array, chills: Array
    ) -> tuple[Array, Array]:
        """Heat into each source [W], and whether the chiller runs. T: of the bodies, shape (bodies, tests)."""
        w, r, mid, power = self.w, i["n"] / self.w["top"], i["mid"], self.w["kW"] * 1e3 * i["cut"]
        warm = 1 + 0.0039 * s  # the resistance of windings grows with temperature
        p: Array = self.hs[:, None] * (zones[self.zone_s] - s) - self.out @ (link * (s[self.src] - T[self.tgt]))
        bf, mo, cw, lw = (NODE[k] for k in ("bf", "mo", "cw", "lw"))
        oil = r**1.5 * np.exp(-w["visc"] * np.clip(s[bf], -10, 60))
        p[bf] += w["bf"] * oil * (1 + w["preload"] * np.clip(s[bf] - T[AT["h1"]], 0, 30))
        flow, goal = w["mc"] * i["on"] * (s[mo] - s[cw]), w["follow"] * 0.8 * mid - 1 + i["set"]
        p[mo] += w["idle"] * (i["n"] > 0) + w["iron"] * r**2 + w["copper"] * i["cut"] ** 2 * warm[mo] - flow
        chills = ((s[cw] > goal + w["band"]) | (chills & (s[cw] > goal - w["band"]))) & (i["on"] > 0)
        p[cw] += i["on"] * (w["pump"] + 500 * (s[cw] < goal - 1.2 * w["band"])) + flow - w["chill"] * chills
        disc = i["nc"] / 20
        cooled = {  # heat [W], and flow of its heat to the water of the linear motors [W/K]
            "lx": (w["lx"] * (i["vx"] / 20) ** 1.5, w["lc"]),
            "ly": (w["ly"] * (i["vy"] / 20) ** 1.5, w["lc"]),
            "am": (w["roll"] * (i["na"] / 8) ** 1.3 + w["hold"] * np.sin(i["tilt"]) ** 2, w["ac"]),
            "cm": (w["disc"] * disc + 0.8 * w["disc"] * disc**2, w["cc"]),
        }
        for name, (heat, g) in cooled.items():
            flow = g * i["on"] * (s[NODE[name]] - s[lw])
            p[NODE[name]] += heat * warm[NODE[name]] - flow
            p[lw] += flow
        p[lw] += i["on"] * (w["lp"] - w["valve"] * (s[lw] - i["setl"] - 0.3 * mid))
        tank, oils, cabin = (s[NODE[k]] for k in ("kt", "ht", "ka"))
        heats = [
            w["br"] * oil,
            w["nut"] * (i["vz"] / 10 + 0.35 * (i["vz"] / 10) ** 2),
            14 * i["vz"] + 25 * i["on"],
            (w["tank"] + 0.1 * power) * i["kss"],
            w["oil"] * i["hyd"] - 25 * (oils > 16) * (oils - mid),
            w["air"] * r + 0.05 * power + 8 * (i["vx"] + i["vy"]) + 14 * i["kss"] * (tank - cabin),
            180 * i["on"] + 0.02 * power,
        ]
        p[OTHERS] += np.stack(heats)
        return p, chills

    def moves(self, axis: str, shares: Array, runs: Sequence[Run], size: Mapping[str, float]) -> Array:
        """What each cause does along one axis [um], shape (minutes, causes, tests)."""
        part: Array = np.einsum("kcbt,b->kct", shares, self.grow[axis])
        if axis == "Z":  # the shaft shifts with the square of the speed, at once
            speed = together([r.inputs for r in runs])["n"][-len(part) :]
            part[:, NAMES.index("centri")] += size["centri"] * (speed / 1e4) ** 2
        return part


def scaled(
    m: Machine, runs: Sequence[Run], axis: str, want_um: Mapping[str, float], size: dict[str, float]
) -> tuple[Array, Array, Array, dict[str, float], dict[str, float]]:
    """Bring the causes to their sizes. Returns shares, sources, parts along the axis, [um] and size of each cause."""
    for again in range(4):
        shares, sources = m.run(runs, size)
        part = m.moves(axis, shares, runs, size)
        um = {k: max(_most(part[-r.steps :, i, j]) for j, r in enumerate(runs)) for i, k in enumerate(NAMES)}
        if again < 3:
            wanted = {k: size[k] * np.clip(a / max(um[k], 1e-3), 0.05, 8) for k, a in want_um.items()}
            size = size | {k: float(np.clip(x, 1e-4, 8)) for k, x in wanted.items()}
    return shares, sources, part, um, size


def _most(d: Array) -> float:
    return float(np.abs(d - d[0]).max())


def _around(rng: np.random.Generator, numbers: Sequence[float], unit: float = 1) -> Array:
    return np.array(numbers) * unit * 1.3 ** rng.uniform(-1, 1, len(numbers))


def _column(of: Mapping[str, float]) -> Array:
    return np.array([of.get(name, 0.0) for name in AT])
