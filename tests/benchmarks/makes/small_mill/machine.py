"""A C-frame mill of thirty bodies: conduction, convection (some of it with speed), a coolant, losses, and growth.

Heat capacities and conductances are those of bodies of a tonne and less with joints of some dm2, chosen by hand; each
machine has its own, 10 to 20 % around them. Losses hang on speed, load, feed and viscosity.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from ..bodies import Array, conduction, pairs, varied
from .programme import DT_S, REST, Run

T0 = 21.0  # [degC] of everything as a test's rest begins
HEAT = """
    shaft 2500, bearing_front 3500, bearing_rear 1500, motor 3000, head 25000, arm_top 18000, arm_bottom 18000,
    column_front_low 40000, column_front_high 40000, column_rear_low 32000, column_rear_high 32000, bed 120000,
    table 25000, bracket 400, tool 250, screw_z_1 1200, screw_z_2 1200, screw_z_3 1200, nut_z 4000, bearing_z 2500,
    motor_z 4000, guide_z 6000, screw_y_1 1200, screw_y_2 1200, screw_y_3 1200, nut_y 4000, motor_y 3500,
    cabinet 15000, tank 160000, enclosure 3000
"""  # heat capacities [J/K]
LINKS = """
    shaft-bearing_front 6, bearing_front-head 25, bearing_rear-head 15, shaft-bearing_rear 2, motor-bearing_rear 5,
    motor-head 6, shaft-tool 3, head-arm_bottom 60, arm_bottom-arm_top 30, arm_bottom-column_front_high 60,
    arm_top-column_rear_high 30, column_front_low-column_front_high 50, column_rear_low-column_rear_high 50,
    column_front_low-column_rear_low 20, column_front_high-column_rear_high 20, column_front_low-bed 60,
    column_rear_low-bed 60, bed-table 15, table-bracket 0.5, screw_z_1-screw_z_2 0.3, screw_z_2-screw_z_3 0.3,
    screw_z_1-bearing_z 1, bearing_z-column_front_high 4, motor_z-bearing_z 3, nut_z-screw_z_1 1,
    nut_z-screw_z_2 1.5, nut_z-head 2, guide_z-column_front_high 20, guide_z-column_front_low 10,
    motor_y-screw_y_1 1.5, screw_y_1-screw_y_2 0.3, screw_y_2-screw_y_3 0.3, nut_y-screw_y_2 1.5, nut_y-table 2,
    motor_y-bed 3, cabinet-column_rear_high 6, cabinet-column_rear_low 4, enclosure-bearing_front 2,
    enclosure-head 6, enclosure-arm_bottom 3, enclosure-column_front_low 3, enclosure-column_front_high 3,
    enclosure-table 5, enclosure-bracket 1, enclosure-tool 0.8, enclosure-shaft 1, enclosure-guide_z 1.5,
    enclosure-nut_z 0.8, enclosure-screw_z_2 0.6, enclosure-screw_z_3 0.6
"""  # conductances between bodies [W/K]
AIR = {  # conductances to the layers of air [W/K]
    "top": "bearing_rear 1, motor 3, arm_top 6, column_rear_high 5, motor_z 4, cabinet 5, bearing_z 1, screw_z_1 0.6",
    "low": "arm_bottom 2, column_rear_low 5, bed 12, motor_y 4, tank 8, screw_y_1 0.6, screw_y_2 0.6, screw_y_3 0.6",
    "mid": "enclosure 25",
}
LOSSES = {  # heat of each cause: body, what drives it, watts for one of it
    "motor": (("motor", "windings", 1),),
    "cutting": (("shaft", "chips", 100), ("tool", "chips", 200), ("table", "chips", 150)),
    "zscrew": (
        ("nut_z", "feed_z", 8),
        ("screw_z_1", "feed_z", 2),
        ("screw_z_2", "feed_z", 3),
        ("bearing_z", "feed_z", 2),
    ),
    "zmotor": (("motor_z", "servo_z", 1),),
    "guide": (("guide_z", "feed_z", 10),),
    "yscrew": (("nut_y", "feed_y", 8), ("screw_y_2", "feed_y", 4), ("motor_y", "feed_y", 3)),
    "cabinet": (("cabinet", "drives", 1),),
    "coolant": (("tank", "pump", 250),),
}
WASH = {"table": 45.0, "bed": 15.0, "enclosure": 8.0, "bracket": 0.2, "tool": 2.0}  # to the tank as it flows [W/K]
GROWTH = {  # of the tool against the table [um/K]
    "Z": """
        shaft -1.7, bearing_front -0.6, head -1.7, tool -1.1, column_front_low 1.9, column_front_high 1.9,
        column_rear_low 1.7, column_rear_high 1.7, arm_top -5, arm_bottom 5, screw_z_1 -1.4, screw_z_2 -1.2,
        screw_z_3 -0.2, bearing_z -0.3, table -0.9, bed -2.0
""",
    "Y": """
        arm_top -2.6, arm_bottom -2.6, head -0.4, column_front_low -5, column_rear_low 5, column_front_high -3,
        column_rear_high 3, screw_y_1 1.3, screw_y_2 1.2, screw_y_3 0.3, table 0.4, bed 1.6
""",
}
BODIES = tuple(pairs(HEAT))
AT: Mapping[str, int] = {name: k for k, name in enumerate((*BODIES, "top", "mid", "low"))}  # columns of temperatures
SIZE = len(BODIES)


def _column(of: Mapping[str, float]) -> Array:
    return np.array([[of.get(name, 0.0)] for name in BODIES])


class Mill:
    """One machine: its constants are drawn, its bodies stepped for all tests and all strengths at once."""

    def __init__(self, rng: np.random.Generator, axis: str, top_rpm: float) -> None:
        """axis: of the displacement that is asked, Z or Y."""
        self.heat = np.array([c * np.exp(rng.normal(0, 0.15)) for c in pairs(HEAT).values()])[:, None]
        self.flow = conduction({name: AT[name] for name in BODIES}, varied(rng, LINKS, 0.2))
        self.air = {layer: _column(varied(rng, text, 0.2)) for layer, text in AIR.items()}
        self.growth = _column(varied(rng, GROWTH[axis], 0.12))[:, 0]
        self.thinning = rng.uniform(0.006, 0.014)  # of the grease [1/K]
        self.power = rng.uniform(1.35, 1.7)  # friction by speed
        self.axis, self.top_rpm = axis, top_rpm

    def run(self, runs: Sequence[Run], strength: Mapping[str, Array]) -> tuple[Array, Array]:
        """Temperatures (time, body and layer, test, variant) [degC] and displacement (time, test, variant) [um].

        strength: of each cause, shape (variants,); 0 where it does not act.
        """
        variants = len(strength["bearing"])
        longest = max(len(r.swing) for r in runs)

        def wide(courses: Sequence[Array]) -> Array:
            padded = [np.pad(x, (0, longest - len(x)), "edge") for x in courses]
            return np.repeat(np.stack(padded, axis=1), variants, axis=1)

        s = {cause: np.tile(v, len(runs)) for cause, v in strength.items()}
        u = {name: wide([np.r_[np.zeros(REST), r.inputs[name]] for r in runs]) for name in runs[0].inputs}
        mid = T0 + s["ambient"] * wide([r.swing - r.swing[0] for r in runs])
        layer = s["gradient"] * wide([r.layer - r.layer[0] for r in runs])
        layers = {"top": mid + layer, "mid": mid, "low": mid - 0.4 * layer}
        T = np.full((SIZE, mid.shape[1]), T0)
        bodies = np.empty((longest, *T.shape), np.float32)
        for k in range(longest):
            now = {name: x[k] for name, x in u.items()}
            T = T + DT_S * self._heat_w(T, {name: x[k] for name, x in layers.items()}, now, s) / self.heat
            bodies[k] = T
        move = np.tensordot(bodies, self.growth, (1, 0))
        if self.axis == "Z":
            stretch = 6 * (u["speed"] / self.top_rpm) ** 2
            move = move + 4.0 * s["fixture"] * (bodies[:, AT["bracket"]] - T0) + s["centrifugal"] * stretch
        air = np.stack([layers[name] for name in ("top", "mid", "low")], axis=1).astype(np.float32)
        shape = (longest, SIZE + 3, len(runs), variants)
        temps = np.concatenate([bodies, air], axis=1).reshape(shape)
        return temps[REST:], move.reshape(longest, len(runs), variants)[REST:]

    def _heat_w(self, T: Array, air: Mapping[str, Array], u: Mapping[str, Array], s: Mapping[str, Array]) -> Array:
        """Heat into each body [W], shape (bodies, tests and variants)."""
        krpm, feed_z, feed_y, load = u["speed"] / 1000, u["feed_z"], u["feed_y"], u["load"]
        wet = u["wet"] * (s["coolant"] > 0)
        q = self.flow @ T
        for layer, g in self.air.items():
            q += g * (air[layer] - T)
        rub = s["bearing"] * 5 * krpm**self.power * np.exp(-self.thinning * (T[AT["bearing_front"]] - T0))
        # preload grows with the shaft
        front = rub * np.clip(1 + 0.03 * (T[AT["shaft"]] - T[AT["bearing_front"]]), 0.7, 2)
        q[AT["shaft"]] += 0.45 * front - 0.35 * krpm * (T[AT["shaft"]] - T[AT["enclosure"]])
        q[AT["bearing_front"]] += 0.55 * front
        q[AT["bearing_rear"]] += 0.4 * rub
        q[AT["tool"]] -= 0.2 * krpm * (T[AT["tool"]] - T[AT["enclosure"]])
        drives = {
            "chips": load * (feed_z + feed_y > 0),
            "windings": (krpm > 0) * 15 + 5 * krpm + 500 * load**2,
            "feed_z": feed_z,
            "feed_y": feed_y,
            "servo_z": 8 * feed_z + 0.6 * feed_z**2,
            "drives": 15 * krpm + 6 * (feed_z + feed_y) + 400 * load,
            "pump": wet,
        }
        for cause, losses in LOSSES.items():
            for body, by, watts in losses:
                q[AT[body]] += s[cause] * watts * drives[by]
        q[AT["tank"]] += 400 * load * wet * (s["coolant"] > 0)
        for to, conductance in WASH.items():
            heat = conductance * wet * (T[AT["tank"]] - T[AT[to]])
            q[AT[to]] += heat
            q[AT["tank"]] -= heat
        return q


def scaled(mill: Mill, runs: Sequence[Run], want_um: Mapping[str, float]) -> tuple[Array, Array, dict[str, float]]:
    """Bring each cause to its size, which is what the displacement loses without it while the axes rest.

    Returns temperatures (time, body and layer, test), displacement (time, test) and sizes [um].
    """
    causes = list(want_um)
    size = {cause: (1.0 if um else 0.0) for cause, um in want_um.items()}
    for again in range(3):
        without = {c: [0.0 if c == other else size[c] for other in causes] for c in causes}
        temps, move = mill.run(runs, {c: np.array([size[c], *without[c]]) for c in causes})
        lost = dict.fromkeys(causes, 0.0)
        for j, r in enumerate(runs):
            part = (move[:, j, :1] - move[:, j, 1:])[np.flatnonzero(~r.moving)]
            peaks = np.abs(part - part[0]).max(axis=0)
            lost = {c: max(lost[c], float(um)) for c, um in zip(causes, peaks, strict=True)}
        if again < 2:
            size = {c: v * float(np.clip(want_um[c] / max(lost[c], 1e-3), 0.02, 30)) for c, v in size.items()}
    return temps[..., 0], move[..., 0], lost
