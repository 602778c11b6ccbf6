"""Conditions, poses and attributes of a test as plain numbers in canonical units, or as text."""

from __future__ import annotations

from typing import Any

from thermodata.errors import UsageError
from thermodata.schema.units.conversion import linear_conversion
from thermodata.schema.units.unit import normal_unit
from thermodata.schema.units.value import split_value

# tried in this order: what a condition of a thermal test is usually given in
_TARGETS = ("rpm", "m/min", "degC", "mm", "kW", "s", "bar", "l/min", "A", "N*m", "V", "percent", "deg", "kg", "N")
_SHOWN = {"N*m": "N m", "percent": "%"}  # as channels have them


def plain_value(value: Any) -> float | str | bool | None:
    """'9000 rpm' -> 9000.0, '6 m/min' -> 6.0, '0.5 h' -> 1800.0, 'air' -> 'air'; a length is in mm.

    A number whose unit is unknown keeps its text, for its number alone would say nothing.
    """
    return _value_and_unit(value)[0]


def plain_unit(value: Any) -> str | None:
    """The unit that `plain_value` gives a number in: '600 mm/min' -> 'm/min'; None of a text, and of a number that was
    written without one."""
    return _value_and_unit(value)[1]


def _value_and_unit(value: Any) -> tuple[float | str | bool | None, str | None]:
    if value is None or isinstance(value, bool):
        return value, None
    if isinstance(value, int | float):
        return float(value), None
    text = str(value)
    try:
        number, unit = split_value(text)
    except UsageError:
        return text, None
    if not unit:
        return number, None
    if normal_unit(unit) == "K":
        return number, "K"
    for target in _TARGETS:
        try:
            factor, offset = linear_conversion(unit, target)
        except UsageError:
            continue
        return factor * number + offset, _SHOWN.get(target, target)
    return text, None


def plain_values(values: dict[str, Any]) -> dict[str, Any]:
    """As `plain_value`, for each of a mapping, nested ones too."""
    return {
        k: plain_values(v)
        if isinstance(v, dict)
        else [plain_value(x) for x in v]
        if isinstance(v, list | tuple)
        else plain_value(v)
        for k, v in values.items()
    }
