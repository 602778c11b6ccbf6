"""What the entries of a campaign file are made of: strict models, and values with units."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from datetime import datetime
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, BaseModel, BeforeValidator, ConfigDict, JsonValue, ValidationInfo, model_validator

from thermodata.errors import ThermodataError
from thermodata.schema.units.conversion import converts
from thermodata.schema.units.value import split_value, value_in
from thermodata.schema.words.slips import slip_of

Value = str | float | int
Direction = Literal["+X", "-X", "+Y", "-Y", "+Z", "-Z", "+A", "-A", "+B", "-B", "+C", "-C"]

STORED = {"stored": True}  # validation context of what model_dump_json wrote: plain numbers in canonical units


# what the program itself writes into a file that it keeps: read again, and never offered to who writes one by hand
NOT_TYPED: dict[str, JsonValue] = {"readOnly": True}


class WrongKeyError(ValueError):
    """What is wrong with a key of a mapping, where its values are not: said at the line of the key."""

    def __init__(self, key: str, what: str, *, expected: str, hint: str) -> None:
        super().__init__(what)
        self.key, self.expected, self.hint = key, expected, hint


class MissingKeyError(ValueError):
    """A key that nothing else of its mapping tells, with the words that it may have."""

    def __init__(self, key: str, words: Sequence[str]) -> None:
        super().__init__(f"the key '{key}' is missing")
        self.key, self.words = key, tuple(words)


class WrongValueError(ValueError):
    """What is wrong with a value, and what would be right."""

    def __init__(self, what: str, *, expected: str, hint: str | None = None) -> None:
        super().__init__(what)
        self.expected, self.hint = expected, hint


def _as_wrong_value(error: ThermodataError) -> WrongValueError:
    return WrongValueError(error.what, expected=error.expected or "", hint=error.hint)


def in_unit(unit: str) -> BeforeValidator:
    """Takes a number in a unit, or text with one of its own; ValueError for text that is neither."""

    def convert(text: Any, info: ValidationInfo) -> float:
        if info.context == STORED and isinstance(text, int | float):
            return float(text)
        try:
            return value_in(text, unit)
        except ThermodataError as error:
            raise _as_wrong_value(error) from None

    return BeforeValidator(convert, json_schema_input_type=str | float)


def amount(*units: str, words: bool = False) -> BeforeValidator:
    """Takes a number, or text with one and a unit, and leaves it as it is; WrongValueError for what has a unit of
    another kind. units: of the kinds that will do; none: any. words: text without a number will do too."""

    def judge(value: Any, info: ValidationInfo) -> Any:
        if not isinstance(value, str) or info.context == STORED or (words and not re.match(r"\s*[-+.]?\d", value)):
            return value
        try:
            number, written = split_value(value)
        except ThermodataError as error:
            raise _as_wrong_value(error) from None
        if written and units and not any(converts(written, unit) for unit in units):
            right = " or ".join(f"'{number:g} {unit}'" for unit in units)
            raise WrongValueError(
                f"a value in '{written}'", expected=f"a unit of the kind of {' or '.join(units)}: {right}"
            )
        return value

    return BeforeValidator(judge)


def _as_a_path(value: Any) -> Any:
    """A number is no path: YAML makes text of one in quotes."""
    for one in value if isinstance(value, list) else [value]:
        if isinstance(one, bool | int | float):
            raise WrongValueError(
                "a number is no path",
                expected="a path below this file: raw/{test}.csv",
                hint=f'files: "{one}", if it is its name',
            )
    return value


def _as_a_place(value: Any) -> Any:
    """A place begins with a letter: of `17` nobody knows where it is."""
    if value is not None and not re.match(r"\s*[^\W\d_]", str(value)):
        raise WrongValueError(f"'{value}' is no place", expected="a dotted place on the machine: spindle.bearing.front")
    return value


def _in_nanoseconds(seconds: float) -> float:
    """A time that clocks can count: of at most 292 years."""
    if not abs(seconds) < 2**63 / 1e9:
        raise ValueError("a time of centuries: clocks count 292 years at most")
    return seconds


def _amount_that(holds: Callable[[float], bool], expected: str) -> AfterValidator:
    """Refuses an amount, with or without a unit, whose number can't be. Text without a number is left as it is."""

    def judge(value: Any, info: ValidationInfo) -> Any:
        if value is None or info.context == STORED:
            return value
        try:
            number, _ = split_value(value)
        except ThermodataError:
            return value
        if not holds(number):
            raise WrongValueError("a number that can't be", expected=expected)
        return value

    return AfterValidator(judge)


NOT_NEGATIVE = _amount_that(lambda number: number >= 0, "0 or more")
POSITIVE = _amount_that(lambda number: number > 0, "more than 0")

Seconds = Annotated[float, in_unit("s"), AfterValidator(_in_nanoseconds)]
Um = Annotated[float, in_unit("um")]
Amount = Annotated[Value, amount()]
Length = Annotated[Value, amount("mm"), NOT_NEGATIVE]
Position = Annotated[Value, amount("mm", "deg", words=True)]
Paths = Annotated[str | list[str], BeforeValidator(_as_a_path)]
At = Annotated[str, BeforeValidator(_as_a_place)]
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


class Attributed(Strict):
    """Base of what takes attributes of the user's own beside its keys. One that is a slip away from a key is asked."""

    model_config = ConfigDict(extra="allow", frozen=True)

    @model_validator(mode="before")
    @classmethod
    def _no_slip(cls, value: Any, info: ValidationInfo) -> Any:
        if isinstance(value, dict) and info.context != STORED:
            known = {field.alias or name for name, field in cls.model_fields.items()}
            for key in value:
                meant = None if key in known or key in cls.model_fields else slip_of(str(key), known - set(value))
                if meant is not None:
                    raise WrongKeyError(
                        str(key),
                        f"unknown key '{key}'",
                        expected=f"one of {', '.join(sorted(known))}, or an attribute that is called by none like them",
                        hint=f"did you mean '{meant}'?",
                    )
        return value
