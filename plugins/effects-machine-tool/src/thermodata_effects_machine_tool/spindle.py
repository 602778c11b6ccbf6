"""The spindle: bearings, motor, friction heat without a sensor, and the centrifugal shift."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from thermodata.effect.lag import lag, step_of
from thermodata.plugin import Drivers, Float1D, Float2D, Need

from .shared import REFERENCE_SPEED_RPM, Lagged, column, exponent, gain, power_of, tau


class SpindleBearing(Lagged):
    name = "spindle_bearing"
    family = "spindle"
    meaning = "growth of the spindle with its bearing temperature: k F{dT}"
    source = "papers 000, 002 (first-order part of the printed functions)"
    needs = (Need("temperature", "temperature", ("spindle.bearing",)),)
    params = (tau(45, 1, 360),)
    gains = (gain("um/K", 0.2, 40, "displacement at rest a kelvin of the bearing"),)


class SpindleBearing2:
    name = "spindle_bearing_2"
    refines = ("spindle_bearing",)
    family = "spindle"
    meaning = "growth of the spindle in two modes: k1 F_fast{dT} + k2 F_slow{dT}; two slopes in cooling"
    source = "modelling.md section 5, row 1; papers 000, 002 (second-order functions)"
    needs = (Need("temperature", "temperature", ("spindle.bearing",)),)
    params = (
        tau(15, 1, 60, "tau_fast", "time constant of the shaft and bearings"),
        tau(150, 60, 360, "tau_slow", "time constant of the housing"),
    )
    gains = (gain("um/K", 0, 40, "fast part", "gain_fast"), gain("um/K", 0, 40, "slow part", "gain_slow"))

    def basis(self, drivers: Drivers, p: Mapping[str, float]) -> Float2D:
        u, step = drivers.values["temperature"], step_of(drivers)
        return np.column_stack([lag(u, p["tau_fast"] * 60, step), lag(u, p["tau_slow"] * 60, step)])


class SpindleMotor(Lagged):
    name = "spindle_motor"
    family = "spindle"
    meaning = "growth with the temperature of the motor winding: k F{dT}; large at low speed"
    source = "modelling.md section 5, row 2; paper 002, SP3"
    needs = (Need("temperature", "temperature", ("spindle.motor",)),)
    params = (tau(40, 10, 120),)
    gains = (gain("um/K", 0.1, 5, "displacement at rest a kelvin of the winding"),)


class SpindleFriction(Lagged):
    name = "spindle_friction"
    family = "spindle"
    meaning = "friction heat of the spindle from its speed, where no sensor sees it: k F{(n/10000 rpm)^p}"
    source = "modelling.md section 5, row 3"
    needs = (Need("speed", "rotational_speed", ("spindle",)),)
    params = (tau(45, 2, 360), exponent())
    gains = (gain("um", 0.5, 60, "displacement at rest at 10000 rpm"),)

    def drive(self, drivers: Drivers, p: Mapping[str, float]) -> Float1D:
        return power_of(drivers.values["speed"], REFERENCE_SPEED_RPM, p["exponent"])


class CentrifugalShift:
    name = "centrifugal_shift"
    family = "centrifugal"
    meaning = "shift of the shaft under centrifugal load, at once and reversible: k (n/10000 rpm)^2"
    source = "modelling.md section 5, row 4"
    needs = (Need("speed", "rotational_speed", ("spindle",)),)
    params = ()
    gains = (gain("um", 0.5, 30, "displacement at 10000 rpm"),)

    def basis(self, drivers: Drivers, p: Mapping[str, float]) -> Float2D:
        return column(power_of(drivers.values["speed"], REFERENCE_SPEED_RPM, 2.0))


class SpindleHeatingCooling:
    """The state follows tau_on while the spindle turns and tau_off while it stands: air moves heat."""

    name = "spindle_heating_cooling"
    refines = ("spindle_bearing",)
    family = "spindle"
    meaning = "heating that differs from cooling: k F{dT} with tau_on while the spindle turns, else tau_off"
    source = "modelling.md section 5, row 5; paper 001 (separate functions for heating and cooling)"
    needs = (Need("temperature", "temperature", ("spindle.bearing",)), Need("speed", "rotational_speed", ("spindle",)))
    params = (
        tau(45, 1, 360, "tau_on", "time constant while turning"),
        tau(90, 1, 720, "tau_off", "time constant while standing"),
    )
    gains = (gain("um/K", 0.2, 40, "displacement at rest a kelvin of the bearing"),)

    def basis(self, drivers: Drivers, p: Mapping[str, float]) -> Float2D:
        u, step = drivers.values["temperature"], step_of(drivers)
        turning = np.abs(drivers.values["speed"]) > 1.0
        edges = np.flatnonzero(np.diff(turning)) + 1
        out, state = np.empty(len(u)), 0.0
        for a, b in zip([0, *edges], [*edges, len(u)], strict=True):
            seconds = p["tau_on" if turning[a] else "tau_off"] * 60
            first = max(a - 1, 0)  # carry the state over from the last sample before
            part = lag(u[first:b], seconds, step, state)
            out[a:b] = part[a - first :]
            state = float(part[-1])
        return column(out)


class SpeedDependentGain:
    """Two gains, k and k beta: T acts more or less where the spindle turns."""

    name = "speed_dependent_gain"
    refines = ("spindle_bearing",)
    family = "spindle"
    meaning = "the gain of the bearing temperature depends on the speed: k F{dT (n/10000 rpm)}"
    source = "modelling.md section 5, row 26"
    needs = (Need("temperature", "temperature", ("spindle.bearing",)), Need("speed", "rotational_speed", ("spindle",)))
    params = (tau(45, 1, 360),)
    gains = (gain("um/K", 0, 20, "change of the gain at 10000 rpm"),)

    def basis(self, drivers: Drivers, p: Mapping[str, float]) -> Float2D:
        u = drivers.values["temperature"] * drivers.values["speed"] / REFERENCE_SPEED_RPM
        return column(lag(u, p["tau"] * 60, step_of(drivers)))
