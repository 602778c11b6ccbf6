"""The spindle: bearings, motor, friction heat without a sensor, and the centrifugal shift."""

from __future__ import annotations

from collections.abc import Collection, Mapping

import numpy as np

from thermodata.effect.lag import lag_along, step_of
from thermodata.effect.law import Law
from thermodata.plugin import Drivers, Float1D, Float2D, Need

from .shared import (
    MOTOR_HEAT,
    REFERENCE_SPEED_RPM,
    FastAndSlow,
    Lagged,
    column,
    exponent,
    gain,
    power_of,
    tau,
)

BEARING_FRICTION = "bearing friction"  # one heat, read by its temperature or its speed: `cause` of these effects


class SpindleBearing(Lagged):
    """The spindle grows with the temperature of its bearings.

        d = k F_tau{dT}

    k [um/K], tau [min], dT [K] of the bearing.
    Source: [straka2021], [horejs2022] transfer functions; bounds:
    docs/model.md#bounds-of-the-effects
    """

    name = "spindle_bearing"
    cause = BEARING_FRICTION
    family = "{s}spindle"
    meaning = "growth of the spindle with its bearing temperature: k F{dT}"
    equation = "d = k F_tau{dT}"
    telltale = "heating and cooling with the spindle, slower than the bearing itself; told apart by a stop while warm"
    source = "[straka2021], [horejs2022] transfer functions; bounds: docs/model.md#bounds-of-the-effects"
    needs = (Need("temperature", "temperature", ("{s}spindle.bearing?",)),)
    params = (tau(45, 1, 360),)
    gains = (gain("um/K", 0.2, 40, "displacement at rest a kelvin of the bearing"),)


class SpindleBearing2(FastAndSlow):
    """The spindle grows in two modes: shaft and bearings, then the housing.

        d = k_fast F_tau_fast{dT} + k_slow F_tau_slow{dT}

    k_fast and k_slow [um/K], tau_fast and tau_slow [min], dT [K].
    Source: [straka2021], [horejs2022] functions of second order; bounds:
    docs/model.md#bounds-of-the-effects
    """

    name = "spindle_bearing_2"
    cause = BEARING_FRICTION
    refines = ("spindle_bearing",)
    family = "{s}spindle"
    meaning = "growth of the spindle in two modes: k1 F_fast{dT} + k2 F_slow{dT}; two slopes in cooling"
    equation = "d = k_fast F_tau_fast{dT} + k_slow F_tau_slow{dT}"
    telltale = "two slopes in one cooling; told apart by a long cooling"
    source = "[straka2021], [horejs2022] functions of second order; bounds: docs/model.md#bounds-of-the-effects"
    needs = (Need("temperature", "temperature", ("{s}spindle.bearing?",)),)
    params = (
        tau(15, 1, 60, "tau_fast", "time constant of the shaft and bearings"),
        tau(150, 60, 360, "tau_slow", "time constant of the housing"),
    )
    gains = (gain("um/K", 0, 40, "fast part", "gain_fast"), gain("um/K", 0, 40, "slow part", "gain_slow"))

    def modes(self, fast: Float1D, slow: Float1D) -> Float2D:
        return np.column_stack([fast, slow])

    def law(self, roles: Collection[str], p: Mapping[str, float], step_s: float) -> tuple[Law, ...]:
        """The same as a formula; see `thermodata.effect.law`."""
        return ("lag(temperature, tau_fast)", "lag(temperature, tau_slow)")


class SpindleMotor(Lagged):
    """The spindle grows with the temperature of its motor winding.

        d = k F_tau{dT}

    k [um/K], tau [min], dT [K] of the winding.
    Source: [horejs2022] motor temperatures of SP1 to SP3; bounds:
    docs/model.md#bounds-of-the-effects
    """

    name = "spindle_motor"
    cause = MOTOR_HEAT
    family = "{s}spindle"
    meaning = "growth with the temperature of the motor winding: k F{dT}; large at low speed"
    equation = "d = k F_tau{dT}"
    telltale = "large at low speed, where the bearings stay cool; told apart by 500 against 9000 rpm"
    source = "[horejs2022] motor temperatures of SP1 to SP3; bounds: docs/model.md#bounds-of-the-effects"
    needs = (Need("temperature", "temperature", ("{s}spindle.motor",)),)
    params = (tau(40, 10, 120, reach=(1, 360)),)
    gains = (gain("um/K", 0.1, 5, "displacement at rest a kelvin of the winding"),)


class SpindleGearbox(Lagged):
    """The gearbox between motor and spindle warms the headstock.

        d = k F_tau{dT}

    k [um/K], tau [min], dT [K] of the gearbox or its oil.
    Source: as spindle_motor, for a larger body; bounds: docs/model.md#bounds-of-the-effects
    """

    name = "spindle_gearbox"
    family = "{s}gearbox"
    meaning = "heat of the gearbox into the headstock: k F{dT of the gearbox}; goes on after a stop"
    equation = "d = k F_tau{dT}"
    telltale = "changes with the gear at one speed, slower than the bearings; told apart by one speed in two gears"
    source = "as spindle_motor, for a larger body; bounds: docs/model.md#bounds-of-the-effects"
    needs = (Need("temperature", "temperature", ("{s}spindle.gearbox",)),)
    params = (tau(60, 5, 360),)
    gains = (gain("um/K", 0.1, 10, "displacement at rest a kelvin of the gearbox"),)


class SpindleFriction(Lagged):
    """Friction heat of the spindle, by its speed, where no sensor sees it.

        d = k F_tau{(|n| / 10000 rpm)^p}

    k [um] at 10000 rpm, tau [min], p [1], n [rpm].
    Source: [mayr2012] on spindles; bounds: docs/model.md#bounds-of-the-effects
    """

    name = "spindle_friction"
    cause = BEARING_FRICTION
    family = "{s}spindle"
    meaning = "friction heat of the spindle from its speed, where no sensor sees it: k F{(n/10000 rpm)^p}"
    equation = "d = k F_tau{(|n| / 10000 rpm)^p}"
    telltale = "not linear in the speed; told apart by three speeds"
    source = "[mayr2012] on spindles; bounds: docs/model.md#bounds-of-the-effects"
    needs = (Need("speed", "rotational_speed", ("{s}spindle",)),)
    params = (tau(45, 2, 360), exponent())
    gains = (gain("um", 0.5, 60, "displacement at rest at 10000 rpm"),)
    driven = ("abs(speed / 10000) ** exponent",)

    def drive(self, drivers: Drivers, p: Mapping[str, float]) -> Float1D:
        return power_of(drivers.values["speed"], REFERENCE_SPEED_RPM, p["exponent"])


class CentrifugalShift:
    """The turning shaft shifts under centrifugal load, at once and reversibly.

        d = k (n / 10000 rpm)^2

    k [um] at 10000 rpm, n [rpm].
    Source: [abele2010] on spindles at speed; bounds: docs/model.md#bounds-of-the-effects
    """

    name = "centrifugal_shift"
    family = "{s}centrifugal"
    meaning = "shift of the shaft under centrifugal load, at once and reversible: k (n/10000 rpm)^2"
    equation = "d = k (n / 10000 rpm)^2"
    telltale = "a jump within a minute of a change of speed that goes back with it; told apart by short pulses of speed"
    source = "[abele2010] on spindles at speed; bounds: docs/model.md#bounds-of-the-effects"
    needs = (Need("speed", "rotational_speed", ("{s}spindle",)),)
    params = ()
    gains = (gain("um", 0.5, 30, "displacement at 10000 rpm"),)

    def basis(self, drivers: Drivers, p: Mapping[str, float]) -> Float2D:
        return column(power_of(drivers.values["speed"], REFERENCE_SPEED_RPM, 2.0))

    def law(self, roles: Collection[str], p: Mapping[str, float], step_s: float) -> tuple[Law, ...]:
        """The same as a formula; see `thermodata.effect.law`."""
        return ("(speed / 10000) ** 2",)


class SpindleHeatingCooling:
    """Heating differs from cooling: the air that a turning spindle moves carries heat away.

        tau dd/dt + d = k dT, tau = tau_on while |n| > 1 rpm, else tau_off

    d [um], k [um/K], tau_on and tau_off [min], dT [K], n [rpm].
    Source: [horejs2010] separate functions for heating and cooling; bounds:
    docs/model.md#bounds-of-the-effects
    """

    name = "spindle_heating_cooling"
    cause = BEARING_FRICTION
    refines = ("spindle_bearing",)
    family = "{s}spindle"
    meaning = "heating that differs from cooling: k F{dT} with tau_on while the spindle turns, else tau_off"
    equation = "tau dd/dt + d = k dT, tau = tau_on while |n| > 1 rpm, else tau_off"
    telltale = "a lobe in cooling only; told apart by a stop while warm"
    source = "[horejs2010] separate functions for heating and cooling; bounds: docs/model.md#bounds-of-the-effects"
    needs = (
        Need("temperature", "temperature", ("{s}spindle.bearing?",)),
        Need("speed", "rotational_speed", ("{s}spindle",)),
    )
    params = (
        tau(45, 1, 360, "tau_on", "time constant while turning"),
        tau(90, 1, 720, "tau_off", "time constant while standing"),
    )
    gains = (gain("um/K", 0.2, 40, "displacement at rest a kelvin of the bearing"),)

    def basis(self, drivers: Drivers, p: Mapping[str, float]) -> Float2D:
        turning = np.abs(drivers.values["speed"]) > 1.0
        taus_s = np.where(turning, p["tau_on"], p["tau_off"]) * 60
        return column(lag_along(drivers.values["temperature"], taus_s, step_of(drivers)))

    def law(self, roles: Collection[str], p: Mapping[str, float], step_s: float) -> tuple[Law, ...]:
        """The same as a formula; see `thermodata.effect.law`."""
        return ("lag(temperature, where(abs(speed) > 1, tau_on, tau_off))",)


class SpeedDependentGain(Lagged):
    """The gain of the bearing's temperature changes with the speed.

        d = k F_tau{dT n / 10000 rpm}

    k [um/K] at 10000 rpm, tau [min], dT [K], n [rpm].
    Source: [horejs2022] spindle SP3; bounds: docs/model.md#bounds-of-the-effects
    """

    name = "speed_dependent_gain"
    cause = BEARING_FRICTION
    refines = ("spindle_bearing",)
    family = "{s}spindle"
    meaning = "the gain of the bearing temperature depends on the speed: k F{dT (n/10000 rpm)}"
    equation = "d = k F_tau{dT n / 10000 rpm}"
    telltale = "the same temperature acts otherwise at another speed; told apart by one temperature at two speeds"
    source = "[horejs2022] spindle SP3; bounds: docs/model.md#bounds-of-the-effects"
    needs = (
        Need("temperature", "temperature", ("{s}spindle.bearing?",)),
        Need("speed", "rotational_speed", ("{s}spindle",)),
    )
    params = (tau(45, 1, 360),)
    gains = (gain("um/K", 0, 20, "change of the gain at 10000 rpm"),)

    def drive(self, drivers: Drivers, p: Mapping[str, float]) -> Float1D:
        return drivers.values["temperature"] * drivers.values["speed"] / REFERENCE_SPEED_RPM

    def law(self, roles: Collection[str], p: Mapping[str, float], step_s: float) -> tuple[Law, ...]:
        """The same as a formula; see `thermodata.effect.law`."""
        return ("lag(temperature * speed / 10000, tau)",)
