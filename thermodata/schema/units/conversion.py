"""From one unit to another: what a value and a difference of two values are in it."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

from thermodata.errors import UsageError
from thermodata.schema.units.scale import counted_unit, scaled_unit
from thermodata.schema.units.unit import normal_unit, pint_units, read_unit

_TURNING = ("turn", "kiloturn", "revolutions_per_minute", "kilorevolutions_per_minute", "revolution", "kilorevolution")


def _power_of_turns(read: Any) -> float:
    """The power of turns in a unit: 1 for rpm, -1 for mm by the turn."""
    return float(sum(power for name, power in read._units.items() if name in _TURNING))


def _per_time_only(read: Any) -> bool:
    """Whether a unit is 1/time without an angle: Hz, 1/d."""
    angles = any("radian" in name or "degree" in name or "arc" in name or name == "grade" for name in read._units)
    return read.dimensionality == {"[time]": -1} and not angles and _power_of_turns(read) == 0


@lru_cache(maxsize=4096)
def linear_conversion(unit: str, target: str) -> tuple[float, float]:
    """(factor, offset) with value_target = factor * value_unit + offset; UsageError where they don't convert."""
    (scale, bare), (goal_scale, bare_goal) = scaled_unit(unit), scaled_unit(target)
    source, goal = normal_unit(bare), normal_unit(bare_goal)
    if source == goal:
        return scale / goal_scale, 0.0
    try:
        registry = pint_units()
        read, wanted = read_unit(source), read_unit(goal)
        if _per_time_only(read) and _power_of_turns(wanted) == 1:
            read = read * registry.turn  # what is counted by the second is turns, not radians
        if _power_of_turns(read) < 0 <= _power_of_turns(wanted):
            raise ValueError("a length by the turn is no length")
        at_0 = float(registry.Quantity(0.0, read).to(wanted).magnitude)
        at_1 = float(registry.Quantity(1.0, read).to(wanted).magnitude)
    except Exception as error:
        raise UsageError(
            f"unit '{unit}' does not convert to '{target}'",
            expected=f"a unit of the same kind as {target}",
            got=unit,
            hint="declare the channel's unit in the campaign file (unit: ...)",
        ) from error
    return (at_1 - at_0) * scale / goal_scale, at_0 / goal_scale


def declared_conversion(unit: str, target: str) -> tuple[float, float]:
    """The same of a unit that somebody declares, who may say how much one count is: '0.0078125 degC', '20 nm'."""
    try:
        return linear_conversion(unit, target)
    except UsageError:
        counted = counted_unit(unit)
        if counted is None:
            raise
    factor, offset = linear_conversion(counted[1], target)
    return factor * counted[0], offset


def converts(unit: str, target: str) -> bool:
    """Whether values in one unit can be given in another."""
    try:
        linear_conversion(unit, target)
    except UsageError:
        return False
    return True


def delta_factor(unit: str, target: str) -> float:
    """Factor of a difference: 1 K is 1 degC, 1 degF is 0.556 K. UsageError where they don't convert."""
    return linear_conversion(unit, target)[0]
