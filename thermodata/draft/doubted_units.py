"""A unit that only values suggest, where they suit another unit of the field as well: 8 rpm of a spindle are krpm."""

from __future__ import annotations

from dataclasses import replace

from thermodata.draft import units
from thermodata.draft.quantity import Guess, range_text
from thermodata.draft.values import Values

_NO_HALL_C = 45.0  # of whose rest a hall's 20 degC may be read in Fahrenheit
_NO_REST_C = 60.0  # no bearing, column or oil begins a log above that, though a motor may run there
_AIR = ("hall", "floor", "outside")
# spindles turn with hundreds of rpm; in krpm, or in turns a second, a test has fewer than this
_FEW_RPM = 60.0
_SLOW = ("table", "rotary", "axis", "workpiece")  # these turn so slowly


def doubted(found: Guess, name: str, values: Values) -> Guess:
    """With a question where values of a channel without a unit may be of another one than `found` has."""
    asked = None
    if found.quantity == "temperature" and found.unit == "degC":
        least = _coldest(values)
        closed = _NO_HALL_C if units.may_be_fahrenheit(name) or _stands_at(found, _AIR) else _NO_REST_C
        asked = "degF, or degC?" if values.n > 0 and least >= closed else None
    elif found.quantity == "rotational_speed" and found.unit == "rpm" and not _stands_at(found, _SLOW):
        asked = "krpm, 1/s, or rpm?" if 0.0 < max(abs(values.low), abs(values.high)) <= _FEW_RPM else None
    if asked is None:
        return found
    return replace(found, sure=False, questions=(*found.questions, f"unit: {asked} ({range_text(values)})"))


def _coldest(values: Values) -> float:
    """The lowest reading; without the zeros that a logger writes where it lost one."""
    return min(values.first, values.median) if values.low == 0.0 else values.low


def _stands_at(found: Guess, places: tuple[str, ...]) -> bool:
    return (found.at or "").split(".")[0] in places
