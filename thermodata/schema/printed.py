"""Numbers that keep the digits they were printed with: 0.98650 says more than 0.9865.

What a printed coefficient leaves open is half a unit of its last digit, and the sums of a transfer function's
coefficients are often smaller than that.
"""

from __future__ import annotations

from decimal import Decimal, InvalidOperation
from typing import Annotated, Any

from pydantic import PlainSerializer, PlainValidator, WithJsonSchema


class Printed(float):
    """A number with the text that it was read from. Calculates, compares and hashes as the number."""

    text: str

    def __new__(cls, value: str | float) -> Printed:
        made = super().__new__(cls, value)
        made.text = value.text if isinstance(value, Printed) else value if isinstance(value, str) else repr(value)
        return made

    def __reduce__(self) -> tuple[type[Printed], tuple[str]]:
        return Printed, (self.text,)


def rounding(value: float) -> float:
    """Half a unit of the last printed digit; 0 for a whole number, which is exact."""
    text = value.text if isinstance(value, Printed) else repr(float(value))
    try:
        exponent = Decimal(text.strip()).as_tuple().exponent
    except InvalidOperation:
        return 0.0
    return 0.5 * 10.0**exponent if isinstance(exponent, int) and exponent < 0 and value != int(value) else 0.0


def _read(value: Any) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float | str):
        raise ValueError("a number is wanted")
    try:
        number = Printed(value if isinstance(value, str) else float(value) if isinstance(value, int) else value)
    except ValueError:
        raise ValueError(f"'{value}' is no number") from None
    # the shortest text of a number says no more than the number
    return number if number.text != repr(float(number)) else float(number)


def _written(value: float) -> str | float:
    return value.text if isinstance(value, Printed) else value


PrintedNumber = Annotated[
    float,
    PlainValidator(_read),
    PlainSerializer(_written, when_used="json"),
    WithJsonSchema({"type": "number"}),
]
"""A number of a file; as JSON it is text where only that keeps its digits."""
