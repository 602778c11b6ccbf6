"""What grows with the place that an axis holds: its scale, and what hangs over.

Diagnosis does not ask for these by itself: over few positions they look like the frame and the screw.
"""

from __future__ import annotations

from collections.abc import Mapping

from thermodata.plugin import Drivers, Float1D, Need

from .shared import GrowsWithPosition, Lagged, gain, tau


class ScaleGrowth(GrowsWithPosition):
    """The linear scale of an axis grows, and the axis goes where the scale says.

        d = alpha x F_tau{dT} + k0 F_tau{dT}

    alpha [um/m/K], x [m], k0 [um/K] of the point where the scale is fixed, tau [min], dT [K] of the scale.
    Source: steel scales expand by about 11 um/m/K, glass ones by 8; bounds:
    docs/model.md#bounds-of-the-effects
    """

    name = "scale_growth"
    asked = False
    family = "scale_{a}"
    meaning = "growth of the linear scale, with position: alpha x F{dT} and its fixed point's k0 F{dT}"
    equation = "d = alpha x F_tau{dT} + k0 F_tau{dT}"
    telltale = "slow, and grows with the position of the axis though a scale closes the loop; told apart by a laser"
    source = "steel scales expand by about 11 um/m/K, glass ones by 8; bounds: docs/model.md#bounds-of-the-effects"
    needs = (Need("temperature", "temperature", ("axis.{a}.scale",)), Need("position", "position", ("axis.{a}",)))
    params = (tau(60, 1, 720),)
    gains = (gain("um/m/K", 0, 11, "expansion", "alpha"), gain("um/K", 0, 11, "part of the fixed point", "fixed_end"))


class Overhang(Lagged):
    """What hangs over grows, or tilts the tool, with its temperature and its length.

        d = k F_tau{dT z}

    k [um/m/K], tau [min], dT [K], z [m] by which the ram or quill stands out.
    Source: geometry of a warm bar: expansion times length; bounds:
    docs/model.md#bounds-of-the-effects
    """

    name = "overhang"
    asked = False
    family = "overhang"
    meaning = "growth or tilt of what hangs over, with its length: k F{dT z}"
    equation = "d = k F_tau{dT z}"
    telltale = "grows with the overhang; told apart by the same heat at two positions"
    source = "geometry of a warm bar: expansion times length; bounds: docs/model.md#bounds-of-the-effects"
    needs = (
        Need("temperature", "temperature", ("ram", "headstock", "column", "spindle")),
        Need("position", "position", ("axis.z", "ram")),
    )
    params = (tau(30, 1, 360),)
    gains = (gain("um/m/K", 1, 60, "displacement at rest a kelvin and metre"),)
    driven = ("temperature * position / 1000",)

    def drive(self, drivers: Drivers, p: Mapping[str, float]) -> Float1D:
        return drivers.values["temperature"] * drivers.values["position"] / 1000.0
