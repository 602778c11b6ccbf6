"""Linear and turning axes, table and turret: friction of screw, nut, guideway and bearings, motors, screw growth."""

from __future__ import annotations

from collections.abc import Mapping

from thermodata.plugin import Drivers, Float1D, Need

from .shared import (
    MOTOR_HEAT,
    REFERENCE_FEED_M_MIN,
    REFERENCE_SPEED_RPM,
    REFERENCE_TURNING_RPM,
    SCREW_FRICTION,
    GrowsWithPosition,
    Lagged,
    exponent,
    gain,
    power_of,
    tau,
)

ROTARY_HEAT = "heat of a rotary axis"
"""By its temperature or by its speed it is the same."""
TURRET_HEAT = "heat of a turret"
"""By its temperature or by the speed of its driven tools it is the same."""


class FeedScrew(Lagged):
    """Friction in nut and bearings warms the feed screw, and it grows.

        d = k F_tau{dT}, or k F_tau{|v / 10 m/min|^p} where no sensor is at the screw

    k [um/K] ([um] at 10 m/min), tau [min], p [1], dT [K], v [m/min].
    Source: [straka2021] inputs dyn (nut) and stat (bearing house); bounds:
    docs/model.md#bounds-of-the-effects
    """

    name = "feed_screw"
    closed_by = "scale"
    cause = SCREW_FRICTION
    family = "feed_{a}"
    meaning = "growth of the feed screw from friction: k F{dT of the nut}, or k F{|v/10 m/min|^p} without a sensor"
    equation = "d = k F_tau{dT}, or k F_tau{|v / 10 m/min|^p} where no sensor is at the screw"
    telltale = (
        "follows the feed of one axis; nothing remains where a linear scale closes the loop; told apart by several "
        "feeds"
    )
    source = "[straka2021] inputs dyn (nut) and stat (bearing house); bounds: docs/model.md#bounds-of-the-effects"
    needs = (
        Need("temperature", "temperature", ("axis.{a}.nut", "axis.{a}.screw", "axis.{a}.bearing"), True),
        Need("feed", "feed", ("axis.{a}",), True),
    )
    params = (tau(60, 18, 240, reach=(1, 360)), exponent(1.0))
    gains = (gain("um/K", 0.5, 5, "displacement at rest a kelvin (um at 10 m/min where the feed drives it)"),)
    driven = ("abs(feed / 10) ** exponent",)

    def drive(self, drivers: Drivers, p: Mapping[str, float]) -> Float1D:
        if "feed" in drivers.values:
            return power_of(drivers.values["feed"], REFERENCE_FEED_M_MIN, p["exponent"])
        return drivers.values["temperature"]


class FeedMotor(Lagged):
    """Heat of the axis motor flows into screw and slide.

        d = k F_tau{dT}

    k [um/K], tau [min], dT [K] of the motor.
    Source: [straka2021] input syst (feed motor); bounds: docs/model.md#bounds-of-the-effects
    """

    name = "feed_motor"
    cause = MOTOR_HEAT
    family = "feed_{a}"
    meaning = "heat of the axis motor into screw and slide: k F{dT of the motor}"
    equation = "d = k F_tau{dT}"
    telltale = "twin of feed_screw: the same axis moves; told apart by a sensor at the nut"
    source = "[straka2021] input syst (feed motor); bounds: docs/model.md#bounds-of-the-effects"
    needs = (Need("temperature", "temperature", ("axis.{a}.motor",)),)
    params = (tau(60, 30, 180, reach=(1, 360)),)
    gains = (gain("um/K", 0.2, 4, "displacement at rest a kelvin of the motor"),)


class Guideway(Lagged):
    """Friction in the guideway warms the slide and what carries it, and bends them.

        d = k F_tau{dT}

    k [um/K], tau [min], dT [K] of the guideway.
    Source: as feed_screw, for a slower and larger body; bounds: docs/model.md#bounds-of-the-effects
    """

    name = "guideway"
    family = "guide_{a}"
    meaning = "friction of the guideway warms slide and bed: k F{dT of the guideway}"
    equation = "d = k F_tau{dT}"
    telltale = (
        "follows the feed of one axis, slower than its screw, and remains where a linear scale closes the loop; told "
        "apart by a sensor at the nut"
    )
    source = "as feed_screw, for a slower and larger body; bounds: docs/model.md#bounds-of-the-effects"
    needs = (Need("temperature", "temperature", ("axis.{a}.guide",)),)
    params = (tau(60, 2, 720),)
    gains = (gain("um/K", 0.2, 20, "displacement at rest a kelvin of the guideway"),)


class ScrewGrowth(GrowsWithPosition):
    """A screw without a linear scale grows with the position that it holds; its fixed end adds a constant share.

        d = alpha x F_tau{dT} + k0 F_tau{dT}

    alpha [um/m/K], x [m], k0 [um/K], tau [min], dT [K].
    Source: steel expands by about 12 um/m/K; bounds: docs/model.md#bounds-of-the-effects
    """

    name = "screw_growth"
    closed_by = "scale"
    refines = ("feed_screw",)
    told_by = "position"
    family = "feed_{a}"
    meaning = "growth of a screw without a scale, with position: alpha x dT and the fixed end's alpha x0 dT"
    equation = "d = alpha x F_tau{dT} + k0 F_tau{dT}"
    telltale = "grows with the position of the axis; told apart by measuring at two positions"
    source = "steel expands by about 12 um/m/K; bounds: docs/model.md#bounds-of-the-effects"
    needs = (
        Need("temperature", "temperature", ("axis.{a}.screw", "axis.{a}.nut")),
        Need("position", "position", ("axis.{a}",)),
    )
    params = (tau(20, 1, 240),)
    gains = (gain("um/m/K", 1, 14, "expansion", "alpha"), gain("um/K", 0, 14, "part of the fixed end", "fixed_end"))


class TableBearing(Lagged):
    """The bearing of the table warms, and the table grows.

        d = k F_tau{dT}, or k F_tau{(|n| / 1000 rpm)^p} where no sensor is at the bearing

    k [um/K] ([um] at 1000 rpm), tau [min], p [1], dT [K], n [rpm].
    Source: [mares2021] turning; bounds: docs/model.md#bounds-of-the-effects
    """

    name = "table_bearing"
    family = "table"
    meaning = "growth of the table with its bearing: k F{dT}, or k F{(n/1000 rpm)^p} without a sensor"
    equation = "d = k F_tau{dT}, or k F_tau{(|n| / 1000 rpm)^p} where no sensor is at the bearing"
    telltale = "grows with the radius at which it is measured; told apart by measuring at two radii"
    source = "[mares2021] turning; bounds: docs/model.md#bounds-of-the-effects"
    needs = (
        Need("temperature", "temperature", ("table.bearing", "table"), True),
        Need("speed", "rotational_speed", ("table",), True),
    )
    params = (tau(60, 2, 360), exponent(1.5))
    gains = (gain("um/K", 0.2, 60, "displacement at rest a kelvin (um at 1000 rpm where the speed drives it)"),)
    driven = ("abs(speed / 1000) ** exponent",)

    def drive(self, drivers: Drivers, p: Mapping[str, float]) -> Float1D:
        if "speed" in drivers.values:
            return power_of(drivers.values["speed"], 1000.0, p["exponent"])
        return drivers.values["temperature"]


class RotaryAxis(Lagged):
    """A swivelling or turning axis grows with its temperature.

        d = k F_tau{dT}

    k [um/K], tau [min], dT [K].
    Source: as feed_motor, for a turning axis; bounds: docs/model.md#bounds-of-the-effects
    """

    name = "rotary_axis"
    cause = ROTARY_HEAT
    family = "rotary_{a}"
    meaning = "growth with the temperature of a rotary axis: k F{dT}"
    equation = "d = k F_tau{dT}"
    telltale = "follows the axis while all linear axes stand; told apart by moving it alone"
    source = "as feed_motor, for a turning axis; bounds: docs/model.md#bounds-of-the-effects"
    needs = (Need("temperature", "temperature", ("rotary.{a}",)),)
    params = (tau(60, 5, 360, reach=(1, 360)),)
    gains = (gain("um/K", 0.1, 10, "displacement at rest a kelvin"),)


class RotaryFriction(Lagged):
    """Friction heat of a swivelling or turning axis, by its speed, where no sensor sees it.

        d = k F_tau{(|n| / 10 rpm)^p}

    k [um] at 10 rpm, tau [min], p [1], n [rpm].
    Source: as spindle_friction, for a slow axis; bounds: docs/model.md#bounds-of-the-effects
    """

    name = "rotary_friction"
    cause = ROTARY_HEAT
    family = "rotary_{a}"
    meaning = "friction heat of a rotary axis from its speed, where no sensor sees it: k F{(n/10 rpm)^p}"
    equation = "d = k F_tau{(|n| / 10 rpm)^p}"
    telltale = "follows the axis while all linear axes stand; told apart by moving it alone at two speeds"
    source = "as spindle_friction, for a slow axis; bounds: docs/model.md#bounds-of-the-effects"
    needs = (Need("speed", "rotational_speed", ("rotary.{a}",)),)
    params = (tau(60, 5, 360), exponent(1.0))
    gains = (gain("um", 0.1, 60, "displacement at rest at 10 rpm"),)
    driven = ("abs(speed / 10) ** exponent",)

    def drive(self, drivers: Drivers, p: Mapping[str, float]) -> Float1D:
        return power_of(drivers.values["speed"], REFERENCE_TURNING_RPM, p["exponent"])


class TurretHeat(Lagged):
    """A turret grows with its temperature: its motor, and the gear and bearings of driven tools, warm it.

        d = k F_tau{dT}

    k [um/K], tau [min], dT [K].
    Source: as feed_motor, for a turret; bounds: docs/model.md#bounds-of-the-effects
    """

    name = "turret_heat"
    cause = TURRET_HEAT
    family = "turret"
    meaning = "growth with the temperature of a turret: k F{dT}"
    equation = "d = k F_tau{dT}"
    telltale = "follows the driven tools while the spindle stands; told apart by driving them alone"
    source = "as feed_motor, for a turret; bounds: docs/model.md#bounds-of-the-effects"
    needs = (Need("temperature", "temperature", ("turret",)),)
    params = (tau(40, 5, 240, reach=(1, 360)),)
    gains = (gain("um/K", 0.1, 10, "displacement at rest a kelvin"),)


class TurretFriction(Lagged):
    """Friction heat of driven tools in a turret, by their speed, where no sensor sees it.

        d = k F_tau{(|n| / 10000 rpm)^p}

    k [um] at 10000 rpm, tau [min], p [1], n [rpm].
    Source: as spindle_friction, for driven tools; bounds: docs/model.md#bounds-of-the-effects
    """

    name = "turret_friction"
    cause = TURRET_HEAT
    family = "turret"
    meaning = "friction heat of driven tools from their speed, where no sensor sees it: k F{(n/10000 rpm)^p}"
    equation = "d = k F_tau{(|n| / 10000 rpm)^p}"
    telltale = "follows the driven tools while the spindle stands; told apart by driving them alone at two speeds"
    source = "as spindle_friction, for driven tools; bounds: docs/model.md#bounds-of-the-effects"
    needs = (Need("speed", "rotational_speed", ("turret",)),)
    params = (tau(40, 2, 360), exponent())
    gains = (gain("um", 0.5, 60, "displacement at rest at 10000 rpm"),)
    driven = ("abs(speed / 10000) ** exponent",)

    def drive(self, drivers: Drivers, p: Mapping[str, float]) -> Float1D:
        return power_of(drivers.values["speed"], REFERENCE_SPEED_RPM, p["exponent"])
