"""The hall: air temperature into frame and skin, its gradient, and the floor."""

from __future__ import annotations

from collections.abc import Mapping

from thermodata.effect.lag import lag, step_of
from thermodata.plugin import Drivers, Float1D, Float2D, Need

from .shared import Lagged, column, gain, tau

_HALL = (Need("temperature", "temperature", ("hall.*",)),)


class AmbientFrame(Lagged):
    name = "ambient_frame"
    family = "ambient"
    meaning = "the frame follows the hall's air: k F{dT}; daily"
    source = "modelling.md section 5, row 8; paper 000, Z_amb"
    needs = _HALL
    params = (tau(240, 60, 720),)
    gains = (gain("um/K", 0.1, 15, "displacement at rest a kelvin of the hall"),)


class AmbientSkin:
    name = "ambient_skin"
    refines = ("ambient_frame",)
    family = "ambient"
    meaning = "thin parts follow the hall's air before the frame does: k (F_fast{dT} - F_slow{dT}); door events"
    source = "modelling.md section 5, row 9"
    needs = _HALL
    params = (
        tau(15, 5, 40, "tau_fast", "time constant of thin parts"),
        tau(240, 120, 480, "tau_slow", "time constant of the frame"),
    )
    gains = (gain("um/K", 0.1, 15, "displacement a kelvin between skin and frame"),)

    def basis(self, drivers: Drivers, p: Mapping[str, float]) -> Float2D:
        u, step = drivers.values["temperature"], step_of(drivers)
        return column(lag(u, p["tau_fast"] * 60, step) - lag(u, p["tau_slow"] * 60, step))


class VerticalGradient(Lagged):
    name = "vertical_gradient"
    family = "ambient"
    meaning = "the column tilts with the gradient of the air: k F{dT top - dT bottom}"
    source = "modelling.md section 5, row 10"
    needs = (Need("top", "temperature", ("hall.top",)), Need("bottom", "temperature", ("hall.bottom",)))
    params = (tau(60, 2, 360),)
    gains = (gain("um/K", 2, 30, "displacement at rest a kelvin between top and bottom"),)

    def drive(self, drivers: Drivers, p: Mapping[str, float]) -> Float1D:
        return drivers.values["top"] - drivers.values["bottom"]


class Sun(Lagged):
    name = "sun"
    family = "ambient"
    meaning = "sun on the machine: k F{irradiance / 500 W/m2}; same clock hour"
    source = "modelling.md section 5, row 11"
    needs = (Need("irradiance", "irradiance", ("hall.*",)),)
    params = (tau(60, 5, 360),)
    gains = (gain("um", 1, 15, "displacement at rest at 500 W/m2"),)

    def drive(self, drivers: Drivers, p: Mapping[str, float]) -> Float1D:
        return drivers.values["irradiance"] / 500.0


class Floor(Lagged):
    name = "floor"
    family = "ambient"
    meaning = "the foundation follows the floor's temperature: k F{dT}; looks like drift"
    source = "modelling.md section 5, row 12"
    needs = (Need("temperature", "temperature", ("floor",)),)
    params = (tau(1440, 720, 4320),)
    gains = (gain("um/K", 0.1, 30, "displacement at rest a kelvin of the floor"),)
