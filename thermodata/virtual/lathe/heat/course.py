"""What drives the machine through one test and does not hang on its temperatures: hall, heat put in, what is wet."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from thermodata.plugin import Float1D, Float2D
from thermodata.virtual.lathe.heat.fields import STACK, TANKS
from thermodata.virtual.lathe.heat.hall import Air
from thermodata.virtual.lathe.heat.losses import forced_cubed, motor_w, sliding_w
from thermodata.virtual.lathe.programme import TOP_RPM, Work

COOLER = 110.0  # [W/K] between the coolant and its cooler
CELLS = len(STACK.capacity)
TANK = {name: i for i, name in enumerate(TANKS)}
AT = {
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
TOUCH = {
    "winding": (AT["plate"], 5.0),
    "motor_x": (AT["end_x"], 0.4),
    "motor_z": (AT["end_z"], 0.5),
    "oil": (AT["oil"], 11.0),
}


@dataclass(frozen=True, slots=True)
class Course:
    """Each row a step. low, floor: air [degC], shape (n,). around: of each cell outside of the working space,
    shape (n, cells) [degC]. forced: `forced_cubed` of the draught. spin: film of the turning part beside the hall's
    [W/m2/K]. wet: 0 or 1. speed [rpm]. power: but for bearings, shape (n, cells) [W]. given [W], loss [W/K], decay:
    of each lump, shape (n, lumps). space: of the working space without coolant [degC].
    """

    low: Float1D
    floor: Float1D
    around: Float2D
    forced: Float1D
    spin: Float1D
    wet: Float1D
    speed: Float1D
    power: Float2D
    given: Float2D
    loss: Float2D
    decay: Float2D
    space: Float1D


def make_course(work: Work, air: Air, working: bool, dt_s: float) -> Course:
    """working=False: a machine that is off in the same hall. dt_s: of the steps that it is taken in."""
    on = float(working)
    speed, kw, wet = on * work.speed, on * work.cutting, on * (work.coolant != 0)
    return Course(
        air.low,
        air.floor,
        _air_around_cells(air),
        _at_each_step(forced_cubed, air.draught),
        22 * _at_each_step(lambda n: (n / TOP_RPM) ** 0.7, speed) + 90 * wet,
        wet,
        speed,
        _power(work, kw) if working else np.zeros((work.n, CELLS)),
        *_lumps(work, air, kw, wet, on, dt_s),
        air.low + 0.012 * (35 * kw + 0.1 * speed),
    )


def _at_each_step(value: Callable[..., float], *courses: Float1D) -> Float1D:
    """A function of numbers at each step; courses hold their values for long, so that few are computed."""
    rows = list(zip(*(c.tolist() for c in courses), strict=True))
    known = {row: value(*row) for row in set(rows)}
    return np.array([known[row] for row in rows])


def _air_around_cells(air: Air) -> Float2D:
    found = np.repeat(air.low[:, None], CELLS, axis=1)
    layer = air.high - air.low
    for body, bottom, top in (
        ("headstock", air.low, air.high),
        ("bed", air.low - 0.3 * layer, air.low + 0.4 * layer),
    ):
        cells = STACK.where[body]
        found[:, cells] = np.linspace(bottom, top, cells.stop - cells.start, axis=1)
    return found


def _power(work: Work, kw: Float1D) -> Float2D:
    P = np.zeros((work.n, CELLS))
    screw = _at_each_step(lambda v: sliding_w(v, 35, 70, 80) / 3, work.feed_z)
    first = STACK.where["screw_z"].start
    for pos in np.unique(work.pos_z):
        rows = np.flatnonzero(work.pos_z == pos)
        nut = STACK.cell("screw_z", min(0.35 + 0.5 * float(pos) / 400, 0.95))
        P[rows, max(nut - 1, first) : nut + 2] += screw[rows, None]
    P[:, AT["nut_x"]] += _at_each_step(lambda v: sliding_w(v, 50, 90, 150), work.feed_x)
    P[:, AT["guide"]] += _at_each_step(
        lambda z, x: sliding_w(z, 350, 900, 300) + 0.4 * sliding_w(x, 300, 800, 250), work.feed_z, work.feed_x
    )
    P[:, AT["gear"]] += 0.055 * work.tool_speed
    P[:, AT["part"]] += 18 * kw
    P[:, AT["tool"]] += 4 * kw
    return P


def _lumps(work: Work, air: Air, kw: Float1D, wet: Float1D, on: float, dt_s: float) -> tuple[Float2D, Float2D, Float2D]:
    """(given, loss, decay) of each lump, but for what its rod gives."""
    heat = {
        "winding": on * _at_each_step(motor_w, work.speed, kw),
        "motor_x": on * (25 * (work.feed_x > 0) + 3.0 * work.feed_x),
        "motor_z": on * (25 * (work.feed_z > 0) + 3.5 * work.feed_z),
        "coolant": 150 * wet + 60 * kw * wet,
        "oil": on * 520 * work.pump,
    }
    given, loss = np.empty((work.n, len(TANKS))), np.empty((work.n, len(TANKS)))
    for name, (_, to_air) in TANKS.items():
        leak = to_air * (1 + 0.8 * air.draught)
        put = leak * air.low + heat[name]
        if name == "coolant":  # its cooler keeps it below the floor
            put, leak = put + COOLER * (air.floor - 9.0), leak + COOLER
        given[:, TANK[name]] = put
        loss[:, TANK[name]] = leak + (TOUCH[name][1] if name in TOUCH else 0.0)
    capacity = np.array([c for c, _ in TANKS.values()])
    return given, loss, np.exp(-loss * dt_s / capacity)
