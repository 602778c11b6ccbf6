"""Quantities, canonical units, and the one sign convention.

Sign: a displacement is positive when the tool centre point moves along the machine's + axis relative to
the table. Every channel comes to it by data (the jump test, or the probe's facing), never by a stray minus.
"""

from __future__ import annotations

import math
import re
from functools import lru_cache
from typing import Any, Literal, get_args

from thermodata.errors import UsageError, nearest
from thermodata.schema.units.prefixes import usual
from thermodata.schema.units.scale import counted_unit, scaled_unit
from thermodata.schema.units.signs import bare_unit, may_be_unit, plain_signs, unwrapped
from thermodata.schema.units.spelling import UNIT_SPELLING, spelled
from thermodata.schema.units.time_of_parts import time_of_parts

Quantity = Literal[
    "displacement",
    "tilt",
    "angle",
    "temperature",
    "temperature_difference",
    "rotational_speed",
    "feed",
    "power",
    "load",
    "current",
    "torque",
    "position",
    "flow",
    "pressure",
    "humidity",
    "irradiance",
    "voltage",
    "resistance",
    "state",
    "label",
]
QUANTITIES: tuple[str, ...] = get_args(Quantity)

CANONICAL_UNIT: dict[str, str] = {
    "displacement": "um",
    "tilt": "urad",
    "angle": "deg",
    "temperature": "degC",
    "temperature_difference": "K",
    "rotational_speed": "rpm",
    "feed": "m/min",
    "power": "kW",
    "load": "%",
    "current": "A",
    "torque": "N m",
    "position": "mm",
    "flow": "l/min",
    "pressure": "bar",
    "humidity": "%",
    "irradiance": "W/m2",
    "voltage": "V",
    "resistance": "Ohm",
    "state": "1",
    "label": "1",
}

MEASURED = ("displacement", "tilt", "angle")  # what a model explains, or shows it
PROBED = frozenset({"displacement", "tilt"})  # what a probe reads at the tool, of an axis and with a sign
NOT_DRIVERS = PROBED | {"label"}  # no cause of a displacement
STATES = frozenset({"state", "label"})  # held between samples, and without a unit
# an axis that goes to and fro rubs either way, while its mean is nothing; power that a drive feeds back heats nothing
UNDIRECTED = frozenset({"rotational_speed", "feed", "load", "current", "torque"})
SECONDS_PER_UNIT = {"s": 1.0, "min": 60.0, "h": 3600.0}  # of the time constants of effects

# What each is, in the words of the people who log it.
QUANTITY_MEANING: dict[str, str] = {
    "displacement": "of the tool centre point, or of another place, along an axis; what is modelled",
    "tilt": "a small rotation, from two displacements and their distance",
    "angle": "where a rotary axis or a table stands",
    "temperature": "of a part, a fluid or the air",
    "temperature_difference": "between two places, where only the difference is logged",
    "rotational_speed": "of spindle, table or rotary axis",
    "feed": "speed of a linear axis",
    "power": "drawn by a drive or a machine",
    "load": "of a drive, as a share of what it may give",
    "current": "of a motor or a drive",
    "torque": "of a motor or a drive",
    "position": "where a linear axis stands",
    "flow": "of coolant, oil or air",
    "pressure": "of a fluid or of compressed air",
    "humidity": "relative, of the air",
    "irradiance": "of sunlight on the machine",
    "voltage": "of a sensor that is not calibrated, or of a drive",
    "resistance": "of a sensor that is not converted",
    "state": "on or off, open or closed: 1 or 0, held between samples",
    "label": "text, such as a program's or a tool's name; held, never averaged",
}

# units in pint's spelling that need not be looked up: to begin, pint reads its definitions for half a second
AT_HAND = frozenset(
    {
        *(u for u in UNIT_SPELLING.values() if u != "per_unit"),  # which is defined here
        *(u for u in CANONICAL_UNIT.values() if u not in ("1", "%", "Ohm", "N m", "W/m2")),
        *("nm", "mm", "cm", "m", "mm/min", "m/s", "mm/s", "mrad", "rad", "degF", "s", "ms", "min", "h"),
        *("mV", "mA", "W", "N", "kN", "Pa", "kPa", "MPa", "mbar", "l/h", "kg"),
    }
)
_NEWTON_METRE = re.compile(r"(?<![^\W\d_])([km]?)Nm(?![^\W\d_])")  # pint takes 'Nm' for a number of metres
_QUANTITY_TEXT = re.compile(r"^\s*([+-]?(?:\d+(?:[.,]\d*)?|[.,]\d+)(?:[eE][+-]?\d+)?)\s*(.*?)\s*$")


def normal_unit(text: str) -> str:
    """The unit in pint's spelling, from what a lab wrote."""
    bare = bare_unit(text)
    # "nm" in lower case is nanometres; torque is written with a capital N
    if bare == "nm":
        return "nm"
    # in these the case of the prefix counts: mOhm and MOhm, mNm and MNm
    known = spelled(text)
    if known is not None:
        return _powers(known)
    if torque := re.fullmatch(r"(k|m|M|c|d|da|u|μ)?N[-·.*]?(m|mm|cm)", bare):
        return f"{torque[1] or ''}N*{torque[2]}"
    if resistance := re.fullmatch(r"([kMmGuμ]?)(?:[Oo]hms?|OHM|Ω|\u2126)", bare):
        return f"{resistance[1]}ohm"
    return _powers(unwrapped(plain_signs(text).strip()))


def _powers(unit: str) -> str:
    unit = _NEWTON_METRE.sub(r"(\1N*m)", unit)
    return re.sub(r"\b([kcdm]?m|ft|in)\^?([23])(?![\d.])", r"\1**\2", unit)


@lru_cache(maxsize=1)
def _registry() -> Any:
    import pint

    registry: Any = pint.UnitRegistry(autoconvert_offset_to_baseunit=False, cache_folder=None)
    registry.define("per_unit = 1")  # a share of what is rated, 1 of which is 100 %
    return registry


def _read(unit: str) -> Any:
    """Pint's unit; ValueError where it leaves signs out, or takes a lab's word for a prefix and a unit that nobody
    writes."""
    if not may_be_unit(unit):
        raise ValueError("a sign that no unit has")
    registry = _registry()
    read = registry.parse_units(unit)
    if not usual(registry, read._units):
        raise ValueError(f"read as {read}")
    return read


_TURNING = ("turn", "kiloturn", "revolutions_per_minute", "kilorevolutions_per_minute", "revolution", "kilorevolution")


def _turns(read: Any) -> float:
    """The power of turns in a unit: 1 for rpm, -1 for mm by the turn."""
    return float(sum(power for name, power in read._units.items() if name in _TURNING))


def _per_time_only(read: Any) -> bool:
    """Whether a unit is 1/time without an angle: Hz, 1/d."""
    angles = any("radian" in name or "degree" in name or "arc" in name or name == "grade" for name in read._units)
    return read.dimensionality == {"[time]": -1} and not angles and _turns(read) == 0


@lru_cache(maxsize=4096)
def linear_conversion(unit: str, target: str) -> tuple[float, float]:
    """(factor, offset) with value_target = factor * value_unit + offset; UsageError where they don't convert."""
    (scale, bare), (goal_scale, bare_goal) = scaled_unit(unit), scaled_unit(target)
    source, goal = normal_unit(bare), normal_unit(bare_goal)
    if source == goal:
        return scale / goal_scale, 0.0
    try:
        registry = _registry()
        read, wanted = _read(source), _read(goal)
        if _per_time_only(read) and _turns(wanted) == 1:
            read = read * registry.turn  # what is counted by the second is turns, not radians
        if _turns(read) < 0 <= _turns(wanted):
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


@lru_cache(maxsize=4096)
def is_unit(text: str) -> bool:
    """Whether the text is a unit at all (a lab's or pint's spelling)."""
    if not text.strip():
        return False
    normal = normal_unit(scaled_unit(text)[1])
    if normal in AT_HAND:
        return True
    try:
        _read(normal)
    except Exception:
        return False
    return True


def difference_unit(unit: str) -> str:
    """Of a difference of two values in a unit: K of temperatures."""
    return "K" if unit == "degC" else unit


def compound_unit(left: str, operator: Literal["*", "/"], right: str) -> str:
    """The unit of a product or quotient, '' where it has none; a temperature counts as a difference in it."""
    registry = _registry()
    a, b = (
        registry.parse_units({"degC": "K", "degF": "delta_degF"}.get(n, n) if (n := normal_unit(u)) else "")
        for u in (left, right)
    )
    unit = a * b if operator == "*" else a / b
    return "" if unit == registry.dimensionless else str(unit)


def canonical(quantity: str) -> str:
    """The canonical unit of a quantity."""
    if quantity not in CANONICAL_UNIT:
        raise UsageError(
            f"no quantity '{quantity}'",
            expected=", ".join(QUANTITIES),
            got=quantity,
            hint=f"did you mean '{close}'?" if (close := nearest(quantity, QUANTITIES)) else None,
        )
    return CANONICAL_UNIT[quantity]


def split_value(text: str | float | int) -> tuple[float, str]:
    """'9000 rpm' -> (9000.0, 'rpm'); a bare number has the unit ''. UsageError where there is no number."""
    if isinstance(text, bool) or not isinstance(text, str | float | int):
        raise UsageError("not a value with a unit", expected="for example '10 s'", got=repr(text))
    if not isinstance(text, str):
        return float(text), ""
    match = _QUANTITY_TEXT.match(text)
    if not match:
        raise UsageError("not a value with a unit", expected="for example '10 s'", got=repr(text))
    number = float(match[1].replace(",", "."))
    if not math.isfinite(number):  # of so many digits
        raise UsageError("a number that is too large", expected="for example '10 s'", got=repr(text))
    return number, match[2]


def value_in(text: str | float | int, unit: str) -> float:
    """'10 min' in 's' -> 600.0. A bare number is taken only where it is 0, for 0 is 0 in any unit; a time may have
    several parts: '1 h 30 min'."""
    if unit == "s" and (parts_s := time_of_parts(text)) is not None:
        return parts_s
    value, written = split_value(text)
    if not written:
        if value == 0 or unit in ("1", "dimensionless"):
            return value
        raise UsageError(
            "a value without a unit",
            expected=f"a unit of the kind of {unit}",
            got=str(text),
            hint=f"write '{text} {unit}'",
        )
    try:
        factor, offset = linear_conversion(written, unit)
    except UsageError as error:
        error.hint = f"write '{value:g} {unit}', if that is meant"  # nobody declares the unit of a value elsewhere
        raise
    return factor * value + offset
