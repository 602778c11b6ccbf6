"""A bed mill with a motor spindle: ninety-eight bodies and three layers of air, stepped implicitly.

Shaft, rotor and stator in a sleeve through which water flows cell by cell from a tank that a compressor cools between
two temperatures; a hollow screw of Y with its own oil; a column of two walls in five storeys, splashed in front and
drawn at by the hall's layers behind; bed, tables, part and tanks. Losses hang on speed, load, feed and viscosity,
conductances on speed, flow and coolant. Heat capacities and conductances are the maker's estimates; each machine has
its own.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from datetime import timedelta
from itertools import pairwise

import numpy as np

from ..bodies import Array, conduction, pairs
from .programme import DT_S, INPUTS, Run

HEAT = """
    shaft_front 2.5, shaft_middle 5, shaft_rear 2, bearing_front 1.8, bearing_rear 1.2, rotor 5, stator 7, sleeve_1 3,
    sleeve_2 4, sleeve_3 3, headstock_1 35, headstock_2 40, headstock_3 35, holder 1.1, tool 0.6, lubrication_ring 0.9,
    cooled_plate 10, water_tank 260, water_1 2, water_2 2, water_3 2, water_plate 2, oil_tank 300, oil_1 1.5, oil_2 1.5,
    nut_y 3.5, bearing_y 4, motor_y 8, slide_y 60, cover_top 7, cover_bottom 8, carriage_x 90, nut_x 4, bearing_x 4,
    motor_x 9, screw_x_1 2, screw_x_2 2, slide_z 80, guide_z 22, nut_z 4, bearing_z 4, motor_z 9, screw_z_1 2,
    screw_z_2 2, scale_z 0.8, table_b 45, bearing_b 6, motor_b 8, pallet 45, fixture 15, part_1 7, part_2 9, frame 55,
    frame_foot 160, trough 14, foundation 4000, coolant_tank 650, hydraulic_tank 85, hydraulic_block 18, enclosure 9,
    chips 12, screw_y_1 1.6, screw_y_2 1.6, screw_y_3 1.6, screw_y_4 1.6, column_front_1 50, column_front_2 50,
    column_front_3 50, column_front_4 50, column_front_5 50, column_rear_1 50, column_rear_2 50, column_rear_3 50,
    column_rear_4 50, column_rear_5 50, bed_top_1 55, bed_top_2 55, bed_top_3 55, bed_top_4 55, bed_top_5 55,
    bed_bottom_1 75, bed_bottom_2 75, bed_bottom_3 75, bed_bottom_4 75, bed_bottom_5 75
"""  # heat capacities [kJ/K]
LINKS = """
    shaft_front-bearing_front 8, shaft_front-shaft_middle 1.5, shaft_middle-rotor 8, shaft_middle-shaft_rear 3,
    shaft_rear-bearing_rear 6, rotor-stator 8, stator-sleeve_2 50, bearing_front-sleeve_1 15, bearing_rear-sleeve_3 12,
    sleeve_1-sleeve_2 9, sleeve_2-sleeve_3 9, sleeve_1-headstock_1 14, sleeve_2-headstock_2 14, sleeve_3-headstock_3 14,
    headstock_1-headstock_2 55, headstock_2-headstock_3 55, headstock_1-slide_y 18, headstock_2-slide_y 25,
    headstock_3-slide_y 18, shaft_front-holder 0.6, holder-tool 1.5, lubrication_ring-sleeve_1 0.5,
    cooled_plate-headstock_2 3, water_1-sleeve_1 90, water_2-sleeve_2 140, water_3-sleeve_3 80,
    water_plate-cooled_plate 45, oil_1-screw_y_1 11, oil_1-screw_y_2 11, oil_2-screw_y_3 11, oil_2-screw_y_4 11,
    screw_y_1-screw_y_2 0.6, screw_y_2-screw_y_3 0.6, screw_y_3-screw_y_4 0.6, bearing_y-screw_y_1 1.5,
    motor_y-bearing_y 3, bearing_y-column_front_5 6, nut_y-screw_y_2 2, nut_y-screw_y_3 2, nut_y-slide_y 2.5,
    slide_y-column_front_2 12, slide_y-column_front_3 22, slide_y-column_front_4 10, cover_top-column_front_5 0.2,
    cover_bottom-column_front_1 0.2, column_front_1-carriage_x 30, column_rear_1-carriage_x 30, carriage_x-bed_top_3 14,
    carriage_x-bed_top_4 14, nut_x-carriage_x 3, nut_x-screw_x_1 2, screw_x_1-screw_x_2 0.6, bearing_x-screw_x_2 1.5,
    motor_x-bearing_x 3, bearing_x-bed_top_5 6, guide_z-slide_z 10, guide_z-bed_top_1 5, guide_z-bed_top_2 6,
    nut_z-slide_z 3, nut_z-screw_z_1 2, screw_z_1-screw_z_2 0.6, bearing_z-screw_z_2 1.5, motor_z-bearing_z 3,
    bearing_z-bed_top_1 6, scale_z-slide_z 0.8, scale_z-guide_z 0.5, bearing_b-table_b 12, motor_b-bearing_b 4,
    table_b-slide_z 14, pallet-table_b 12, fixture-pallet 14, part_1-fixture 7, part_1-part_2 8, frame-frame_foot 3,
    frame_foot-bed_bottom_1 0.3, hydraulic_tank-hydraulic_block 12, hydraulic_block-bed_top_2 1.5,
    hydraulic_block-bed_bottom_2 1, chips-bed_top_2 6, chips-bed_top_3 8, chips-bed_top_4 5,
    coolant_tank-bed_bottom_3 5, coolant_tank-bed_bottom_4 5, enclosure-column_front_1 4, enclosure-column_front_2 5,
    enclosure-column_front_3 5, enclosure-slide_y 4, enclosure-headstock_1 4, enclosure-part_1 2, enclosure-part_2 2,
    enclosure-pallet 4, enclosure-tool 0.3, enclosure-slide_z 5, enclosure-bed_top_3 5, enclosure-scale_z 0.2,
    trough-bed_top_3 2, enclosure-trough 1, bed_top_1-bed_bottom_1 26, bed_top_2-bed_bottom_2 26,
    bed_top_3-bed_bottom_3 26, bed_top_4-bed_bottom_4 26, bed_top_5-bed_bottom_5 26, bed_bottom_1-foundation 3,
    bed_bottom_2-foundation 3, bed_bottom_3-foundation 3, bed_bottom_4-foundation 3, bed_bottom_5-foundation 3,
    column_front_1-column_rear_1 9, column_front_2-column_rear_2 9, column_front_3-column_rear_3 9,
    column_front_4-column_rear_4 9, column_front_5-column_rear_5 9, column_front_1-column_front_2 24,
    column_front_2-column_front_3 24, column_front_3-column_front_4 24, column_front_4-column_front_5 24,
    column_rear_1-column_rear_2 24, column_rear_2-column_rear_3 24, column_rear_3-column_rear_4 24,
    column_rear_4-column_rear_5 24, bed_top_1-bed_top_2 24, bed_top_2-bed_top_3 24, bed_top_3-bed_top_4 24,
    bed_top_4-bed_top_5 24, bed_bottom_1-bed_bottom_2 24, bed_bottom_2-bed_bottom_3 24, bed_bottom_3-bed_bottom_4 24,
    bed_bottom_4-bed_bottom_5 24
"""  # conductances between bodies [W/K]
AIR = {
    "top": """
        column_rear_5 14, column_rear_4 9, column_front_5 7, cover_top 9, headstock_3 5, motor_y 3
    """,
    "mid": """
        column_rear_3 9, column_rear_2 6, column_front_4 3, headstock_2 6, headstock_3 5, frame 22, frame_foot 10,
        motor_x 3, motor_z 3, motor_b 2, enclosure 4, water_tank 9, oil_tank 150, scale_z 0.3, slide_z 4, slide_y 4,
        carriage_x 5, pallet 1
    """,
    "low": """
        column_rear_1 8, cover_bottom 9, hydraulic_tank 11, coolant_tank 40, chips 4, foundation 35, bed_top_1 5,
        bed_top_5 5, bed_bottom_1 9, bed_bottom_2 9, bed_bottom_3 9, bed_bottom_4 9, bed_bottom_5 9
    """,
}  # conductances to the layers of the hall's air [W/K]
WASH = """
    column_front_1 14, column_front_2 20, column_front_3 6, bed_top_3 14, bed_top_4 10, bed_top_2 6, part_1 14,
    part_2 14, fixture 16, pallet 14, trough 25, holder 2, tool 3, enclosure 8, chips 6, slide_z 3
"""  # conductances to the coolant as it flows [W/K]
LOSSES = {
    "bearing": "bearing_front 300, shaft_front 60, bearing_rear 160, shaft_rear 40",
    "motor": "stator 800, rotor 200",
    "windage": "rotor 60",
    "cut": "tool 2.5, holder 1.2, part_1 40, part_2 20, chips 600",
    "feed_y": "nut_y 19, bearing_y 8, motor_y 50, screw_y_2 3, screw_y_3 3",
    "feed_x": "nut_x 13, bearing_x 7, motor_x 45, screw_x_1 2",
    "feed_z": "nut_z 22, bearing_z 10, motor_z 50, guide_z 90",
    "rotary": "bearing_b 110, motor_b 120",
    "coolant": "coolant_tank 900",
    "hydraulics": "hydraulic_tank 320",
    "chiller": "water_tank 250",
}  # heat by what drives it: its bodies, with watts at full drive
RINGS = (  # through which a fluid flows cell by cell
    "water_tank water_1 water_2 water_3 water_tank",
    "water_tank water_plate water_tank",
    "oil_tank oil_1 oil_2 oil_tank",
)
OIL_AIR = 3.0  # to the bearings [W/K]
BODIES = tuple(pairs(HEAT))
SIZE = len(BODIES)
AT: Mapping[str, int] = {name: k for k, name in enumerate((*BODIES, *AIR, "oil_air"))}  # columns of temperatures
IN_DRAUGHT = np.isin(BODIES, ("holder", "tool"))  # of the spindle


def by_body(table: Mapping[str, float]) -> Array:
    """The table's number of each body, 0 where it has none."""
    return np.array([table.get(name, 0.0) for name in BODIES])


class Mill:
    """One machine of the kind, its constants drawn, with the state it and its hall are in.

    All temperatures stand above the mean of the hall [K].
    """

    def __init__(self, rng: np.random.Generator) -> None:
        self.rng = rng
        self.heat = 1e3 * by_body(pairs(HEAT)) * rng.uniform(0.7, 1.4, SIZE)
        links = {link: g * rng.uniform(0.6, 1.6) for link, g in pairs(LINKS).items()}
        self.links = conduction({name: AT[name] for name in BODIES}, links)
        self.air = {layer: by_body(pairs(text)) * rng.uniform(0.7, 1.4, SIZE) for layer, text in AIR.items()}
        self.wash = by_body(pairs(WASH)) * rng.uniform(0.6, 1.5, SIZE)
        self.losses = {drive: by_body(pairs(text)) * rng.uniform(0.7, 1.4) for drive, text in LOSSES.items()}
        self.flows = dict(zip(RINGS, rng.uniform([500, 150, 150], [900, 300, 300]), strict=True))  # [W/K]
        self.cold_w, self.band = rng.uniform([3200, 0.35], [4600, 0.7])  # of the compressor
        self.follow = rng.choice([0, 0, 0.4])  # of its set point, with the hall
        self.standby = rng.choice([0, 1, 1.5])  # of its set point, in standby [K]
        low, high = (20, 0.8, 0.4, 1.5, 0.6, 2.5), (24, 2.2, 0.9, 2.1, 1.6, 5)
        self.mean, self.swing, self.layer, self.power, self.draught, self.wet = rng.uniform(low, high)
        self.temps: Array = np.zeros(SIZE)
        self.weather = self.mid = self.gust = self.rise = self.compressor = 0.0
        self.heater = self.chills = False

    def step(self, u: Mapping[str, float], hour: float, dt_s: float) -> Array:
        """Go on by dt_s under these inputs; returns the temperatures of `AT`."""
        air, oil = self._air(u, hour, dt_s)
        tank = self.temps[AT["water_tank"]]
        want = self.follow * self.mid - 0.5 + self.standby * u["standby"]
        self.chills = bool(tank > want + (-self.band if self.chills else self.band))
        heat, full = self._heat_w(u), self._conduction(u)
        for layer, g in self.air.items():
            blown = g * (1 + 2 * u["speed"] ** 0.8 * IN_DRAUGHT) if layer == "mid" else g
            full, heat = full + np.diag(blown), heat + blown * air[layer]
        ring = AT["lubrication_ring"]
        full[ring, ring] += OIL_AIR
        heat[ring] += OIL_AIR * oil
        self.temps = np.linalg.solve(full + np.diag(self.heat / dt_s), self.heat / dt_s * self.temps + heat)
        return np.append(self.temps, [*air.values(), oil])

    def _air(self, u: Mapping[str, float], hour: float, dt_s: float) -> tuple[dict[str, float], float]:
        """Layers of the hall's air, and the air that carries the bearings' oil: weather, day, a heater, a gate."""
        rng, day = self.rng, 6 < hour % 24 < 21
        self.weather += -dt_s / 150e3 * self.weather + 0.4 * np.sqrt(2 * dt_s / 150e3) * rng.normal()
        to = self.weather + self.swing * np.sin(np.pi * (hour - 9) / 12) + 0.5 * day
        self.mid += dt_s / 5000 * (to - self.mid) + 0.03 * rng.normal()
        if rng.random() < dt_s / (5000 if self.heater else 7000):
            self.heater = not self.heater
        self.rise += dt_s / 1500 * (self.layer * (0.4 + 0.4 * day + 1.2 * self.heater * day) - self.rise)
        self.gust += dt_s / (300 if u["gate"] else 1500) * (-self.draught * u["gate"] - self.gust)
        self.compressor += dt_s / 4000 * (9 * day * (0.6 + 0.4 * np.sin(hour * 1.7)) - self.compressor)
        shares = {"top": (1, 0.1), "mid": (0, 0.4), "low": (-0.5, 1)}
        air = {layer: self.mid + a * self.rise + b * self.gust for layer, (a, b) in shares.items()}
        return air, 1.2 * self.mid + self.compressor

    def _heat_w(self, u: Mapping[str, float]) -> Array:
        """Losses in each body [W] but for what flows; compressor and evaporation take heat."""
        speed, thickness = u["speed"], np.clip(np.exp(-0.02 * self.temps[AT["bearing_front"]]), 0.5, 1.4)
        drives = {
            "bearing": speed**self.power * thickness,
            "motor": 0.1 * (speed > 0) + 0.3 * speed + 0.7 * u["cut"] ** 1.5,
            "windage": speed**2.5,
            "cut": u["cut"],
            "feed_x": u["feed_x"] / 15,
            "feed_y": u["feed_y"] / 15,
            "feed_z": u["feed_z"] / 18,
            "rotary": u["rotary"],
            "coolant": u["coolant"],
            "hydraulics": u["hydraulics"],
            "chiller": 1.0,
        }
        q = np.zeros(SIZE)
        for drive, watts in self.losses.items():
            q += watts * drives[drive]
        q[AT["water_tank"]] -= self.cold_w * self.chills
        q[AT["coolant_tank"]] -= 55 * self.wet * u["coolant"]
        return q

    def _conduction(self, u: Mapping[str, float]) -> Array:
        """Heat out of each body [W] by the temperatures [K] of all, but for the hall, shape (bodies, bodies)."""
        full, tank, wash = -self.links, AT["coolant_tank"], self.wash * u["coolant"]
        full += np.diag(wash)
        full[tank] -= wash
        full[:, tank] -= wash
        full[tank, tank] += wash.sum()
        nose = 0.5 + 1.5 * u["speed"] ** 0.8  # turns in the air of the enclosure
        full[AT["shaft_front"], AT["shaft_front"]] += nose
        full[AT["shaft_front"], AT["enclosure"]] -= nose
        for ring, flow in self.flows.items():
            for one, other in pairwise(AT[name] for name in ring.split()):
                full[other, one] -= flow
                full[other, other] += flow
        return full


def simulate(mill: Mill, runs: Sequence[Run]) -> list[tuple[Array, Array]]:
    """Temperatures (time, node) above the hall's mean [K] and compressor (1: runs) of each test; idle between them."""
    told, then = [], runs[0].start - timedelta(hours=60)
    idle = dict.fromkeys(INPUTS, 0.0) | {"standby": 1.0}
    for r in runs:
        hours, clock = (r.start - then).total_seconds() / 3600, r.start.hour + r.start.minute / 60
        for k in range(int(hours * 12)):
            mill.step(idle, clock - hours + k / 12, 300)
        temps, chills = [], []
        for k in range(r.steps):
            temps.append(mill.step({name: float(x[k]) for name, x in r.inputs.items()}, clock + k * DT_S / 3600, DT_S))
            chills.append(float(mill.chills))
        then = r.start + timedelta(seconds=DT_S * r.steps)
        told.append((np.array(temps), np.array(chills)))
    return told
