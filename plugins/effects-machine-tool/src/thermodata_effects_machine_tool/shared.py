"""What most effects share: one driver, one first-order lag, one gain."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Collection, Mapping, Sequence

import numpy as np

from thermodata.effect.lag import lag, lags_at, step_of
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
        """shape (n,): what is lagged, whatever its time constant."""
        return next(drivers.values[n.role] for n in self.needs if n.role in drivers.values)

    def basis(self, drivers: Drivers, p: Mapping[str, float]) -> Float2D:
        """Shape (n, 1): the lagged drive, for a gain of 1."""
        return column(lag(self.drive(drivers, p), p["tau"] * 60.0, step_of(drivers)))

    def bases(self, several: Sequence[Drivers], points: Sequence[Mapping[str, float]]) -> list[Float2D]:
        """The same at all points in each of several tests, shape (n, points) each; see `thermodata.plugin.Effect`."""
        if type(self).basis is not Lagged.basis:
            return [np.concatenate([self.basis(d, p) for p in points], axis=1) for d in several]
        alike: dict[tuple[tuple[str, float], ...], list[int]] = {}
        for i, p in enumerate(points):
            alike.setdefault(tuple((name, value) for name, value in p.items() if name != "tau"), []).append(i)
        steps_s, found = [step_of(d) for d in several], [np.empty((len(d.t_s), len(points))) for d in several]
        for places in alike.values():
            drives = [self.drive(d, points[places[0]]) for d in several]
            made = lags_at(drives, [points[i]["tau"] * 60.0 for i in places], steps_s)
            if len(alike) == 1:
                return made
            for whole, own in zip(found, made, strict=True):
                whole[:, places] = own
        return found

    def law(self, roles: Collection[str], p: Mapping[str, float], step_s: float) -> tuple[Law, ...]:
        """The same as a formula; see `thermodata.effect.law`."""
        known = {*roles, *(q.name for q in self.params)}
        drives = [*self.driven, *(n.role for n in self.needs)]
        return (f"lag({next(d for d in drives if symbols(tree(d)) <= known)}, tau)",)


class FastAndSlow(ABC):
    """What a temperature does by two lags, tau_fast and tau_slow. An effect states the attributes of the contract, and
    by `modes` how both make its columns."""

    @abstractmethod
    def modes(self, fast: Float1D, slow: Float1D) -> Float2D:
        """Both lags, shape (n,) each, as columns, shape (n, gains)."""

    def basis(self, drivers: Drivers, p: Mapping[str, float]) -> Float2D:
        """Shape (n, gains), for gains of 1."""
        u, step = drivers.values["temperature"], step_of(drivers)
        return self.modes(lag(u, p["tau_fast"] * 60, step), lag(u, p["tau_slow"] * 60, step))

    def bases(self, several: Sequence[Drivers], points: Sequence[Mapping[str, float]]) -> list[Float2D]:
        """The same at all points in each of several tests, shape (n, points * gains) each, with every lag made once;
        see `thermodata.plugin.Effect`."""
        asked = [(p["tau_fast"] * 60, p["tau_slow"] * 60) for p in points]
        taus_s = list(dict.fromkeys(tau_s for both in asked for tau_s in both))
        place = {tau_s: i for i, tau_s in enumerate(taus_s)}
        made = lags_at([d.values["temperature"] for d in several], taus_s, [step_of(d) for d in several])
        return [
            np.concatenate([self.modes(lags[place[fast]], lags[place[slow]]) for fast, slow in asked], axis=1)
            for lags in (np.ascontiguousarray(own.T) for own in made)
        ]


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
