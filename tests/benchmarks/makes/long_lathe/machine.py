"""A flat-bed lathe of 65 finite volumes in a hall with seasons, weekends without heating, a door and sun.

Volumes conduct, give heat to air that the chuck moves, and to coolant while it flows; losses hang on speed, load, feed
and viscosity. Linear in its sources, it carries a column of temperatures a cause, exact and additive.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from datetime import UTC, datetime, timedelta
from zoneinfo import ZoneInfo

import numpy as np

from ..bodies import Array, pairs
from ..run import TestRun
from .network import AIR, FAN, GUST, HEAT, LINKS, SOURCES, WASH
from .programme import INPUTS

DT_S, SLOW_S = 60.0, 900.0  # a step in a test, and between tests
REST = 192  # slow steps before a test that begins after a long time
ZONE = ZoneInfo("Europe/Prague")
CAUSES = tuple(SOURCES)
AT: Mapping[str, int] = {name: i for i, name in enumerate(pairs(HEAT))}


def by_volume(text: str) -> Array:
    of = pairs(text) if text else {}
    return np.array([of.get(name, 0.0) for name in AT])


class Lathe:
    """One machine in its hall, its constants drawn, with the state it is in, a column a cause."""

    def __init__(self, rng: np.random.Generator) -> None:
        self.rng, size = rng, len(AT)
        self.c = np.array([1e3 * c * rng.uniform(0.7, 1.4) for c in pairs(HEAT).values()])
        self.links = np.zeros((size, size))
        for link, g in pairs(LINKS).items():
            i, j = (AT[name] for name in link.split("-"))
            self.links[i, j] = self.links[j, i] = g * rng.uniform(0.6, 1.6)
        self.air = {layer: by_volume(text) * rng.uniform(0.7, 1.4, size) for layer, text in AIR.items()}
        self.wash, self.fan = by_volume(WASH) * rng.uniform(0.6, 1.5), by_volume(FAN)
        self.heat_w = {cause: by_volume(text) * rng.uniform(0.7, 1.4) for cause, text in SOURCES.items()}
        self.swing, self.layer = rng.uniform(0.6, 1.6), rng.uniform(0.4, 1.2)
        self.dip, self.cold = rng.uniform(1.5, 4), rng.uniform(2.5, 6)  # of weekends, of the door in winter [K]
        self.power, self.period, self.rise = rng.uniform(1.3, 1.9), rng.uniform(18, 45), rng.uniform(3, 6)
        self.temps: Array = np.zeros((size, len(CAUSES)))
        self.heating, self.wander, self.gust = 0.0, 0.0, 0.0

    def step(self, u: Mapping[str, float], when: datetime, dt_s: float) -> dict[str, float]:
        """Go on by dt_s under these inputs; returns the air's layers and that at the door above the hall's mean [K],
        and the sun (1: full)."""
        layers, sun = self._hall(u["door"], when, dt_s)
        full, tank = self.links.copy(), AT["ct"]
        full[tank] += self.wash * u["cool"]
        full[:, tank] += self.wash * u["cool"]
        drives = self._drives(u, sun)
        heat = np.column_stack([self.heat_w[k] * drives.get(k, 0.0) for k in CAUSES])
        loss = np.zeros(len(AT))
        for layer, temp in layers.items():
            blown = self.fan * u["n"] if layer == "mid" else 0
            g = self.air[layer] * (1 + 0.6 * u["n"] * (self.fan > 0)) + blown
            loss = loss + g
            heat[:, CAUSES.index("air")] += g * temp
            heat[:, CAUSES.index("door")] += g * GUST[layer] * self.gust
        a = np.diag(self.c / dt_s + full.sum(1) + loss) - full
        self.temps = np.linalg.solve(a, self.c[:, None] / dt_s * self.temps + heat)
        felt = {layer: temp + GUST[layer] * self.gust for layer, temp in layers.items()}
        return felt | {"vr": layers["mid"] + 1.5 * self.gust, "sun": sun}

    def _hall(self, door: float, when: datetime, dt_s: float) -> tuple[dict[str, float], float]:
        """Layers of air without the door's draught [K], and the sun: season, day, weekend, heating that cycles."""
        rng, local = self.rng, when.astimezone(ZONE)
        hour = local.hour + local.minute / 60
        day = (when - datetime(2026, 1, 1, tzinfo=UTC)).total_seconds() / 86400
        weekday = local.weekday()
        off = (weekday == 4 and hour > 17) or weekday > 4 or (weekday == 0 and hour < 5)
        self.heating += (1 - np.exp(-dt_s / 25e3)) * (-self.dip * off * max(0, 1 - day / 150) - self.heating)
        stir = rng.normal(0, 0.5 * np.sqrt(1 - np.exp(-dt_s / 1e4)))
        self.wander = self.wander * np.exp(-dt_s / 2e4) + stir
        self.gust += (1 - np.exp(-dt_s / 400)) * (-self.cold * door * max(0.3, 1 - day / 200) - self.gust)
        daily = self.swing * np.sin((hour - 9.5) / 24 * 2 * np.pi)
        cycle = 0.12 * np.sin(60 * hour / self.period * 2 * np.pi)
        mid = self.rise * day / 180 + daily + self.heating + self.wander + cycle
        top = mid + self.layer * (1 + 0.3 * np.sin((hour - 8) / 24 * 2 * np.pi))
        sun = max(0.0, 1 - abs(hour - 10) / 2.5) * (1 if np.sin(day // 1 * 12.9) > 0.1 else 0.15)
        return {"top": top, "mid": mid, "low": 0.85 * mid - 0.4 * self.layer}, sun

    def _drives(self, u: Mapping[str, float], sun: float) -> dict[str, float]:
        """What drives the heat of each cause, 1 at most."""
        warm = self.temps[AT["bf"]].sum() - self.temps[AT["fd"]].sum()
        return {
            "bearing": u["n"] ** self.power * (1 - 0.009 * min(warm, 40)),
            "belt": 0.35 * u["n"] ** 1.5 + 0.65 * u["cut"],
            "hydraulics": u["hyd"],
            "zscrew": u["fz"] ** 1.2,
            "xscrew": u["fx"],
            "guide": u["fz"] ** 1.5,
            "coolant": u["cool"],
            "cutting": u["cut"],
            "chips": u["cut"] ** 1.3,
            "turret": u["live"] ** 1.4,
            "tailstock": u["tail"] * u["n"],
            "sun": sun,
        }


def simulate(lathe: Lathe, runs: Sequence[TestRun]) -> list[tuple[Array, dict[str, Array]]]:
    """Of each test the temperatures (time, volume, cause) [K] and the air; the lathe stands between tests."""
    told, then, rest = [], runs[0].start - timedelta(days=9), dict.fromkeys(INPUTS, 0.0)
    slow = timedelta(seconds=SLOW_S)
    for r in runs:
        if r.start - then > timedelta(hours=60):  # weeks in a few steps, but for their end
            for _ in range(3):
                lathe.step(rest, then, (r.start - then).total_seconds() / 3)
            then = r.start - REST * slow
        for k in range(max(0, -(-(r.start - then) // slow))):
            lathe.step(rest, then + k * slow, SLOW_S)
        temps, air = [], []
        for k in range(len(r.inputs["n"])):
            now = {name: float(x[k]) for name, x in r.inputs.items()}
            air.append(lathe.step(now, r.start + timedelta(seconds=DT_S * k), DT_S))
            temps.append(lathe.temps)
        then = r.start + timedelta(seconds=DT_S * len(temps))
        told.append((np.array(temps), {k: np.array([a[k] for a in air]) for k in air[0]}))
    return told
