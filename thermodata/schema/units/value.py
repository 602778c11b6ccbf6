"""A number with its unit, as it stands in a file of a user or on a command line: '9000 rpm', '1 h 30 min'."""

from __future__ import annotations

import math
import re

from thermodata.errors import UsageError
from thermodata.schema.units.conversion import linear_conversion
from thermodata.schema.units.time_of_parts import time_of_parts

_QUANTITY_TEXT = re.compile(r"^\s*([+-]?(?:\d+(?:[.,]\d*)?|[.,]\d+)(?:[eE][+-]?\d+)?)\s*(.*?)\s*$")


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
