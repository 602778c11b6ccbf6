"""The hall: air temperature into frame and skin, its gradient, and the floor."""

from __future__ import annotations

from collections.abc import Collection, Mapping

from thermodata.effect.law import Law
from thermodata.plugin import Drivers, Float1D, Float2D, Need

from .shared import FastAndSlow, Lagged, column, gain, tau

_HALL = (Need("temperature", "temperature", ("hall.*",)),)


class AmbientFrame(Lagged):
    """The frame follows the air of the hall, slowly.

        d = k F_tau{dT}

    k [um/K], tau [min], dT [K] from the test's start.
    Source: [straka2021] Z_amb; [iso230-3] ETVE test; bounds: docs/model.md#bounds-of-the-effects
    """

    name = "ambient_frame"
    family = "ambient"
    meaning = "the frame follows the hall's air: k F{dT}; daily"
    equation = "d = k F_tau{dT}"
    telltale = "a daily swing that goes on while the machine rests; told apart by a test at rest of 24 h or more (ETVE)"
    source = "[straka2021] Z_amb; [iso230-3] ETVE test; bounds: docs/model.md#bounds-of-the-effects"
    needs = _HALL
    params = (tau(240, 5, 1440, reach=(1, 1440)),)
    gains = (gain("um/K", 0.1, 15, "displacement at rest a kelvin of the hall"),)


class AmbientSkin(FastAndSlow):
    """Thin parts follow the air before the frame does; the difference fades.

        d = k (F_tau_fast{dT} - F_tau_slow{dT})

    k [um/K], tau_fast and tau_slow [min], dT [K] of the hall.
    Source: [mayr2012] on the environment; bounds: docs/model.md#bounds-of-the-effects
    """

    name = "ambient_skin"
    refines = ("ambient_frame",)
    family = "ambient"
    meaning = "thin parts follow the hall's air before the frame does: k (F_fast{dT} - F_slow{dT}); door events"
    equation = "d = k (F_tau_fast{dT} - F_tau_slow{dT})"
    telltale = (
        "a bump of minutes after a door opens, gone once the frame has followed; told apart by a pulse of the door"
    )
    source = "[mayr2012] on the environment; bounds: docs/model.md#bounds-of-the-effects"
    needs = _HALL
    params = (
        tau(15, 5, 40, "tau_fast", "time constant of thin parts"),
        tau(240, 120, 480, "tau_slow", "time constant of the frame"),
    )
    gains = (gain("um/K", 0.1, 15, "displacement a kelvin between skin and frame"),)

    def modes(self, fast: Float1D, slow: Float1D) -> Float2D:
        return column(fast - slow)

    def law(self, roles: Collection[str], p: Mapping[str, float], step_s: float) -> tuple[Law, ...]:
        """The same as a formula; see `thermodata.effect.law`."""
        return ("lag(temperature, tau_fast) - lag(temperature, tau_slow)",)


class VerticalGradient(Lagged):
    """Air that is warmer above than below tilts the column.

        d = k F_tau{dT_top - dT_bottom}

    k [um/K], tau [min], temperatures [K].
    Source: [mayr2012] on the environment; bounds: docs/model.md#bounds-of-the-effects
    """

    name = "vertical_gradient"
    family = "ambient"
    meaning = "the column tilts with the gradient of the air: k F{dT top - dT bottom}"
    equation = "d = k F_tau{dT_top - dT_bottom}"
    telltale = "a tilt: the same course in X and Y, larger than in Z; told apart by switching fans on"
    source = "[mayr2012] on the environment; bounds: docs/model.md#bounds-of-the-effects"
    needs = (Need("top", "temperature", ("hall.top",)), Need("bottom", "temperature", ("hall.bottom",)))
    params = (tau(60, 2, 360),)
    gains = (gain("um/K", 2, 30, "displacement at rest a kelvin between top and bottom"),)
    driven = ("top - bottom",)

    def drive(self, drivers: Drivers, p: Mapping[str, float]) -> Float1D:
        return drivers.values["top"] - drivers.values["bottom"]


class Sun(Lagged):
    """Sunlight warms one side of the machine.

        d = k F_tau{G / 500 W/m2}

    k [um] at 500 W/m2, tau [min], irradiance G [W/m2].
    Source: [mayr2012] on the environment; bounds: docs/model.md#bounds-of-the-effects
    """

    name = "sun"
    family = "ambient"
    meaning = "sun on the machine: k F{irradiance / 500 W/m2}; same clock hour"
    equation = "d = k F_tau{G / 500 W/m2}"
    telltale = "comes at the same hour of the clock on clear days; told apart by shading the window"
    source = "[mayr2012] on the environment; bounds: docs/model.md#bounds-of-the-effects"
    needs = (Need("irradiance", "irradiance", ("hall.*",)),)
    params = (tau(60, 5, 360, reach=(1, 720)),)
    gains = (gain("um", 1, 15, "displacement at rest at 500 W/m2"),)
    driven = ("irradiance / 500",)

    def drive(self, drivers: Drivers, p: Mapping[str, float]) -> Float1D:
        return drivers.values["irradiance"] / 500.0


class Floor(Lagged):
    """The foundation follows the floor's temperature over days.

        d = k F_tau{dT}

    k [um/K], tau [min], dT [K].
    Source: [mayr2012] on the environment; bounds: docs/model.md#bounds-of-the-effects
    """

    name = "floor"
    family = "ambient"
    meaning = "the foundation follows the floor's temperature: k F{dT}; looks like drift"
    equation = "d = k F_tau{dT}"
    telltale = "looks like drift over one test; told apart by several days at rest"
    source = "[mayr2012] on the environment; bounds: docs/model.md#bounds-of-the-effects"
    needs = (Need("temperature", "temperature", ("floor",)),)
    params = (tau(1440, 720, 4320, reach=(30, 4320)),)
    gains = (gain("um/K", 0.1, 30, "displacement at rest a kelvin of the floor"),)
