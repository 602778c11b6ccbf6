"""The temperatures of all bodies through one test: what the work heats, what the hall does, what the coolant wets."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from thermodata.plugin import Float1D, Float2D
from thermodata.virtual.lathe.hall import Air
from thermodata.virtual.lathe.losses import bearing_w, film_coefficient, motor_w, sliding_w
from thermodata.virtual.lathe.programme import DT_S, TOP_RPM, Work
from thermodata.virtual.lathe.rods import ALUMINIUM, CAST_IRON, STEEL, Body, Stack

STACK = Stack(
    (
        Body("quill", 0.45, 12, 0.022, 0.10, STEEL),  # from the pulley to the nose
        Body("headstock", 0.50, 10, 0.050, 1.80, CAST_IRON),  # from its foot to the spindle's centre
        Body("motor_plate", 0.06, 5, 0.120, 0.30, CAST_IRON),  # through its thickness, motor on cell 0
        Body("bed", 0.30, 10, 0.280, 5.50, CAST_IRON),  # through its thickness, from the floor up
        Body("screw_z", 0.90, 14, 0.0009, 0.10, STEEL),  # from the fixed bearing
        Body("screw_x", 0.40, 8, 0.0006, 0.05, STEEL),
        Body("saddle", 0.12, 6, 0.150, 0.50, CAST_IRON),  # through its thickness, guides below
        Body("rib", 0.08, 6, 0.200, 0.55, CAST_IRON),  # rear wall through its thickness, oil tank outside
        Body("turret", 0.25, 8, 0.020, 0.30, STEEL),  # from its gear to the tool
        Body("part", 0.12, 5, 0.004, 0.05, STEEL),
        Body("bracket", 0.20, 5, 0.0006, 0.05, ALUMINIUM),  # that holds the probes
    )
)
# lumps beside the rods: [J/K], and [W/K] to the air
TANKS = {
    "winding": (9e3, 6.0),
    "coolant": (6.2e5, 38.0),
    "oil": (6e4, 9.0),
    "motor_x": (4e3, 2.5),
    "motor_z": (5e3, 3.0),
}
WET_FILM = 130.0  # [W/m2/K] of coolant on what it wets
COOLER = 110.0  # [W/K] between the coolant and its cooler
SOAK_H = 30.0


@dataclass(frozen=True, slots=True)
class Fields:
    """rods: shape (n, cells) [degC]. tanks: name -> shape (n,) [degC]. inside: air of the working space, shape (n,)."""

    rods: Float2D
    tanks: Mapping[str, Float1D]
    inside: Float1D

    def at(self, body: str, share: float) -> Float1D:
        return self.rods[:, STACK.cell(body, share)]

    def of(self, body: str) -> Float2D:
        return self.rods[:, STACK.where[body]]


def solve(work: Work, air: Air, before: Air, working: bool = True, dt_s: float = DT_S) -> Fields:
    """Every course from balance with `before`, the hall of the hours before the test.

    working=False: the same hall around a machine that is off. dt_s divides DT_S; inputs are held within DT_S.
    """
    T, tank = _soak(before)
    per = round(DT_S / dt_s)
    rods = np.empty((work.n, len(T)))
    tanks = {name: np.empty(work.n) for name in TANKS}
    inside = np.empty(work.n)
    warm = float(before.low[-1])
    for i in range(work.n):
        rods[i], inside[i] = T, warm
        for name in TANKS:
            tanks[name][i] = tank[name]
        for _ in range(per):
            T, tank, warm = _advance(T, tank, warm, work, air, i, working, dt_s)
    return Fields(rods, tanks, inside)


def _soak(before: Air) -> tuple[Float1D, dict[str, float]]:
    """A machine that was off for the hours of `before`."""
    n = len(before.low)
    still = np.zeros(n)
    off = Work("idle", still, still, still, still, still, still, still, still, still)
    T = np.full(len(STACK.capacity), float(before.low[0]))
    tank = dict.fromkeys(TANKS, float(before.low[0]))
    warm = float(before.low[0])
    for i in range(n):
        T, tank, warm = _advance(T, tank, warm, off, before, i, False, SOAK_H * 3600 / n)
    return T, tank


_TALL = STACK.where["headstock"]
_BED = STACK.where["bed"]
_AT = {
    "front": STACK.cell("quill", 0.85),
    "rear": STACK.cell("quill", 0.2),
    "plate": STACK.cell("motor_plate", 0),
    "nut_x": STACK.cell("screw_x", 0.6),
    "end_x": STACK.cell("screw_x", 0),
    "end_z": STACK.cell("screw_z", 0),
    "guide": STACK.cell("saddle", 0),
    "oil": STACK.cell("rib", 0),
    "gear": STACK.cell("turret", 0.1),
    "tool": STACK.cell("turret", 1),
    "top": STACK.cell("bed", 1),
    "foot": STACK.cell("bed", 0),
    "part": STACK.cell("part", 0.5),
}

# lumps that lean on a rod: cell, conductance [W/K]
_TOUCH = {
    "winding": (_AT["plate"], 5.0),
    "motor_x": (_AT["end_x"], 0.4),
    "motor_z": (_AT["end_z"], 0.5),
    "oil": (_AT["oil"], 11.0),
}


def _advance(
    T: Float1D, tank: dict[str, float], warm: float, work: Work, air: Air, i: int, working: bool, dt_s: float
) -> tuple[Float1D, dict[str, float], float]:
    n, kw = (float(work.speed[i]), float(work.cutting[i])) if working else (0.0, 0.0)
    wet = bool(work.coolant[i]) and working
    low, high, draught = float(air.low[i]), float(air.high[i]), float(air.draught[i])
    around = np.full(len(T), low)
    around[_TALL] = np.linspace(low, high, _TALL.stop - _TALL.start)
    around[_BED] = np.linspace(low - 0.3 * (high - low), low + 0.4 * (high - low), _BED.stop - _BED.start)
    for name in ("part", "bracket", "turret", "saddle"):
        around[STACK.where[name]] = warm
    h = film_coefficient(T, around, draught)
    spin = STACK.where["part"]
    h[spin] += 22 * (n / TOP_RPM) ** 0.7 + 90 * wet
    leak = h * STACK.skin
    bath = leak * around
    top, foot = _AT["top"], _AT["foot"]
    if wet:  # a film of coolant on the bed's covers and on the turret
        for cell, area in ((top, 0.35), (_AT["tool"], 0.03)):
            leak[cell] += WET_FILM * area
            bath[cell] += WET_FILM * area * tank["coolant"]
    leak[foot] += 9.0
    bath[foot] += 9.0 * float(air.floor[i])
    P = np.zeros(len(T))
    heat = dict.fromkeys(TANKS, 0.0)
    if working:
        P[_AT["front"]] += bearing_w(n, T[_AT["front"]])
        P[_AT["rear"]] += 0.6 * bearing_w(n, T[_AT["rear"]])
        heat["winding"] = motor_w(n, kw)
        fx, fz = float(work.feed_x[i]), float(work.feed_z[i])
        nut = STACK.cell("screw_z", min(0.35 + 0.5 * float(work.pos_z[i]) / 400, 0.95))
        for cell in range(max(nut - 1, STACK.where["screw_z"].start), nut + 2):
            P[cell] += sliding_w(fz, 35, 70, 80) / 3
        P[_AT["nut_x"]] += sliding_w(fx, 50, 90, 150)
        P[_AT["guide"]] += sliding_w(fz, 350, 900, 300) + 0.4 * sliding_w(fx, 300, 800, 250)
        heat["motor_x"] = 25 * (fx > 0) + 3.0 * fx
        heat["motor_z"] = 25 * (fz > 0) + 3.5 * fz
        P[_AT["gear"]] += 0.055 * float(work.tool_speed[i])
        P[_AT["part"]] += 18 * kw
        P[_AT["tool"]] += 4 * kw
        heat["coolant"] = 150 * wet + 60 * kw * wet
        heat["oil"] = 520 * float(work.pump[i])
    # heat that crosses between bodies; the partner stays where it was a step ago, which is stable for any step
    for a, b, g in (
        (STACK.cell("quill", 0.7), STACK.cell("headstock", 0.95), 7.0),
        (STACK.cell("quill", 0.3), STACK.cell("headstock", 0.8), 5.0),
        (STACK.cell("headstock", 0), top, 1.0),
        (STACK.cell("saddle", 0), top, 0.5),
    ):
        leak[[a, b]] += g
        bath[[a, b]] += g * T[[b, a]]
    for name, (cell, g) in _TOUCH.items():
        leak[cell] += g
        bath[cell] += g * tank[name]
    # what leaks is linear in T within the step, so the bath stands for leak times the outside
    outside = np.where(leak > 0, bath / np.maximum(leak, 1e-12), T)
    after = STACK.step(T, dt_s, leak, outside, P)
    tanks = {}
    for name, (capacity, loss) in TANKS.items():
        loss *= 1 + 0.8 * draught
        given = loss * low + heat[name]
        if name == "coolant":  # its cooler keeps it below the floor
            given, loss = given + COOLER * (float(air.floor[i]) - 9.0), loss + COOLER
        if name in _TOUCH:
            cell, g = _TOUCH[name]
            given, loss = given + g * float(T[cell]), loss + g
        rest = given / loss
        tanks[name] = rest + (tank[name] - rest) * float(np.exp(-loss * dt_s / capacity))
    space = low + 0.012 * (35 * kw + 0.1 * n) + (0.25 * (tank["coolant"] - low) if wet else 0.0)
    return after, tanks, space + (warm - space) * float(np.exp(-dt_s / 900))
