"""What the process and its fluids do: tool, cutting power, coolant, hydraulics."""

from __future__ import annotations

from collections.abc import Mapping

from thermodata.plugin import Drivers, Float1D, Need

from .shared import Lagged, gain, tau


class ToolElongation(Lagged):
    name = "tool_elongation"
    family = "tool"
    meaning = "elongation of the tool: k F{dT tool}; at the tool centre point, not at the stator"
    source = "modelling.md section 5, row 19; paper 004, e3"
    needs = (Need("temperature", "temperature", ("tool",)),)
    params = (tau(3, 1, 10),)
    gains = (gain("um/K", 0.5, 3, "displacement at rest a kelvin of the tool"),)


class CuttingPower(Lagged):
    name = "cutting_power"
    family = "cutting"
    meaning = "heat of cutting from the spindle's power: k F{P}"
    source = "modelling.md section 5, row 20; paper 004, gamma1"
    needs = (Need("power", "power", ("spindle",)),)
    params = (tau(30, 1, 240),)
    gains = (gain("um/kW", 5, 60, "displacement at rest a kilowatt"),)


class Coolant(Lagged):
    name = "coolant"
    family = "coolant"
    meaning = "coolant switched on and off: k F{state}, or k F{flow / 10 l/min}"
    source = "modelling.md section 5, row 22"
    needs = (Need("state", "state", ("coolant",), True), Need("flow", "flow", ("coolant",), True))
    params = (tau(20, 5, 90),)
    gains = (gain("um", 0.5, 30, "displacement at rest with the coolant on"),)

    def drive(self, drivers: Drivers, p: Mapping[str, float]) -> Float1D:
        return drivers.values["state"] if "state" in drivers.values else drivers.values["flow"] / 10.0


class CoolantTemperature(Lagged):
    name = "coolant_temperature"
    family = "coolant"
    meaning = "parts that the coolant or the chiller washes follow its temperature: k F{dT}; a line at 5-40 min"
    source = "modelling.md section 5, row 23"
    needs = (Need("temperature", "temperature", ("coolant",)),)
    params = (tau(15, 1, 240),)
    gains = (gain("um/K", 0.1, 20, "displacement at rest a kelvin of the coolant"),)


class Hydraulics(Lagged):
    name = "hydraulics"
    family = "hydraulics"
    meaning = "parts near tank and pump: k F{dT}, or k F{pump on}; pump cycle"
    source = "modelling.md section 5, row 37"
    needs = (Need("temperature", "temperature", ("hydraulics",), True), Need("state", "state", ("hydraulics",), True))
    params = (tau(45, 2, 360),)
    gains = (gain("um/K", 0.1, 20, "displacement at rest a kelvin of the tank (um with the pump on)"),)


class Workpiece(Lagged):
    name = "workpiece"
    family = "workpiece"
    meaning = "growth of the part: k F{dT}; only with a part"
    source = "modelling.md section 5, row 25 (11-24 um/m/K times the part's length)"
    needs = (Need("temperature", "temperature", ("workpiece",)),)
    params = (tau(30, 1, 360),)
    gains = (gain("um/K", 0.5, 50, "displacement at rest a kelvin of the part"),)
