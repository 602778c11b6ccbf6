"""What torque and current of a drive heat, on machines that log these and neither a power nor a temperature there: two
channels of which neither alone tells the heat, or one that tells it by its square."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping

import numpy as np

from thermodata.effect.law import Law
from thermodata.plugin import Drivers, Float1D, Need

from .shared import CUTTING_HEAT, MOTOR_HEAT, SCREW_FRICTION, Lagged, gain, power_of, tau

KILOWATTS_PER_NM_RPM = 2 * math.pi / 60 / 1000


class CuttingTorque(Lagged):
    """Heat of the cut, by torque and speed of the spindle, of a control that logs these and no power.

        d = k F_tau{|M n| 2 pi / 60000}

    k [um/kW], tau [min], torque M [N m], n [rpm].
    Source: as cutting_power, which is torque times speed; bounds: docs/model.md#bounds-of-the-effects
    """

    name = "cutting_torque"
    cause = CUTTING_HEAT
    family = "{s}cutting"
    meaning = "heat of cutting from the spindle's torque and speed: k F{|M n|}, where no power is logged"
    equation = "d = k F_tau{|M n| 2 pi / 60000}"
    telltale = "twin of cutting_power; told apart from other heat by the same path as an air cut"
    source = "as cutting_power, which is torque times speed; bounds: docs/model.md#bounds-of-the-effects"
    needs = (
        Need("torque", "torque", ("{s}spindle", "{s}spindle.motor")),
        Need("speed", "rotational_speed", ("{s}spindle",)),
    )
    params = (tau(30, 1, 240),)
    gains = (gain("um/kW", 5, 300, "displacement at rest a kilowatt"),)
    driven = (f"abs(torque * speed) * {KILOWATTS_PER_NM_RPM!r}",)

    def drive(self, drivers: Drivers, p: Mapping[str, float]) -> Float1D:
        return np.abs(drivers.values["torque"] * drivers.values["speed"]) * KILOWATTS_PER_NM_RPM


class ScrewPower(Lagged):
    """What the motor of an axis takes to move it is friction of the screw, its nut, its bearings and the guideway.

        d = k F_tau{|M v| / (10 N m 10 m/min)}

    k [um] at 10 N m and 10 m/min, tau [min], torque M of the motor [N m], v [m/min].
    Source: as feed_screw, torque times speed is power; bounds: docs/model.md#bounds-of-the-effects
    """

    name = "screw_power"
    closed_by = "scale"
    cause = SCREW_FRICTION
    family = "feed_{a}"
    meaning = "growth of the feed screw from the power that moves the axis: k F{|M v|}, of its motor's torque"
    equation = "d = k F_tau{|M v| / (10 N m 10 m/min)}"
    telltale = "twin of feed_screw; told apart by the same feed with another load on the table"
    source = "as feed_screw, torque times speed is power; bounds: docs/model.md#bounds-of-the-effects"
    needs = (
        Need("torque", "torque", ("axis.{a}", "axis.{a}.motor", "axis.{a}.screw")),
        Need("feed", "feed", ("axis.{a}",)),
    )
    params = (tau(60, 18, 240, reach=(1, 360)),)
    gains = (gain("um", 0.5, 60, "displacement at rest at 10 N m and 10 m/min"),)
    driven = ("abs(torque * feed / 100)",)

    def drive(self, drivers: Drivers, p: Mapping[str, float]) -> Float1D:
        return np.asarray(np.abs(drivers.values["torque"] * drivers.values["feed"] / 100.0))


class MotorLosses(Lagged):
    """gain * F_tau{(M / rated)^2}, or of the current or the load: the losses of a winding go with its current squared,
    and its torque with its current. A subclass states `rated` beside the attributes of the contract: role -> what the
    gain is told at."""

    rated: Mapping[str, float]

    def drive(self, drivers: Drivers, p: Mapping[str, float]) -> Float1D:
        ((role, values),) = drivers.values.items()
        return power_of(values, self.rated[role], 2.0)

    def law(self, roles: Collection[str], p: Mapping[str, float], step_s: float) -> tuple[Law, ...]:
        """The same as a formula; see `thermodata.effect.law`."""
        (role,) = roles
        return (f"lag(({role} / {self.rated[role]:g}) ** 2, tau)",)


class FeedMotorLosses(MotorLosses):
    """Losses in the winding of the axis motor flow into screw and slide.

        d = k F_tau{(M / 10 N m)^2}, or k F_tau{(I / 10 A)^2}, or k F_tau{(load / 50 %)^2}

    k [um] at 10 N m (10 A, 50 %), tau [min], torque M [N m], current I [A] or load [%] of the motor.
    Source: [mayr2012] on feed drives: copper losses go with the current squared; bounds:
    docs/model.md#bounds-of-the-effects
    """

    name = "feed_motor_losses"
    cause = MOTOR_HEAT
    family = "feed_{a}"
    meaning = "heat of the axis motor from its torque, current or load: k F{M^2}, where no sensor is at the motor"
    equation = "d = k F_tau{(M / 10 N m)^2}, or k F_tau{(I / 10 A)^2}, or k F_tau{(load / 50 %)^2}"
    telltale = "twin of feed_screw: the same axis moves; told apart by holding a load at rest"
    source = (
        "[mayr2012] on feed drives: copper losses go with the current squared; bounds: "
        "docs/model.md#bounds-of-the-effects"
    )
    needs = (
        Need("torque", "torque", ("axis.{a}", "axis.{a}.motor"), True),
        Need("current", "current", ("axis.{a}", "axis.{a}.motor"), True),
        Need("load", "load", ("axis.{a}", "axis.{a}.motor"), True),
    )
    params = (tau(60, 30, 180, reach=(1, 360)),)
    gains = (gain("um", 0.5, 60, "displacement at rest at 10 N m (10 A, 50 %)"),)
    rated = {"torque": 10.0, "current": 10.0, "load": 50.0}


class SpindleMotorLosses(MotorLosses):
    """Losses in the winding of the spindle's motor warm the headstock.

        d = k F_tau{(M / 50 N m)^2}, or k F_tau{(I / 50 A)^2}

    k [um] at 50 N m (50 A), tau [min], torque M [N m] or current I [A] of the motor.
    Source: [mayr2012] on spindles: copper losses go with the current squared; bounds:
    docs/model.md#bounds-of-the-effects
    """

    name = "spindle_motor_losses"
    cause = MOTOR_HEAT
    family = "{s}spindle"
    meaning = "heat of the spindle's motor from its torque or current: k F{M^2}, where no sensor is at the winding"
    equation = "d = k F_tau{(M / 50 N m)^2}, or k F_tau{(I / 50 A)^2}"
    telltale = "large at high torque, whatever the speed; told apart by one torque at two speeds"
    source = (
        "[mayr2012] on spindles: copper losses go with the current squared; bounds: docs/model.md#bounds-of-the-effects"
    )
    needs = (
        Need("torque", "torque", ("{s}spindle", "{s}spindle.motor"), True),
        Need("current", "current", ("{s}spindle", "{s}spindle.motor"), True),
    )
    params = (tau(40, 10, 120, reach=(1, 360)),)
    gains = (gain("um", 0.5, 60, "displacement at rest at 50 N m (50 A)"),)
    rated = {"torque": 50.0, "current": 50.0}
