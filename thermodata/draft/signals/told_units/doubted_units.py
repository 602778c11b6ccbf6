"""A unit that only values suggest, where they suit another unit of the field as well: 8 rpm of a spindle are krpm."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace

from thermodata.draft.signals import units
from thermodata.draft.signals.quantity.guessed import Guess, range_text
from thermodata.draft.signals.values import Values, least_reading
from thermodata.schema.units.unit import normal_unit
from thermodata.schema.words.places import AROUND

_NO_HALL_C = 45.0  # of whose rest a hall's 20 degC may be read in Fahrenheit
_NO_REST_C = 60.0  # no bearing, column or oil begins a log above that, though a motor may run there
# spindles turn with hundreds of rpm; in krpm, or in turns a second, a test has fewer than this
_FEW_RPM = 60.0
_FURTHEST_UM = 3000.0  # a tool is displaced by tenths of a millimetre
_NO_PART_C = 150.0  # and no motor is hotter all through its test
_COOL = ("bed", "column", "table", "crossbeam", "saddle", *AROUND)  # no heat is made there
# what never is colder counts kelvins: of a machine at -20 degC, and what runs hottest; counts of a converter beyond
# are asked for elsewhere
_COLDEST_K, _HOTTEST_K = 250.0, 400.0
_COLD_K = (280.0, 310.0)  # of what burns, before it was lit
# what a temperature says that has no unit of another kind, and of what burns or is fired [degC]
_HOTTEST_C, _HOTTEST_FIRE_C = 400.0, 1800.0
_FIRE = re.compile(
    r"\b(?:furnace|oven|kiln|exhaust|flue|burner|hot ?gas|ofen|abgas|rauchgas|brenner|hei(?:ss|ß)gas|spalin)"
)
# no machine tool draws, turns or feeds more: (how much, its unit, units that were meant)
_MOST = {
    "power": (500.0, "kW", "W"),
    "rotational_speed": (250_000.0, "rpm", "rpm"),
    "feed": (500.0, "m/min", "mm/min"),
}
MOST_OF_ONE = 2.5  # an overload of a drive that is logged as a share of 1
SHARED = ("load", "humidity")
_INCHES_MM = (25.4, 304.8)  # an inch, and a foot
_FURTHEST_MM = 5000.0  # an axis of a machine that is told in these travels less
_SLOW = ("table", "rotary", "axis", "workpiece")  # these turn so slowly


def doubted(found: Guess, name: str, values: Values) -> Guess:
    """With a question where values of a channel without a unit may be of another one than `found` has."""
    asked = None
    if found.quantity == "temperature" and found.unit == "degC":
        least = least_reading(values)
        closed = _NO_HALL_C if units.may_be_fahrenheit(name) or _stands_at(found, AROUND) else _NO_REST_C
        asked = "degF, or degC?" if values.n > 0 and least >= closed else None
    elif found.quantity == "rotational_speed" and found.unit == "rpm" and not _stands_at(found, _SLOW):
        asked = "krpm, 1/s, or rpm?" if 0.0 < max(abs(values.low), abs(values.high)) <= _FEW_RPM else None
    if asked is None:
        return found
    return replace(found, sure=False, questions=(*found.questions, f"unit: {asked} ({range_text(values)})"))


def is_fired(text: str) -> bool:
    """Whether a name says a furnace, a burner or its gas, which may be as hot as they like. text: its words."""
    return _FIRE.search(text) is not None


def hottest_c(text: str) -> float:
    """Beyond this a temperature of that name is counts of a converter, or a broken sensor [degC]."""
    return _HOTTEST_FIRE_C if is_fired(text) else _HOTTEST_C


def implausible(found: Guess, text: str, values: Values) -> Guess:
    """With a question where a unit that the file says makes readings of it that no machine gives: a header that was
    typed, and is wrong. text: the words of its name."""
    asks = _ASKS.get(found.quantity)
    if found.unit is None or values.n == 0 or asks is None:
        return found
    if found.quantity == "temperature" and not units.converts(found.unit, "temperature"):
        return found  # of ohms, whose curve is asked
    asked = asks(found, found.unit, text, values)
    return found if asked is None else replace(found, sure=False, questions=(*found.questions, asked))


def _of_a_share(_found: Guess, unit: str, _text: str, values: Values) -> str | None:
    top = max(-values.low, values.high)
    if normal_unit(unit) != "per_unit" or top <= MOST_OF_ONE:
        return None
    return f'unit: {unit}, or "%"? it goes up to {top:.3g}'


def _of_a_drive(found: Guess, unit: str, _text: str, values: Values) -> str | None:
    most, in_unit, others = _MOST[found.quantity or ""]
    top = max(-values.low, values.high) * units.factor_to(unit, in_unit)
    if top <= most:
        return None
    other = "" if normal_unit(unit) == normal_unit(others) else f", or {others}"
    return f"unit: {unit}{other}? it goes up to {top:.3g} {in_unit}, and no machine tool's does"


def _of_a_position(_found: Guess, unit: str, _text: str, values: Values) -> str | None:
    mm = round(units.factor_to(unit, "mm"), 6)
    top = max(-values.low, values.high) * mm
    if mm not in _INCHES_MM or top <= _FURTHEST_MM:
        return None
    return f"unit: {unit}, or mm? it goes up to {top / 1000:.3g} m"


def _of_a_displacement(_found: Guess, unit: str, _text: str, values: Values) -> str | None:
    span = (values.high - values.low) * units.factor_to(unit, "um")
    if span <= _FURTHEST_UM:
        return None
    return f"unit: {unit}? it goes over {span / 1000:.3g} mm, and a tool is displaced by far less"


def _of_a_temperature(found: Guess, unit: str, text: str, values: Values) -> str | None:
    if units.kelvins(unit) is not None:
        return None
    factor, offset = units.to_degc(unit)
    least = factor * least_reading(values) + offset
    coldest, warmest = _COLD_K if is_fired(text) else (_COLDEST_K, _HOTTEST_K)
    if coldest <= least <= warmest and factor * values.median + offset <= _HOTTEST_K:
        return f"unit: K, or {unit}? no reading is below {least:.3g} degC"
    if (_NO_REST_C if _stands_at(found, _COOL) else _NO_PART_C) <= least <= _COLDEST_K and not is_fired(text):
        return f"unit: {unit}? no reading is below {least:.3g} degC"
    return None


_ASKS: dict[str | None, Callable[[Guess, str, str, Values], str | None]] = {
    **dict.fromkeys(SHARED, _of_a_share),
    **dict.fromkeys(_MOST, _of_a_drive),
    "position": _of_a_position,
    "displacement": _of_a_displacement,
    "temperature": _of_a_temperature,
}
"""What to ask of a quantity in the unit of its file, where that is likely another."""


def _stands_at(found: Guess, places: tuple[str, ...]) -> bool:
    return (found.at or "").split(".")[0] in places
