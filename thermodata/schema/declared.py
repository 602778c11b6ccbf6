"""What the entries of a campaign file are made of: strict models, and values with units."""

from __future__ import annotations

import re
from datetime import datetime
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, BaseModel, BeforeValidator, ConfigDict, ValidationInfo

from thermodata.errors import ThermodataError
from thermodata.schema.quantity import value_in

Value = str | float | int
Direction = Literal["+X", "-X", "+Y", "-Y", "+Z", "-Z", "+A", "-A", "+B", "-B", "+C", "-C"]

STORED = {"stored": True}  # validation context of what model_dump_json wrote: plain numbers in canonical units


class WrongKeyError(ValueError):
    """What is wrong with a key of a mapping, where its values are not: said at the line of the key."""

    def __init__(self, key: str, what: str, *, expected: str, hint: str) -> None:
        super().__init__(what)
        self.key, self.expected, self.hint = key, expected, hint


def in_unit(unit: str) -> BeforeValidator:
    """Takes a number in a unit, or text with one of its own; ValueError for text that is neither."""

    def convert(text: Any, info: ValidationInfo) -> float:
        if info.context == STORED and isinstance(text, int | float):
            return float(text)
        try:
            return value_in(text, unit)
        except ThermodataError as error:
            raise ValueError("; ".join(str(error).splitlines())) from None

    return BeforeValidator(convert, json_schema_input_type=str | float)


def _in_nanoseconds(seconds: float) -> float:
    """A time that clocks can count: of at most 292 years."""
    if not abs(seconds) < 2**63 / 1e9:
        raise ValueError("a time of centuries: clocks count 292 years at most")
    return seconds


Seconds = Annotated[float, in_unit("s"), AfterValidator(_in_nanoseconds)]
Um = Annotated[float, in_unit("um")]
# YAML makes a date of what looks like one
Moment = Annotated[Value, BeforeValidator(lambda x: x.isoformat(" ") if isinstance(x, datetime) else x)]


def date_and_time(value: Any) -> Any:
    """A date with a time of day, as text; YAML makes a datetime of some."""
    if value is None or isinstance(value, datetime):
        return None if value is None else value.isoformat(" ")
    try:
        datetime.fromisoformat(str(value))
    except ValueError:
        raise ValueError(f"'{value}' is no date and time such as 2026-03-02 08:00") from None
    if not re.search(r"\d[ T]\d", str(value)):
        raise ValueError(f"'{value}' has no time of day; expected one such as 2026-03-02 08:00")
    return str(value)


class Strict(BaseModel):
    """Base of all that users write. Unknown keys are refused; the loader names the nearest right one."""

    model_config = ConfigDict(extra="forbid", frozen=True, populate_by_name=True, coerce_numbers_to_str=True)
