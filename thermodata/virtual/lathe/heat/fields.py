"""The temperatures of all bodies through one test, and the bodies and lumps that have them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from thermodata.plugin import Float1D, Float2D
from thermodata.virtual.lathe.heat.rods import ALUMINIUM, CAST_IRON, STEEL, Body, Stack

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
