"""The causes of displacement: what each heat path does at the tool, from the profiles of its own body.

A cause acts through the geometry of its machine (`World.scale`): where it has none, its heat and its sensors are there
all the same. What the hall alone does to a body is the hall's; what the work adds to it is the work's.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from thermodata.plugin import Float1D, Float2D
from thermodata.virtual.lathe.heat.fields import STACK, Fields
from thermodata.virtual.lathe.programme import DT_S, TOP_RPM, Work

BODIES = {b.name: b for b in STACK.bodies}


@dataclass(frozen=True, slots=True)
class Heat:
    """One test: the machine at work, and the same machine off in the same hall."""

    work: Work
    full: Fields
    quiet: Fields

    def excess(self, body: str) -> Float2D:
        """What the work heats, shape (n, cells) [K]."""
        return np.asarray(self.full.of(body) - self.quiet.of(body))


def growth(body: str, rise: Float2D, upto: Float1D | float = 1.0) -> Float1D:
    """Expansion integrated from the body's start to a share of its length [um]; rise: shape (n, cells) [K]."""
    b = BODIES[body]
    cells = rise.shape[1]
    inside = np.clip(np.multiply.outer(np.asarray(upto), np.ones(cells)) * cells - np.arange(cells), 0, 1)
    return np.asarray(1e6 * b.material.alpha * b.length_m / cells * np.sum(rise * inside, axis=1))


def bend(body: str, rise: Float2D, reach_m: float = 0.5) -> Float1D:
    """Deflection at reach_m of a plate that is warmer on one side [um]: reach^2/2 times its thermal curvature."""
    b = BODIES[body]
    cells = rise.shape[1]
    y = (np.arange(cells) + 0.5) / cells - 0.5
    curvature = 12 * b.material.alpha / b.length_m * (rise @ y) / cells
    return np.asarray(1e6 * curvature * reach_m**2 / 2)


def play(course: Float1D, width: float) -> Float1D:
    """A part that follows only once the play is used up (Prandtl's play operator)."""
    held = np.empty_like(course)
    at = float(course[0])
    for i, x in enumerate(course):
        at = min(max(at, float(x) - width / 2), float(x) + width / 2)
        held[i] = at
    return held


Shift = Callable[[Heat], tuple[Float1D, Float1D]]


@dataclass(frozen=True, slots=True)
class Cause:
    """shift: X and Z of one test before the machine's geometry [um]. sensors: that see it, the nearest one first.
    known: whether a library of lags can hold it at all."""

    meaning: str
    shift: Shift
    sensors: tuple[str, ...]
    known: bool = True


def _bearing(h: Heat) -> tuple[Float1D, Float1D]:
    quill, tall = growth("quill", h.excess("quill")), growth("headstock", h.excess("headstock"))
    return 0.2 * quill + tall, quill + 0.25 * tall


def _motor(h: Heat) -> tuple[Float1D, Float1D]:
    x = h.excess("motor_plate")
    return growth("motor_plate", x) + 0.05 * bend("motor_plate", x), 0.6 * growth("motor_plate", x)


def _screw_z(h: Heat) -> tuple[Float1D, Float1D]:
    z = growth("screw_z", h.excess("screw_z"), 0.35 + 0.5 * 180 / 400)
    return 0.1 * z, z


def _screw_x(h: Heat) -> tuple[Float1D, Float1D]:
    x = growth("screw_x", h.excess("screw_x"), 0.7)
    return x, 0.1 * x


def _air(h: Heat) -> tuple[Float1D, Float1D]:
    tall, bed = growth("headstock", h.quiet.of("headstock")), growth("bed", h.quiet.of("bed"))
    return tall + 0.2 * bed, bed + 0.3 * tall


def _layers(h: Heat) -> tuple[Float1D, Float1D]:
    tall = h.quiet.of("headstock")
    lean = tall @ np.linspace(-1, 1, tall.shape[1])
    bow = 0.05 * bend("bed", h.quiet.of("bed"))
    return lean + bow, 0.6 * lean + bow


def _film(h: Heat) -> tuple[Float1D, Float1D]:
    b = h.excess("bed")
    return 0.1 * bend("bed", b) + growth("bed", b), 0.05 * bend("bed", b) + growth("bed", b)


def _oil(h: Heat) -> tuple[Float1D, Float1D]:
    r = h.excess("rib")
    return 0.05 * bend("rib", r) + growth("rib", r), 0.02 * bend("rib", r) + growth("rib", r)


def _turret(h: Heat) -> tuple[Float1D, Float1D]:
    x = growth("turret", h.excess("turret"))
    return x, 0.3 * x


def _part(h: Heat) -> tuple[Float1D, Float1D]:
    x = growth("part", h.excess("part"))
    return 0.5 * x, x


def _bracket(h: Heat) -> tuple[Float1D, Float1D]:
    g = growth("bracket", h.full.of("bracket"))
    return g, 0.7 * g


def _guides(h: Heat) -> tuple[Float1D, Float1D]:
    s = h.excess("saddle")
    return 0.05 * bend("saddle", s) + growth("saddle", s), 0.4 * growth("saddle", s)


def _ring(h: Heat) -> tuple[Float1D, Float1D]:
    shift = (h.work.speed / TOP_RPM) ** 2
    return 0.3 * shift, shift


def _seat(h: Heat) -> tuple[Float1D, Float1D]:
    x = growth("headstock", h.excess("headstock") + h.quiet.of("headstock"))
    slip = play(x, 0.7 * float(np.ptp(x)) + 1e-9) - x
    return slip, slip


def _chips(h: Heat) -> tuple[Float1D, Float1D]:
    """A heap of hot chips grows while it cuts and is emptied at times that nobody logs."""
    heap = np.zeros(h.work.n)
    level, warm = 0.0, 0.0
    empty = np.random.default_rng(int(1e6 * h.work.hour[0])).random(h.work.n) < DT_S / 5400
    for i in range(h.work.n):
        level = 0.0 if empty[i] else level + DT_S * (float(h.work.cutting[i]) + 0.4 * float(h.work.speed[i] > 0))
        warm += DT_S / 2400 * (level - warm)
        heap[i] = warm
    return heap, 0.5 * heap


def _stretch(h: Heat) -> tuple[Float1D, Float1D]:
    """A screw that is held at both ends moves only once its growth has used up its stretch."""
    g = growth("screw_z", h.excess("screw_z"))
    lost = np.clip(g - 0.6 * float(np.max(g)), 0, None)
    return 0.2 * lost, lost


CAUSES: Mapping[str, Cause] = {
    "bearing_friction": Cause("spindle bearings heat quill and headstock", _bearing, ("TS_brg_f", "TS_brg_r", "n_S")),
    "belt_motor": Cause(
        "the spindle's motor heats and bends the plate that holds it", _motor, ("T_mot_S", "n_S", "P_S")
    ),
    "nut_z": Cause("the nut heats the Z screw, which no scale corrects", _screw_z, ("C01_nutZ", "v_Z", "T_mot_Z")),
    "nut_x": Cause("the nut heats the X screw, which no scale corrects", _screw_x, ("C02_nutX", "v_X", "T_mot_X")),
    "hall_air": Cause("headstock and bed follow the air", _air, ("A2_low", "A1_high", "C04_foot")),
    "hall_layers": Cause("layers of air lean the headstock and bend the bed", _layers, ("A1_high", "A2_low")),
    "coolant_film": Cause("coolant wets the bed's covers", _film, ("M_cool", "C10_cool", "C05_bedtop")),
    "hydraulic_oil": Cause("the oil tank heats the rear wall", _oil, ("C11_oil", "C07_rib", "p_hyd")),
    "turret_gear": Cause("driven tools heat the turret", _turret, ("C08_turret", "n_tool")),
    "hot_part": Cause("cutting heats the part", _part, ("C12_part", "P_S")),
    "probe_bracket": Cause("the bracket of the probes follows the working space", _bracket, ("C09_bracket",)),
    "guide_friction": Cause("box ways heat the saddle from below", _guides, ("C03_guide", "v_Z")),
    "ring_expansion": Cause("bearing rings widen with the speed, at once", _ring, ("n_S",)),
    "seat_play": Cause("the headstock's seat has play and sticks", _seat, ("TS_brg_f", "C04_foot"), known=False),
    "chip_heap": Cause("hot chips gather and are emptied", _chips, (), known=False),
    "lost_stretch": Cause("the Z screw grows once its stretch is used up", _stretch, ("C01_nutZ",), known=False),
}
KNOWN = tuple(name for name, c in CAUSES.items() if c.known)
OUTSIDE = tuple(name for name, c in CAUSES.items() if not c.known)
# whose sensors no other cause of the machine needs: without them nothing logged stands for it
ALONE = ("nut_z", "nut_x", "hydraulic_oil", "turret_gear", "probe_bracket", "guide_friction")
