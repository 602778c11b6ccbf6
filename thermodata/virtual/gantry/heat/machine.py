"""A gantry milling centre as a thermal network: geometry, masses and couplings, drawn by the seed.

Magnitudes: steel and cast iron; bearing and motor losses that give rises such as [horejs2022] shows (bearing 10-25 K
at 9000 rpm, winding 20-40 K); rods of 8-12 cells, plates of 4-5.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from thermodata.plugin import Float1D, Float2D
from thermodata.virtual.gantry.heat.hall import BOUNDARIES
from thermodata.virtual.gantry.heat.network import Builder, Cells, Network

ALPHA_UM = 11.5  # steel [um/m/K]
RHO_C, CONDUCTIVITY = 3.69e6, 46.0  # steel [J/m3/K], [W/m/K]
SCREW_CELLS = 12
Draw = Callable[[float, float], float]  # uniform between two bounds


@dataclass(frozen=True)
class Machine:
    """cells: body -> its cells. sources: name -> shape (size,), where a watt of it goes.

    growth: effect -> shape (size,): micrometres a kelvin of each cell for a lever of 1 (see `response`).
    screw_length, screw_start: of the axes X, Y, Z [mm], the start in machine coordinates (the fixed bearing).
    """

    network: Network
    cells: dict[str, Cells]
    sources: dict[str, Float1D]
    growth: dict[str, Float1D]
    screw_length: Float1D
    screw_start: Float1D
    nut_w_per_k: float
    wash_w_per_k: dict[str, float]
    chiller_w: float
    chiller_band_k: float
    heat: dict[str, float]

    def screw_share(self, axis: int, lo: Float1D, hi: Float1D) -> Float2D:
        """Share of time that the nut spends over each cell of a screw, shape (cells, n), sums to 1."""
        edges = self.screw_start[axis] + np.linspace(0, self.screw_length[axis], SCREW_CELLS + 1)
        nut = 60.0  # half the length of a nut [mm]
        low, high = lo - nut, hi + nut
        covered = np.minimum(edges[1:, None], high) - np.maximum(edges[:-1, None], low)
        covered = np.clip(covered, 0.0, None)
        return np.asarray(covered / covered.sum(axis=0))


def build(rng: np.random.Generator, home: Float1D) -> Machine:
    """A machine of its own; `home`: the measuring position of X, Y, Z [mm]."""

    def r(lo: float, hi: float) -> float:
        return float(rng.uniform(lo, hi))

    b = Builder(BOUNDARIES)
    sources: dict[str, dict[int, float]] = {}
    _spindle(b, sources, r)
    _structure(b, sources, r)
    length, start = _axes(b, sources, r, home)
    _table(b, sources, r)
    _fluids(b, sources, r)
    network = b.network()
    into = {}
    for name, target in sources.items():
        into[name] = np.zeros(network.size)
        for cell, share in target.items():
            into[name][cell] += share
    growth = _growth(b, network.size, r, length, start, home)
    heat = {
        "front": r(190, 300),
        "rear": r(120, 200),
        "bearing_exponent": r(1.35, 1.7),
        "motor_base": r(130, 220),
        "motor": r(350, 600),
        "sleeve": r(70, 110),
        "sleeve_exponent": r(1.7, 2.3),
        "nut": r(42, 62),
        "screw": r(26, 40),
        "feed_motor": r(45, 80),
        "holding": r(12, 22),
        "table": r(220, 340),
        "table_exponent": r(1.3, 1.6),
        "cabinet": r(110, 170),
        "pump": r(220, 320),
        "windage": r(12, 16),
        "tool": r(3.2, 5.2),
        "part": r(180, 280),
        "copper": 0.0039,
        "viscosity": r(0.012, 0.02),
    }
    return Machine(
        network,
        b.cells,
        into,
        growth,
        length,
        start,
        r(0.4, 0.8),
        {"splash": r(11, 15), "probe": r(0.2, 0.35), "tool": r(0.3, 0.6)},
        r(1300, 1700),
        r(1.2, 1.7),
        heat,
    )


def _rod(area_m2: float, length_m: float, n: int) -> tuple[float, float]:
    """(capacity in all [J/K], conductance between neighbours [W/K]) of a steel rod."""
    return RHO_C * area_m2 * length_m, CONDUCTIVITY * area_m2 / (length_m / n)


def _spindle(b: Builder, sources: dict[str, dict[int, float]], r: Draw) -> None:
    shaft = b.body("shaft", *_rod_in_cells(_rod(r(3.6e-3, 5e-3), 0.6, 8), 8))
    housing = b.body("housing", *_rod_in_cells(_rod(r(0.018, 0.024), 0.6, 8), 8))
    b.link(shaft, housing, r(3, 6))
    b.air(shaft[0], "hall.middle", r(0.6, 1.2))
    b.air(housing[:3], "hall.middle", r(4, 7))
    for name, at in (("front", 1), ("rear", 6)):
        inner, outer = b.body(f"bearing_{name}_inner", r(350, 500)), b.body(f"bearing_{name}_outer", r(600, 900))
        b.link(inner, outer, r(2, 4))
        b.link(inner, shaft[at], r(15, 25))
        b.link(outer, housing[at : at + 2], r(13, 18))
        sources[f"bearing_{name}"] = {int(inner[0]): 0.45, int(outer[0]): 0.55}
    stator = b.body("stator", r(4500, 6500))
    b.link(stator, housing[3:6], r(2, 4))
    sources["motor"] = {int(stator[0]): 0.93, int(shaft[3]): 0.035, int(shaft[4]): 0.035}
    head = b.body("headstock", r(30e3, 42e3), 4, r(60, 90))
    b.link(stator, head, r(18, 24))
    b.link(housing[3:6], head[0], r(2, 4))
    b.air(head, "hall.middle", r(4, 6))
    sleeve = _mated(b, "nose_sleeve", r(16e3, 24e3), r(25, 40), "hall.middle", r(4.5, 6.5))
    b.link(sleeve[0], housing[0], r(0.4, 0.8))
    sources["sleeve"] = {int(sleeve[0]): 0.7, int(sleeve[1]): 0.3}
    b.link(housing[5:8], b.body("ram", r(0.9e5, 1.3e5), 4, r(12, 18)), r(1, 2))
    b.air(b.cells["ram"], "hall.middle", r(18, 26))
    holder = b.body("holder", *_rod_in_cells(_rod(1.6e-3, 0.09, 3), 3))
    tool = b.body("tool", *_rod_in_cells(_rod(r(4e-4, 7e-4), 0.11, 4), 4))
    b.link(holder[-1], tool[0], r(0.5, 0.8))
    b.link(holder[0], shaft[0], r(0.8, 1.4))
    b.air(holder, "hall.middle", r(0.35, 0.5))
    b.air(tool, "hall.middle", r(0.5, 0.7))
    sources["tool"] = {int(tool[-1]): 0.6, int(tool[-2]): 0.4}


def _structure(b: Builder, sources: dict[str, dict[int, float]], r: Draw) -> None:
    # the frame: a bed of three layers and a portal, both slow
    bed = b.body("bed", r(0.7e6, 1.0e6), 3, r(500, 800))
    b.air(bed, "hall.bottom", r(75, 105))
    b.air(bed[-1], "floor", r(3, 6))
    portal = b.body("portal", r(0.4e6, 0.6e6), 4, r(40, 60))
    b.air(portal, "hall.top", r(45, 65))
    for side in ("front", "rear"):
        plate = b.body(f"column_{side}", r(1.3e5, 1.7e5), 5, r(6, 9))
        for share, air in ((slice(0, 2), "hall.bottom"), (slice(2, 4), "hall.middle"), (slice(4, 5), "hall.top")):
            b.air(plate[share], air, r(2.6, 3.4) * len(plate[share]))
    b.link(b.cells["column_front"], b.cells["column_rear"], r(3, 6))
    rear = b.cells["column_rear"]
    sources["cabinet"] = {int(rear[1]): 0.15, int(rear[2]): 0.45, int(rear[3]): 0.40}
    for name, air in (("guide_low", "hall.bottom"), ("guide_top", "hall.top")):
        b.air(b.body(name, r(0.9e4, 1.3e4), 3, r(5, 8)), air, r(4, 6))


def _axes(b: Builder, sources: dict[str, dict[int, float]], r: Draw, home: Float1D) -> tuple[Float1D, Float1D]:
    length = np.array([r(1000, 1200), r(900, 1100), r(800, 950)])
    start = home - length * np.array([r(0.5, 0.6) for _ in range(3)])
    for i, a in enumerate("xyz"):
        screw = b.body(f"screw_{a}", *_rod_in_cells(_rod(1.26e-3, float(length[i]) / 1000, SCREW_CELLS), SCREW_CELLS))
        b.air(screw, "hall.middle", r(1.5, 2.4))
        nut = b.body(f"nut_{a}", r(700, 1100))
        b.air(nut, "hall.middle", r(2.4, 3.4))
        bearing = b.body(f"screw_bearing_{a}", r(3500, 5000))
        b.link(bearing, screw[0], r(0.8, 1.4))
        b.air(bearing, "hall.middle", r(2, 3))
        motor = b.body(f"feed_motor_{a}", r(5500, 8000))
        b.air(motor, "hall.middle", r(1.8, 2.6))
        bracket = b.body(f"bracket_{a}", r(1.3e4, 1.9e4), 4, r(14, 20))
        b.link(motor, bracket[0], r(5, 7))
        b.link(bearing, bracket[0], r(0.2, 0.4))
        b.air(bracket, "hall.middle", r(1.0, 1.5))
        sources[f"nut_{a}"] = {int(nut[0]): 1.0}
        sources[f"screw_bearing_{a}"] = {int(bearing[0]): 1.0}
        sources[f"feed_motor_{a}"] = {int(motor[0]): 1.0}
        for k in range(SCREW_CELLS):
            sources[f"screw_{a}_{k}"] = {int(screw[k]): 1.0}
    return length, start


def _table(b: Builder, sources: dict[str, dict[int, float]], r: Draw) -> None:
    ring = b.body("table_bearing", r(9e3, 1.3e4))
    plate = b.body("table", r(5e4, 7e4), 4, r(70, 100))
    b.link(ring, plate[:2], r(16, 22))
    b.air(ring, "hall.bottom", r(10, 14))
    b.air(plate, "hall.bottom", r(7, 10))
    b.link(ring, b.cells["bed"][0], r(0.4, 0.8))
    sources["table"] = {int(ring[0]): 0.85, int(plate[0]): 0.15}
    part = _mated(b, "part", r(1.2e4, 2e4), r(60, 90), "hall.bottom", r(8, 11))
    sources["part"] = {int(part[-1]): 0.5, int(part[1]): 0.5}
    _mated(b, "splash", r(3.2e4, 5.2e4), r(30, 50), "hall.bottom", r(26, 34))
    probe = b.body("probe", r(1100, 1700), 4, r(1.6, 2.4))
    b.air(probe, "hall.bottom", r(1.0, 1.4))
    sources["windage"] = {int(probe[0]): 0.8, int(probe[1]): 0.2}


def _fluids(b: Builder, sources: dict[str, dict[int, float]], r: Draw) -> None:
    chiller = b.body("chiller", r(3.4e5, 4.4e5))
    b.link(chiller, b.cells["stator"], r(38, 52))
    b.link(chiller, b.cells["housing"][3:6], r(4, 7))
    b.air(chiller, "hall.bottom", r(6, 10))
    jacket = b.body("jacket", r(0.7e4, 1.1e4), 3, r(60, 90))
    b.link(chiller, jacket, r(28, 40))
    b.air(jacket, "hall.middle", r(0.2, 0.5))
    sources["chiller"] = {int(chiller[0]): 1.0}
    tank = b.body("tank", r(0.8e5, 1.1e5))
    b.air(tank, "hall.bottom", r(11, 15))
    foot = b.body("foot", r(3.5e4, 5.5e4), 3, r(40, 60))
    b.link(tank, foot[0], r(16, 20))
    b.air(foot, "hall.bottom", r(4, 6))
    sources["pump"] = {int(tank[0]): 1.0}


def _mated(b: Builder, name: str, capacity: float, conductance: float, air: str, w_per_k: float) -> Cells:
    """A body and its mate across the loop, which the same air washes but nothing heats: only the excess counts."""
    cells = b.body(name, capacity, 3, conductance)
    for body in (cells, b.body(f"{name}_mate", capacity, 3, conductance)):
        b.air(body, air, w_per_k)
    return cells


def _rod_in_cells(rod: tuple[float, float], n: int) -> tuple[float, int, float]:
    return rod[0], n, rod[1]


def _growth(b: Builder, size: int, r: Draw, length: Float1D, start: Float1D, home: Float1D) -> dict[str, Float1D]:
    """Elongation: alpha times the length of each cell; bending: alpha times height squared over depth, by cells."""
    out: dict[str, Float1D] = {}

    def add(effect: str, body: str, lengths_m: object, first: int = 0) -> None:
        target = out.setdefault(effect, np.zeros(size))
        values = np.asarray(lengths_m, dtype=np.float64)
        target[b.cells[body][first : first + len(values)]] += ALPHA_UM * values

    # behind the front bearing the shaft grows back into the housing; towards the tool it grows out
    add("spindle_bearing", "shaft", [0.03, 0.03, 0.03])
    add("spindle_bearing", "housing", [0.08, 0.09, 0.075, 0.05])
    add("spindle_motor", "headstock", [0.08, 0.08, 0.08, 0.08])
    add("spindle_friction", "nose_sleeve", [0.1, 0.1, 0.1])
    low = r(0.15, 0.35)  # bed and portal do not share the loop evenly
    add("ambient_frame", "bed", np.full(3, 0.35 * (1 - low)))
    add("ambient_frame", "portal", np.full(4, 0.25 * low))
    add("vertical_gradient", "guide_top", np.full(3, 0.25))
    add("vertical_gradient", "guide_low", np.full(3, -0.25))
    heights = np.array([0.25, 0.5, 0.75, 1.0, 1.25])
    depth = r(0.45, 0.6)
    arm = heights[::-1] * 0.25 / depth  # the lower a cell bends, the more the top moves
    add("column_bending", "column_rear", arm)
    add("column_bending", "column_front", -arm)
    for i, a in enumerate("xyz"):
        edges = start[i] + np.linspace(0, length[i], SCREW_CELLS + 1)
        inside = np.clip(np.minimum(edges[1:], home[i]) - edges[:-1], 0.0, None) / 1000.0
        add(f"feed_screw_{a}", f"screw_{a}", inside)
        add(f"feed_motor_{a}", f"bracket_{a}", np.full(4, 0.08))
    add("table_bearing", "table_bearing", [0.12])
    add("table_bearing", "table", np.full(4, 0.05))
    add("tool_elongation", "holder", np.full(3, 0.03))
    add("tool_elongation", "tool", np.full(4, 0.0275))
    add("cutting_power", "part", np.full(3, 0.06))
    add("coolant", "splash", np.full(3, 0.15))
    for effect, body, share in (
        ("spindle_friction", "nose_sleeve", 0.1),
        ("cutting_power", "part", 0.06),
        ("coolant", "splash", 0.15),
    ):
        add(effect, f"{body}_mate", np.full(3, -share))
    add("coolant_temperature", "jacket", np.full(3, 0.15))
    add("hydraulics", "foot", np.full(3, 0.15))
    add("probe_temperature", "probe", np.full(4, 0.035))
    return out
