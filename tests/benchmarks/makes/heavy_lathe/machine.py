"""A heavy lathe of twenty-four bodies and three layers of air in an unheated hall, stepped implicitly.

Hydrostatic spindle, gearbox of three ranges, motor, oil tank with a chiller between two temperatures, chuck and
workpiece, ram with a live tool, carriage, bed, foundation. Conductances hang on speed and pump, losses on speed, range,
load and viscosity. Heat capacities and conductances are the maker's estimates for a middling machine; each has its own.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from datetime import datetime, timedelta

import numpy as np

from ..bodies import Array, pairs
from .programme import DT_S, INPUTS, Run

HEAT = """
    bearing_front 70, bearing_rear 60, headstock 900, headstock_wall 1500, gear_oil 120, gear_housing 450,
    motor 160, tank 420, oil_supply 25, chuck 260, workpiece 420, bed_top 1600, bed_bottom 2600, foundation 16000,
    ram 240, live_tool 25, ram_front 90, ram_rear 90, nut_x 14, screw_x 70, guide_z 160, carriage 800,
    probe_holder 15, floor_slab 5000
"""  # heat capacities [kJ/K]
LINKS = """
    bearing_front-headstock 60, bearing_rear-headstock 50, bearing_front-chuck 25, headstock-headstock_wall 90,
    headstock-gear_housing 60, gear_oil-gear_housing 150, gear_housing-motor 12, headstock_wall-bed_top 60,
    bed_top-bed_bottom 90, bed_bottom-foundation 45, foundation-floor_slab 60, chuck-workpiece 45, ram-ram_front 30,
    ram-ram_rear 30, live_tool-ram_front 18, live_tool-ram 10, ram_front-ram_rear 6, ram-carriage 25,
    nut_x-screw_x 6, screw_x-carriage 8, nut_x-carriage 6, guide_z-carriage 25, guide_z-bed_top 20,
    tank-bed_bottom 6, probe_holder-carriage 0.4, motor-headstock_wall 10
"""  # conductances between bodies [W/K]
AIR = """
    headstock-mid 25, headstock_wall-top 45, gear_housing-mid 22, motor-low 18, tank-low 25, chuck-mid 10,
    workpiece-mid 14, bed_top-mid 40, bed_bottom-low 45, foundation-low 120, ram-top 8, ram_front-mid 6,
    ram_rear-top 6, screw_x-mid 2.5, guide_z-mid 6, carriage-mid 22, probe_holder-mid 3, floor_slab-low 40
"""  # conductances to a layer of air at rest [W/K]
FLOW = """
    oil_supply-tank 6, oil_supply-bearing_front 0.6, oil_supply-bearing_rear 0.5, oil_supply-headstock 0.25,
    tank-bearing_front 0.3
"""  # shares of the oil's flow, while the pump runs
LOSSES_W = {  # at full speed, cut, live tool or pump; of feeds: for 1 m/min
    "bearings": 2600,
    "gears": 1500,
    "churning": 1100,
    "windings": 900,
    "chips": 1600,
    "live_tool": 500,
    "nut": 60,
    "guide": 45,
    "pump": 2600,
    "chiller": 7500,
}
OIL = 160  # flow of its heat [W/K]
RATIO = {0: 0, 1: 4.0, 2: 2.0, 3: 1.0}  # motor to spindle, by range
LAYERS = ("top", "mid", "low")
BODIES = tuple(pairs(HEAT))
AT: Mapping[str, int] = {name: k for k, name in enumerate((*BODIES, *LAYERS, "out"))}  # columns of temperatures


class Lathe:
    """One machine of the kind, its constants drawn, with the state it and its hall are in."""

    def __init__(self, rng: np.random.Generator, top_rpm: float) -> None:
        self.rng, self.top_rpm, size = rng, top_rpm, len(BODIES)
        self.heat = np.array([1e3 * c * rng.uniform(0.7, 1.4) for c in pairs(HEAT).values()])
        self.links = np.zeros((size, size))
        for link, g in pairs(LINKS).items():
            i, j = (AT[name] for name in link.split("-"))
            self.links[i, j] = self.links[j, i] = g * rng.uniform(0.6, 1.6)
        self.air = np.zeros((size, len(LAYERS)))
        for link, g in pairs(AIR).items():
            body, layer = link.split("-")
            self.air[AT[body], LAYERS.index(layer)] = g * rng.uniform(0.7, 1.4)
        self.losses = {name: watts * float(rng.uniform(0.7, 1.4)) for name, watts in LOSSES_W.items()}
        flow = OIL * float(rng.uniform(0.7, 1.4))
        self.flow = {link: flow * share for link, share in pairs(FLOW).items()}  # [W/K]
        self.mean, self.swing, self.layer = rng.uniform(10, 19), rng.uniform(2.5, 6), rng.uniform(0.8, 2.5)
        self.band, self.set = rng.uniform(0.4, 1.5), self.mean + rng.uniform(3, 7)  # of the chiller [K], [degC]
        self.chills, self.door = 0.0, False
        self.temps: Array = np.full(size, self.mean) + rng.normal(0, 0.3, size)
        self.hall, self.weather = self.mean, 0.0

    def step(self, u: Mapping[str, float], hour: float, dt_s: float) -> Array:
        """Go on by dt_s under these inputs; returns the temperatures of `AT` [degC]."""
        air, out = self._air(hour, dt_s)
        tank = self.temps[AT["tank"]]
        if not u["pump"] or tank < self.set - self.band:
            self.chills = 0.0
        elif tank > self.set + self.band:
            self.chills = 1.0
        links, wind = self.links.copy(), self.air.copy()
        for link, g in self.flow.items():
            i, j = (AT[name] for name in link.split("-"))
            links[i, j] = links[j, i] = links[i, j] + g * u["pump"]
        wind[[AT["chuck"], AT["workpiece"]]] *= 1 + 4 * (u["speed"] / self.top_rpm) ** 0.8
        full = np.diag(self.heat / dt_s + links.sum(1) + wind.sum(1)) - links
        self.temps = np.linalg.solve(full, self.heat / dt_s * self.temps + self._heat_w(u) + wind @ air)
        return np.append(self.temps, [*air, out])

    def _air(self, hour: float, dt_s: float) -> tuple[Array, float]:
        """Layers of the hall's air, shape (3,), and the air outside [degC]: weather, day, a door."""
        rng = self.rng
        self.weather += -dt_s / 200e3 * self.weather + 2.5 * np.sqrt(2 * dt_s / 200e3) * rng.normal()
        out = self.mean + self.weather + self.swing * np.sin(2 * np.pi * (hour - 9) / 24)
        day = 6 < hour % 24 < 20
        self.door = rng.random() > dt_s / 500 if self.door else rng.random() < dt_s / 6000
        tau_s = 1500 if self.door and day else 14e3
        self.hall += dt_s / tau_s * (out - self.hall) + 1.2 * dt_s / 14e3 * day
        rise = self.layer * (0.4 + 0.6 * day + 0.5 * np.sin(2 * np.pi * (hour - 13) / 24))
        layers = [self.hall + rise, self.hall, self.hall - 0.5 * rise - 1.5 * (self.door and day)]
        return np.array(layers) + rng.normal(0, 0.06, 3), out

    def _heat_w(self, u: Mapping[str, float]) -> Array:
        """Losses in each body [W]; the chiller takes heat from the oil's supply."""
        most, turns, speed = self.losses, u["speed"] > 0, u["speed"] / self.top_rpm
        motor = u["speed"] * RATIO[int(u["range"])] / self.top_rpm
        thickness = float(np.clip(np.exp(-0.03 * (self.temps[AT["tank"]] - self.mean)), 0.4, 1.6))
        watts = {
            "bearing_front": most["bearings"] * speed**1.8 * thickness,
            "bearing_rear": 0.6 * most["bearings"] * speed**1.8 * thickness,
            "gear_housing": most["gears"] * (0.5 * motor + u["cut"]) * turns * 0.6,
            "gear_oil": most["churning"] * min(motor, 2.0) ** 1.5 + 150 * turns,
            "motor": most["windings"] * (turns * 0.3 + 0.25 * motor + 1.6 * u["cut"] ** 2),
            "workpiece": most["chips"] * u["cut"],
            "chuck": 0.2 * most["chips"] * u["cut"],
            "live_tool": most["live_tool"] * (u["live"] / 3000) ** 1.5,
            "nut_x": most["nut"] * u["feed_x"],
            "guide_z": most["guide"] * u["feed_z"],
            "tank": most["pump"] * u["pump"],
            "oil_supply": -most["chiller"] * self.chills,
        }
        return np.array([watts.get(body, 0.0) for body in BODIES])


def simulate(lathe: Lathe, runs: Sequence[Run]) -> list[tuple[Array, Array]]:
    """Temperatures (time, node) [degC] and chiller (1: runs) of each test; between the tests the machine is idle."""
    idle, then, told = dict.fromkeys(INPUTS, 0.0), None, []
    for r in runs:
        hours, clock = _rest_h(then, r.start), r.start.hour + r.start.minute / 60
        for k in range(int(hours * 6)):
            lathe.step(idle, clock - hours + k / 6, 600)
        temps, chills = [], []
        for k in range(r.steps):
            temps.append(lathe.step({name: float(x[k]) for name, x in r.inputs.items()}, clock + k * DT_S / 3600, DT_S))
            chills.append(lathe.chills)
        then = r.start + timedelta(seconds=DT_S * r.steps)
        told.append((np.array(temps), np.array(chills)))
    return told


def _rest_h(then: datetime | None, start: datetime) -> float:
    return 36.0 if then is None else min((start - then).total_seconds() / 3600, 48.0)
