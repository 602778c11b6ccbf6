"""Column, ram, crossbeam, bed, probe and fixture; and the control's own compensation: it mirrors a temperature."""

from __future__ import annotations

from collections.abc import Collection, Mapping

from thermodata.effect.law import Law
from thermodata.plugin import Drivers, Float1D, Float2D, Need

from .shared import Lagged, column, gain, tau


class ColumnBending(Lagged):
    """The column bends with the difference between its sides.

        d = k F_tau{dT_warm - dT_cold}

    k [um/K], tau [min], temperatures [K] of rear and front, or left and right.
    Source: [mayr2012] on structures; bounds: docs/model.md#bounds-of-the-effects
    """

    name = "column_bending"
    family = "column"
    meaning = "the column bends with the difference of its sides: k F{dT rear - dT front} or left - right"
    equation = "d = k F_tau{dT_warm - dT_cold}"
    telltale = "a tilt: in Y (or X) more than in Z; told apart by sensors on both sides at once"
    source = "[mayr2012] on structures; bounds: docs/model.md#bounds-of-the-effects"
    needs: tuple[Need, ...] = (
        Need("warm_side", "temperature", ("column.rear", "column.left")),
        Need("cold_side", "temperature", ("column.front", "column.right")),
    )
    params = (tau(20, 0.5, 120, reach=(0.5, 360)),)
    gains = (gain("um/K", 1, 60, "displacement at rest a kelvin between the sides"),)
    driven = ("warm_side - cold_side",)

    def drive(self, drivers: Drivers, p: Mapping[str, float]) -> Float1D:
        return drivers.values["warm_side"] - drivers.values["cold_side"]


class RamBending(ColumnBending):
    """The ram bends with the difference between its sides: as the column, with what it carries out.

        d = k F_tau{dT_warm - dT_cold}

    k [um/K], tau [min], temperatures [K] of rear and front, left and right, or top and bottom.
    Source: as column_bending, of another beam; bounds: docs/model.md#bounds-of-the-effects
    """

    name = "ram_bending"
    family = "ram"
    meaning = "the ram bends with the difference of its sides: k F{dT rear - dT front}, left - right or top - bottom"
    telltale = "grows with how far the ram is out; told apart by sensors on both sides at once"
    source = "as column_bending, of another beam; bounds: docs/model.md#bounds-of-the-effects"
    needs = (
        Need("warm_side", "temperature", ("ram.rear", "ram.left", "ram.top")),
        Need("cold_side", "temperature", ("ram.front", "ram.right", "ram.bottom")),
    )


class CrossbeamBending(ColumnBending):
    """The crossbeam bends, or twists, with the difference between its sides.

        d = k F_tau{dT_warm - dT_cold}

    k [um/K], tau [min], temperatures [K] of top and bottom, or rear and front.
    Source: as column_bending, of another beam; bounds: docs/model.md#bounds-of-the-effects
    """

    name = "crossbeam_bending"
    family = "crossbeam"
    meaning = "the crossbeam bends with the difference of its sides: k F{dT top - dT bottom} or rear - front"
    telltale = "largest in the middle of the beam; told apart by sensors on both sides at once"
    source = "as column_bending, of another beam; bounds: docs/model.md#bounds-of-the-effects"
    needs = (
        Need("warm_side", "temperature", ("crossbeam.top", "crossbeam.rear")),
        Need("cold_side", "temperature", ("crossbeam.bottom", "crossbeam.front")),
    )


class BedBending(ColumnBending):
    """The bed bends with the difference between its sides, as where the coolant warms its top or the floor cools it.

        d = k F_tau{dT_warm - dT_cold}

    k [um/K], tau [min], temperatures [K] of top and bottom, rear and front, or left and right.
    Source: as column_bending, of another beam; bounds: docs/model.md#bounds-of-the-effects
    """

    name = "bed_bending"
    family = "bed"
    meaning = "the bed bends with the difference of its sides: k F{dT top - dT bottom}, rear - front or left - right"
    telltale = "tilts what stands on the bed; told apart by sensors on both sides at once"
    source = "as column_bending, of another beam; bounds: docs/model.md#bounds-of-the-effects"
    needs = (
        Need("warm_side", "temperature", ("bed.top", "bed.rear", "bed.left")),
        Need("cold_side", "temperature", ("bed.bottom", "bed.front", "bed.right")),
    )


class ProbeTemperature(Lagged):
    """The probe or its fixture grows with its own temperature.

        d = k F_tau{dT}

    k [um/K], tau [min], dT [K] of probe or fixture.
    Source: thermal expansion of the fixture; bounds: docs/model.md#bounds-of-the-effects
    """

    name = "probe_temperature"
    family = "probe"
    meaning = "growth of the probe or its fixture, in all axes: k F{dT}"
    equation = "d = k F_tau{dT}"
    telltale = "in all axes alike; told apart by a fixture of little expansion"
    source = "thermal expansion of the fixture; bounds: docs/model.md#bounds-of-the-effects"
    needs = (Need("temperature", "temperature", ("probe", "fixture")),)
    params = (tau(15, 1, 120, reach=(1, 360)),)
    gains = (gain("um/K", 0.1, 2, "displacement at rest a kelvin of the fixture"),)


class ControlCompensation:
    """The static linear model that a control ships with, as a baseline or left on by mistake.

        d = k (dT_spindle - dT_base)

    k [um/K], temperatures [K].
    Source: [horejs2010] eq. 1, 1.5 um/K in Y and 7.0 um/K in Z
    """

    name = "control_compensation"
    family = "control"
    meaning = "the control's static linear model, as a baseline or left on by mistake: k (dT spindle - dT base)"
    equation = "d = k (dT_spindle - dT_base)"
    telltale = "a static mirror of a temperature; told apart by switching the compensation off"
    source = "[horejs2010] eq. 1, 1.5 um/K in Y and 7.0 um/K in Z"
    needs = (Need("spindle", "temperature", ("spindle", "headstock")), Need("base", "temperature", ("bed", "hall.*")))
    params = ()
    gains = (gain("um/K", 0.5, 10, "micrometres a kelvin, at once"),)

    def basis(self, drivers: Drivers, p: Mapping[str, float]) -> Float2D:
        return column(drivers.values["spindle"] - drivers.values["base"])

    def law(self, roles: Collection[str], p: Mapping[str, float], step_s: float) -> tuple[Law, ...]:
        """The same as a formula; see `thermodata.effect.law`."""
        return ("spindle - base",)
