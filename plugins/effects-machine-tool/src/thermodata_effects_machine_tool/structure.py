"""Column, probe and fixture; and the control's own compensation, which mirrors a temperature."""

from __future__ import annotations

from collections.abc import Mapping

from thermodata.plugin import Drivers, Float1D, Float2D, Need

from .shared import Lagged, column, gain, tau


class ColumnBending(Lagged):
    name = "column_bending"
    family = "column"
    meaning = "the column bends with the difference of its sides: k F{dT rear - dT front} or left - right"
    source = "modelling.md section 5, row 38"
    needs = (
        Need("warm_side", "temperature", ("column.rear", "column.left")),
        Need("cold_side", "temperature", ("column.front", "column.right")),
    )
    params = (tau(20, 0.5, 120),)
    gains = (gain("um/K", 1, 60, "displacement at rest a kelvin between the sides"),)

    def drive(self, drivers: Drivers, p: Mapping[str, float]) -> Float1D:
        return drivers.values["warm_side"] - drivers.values["cold_side"]


class ProbeTemperature(Lagged):
    name = "probe_temperature"
    family = "probe"
    meaning = "growth of the probe or its fixture, in all axes: k F{dT}"
    source = "modelling.md section 5, row 31"
    needs = (Need("temperature", "temperature", ("probe", "fixture")),)
    params = (tau(15, 1, 120),)
    gains = (gain("um/K", 0.1, 2, "displacement at rest a kelvin of the fixture"),)


class ControlCompensation:
    name = "control_compensation"
    family = "control"
    meaning = "the control's static linear model, as a baseline or left on by mistake: k (dT spindle - dT base)"
    source = "paper 001, eq. 1 (1.5 um/K in y, 7.0 um/K in z)"
    needs = (Need("spindle", "temperature", ("spindle", "headstock")), Need("base", "temperature", ("bed", "hall.*")))
    params = ()
    gains = (gain("um/K", 0.5, 10, "micrometres a kelvin, at once"),)

    def basis(self, drivers: Drivers, p: Mapping[str, float]) -> Float2D:
        return column(drivers.values["spindle"] - drivers.values["base"])
