"""What the process and its fluids do: tool, cutting power, coolant, hydraulics."""

from __future__ import annotations

from collections.abc import Mapping

from thermodata.plugin import Drivers, Float1D, Need

from .shared import CUTTING_HEAT, Lagged, gain, tau

# one fluid, read by its switch, its flow or its temperature
COOLANT_HEAT = "heat of the coolant"


class ToolElongation(Lagged):
    """The tool grows with its temperature.

        d = k F_tau{dT}

    k [um/K], tau [min], dT [K] of the tool.
    Source: [mares2017] eq. 9, e3; bounds: docs/model.md#bounds-of-the-effects
    """

    name = "tool_elongation"
    family = "tool"
    meaning = "elongation of the tool: k F{dT tool}; at the tool centre point, not at the stator"
    equation = "d = k F_tau{dT}"
    telltale = "at the tool centre point, not at the spindle's stator; told apart by a second probe at the stator"
    source = "[mares2017] eq. 9, e3; bounds: docs/model.md#bounds-of-the-effects"
    needs = (Need("temperature", "temperature", ("tool",)),)
    params = (tau(3, 1, 10, reach=(1, 60)),)
    gains = (gain("um/K", 0.5, 3, "displacement at rest a kelvin of the tool"),)


class CuttingPower(Lagged):
    """Heat of the cut, by the power of the spindle.

        d = k F_tau{P}

    k [um/kW], tau [min], P [kW].
    Source: [mares2017] eq. 8, gamma1; bounds: docs/model.md#bounds-of-the-effects
    """

    name = "cutting_power"
    cause = CUTTING_HEAT
    family = "{s}cutting"
    meaning = "heat of cutting from the spindle's power: k F{P}"
    equation = "d = k F_tau{P}"
    telltale = "follows the load; told apart by the same path as an air cut"
    source = "[mares2017] eq. 8, gamma1; bounds: docs/model.md#bounds-of-the-effects"
    needs = (Need("power", "power", ("{s}spindle",)),)
    params = (tau(30, 1, 240),)
    gains = (gain("um/kW", 5, 300, "displacement at rest a kilowatt"),)


class CuttingLoad(Lagged):
    """Heat of the cut, by the load of the spindle, which a control shows where it shows no power.

        d = k F_tau{load / 100 %}

    k [um] at full load, tau [min], load [%].
    Source: as cutting_power, for a spindle of a few kilowatts; bounds: docs/model.md#bounds-of-the-effects
    """

    name = "cutting_load"
    cause = CUTTING_HEAT
    family = "{s}cutting"
    meaning = "heat of cutting from the spindle's load: k F{load/100 %}"
    equation = "d = k F_tau{load / 100 %}"
    telltale = "twin of cutting_power; told apart from other heat by the same path as an air cut"
    source = "as cutting_power, for a spindle of a few kilowatts; bounds: docs/model.md#bounds-of-the-effects"
    needs = (Need("load", "load", ("{s}spindle",)),)
    params = (tau(30, 1, 240),)
    gains = (gain("um", 5, 300, "displacement at rest at full load"),)
    driven = ("load / 100",)

    def drive(self, drivers: Drivers, p: Mapping[str, float]) -> Float1D:
        return drivers.values["load"] / 100.0


class Coolant(Lagged):
    """Coolant cools or warms the parts that it washes while it flows.

        d = k F_tau{on}, or k F_tau{q / 10 l/min}

    k [um], tau [min], on [0 or 1], flow q [l/min].
    Source: [mayr2012] on fluids; bounds: docs/model.md#bounds-of-the-effects
    """

    name = "coolant"
    cause = COOLANT_HEAT
    family = "coolant"
    meaning = "coolant switched on and off: k F{state}, or k F{flow / 10 l/min}"
    equation = "d = k F_tau{on}, or k F_tau{q / 10 l/min}"
    telltale = "follows the switch of the coolant; told apart by coolant without cutting"
    source = "[mayr2012] on fluids; bounds: docs/model.md#bounds-of-the-effects"
    needs = (Need("state", "state", ("coolant",), True), Need("flow", "flow", ("coolant",), True))
    params = (tau(20, 5, 90, reach=(1, 360)),)
    gains = (gain("um", 0.5, 30, "displacement at rest with the coolant on"),)
    driven = ("state", "flow / 10")

    def drive(self, drivers: Drivers, p: Mapping[str, float]) -> Float1D:
        return drivers.values["state"] if "state" in drivers.values else drivers.values["flow"] / 10.0


class CoolantTemperature(Lagged):
    """Parts that the coolant washes follow its temperature.

        d = k F_tau{dT}

    k [um/K], tau [min], dT [K] of the fluid.
    Source: [mayr2012] on fluids; bounds: docs/model.md#bounds-of-the-effects
    """

    name = "coolant_temperature"
    cause = COOLANT_HEAT
    family = "coolant"
    meaning = "parts that the coolant washes follow its temperature: k F{dT}; a line at 5-40 min"
    equation = "d = k F_tau{dT}"
    telltale = "a ripple with the cycle of the chiller, 5 to 40 min; told apart by a step of its set point"
    source = "[mayr2012] on fluids; bounds: docs/model.md#bounds-of-the-effects"
    needs = (Need("temperature", "temperature", ("coolant",)),)
    params = (tau(15, 1, 240),)
    gains = (gain("um/K", 0.1, 20, "displacement at rest a kelvin of the coolant"),)


class CoolantHeat(Lagged):
    """Coolant warms or cools the parts that it washes by its temperature, and only while it flows.

        d = k F_tau{on dT}

    k [um/K] with the coolant on, tau [min], on [0 or 1], dT [K] of the fluid.
    Source: [mayr2012] on fluids, heat carried by a flow; bounds: docs/model.md#bounds-of-the-effects
    """

    name = "coolant_heat"
    cause = COOLANT_HEAT
    family = "coolant"
    meaning = "parts that the coolant washes follow its temperature while it flows: k F{on dT}"
    equation = "d = k F_tau{on dT}"
    telltale = "follows the coolant's temperature, and only while it flows; told apart by warm coolant that stands"
    source = "[mayr2012] on fluids, heat carried by a flow; bounds: docs/model.md#bounds-of-the-effects"
    needs = (Need("temperature", "temperature", ("coolant",)), Need("state", "state", ("coolant",)))
    params = (tau(30, 1, 360),)
    gains = (gain("um/K", 0.1, 20, "displacement at rest a kelvin of the coolant, with it on"),)
    driven = ("temperature * state",)

    def drive(self, drivers: Drivers, p: Mapping[str, float]) -> Float1D:
        return drivers.values["temperature"] * drivers.values["state"]


class ChillerTemperature(Lagged):
    """Spindle, drives or frame follow the circuit that cools them.

        d = k F_tau{dT}

    k [um/K], tau [min], dT [K] of the fluid.
    Source: [mayr2012] on fluids; bounds: docs/model.md#bounds-of-the-effects
    """

    name = "chiller_temperature"
    family = "chiller"
    meaning = "what the cooling circuit holds follows its temperature: k F{dT}; a line at 5-40 min"
    equation = "d = k F_tau{dT}"
    telltale = "a ripple with the cycle of the chiller, 5 to 40 min; told apart by a step of its set point"
    source = "[mayr2012] on fluids; bounds: docs/model.md#bounds-of-the-effects"
    needs = (Need("temperature", "temperature", ("chiller",)),)
    params = (tau(15, 1, 240),)
    gains = (gain("um/K", 0.1, 20, "displacement at rest a kelvin of the fluid"),)


class Hydraulics(Lagged):
    """Tank and pump of the hydraulics warm what stands near.

        d = k F_tau{dT}, or k F_tau{on}

    k [um/K] ([um] with the pump on), tau [min], dT [K], on [0 or 1].
    Source: [mayr2012] on fluids; bounds: docs/model.md#bounds-of-the-effects
    """

    name = "hydraulics"
    family = "hydraulics"
    meaning = "parts near tank and pump: k F{dT}, or k F{pump on}; pump cycle"
    equation = "d = k F_tau{dT}, or k F_tau{on}"
    telltale = "follows the cycle of the pump; told apart by a test with the pump off"
    source = "[mayr2012] on fluids; bounds: docs/model.md#bounds-of-the-effects"
    needs = (Need("temperature", "temperature", ("hydraulics",), True), Need("state", "state", ("hydraulics",), True))
    params = (tau(45, 2, 360),)
    gains = (gain("um/K", 0.1, 20, "displacement at rest a kelvin of the tank (um with the pump on)"),)


class Workpiece(Lagged):
    """The part grows with its temperature.

        d = k F_tau{dT}

    k [um/K] = expansion [um/m/K] times length [m], tau [min], dT [K].
    Source: metals expand by 11 to 24 um/m/K; bounds: docs/model.md#bounds-of-the-effects
    """

    name = "workpiece"
    cause = CUTTING_HEAT
    family = "workpiece"
    meaning = "growth of the part: k F{dT}; only with a part"
    equation = "d = k F_tau{dT}"
    telltale = "only with a part on the table; told apart by a part of little expansion"
    source = "metals expand by 11 to 24 um/m/K; bounds: docs/model.md#bounds-of-the-effects"
    needs = (Need("temperature", "temperature", ("workpiece",)),)
    params = (tau(30, 1, 360),)
    gains = (gain("um/K", 0.5, 50, "displacement at rest a kelvin of the part"),)
