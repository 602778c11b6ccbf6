"""A horizontal centre of forty-one bodies: shaft, jacket with flow and chiller, ram of eight cells, column of six, bed.

Heat capacities, conductances and growth are the maker's estimates for a machine of ten tonnes; each machine has its
own, 10 to 20 % around them. Losses hang on speed, load, feed and viscosity, convection at shaft and tool on speed.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from ..bodies import Array, conduction, pairs, varied
from .programme import DT_S, REST, Run

T0 = 21.0  # [degC] of everything as a test's rest begins
COARSE = 4  # steps at once while sizes are sought
HEAT = """
    shaft_front 2500, shaft_middle 4000, shaft_rear 3000, bearing_front 3500, bearing_rear 2500, motor 9000,
    gearbox 14000, jacket 30000, tool 800, ram_top_1 12000, ram_top_2 12000, ram_top_3 12000, ram_top_4 12000,
    ram_bottom_1 12000, ram_bottom_2 12000, ram_bottom_3 12000, ram_bottom_4 12000, headstock 60000,
    column_front_1 70000, column_front_2 70000, column_front_3 50000, column_rear_1 60000, column_rear_2 60000,
    column_rear_3 45000, bed_column 120000, bed_table 120000, table 60000, table_bearing 8000, nut_z 2500,
    screw_z 3500, motor_z 6000, scale_z 1500, nut_y 2500, screw_y 4000, motor_y 6000, scale_y 1500, guide_y 6000,
    hydraulics 90000, coolant_tank 250000, fixture 1200, cabinet 25000
"""  # heat capacities [J/K]
LINKS = """
    shaft_front-shaft_middle 10, shaft_middle-shaft_rear 10, shaft_front-bearing_front 14,
    shaft_rear-bearing_rear 10, bearing_front-ram_top_1 15, bearing_front-ram_bottom_1 15,
    bearing_rear-ram_top_2 10, bearing_rear-ram_bottom_2 10, shaft_rear-gearbox 4, motor-gearbox 9,
    gearbox-headstock 16, motor-headstock 3, shaft_front-tool 3, ram_top_1-ram_top_2 22, ram_top_2-ram_top_3 22,
    ram_top_3-ram_top_4 22, ram_bottom_1-ram_bottom_2 22, ram_bottom_2-ram_bottom_3 22,
    ram_bottom_3-ram_bottom_4 22, ram_top_1-ram_bottom_1 9, ram_top_2-ram_bottom_2 9, ram_top_3-ram_bottom_3 9,
    ram_top_4-ram_bottom_4 9, ram_top_3-headstock 12, ram_bottom_3-headstock 12, ram_top_4-headstock 8,
    ram_bottom_4-headstock 8, headstock-column_front_2 22, headstock-guide_y 5, guide_y-column_front_2 14,
    guide_y-column_front_1 8, column_front_1-column_front_2 45, column_front_2-column_front_3 45,
    column_rear_1-column_rear_2 40, column_rear_2-column_rear_3 40, column_front_1-column_rear_1 18,
    column_front_2-column_rear_2 18, column_front_3-column_rear_3 18, column_front_1-bed_column 50,
    column_rear_1-bed_column 40, bed_column-bed_table 60, bed_table-table_bearing 10, table_bearing-table 18,
    table-fixture 0.8, nut_z-screw_z 4, screw_z-bed_column 4, motor_z-screw_z 2, motor_z-bed_column 4,
    nut_z-bed_table 5, scale_z-bed_table 1.2, nut_y-screw_y 4, screw_y-column_front_3 5, motor_y-screw_y 2,
    motor_y-column_front_3 4, nut_y-headstock 6, scale_y-column_front_2 1.4, hydraulics-bed_column 6,
    hydraulics-column_rear_1 5, cabinet-column_rear_2 7, cabinet-column_rear_3 6
"""  # conductances between bodies [W/K]
AIR = {  # conductances to the layers of air [W/K]
    "top": """
        column_front_3 6, column_rear_3 6, headstock 8, motor_y 4, motor 3, gearbox 4, cabinet 5, ram_top_4 2
""",
    "low": """
        bed_column 14, bed_table 14, hydraulics 12, coolant_tank 15, motor_z 4, column_rear_1 5, column_front_1 4
""",
    "mid": """
        ram_top_1 2, ram_top_2 2, ram_top_3 2, ram_bottom_1 2, ram_bottom_2 2, ram_bottom_3 2, ram_bottom_4 2,
        column_front_2 5, column_rear_2 5, table 9, fixture 1.5, tool 0.8, screw_y 1.5, screw_z 1.5, nut_z 0.8,
        nut_y 0.8, scale_z 0.7, scale_y 0.7, table_bearing 1, guide_y 1
""",
}
JACKET = {"bearing_front": 5.0, "ram_top_1": 12.0, "ram_bottom_1": 12.0, "bearing_rear": 10.0, "motor": 30.0}  # [W/K]
WASH = {"table": 40.0, "bed_table": 25.0, "tool": 1.5, "fixture": 0.3}  # to the coolant's tank as it flows [W/K]
LOSSES = {  # heat of each cause: body, what drives it, watts for one of it
    "gearbox": (("gearbox", "gears", 1),),
    "zdrive": (("nut_z", "feed_z", 9), ("screw_z", "feed_z", 7), ("scale_z", "feed_z", 1.2)),
    "zmotor": (("motor_z", "servo_z", 1),),
    "ydrive": (("nut_y", "feed_y", 9), ("screw_y", "feed_y", 7), ("motor_y", "servo_y", 1), ("scale_y", "feed_y", 1)),
    "guide": (("guide_y", "feed_y", 14),),
    "table": (("table_bearing", "turning", 3),),
    "hydraulics": (("hydraulics", "pumps", 1),),
    "cabinet": (("cabinet", "drives", 1),),
    "ramoil": (("ram_top_2", "oil", 90), ("ram_top_3", "oil", 90)),
    "sun": (("column_rear_2", "sun", 0.5), ("column_rear_3", "sun", 0.5)),
}
GROWTH = {  # of the tool against the table [um/K]
    "Z": """
        shaft_front 1.6, shaft_middle 1.2, bearing_front 0.6, tool 1.5, ram_top_1 1.3, ram_top_2 1.3, ram_top_3 1.0,
        ram_bottom_1 1.3, ram_bottom_2 1.3, ram_bottom_3 1.0, headstock 1.2, gearbox 0.8, column_front_1 3,
        column_front_2 4, column_front_3 3, column_rear_1 -3, column_rear_2 -4, column_rear_3 -3, bed_column 2.5,
        bed_table -1.8, table -3.2, table_bearing -1.2, scale_z 3.5, screw_z 0.7, motor_z 0.15, hydraulics 0.12
""",
    "Y": """
        ram_top_1 -3, ram_top_2 -4, ram_top_3 -3, ram_top_4 -2, ram_bottom_1 3.4, ram_bottom_2 4.4,
        ram_bottom_3 3.3, ram_bottom_4 2.2, headstock 1.6, gearbox 1, bearing_front 0.5, motor 0.3,
        column_front_1 4, column_front_2 3.5, column_front_3 1, column_rear_1 2, column_rear_2 1.5,
        column_rear_3 0.5, bed_column 1.5, bed_table -2, table -2.5, scale_y 4, screw_y 0.9, motor_y 0.2,
        guide_y 1.1, hydraulics 0.1
""",
}
BODIES = tuple(pairs(HEAT))
AT: Mapping[str, int] = {name: k for k, name in enumerate((*BODIES, "top", "low", "mid"))}  # columns of temperatures
SIZE = len(BODIES)


class Centre:
    """One machine: its constants are drawn, and its bodies stepped for all tests and all strengths at once."""

    def __init__(self, rng: np.random.Generator, axis: str, top_rpm: float) -> None:
        """axis: of the displacement that is asked, Z or Y."""
        self.axis, self.top_rpm = axis, top_rpm
        self.heat = np.array([c * np.exp(rng.normal(0, 0.15)) for c in pairs(HEAT).values()])[:, None]
        self.flow = conduction({name: AT[name] for name in BODIES}, varied(rng, LINKS, 0.2))
        self.air = {layer: np.zeros((SIZE, 1)) for layer in AIR}
        for layer, text in AIR.items():
            for name, g in varied(rng, text, 0.2).items():
                self.air[layer][AT[name]] = g
                self.flow[AT[name], AT[name]] -= g
        self.growth = np.zeros(SIZE)
        for name, g in varied(rng, GROWTH[axis], 0.12).items():
            self.growth[AT[name]] = g
        self.power = rng.uniform(1.3, 1.75)  # friction by speed
        self.thinning = rng.uniform(0.006, 0.014)  # of the grease [1/K]

    def run(self, runs: Sequence[Run], strength: Mapping[str, Array], every: int = 1) -> tuple[Array, Array]:
        """Temperatures (time, body and layer, test, variant) [degC] and displacement (time, test, variant) [um].

        strength: of each cause, shape (variants,). every: steps taken at once.
        """
        variants, dt = len(strength["bearing"]), DT_S * every
        longest = max(len(r.inputs["speed"]) for r in runs)

        def wide(name: str) -> Array:
            padded = [np.pad(r.inputs[name], (0, longest - len(r.inputs[name])), "edge") for r in runs]
            return np.repeat(np.stack(padded, 1)[::every, :, None], variants, 2).reshape(-1, len(runs) * variants)

        s = {cause: np.tile(v, len(runs)) for cause, v in strength.items()}
        u = {name: wide(name) for name in runs[0].inputs}
        mid = T0 + s["ambient"] * (u["swing"] - u["swing"][0])
        layer = s["gradient"] * (u["layer"] - u["layer"][0])
        layers = {"top": mid + layer, "low": mid - 0.5 * layer, "mid": mid}
        step = np.linalg.inv(np.eye(SIZE) - dt * self.flow / self.heat)
        T = np.full((SIZE, mid.shape[1]), T0)
        temps = np.empty((len(mid), SIZE + 3, mid.shape[1]), np.float32)
        for k in range(len(mid)):
            air = {name: x[k] for name, x in layers.items()}
            T = step @ (T + dt * self._heat_w(T, air, {name: x[k] for name, x in u.items()}, s) / self.heat)
            temps[k, :SIZE] = T
            for name, x in air.items():
                temps[k, AT[name]] = x
        move = np.tensordot(self.growth, temps[:, :SIZE] - 21, (0, 1))
        if self.axis == "Z":
            stretch = s["centrifugal"] * (u["speed"] / self.top_rpm) ** 2
            move = move + s["fixture"] * (temps[:, AT["fixture"]] - 21) + stretch
        cut = REST // every
        return temps[cut:].reshape(-1, SIZE + 3, len(runs), variants), move[cut:].reshape(-1, len(runs), variants)

    def _heat_w(self, T: Array, air: Mapping[str, Array], u: Mapping[str, Array], s: Mapping[str, Array]) -> Array:
        """Heat into each body [W] but for conduction, shape (bodies, tests and variants)."""
        krpm, feed_z, feed_y, load = u["speed"] / 1000, u["feed_z"], u["feed_y"], u["load"]
        mid, wet = air["mid"], u["wet"] * np.clip(s["coolant"], 0, 1)
        q = np.zeros_like(T)
        for layer, g in self.air.items():
            q += g * air[layer]
        rub = s["bearing"] * 28 * krpm**self.power * np.exp(-self.thinning * (T[AT["bearing_front"]] - T0))
        # preload grows with the shaft
        rub *= np.clip(1 + 0.02 * (T[AT["shaft_front"]] - T[AT["bearing_front"]]), 0.7, 1.8)
        q[AT["shaft_front"]] += 0.22 * rub - 0.4 * krpm * (T[AT["shaft_front"]] - mid)
        q[AT["bearing_front"]] += 0.78 * rub
        q[AT["bearing_rear"]] += 0.35 * rub
        windings = s["motor"] * ((krpm > 0) * 60 + 10 * krpm + 6 * load**2)
        q[AT["motor"]] += windings - 2.0e-8 * ((T[AT["motor"]] + 273) ** 4 - (mid + 273) ** 4)
        # heat of the pump, and a compressor
        q[AT["jacket"]] -= np.clip(150 * (T[AT["jacket"]] - T0 - s["chiller"] * u["chiller"]), -400, 900)
        for fluid, parts, gate in (("jacket", JACKET, 1.0), ("coolant_tank", WASH, wet)):
            for to, conductance in parts.items():
                heat = conductance * gate * (T[AT[fluid]] - T[AT[to]])
                q[AT[to]] += heat
                q[AT[fluid]] -= heat
        chips = s["cutting"] * load
        q[AT["tool"]] += 12 * chips - 0.3 * krpm * (T[AT["tool"]] - mid)
        q[AT["shaft_front"]] += 12 * chips
        q[AT["table"]] += 20 * chips
        drives = {
            "gears": 14 * krpm**1.4 + 8 * load,
            "feed_z": feed_z,
            "feed_y": feed_y,
            "servo_z": 6 * feed_z + 0.5 * feed_z**2,
            "servo_y": 4 * feed_y + 0.2 * feed_y**2,
            "turning": u["table"] ** 1.3,
            "pumps": 400 * u["pump"] + 150 * u["oil"],
            "drives": 350 * u["cabinet"] + 15 * krpm + 20 * load,
            "oil": u["oil"],
            "sun": u["sun"],
        }
        for cause, losses in LOSSES.items():
            for body, by, watts in losses:
                q[AT[body]] += s[cause] * watts * drives[by]
        q[AT["coolant_tank"]] += wet * (s["coolant"] * 600 + 40 * load)
        return q


def scaled(machine: Centre, runs: Sequence[Run], want_um: Mapping[str, float]) -> tuple[Array, Array, dict[str, float]]:
    """Bring each cause to its size, which is what the displacement loses without it.

    Returns temperatures (time, body and layer, test), displacement (time, test) and sizes [um].
    """
    causes, size = list(want_um), {cause: float(um > 0) for cause, um in want_um.items()}
    lost: dict[str, float] = {}
    for again in range(4):
        without = {c: [0.0 if c == other else size[c] for other in causes] for c in causes}
        _, move = machine.run(runs, {c: np.array([size[c], *without[c]]) for c in causes}, COARSE)
        lost = dict.fromkeys(causes, 0.0)
        for j, r in enumerate(runs):
            part = move[: (len(r.inputs["speed"]) - REST) // COARSE, j]
            part = part[:, :1] - part[:, 1:]
            for c, um in zip(causes, np.abs(part - part[0]).max(0), strict=True):
                lost[c] = max(lost[c], float(um))
        if again < 3:
            size = {c: size[c] * float(np.clip(want_um[c] / max(lost[c], 1e-3), 0.01, 100)) for c in causes}
    temps, move = machine.run(runs, {c: np.array([v]) for c, v in size.items()})
    return temps[..., 0], move[..., 0], lost
