"""Linear axes and the table: friction of screw and nut, feed motor, screw growth, table bearing."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from thermodata.effect.lag import lag, step_of
from thermodata.plugin import Drivers, Float1D, Float2D, Need

from .shared import REFERENCE_FEED_M_MIN, Lagged, exponent, gain, power_of, tau


class FeedScrew(Lagged):
    name = "feed_screw"
    family = "feed_{a}"
    meaning = "growth of the feed screw from friction: k F{dT of the nut}, or k F{|v/10 m/min|^p} without a sensor"
    source = "modelling.md section 5, row 13; paper 000 (inputs dyn and stat)"
    needs = (
        Need("temperature", "temperature", ("axis.{a}.nut", "axis.{a}.screw", "axis.{a}.bearing"), True),
        Need("feed", "feed", ("axis.{a}",), True),
    )
    params = (tau(60, 18, 240), exponent(1.0))
    gains = (gain("um/K", 0.5, 5, "displacement at rest a kelvin (um at 10 m/min where the feed drives it)"),)

    def drive(self, drivers: Drivers, p: Mapping[str, float]) -> Float1D:
        if "feed" in drivers.values:
            return power_of(drivers.values["feed"], REFERENCE_FEED_M_MIN, p["exponent"])
        return drivers.values["temperature"]


class FeedMotor(Lagged):
    name = "feed_motor"
    family = "feed_{a}"
    meaning = "heat of the axis motor into screw and slide: k F{dT of the motor}"
    source = "modelling.md section 5, row 14; paper 000 (input syst)"
    needs = (Need("temperature", "temperature", ("axis.{a}.motor",)),)
    params = (tau(60, 30, 180),)
    gains = (gain("um/K", 0.2, 4, "displacement at rest a kelvin of the motor"),)


class ScrewGrowth:
    name = "screw_growth"
    refines = ("feed_screw",)
    family = "feed_{a}"
    meaning = "growth of a screw without a scale, with position: alpha x dT and the fixed end's alpha x0 dT"
    source = "modelling.md section 5, row 15"
    needs = (
        Need("temperature", "temperature", ("axis.{a}.screw", "axis.{a}.nut")),
        Need("position", "position", ("axis.{a}",)),
    )
    params = (tau(20, 1, 240),)
    gains = (gain("um/m/K", 1, 14, "expansion", "alpha"), gain("um/K", 0, 14, "part of the fixed end", "fixed_end"))

    def basis(self, drivers: Drivers, p: Mapping[str, float]) -> Float2D:
        warmth = lag(drivers.values["temperature"], p["tau"] * 60, step_of(drivers))
        return np.column_stack([warmth * drivers.values["position"] / 1000.0, warmth])


class TableBearing(Lagged):
    name = "table_bearing"
    family = "table"
    meaning = "growth of the table with its bearing: k F{dT}, or k F{(n/1000 rpm)^p} without a sensor"
    source = "modelling.md section 5, row 18; paper 003 (turning)"
    needs = (
        Need("temperature", "temperature", ("table.bearing", "table"), True),
        Need("speed", "rotational_speed", ("table",), True),
    )
    params = (tau(60, 2, 360), exponent(1.5))
    gains = (gain("um/K", 0.2, 60, "displacement at rest a kelvin (um at 1000 rpm where the speed drives it)"),)

    def drive(self, drivers: Drivers, p: Mapping[str, float]) -> Float1D:
        if "speed" in drivers.values:
            return power_of(drivers.values["speed"], 1000.0, p["exponent"])
        return drivers.values["temperature"]


class RotaryAxis(Lagged):
    name = "rotary_axis"
    family = "rotary_{a}"
    meaning = "growth with the temperature of a rotary axis: k F{dT}"
    source = "as feed_motor; paper 000 treats linear axes only"
    needs = (Need("temperature", "temperature", ("rotary.{a}",)),)
    params = (tau(60, 5, 360),)
    gains = (gain("um/K", 0.1, 10, "displacement at rest a kelvin"),)
