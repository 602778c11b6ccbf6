"""Numbers that keep the digits they were printed with: 0.98650 says more than 0.9865.

What a printed coefficient leaves open is half a unit of its last digit, and the sums of a transfer function's
coefficients are often smaller than that.
"""

from __future__ import annotations

from contextlib import suppress
from decimal import Decimal, InvalidOperation
from math import isfinite
from typing import Annotated, Any

from pydantic import PlainSerializer, PlainValidator, WithJsonSchema

from thermodata.errors import UsageError
from thermodata.schema.strict.declared import WrongValueError
from thermodata.schema.units.value import split_value


class Printed(float):
    """A number with the text that it was read from. Calculates, compares and hashes as the number."""

    text: str

    def __new__(cls, value: str | float) -> Printed:
        made = super().__new__(cls, value)
        made.text = value.text if isinstance(value, Printed) else value if isinstance(value, str) else repr(value)
        return made

    def __reduce__(self) -> tuple[type[Printed], tuple[str]]:
        return Printed, (self.text,)


class WithUnit(Printed):
    """A number with its unit, '18 min': as a number 18, which means nothing until it is in the effect's own unit."""

    def __new__(cls, text: str) -> WithUnit:
        made = float.__new__(cls, split_value(text)[0])
        made.text = text
        return made

    def __reduce__(self) -> tuple[type[WithUnit], tuple[str]]:
        return WithUnit, (self.text,)


def rounding(value: float) -> float:
    """Half a unit of the last printed digit; 0 for a whole number, which is exact."""
    text = value.text if isinstance(value, Printed) else repr(float(value))
    try:
        exponent = Decimal(text.strip()).as_tuple().exponent
    except InvalidOperation:
        return 0.0
    return 0.5 * 10.0**exponent if isinstance(exponent, int) and exponent < 0 and value != int(value) else 0.0


def _read_printed(value: Any) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float | str):
        raise ValueError("a number is wanted")
    try:
        number = Printed(value if isinstance(value, str) else float(value) if isinstance(value, int) else value)
    except ValueError:
        return _with_unit(str(value))
    # the shortest text of a number says no more than the number
    return number if number.text != repr(float(number)) else float(number)


def _with_unit(text: str) -> float:
    with suppress(UsageError):
        if split_value(text)[1]:
            return WithUnit(text)
    raise WrongValueError(f"'{text}' is no number", expected="a number, in the effect's unit or with one: 18 min")


def _write_printed(value: float) -> str | float:
    if isinstance(value, Printed):
        return value.text
    return float(value) if isfinite(value) else str(value)  # JSON has no infinite number


def _read_plainly(value: Any) -> float:
    number = _read_printed(value)
    return number if isinstance(number, WithUnit) else float(number)


PrintedNumber = Annotated[
    float,
    PlainValidator(_read_printed),
    PlainSerializer(_write_printed, when_used="json"),
    WithJsonSchema({"type": ["number", "string"]}),
]
"""A number of a file, or one with its unit; as JSON it is text where only that keeps its digits or the unit."""
NumberOrUnit = Annotated[
    float,
    PlainValidator(_read_plainly),
    PlainSerializer(_write_printed, when_used="json"),
    WithJsonSchema({"type": ["number", "string"]}),
]
"""The same, of which the digits say nothing: 1e-3 and 0.001 are one, and so are the ids of models with either."""
