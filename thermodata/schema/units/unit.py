"""A unit as pint reads it, of what a lab wrote; and the units of products, quotients and differences."""

from __future__ import annotations

import re
from functools import lru_cache
from typing import Any, Literal

from thermodata.schema.units.prefixes import usual
from thermodata.schema.units.quantity import CANONICAL_UNIT
from thermodata.schema.units.scale import scaled_unit
from thermodata.schema.units.signs import bare_unit, may_be_unit, plain_signs, unwrapped
from thermodata.schema.units.spelling import UNIT_SPELLING, spelled

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
def pint_units() -> Any:
    """Pint's registry of units, which takes half a second to make."""
    import pint

    registry: Any = pint.UnitRegistry(autoconvert_offset_to_baseunit=False, cache_folder=None)
    registry.define("per_unit = 1")  # a share of what is rated, 1 of which is 100 %
    return registry


def read_unit(unit: str) -> Any:
    """Pint's unit; ValueError where it leaves signs out, or takes a lab's word for a prefix and a unit that nobody
    writes."""
    if not may_be_unit(unit):
        raise ValueError("a sign that no unit has")
    registry = pint_units()
    read = registry.parse_units(unit)
    if not usual(registry, read._units):
        raise ValueError(f"read as {read}")
    return read


@lru_cache(maxsize=4096)
def is_unit(text: str) -> bool:
    """Whether the text is a unit at all (a lab's or pint's spelling)."""
    if not text.strip():
        return False
    normal = normal_unit(scaled_unit(text)[1])
    if normal in AT_HAND:
        return True
    try:
        read_unit(normal)
    except Exception:
        return False
    return True


def difference_unit(unit: str) -> str:
    """Of a difference of two values in a unit: K of temperatures."""
    return "K" if unit == "degC" else unit


def compound_unit(left: str, operator: Literal["*", "/"], right: str) -> str:
    """The unit of a product or quotient, '' where it has none; a temperature counts as a difference in it."""
    registry = pint_units()
    a, b = (
        registry.parse_units({"degC": "K", "degF": "delta_degF"}.get(n, n) if (n := normal_unit(u)) else "")
        for u in (left, right)
    )
    unit = a * b if operator == "*" else a / b
    return "" if unit == registry.dimensionless else str(unit)
