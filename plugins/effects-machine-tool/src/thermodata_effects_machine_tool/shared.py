"""What most effects share: one driver, one first-order lag, one gain."""

from __future__ import annotations

from collections.abc import Collection, Mapping

import numpy as np

from thermodata.effect.lag import lag, step_of
from thermodata.effect.law import Law, symbols, tree
from thermodata.plugin import Drivers, Float1D, Float2D, Gain, Need, Param

# Speeds are divided by one fixed value and not by a test's own highest, or a gain would not carry over tests.
REFERENCE_SPEED_RPM = 10_000.0
REFERENCE_FEED_M_MIN = 10.0
REFERENCE_TURNING_RPM = 10.0  # of a rotary axis
# `cause` of effects: one heat, read by its temperature or by what drives it
MOTOR_HEAT = "heat of the motor"
SCREW_FRICTION = "friction of the feed screw"
CUTTING_HEAT = "cutting heat"  # also by what the cut warms


def tau(
    start: float,
    lower: float,
    upper: float,
    name: str = "tau",
    meaning: str = "time constant",
    reach: tuple[float, float] | None = None,
) -> Param:
    """A time constant [min]: where its search starts, its bounds, and those of an effect that is added."""
    return Param(name, "min", start, lower, upper, meaning, reach)


def gain(unit: str, smallest: float, largest: float, meaning: str, name: str = "gain") -> Gain:
    """A gain of either sign, with its plausible smallest and largest size in `unit`."""
    return Gain(name, unit, (smallest, largest), "any", meaning)


def exponent(start: float = 1.5) -> Param:
    """The exponent of friction heat [1]: 1 for friction that does not change with speed, 2 for a viscous one."""
    return Param("exponent", "1", start, 1.0, 2.5, "friction heat = |speed| ** exponent")


def column(values: Float1D) -> Float2D:
    """shape (n,) -> (n, 1)."""
    return np.asarray(values, dtype=np.float64).reshape(-1, 1)


def power_of(values: Float1D, reference: float, exponent: float) -> Float1D:
    """(|values| / reference) ** exponent, shape (n,)."""
    return np.asarray(np.abs(values / reference) ** exponent, dtype=np.float64)


class Lagged:
    """gain * F_tau{drive}. A subclass gives the attributes of the contract; `drive` is its first bound driver."""

    name: str
    family: str
    meaning: str
    source: str
    equation: str
    telltale: str
    needs: tuple[Need, ...]
    params: tuple[Param, ...]
    gains: tuple[Gain, ...]
    driven: tuple[str, ...] = ()  # `drive` as formulas, for `law`: the first whose drivers are bound

    def drive(self, drivers: Drivers, p: Mapping[str, float]) -> Float1D:
        """shape (n,): what is lagged."""
        return next(drivers.values[n.role] for n in self.needs if n.role in drivers.values)

    def basis(self, drivers: Drivers, p: Mapping[str, float]) -> Float2D:
        """Shape (n, 1): the lagged drive, for a gain of 1."""
        return column(lag(self.drive(drivers, p), p["tau"] * 60.0, step_of(drivers)))

    def law(self, roles: Collection[str], p: Mapping[str, float], step_s: float) -> tuple[Law, ...]:
        """The same as a formula; see `thermodata.effect.law`."""
        known = {*roles, *(q.name for q in self.params)}
        drives = [*self.driven, *(n.role for n in self.needs)]
        return (f"lag({next(d for d in drives if symbols(tree(d)) <= known)}, tau)",)


class GrowsWithPosition:
    """What grows with the position that it holds [mm], from a point that is fixed.

        d = alpha x F_tau{dT} + k0 F_tau{dT}

    An effect states name, family, meaning, source, needs (`temperature`, `position`), params (`tau`) and both gains.
    """

    def basis(self, drivers: Drivers, p: Mapping[str, float]) -> Float2D:
        """Shape (n, 2): the lagged temperature times the position [m], and alone, for gains of 1."""
        warmth = lag(drivers.values["temperature"], p["tau"] * 60, step_of(drivers))
        return np.column_stack([warmth * drivers.values["position"] / 1000.0, warmth])

    def law(self, roles: Collection[str], p: Mapping[str, float], step_s: float) -> tuple[Law, ...]:
        """The same as a formula; see `thermodata.effect.law`."""
        return ("lag(temperature, tau) * position / 1000", "lag(temperature, tau)")
