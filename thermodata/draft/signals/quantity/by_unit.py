"""What a signal with a unit measures: each rule has an answer or leaves it to the next, the surest first."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from thermodata.calibration.platinum import R0_OHM, degrees
from thermodata.draft.signals import units
from thermodata.draft.signals.quantity.guessed import OF_SENSOR, Guess, range_text
from thermodata.draft.signals.values import Values
from thermodata.draft.words.axis import axis_of
from thermodata.draft.words.listed import holds_word
from thermodata.draft.words.vocabulary import places_in
from thermodata.schema.units.signs import bare_unit
from thermodata.schema.units.spelling import is_of_humidity
from thermodata.schema.units.unit import normal_unit

_DELTA = re.compile(r"(?:d|δ) ?t(?:emp)?\b")  # 'dT_front', which begins at 0
_NO_HALL_C = 10.0  # colder than any machine that stands in a hall
_NEST = "nest. nid. nido."  # that holds the probes
_SIGNAL_MA = (3.5, 21.0)  # NAMUR NE 43: what a sensor sends, with the marks of its failures
# places of parts whose current is that of a drive, and of ones that have none
_DRIVES = frozenset({"motor", "spindle", "pump", "fan", "drive"})
_OF_SENSORS = frozenset({"bearing", "bed", "column", "table", "hall", "floor", "outside", "window", "probe", "coolant"})
_PLATINUM = re.compile(r"(?:pt|rtd) ?\d*\b")
_COLD_C, _HOT_C = -15.0, 130.0  # that a thermometer on a machine reads
_SURELY = ("temperature", "rotational_speed")  # whose units nothing else has, whatever the name says


@dataclass(frozen=True)
class Called:
    """A signal with a unit. own: its name; named: the quantities that this says; possible: those that have the unit;
    values: a sample of them, where there is one."""

    own: str
    named: tuple[str, ...]
    unit: str
    possible: tuple[str, ...]
    values: Values | None

    @property
    def both(self) -> list[str]:
        """What unit and name both say."""
        return [q for q in self.possible if q in self.named]

    @property
    def against(self) -> list[str]:
        """What the name says of quantities, where the unit says none of them."""
        return [q for q in self.named if q != "state"]

    @property
    def is_linear(self) -> bool:
        """Whether the name has a linear axis."""
        return (axis_of(self.own) or "") in ("x", "y", "z")

    def likely(self, quantity: str) -> bool:
        """Whether it is the first of the quantities that have the unit."""
        return self.possible[:1] == (quantity,)

    def by_both(self, quantity: str) -> Guess:
        return Guess(quantity, self.unit, sure=True, basis=("name", "unit"))

    def none(self, why: str) -> Guess:
        return Guess(None, self.unit, why_not=why)

    def asked(self, quantity: str, question: str, *basis: str) -> Guess:
        return Guess(quantity, self.unit, basis=basis or ("unit",), questions=(question,))


def by_unit(own: str, named: tuple[str, ...], unit: str, values: Values | None) -> Guess:
    """What a signal of a unit measures. own: its name; named: the quantities that this says, the surest first."""
    signal = Called(own, named, unit, tuple(units.quantities_of(unit)), values)
    return next(found for rule in RULES if (found := rule(signal)) is not None)


def kelvins_are_a_temperature_or_a_difference(signal: Called) -> Guess | None:
    """A temperature above 200 K and a difference below, unless the name says which."""
    size, values = units.kelvins(signal.unit), signal.values
    if size is None:
        return None
    if "temperature_difference" in signal.named:
        return signal.by_both("temperature_difference")
    if values is not None and values.low * size > 200:
        sure = "temperature" in signal.named
        return Guess("temperature", signal.unit, sure=sure, basis=("unit", "values"))
    if values is not None and values.high * size < 150 and values.low * size < 60:
        which = f"quantity: {values.span()} {signal.unit} is a difference; or are they degC?"
        return signal.asked("temperature_difference", which, "unit", "values")
    return signal.asked("temperature", "quantity: temperature, or temperature_difference?")


def a_unit_of_humidity_says_so(signal: Called) -> Guess | None:
    if not is_of_humidity(signal.unit):
        return None
    other = next((q for q in signal.named if q not in ("state", "humidity")), None)
    if other and "%" not in signal.unit:  # the right-hand one of two bearings, as well
        return signal.none(f"quantity: {other}, or humidity? the name says {other}, and then {signal.unit}")
    if other:
        return signal.asked("humidity", f"quantity: {other}? the unit says humidity")
    sure = "humidity" in signal.named
    return Guess("humidity", signal.unit, sure=sure, basis=("name", "unit") if sure else ("unit",))


def a_delta_in_a_name_may_be_a_difference(signal: Called) -> Guess | None:
    if signal.both[:1] != ["temperature"] or not _DELTA.match(signal.own):
        return None
    if signal.values is not None and _in_degc(signal.values.low, signal.unit) >= _NO_HALL_C:
        return None
    which = f"quantity: temperature_difference, or temperature? the name may say a difference, in {signal.unit}"
    return signal.asked("temperature", which, "name", "unit")


def name_and_unit_agree(signal: Called) -> Guess | None:
    both = signal.both
    if not both:
        return None
    # a displacement in volts is one that its probe sends
    return signal.by_both("displacement" if both[0] == "voltage" and "displacement" in both else both[0])


def of_quantities_that_share_a_unit_the_name_tells_which(signal: Called) -> Guess | None:
    told = next((q for q in signal.against if _shares(signal.unit, q)), None)
    return None if told is None else signal.by_both(told)


def turns_a_second_may_be_a_frequency(signal: Called) -> Guess | None:
    unit = signal.unit
    if signal.possible or not units.converts(unit, "rotational_speed"):
        return None
    if "hz" in unit.casefold():
        if not any(place.startswith("spindle") for place in places_in(signal.own)):
            return None
        which = f"quantity: rotational_speed, in turns a second, or another frequency? ({range_text(signal.values)})"
        return signal.asked("rotational_speed", which, "name", "unit")
    return signal.none(f"quantity: rotational_speed, in turns a second, or a frequency? ({range_text(signal.values)})")


def a_share_is_of_something(signal: Called) -> Guess | None:
    if normal_unit(signal.unit) not in units.SHARES:
        return None
    return signal.none(f"a share in {signal.unit}: of what? quantity: load, humidity, or none")


def some_units_are_of_no_quantity(signal: Called) -> Guess | None:
    return None if signal.possible else signal.none(f"no quantity has the unit {signal.unit}")


def volts_of_a_probe_are_a_displacement(signal: Called) -> Guess | None:
    """'probe X', in volts."""
    of_a_probe = signal.is_linear and places_in(signal.own) <= {"probe"}
    if not signal.likely("voltage") or signal.against or not of_a_probe:
        return None
    return Guess("displacement", signal.unit, basis=("name", "unit"))


def volts_are_of_something(signal: Called) -> Guess | None:
    if not signal.likely("voltage"):
        return None
    return signal.asked("voltage", "what does it measure? then: quantity, calibration")


def milliamperes_may_be_of_a_sensor(signal: Called) -> Guess | None:
    """By the quantity or the place in the name, or by where they stand; not those of a drive."""
    if normal_unit(signal.unit) != "mA":
        return None
    places, values, against = places_in(signal.own), signal.values, signal.against
    low, high = (0.0, 0.0) if values is None else values.usual
    if against:
        return signal.asked("current", f"{OF_SENSOR} of {against[0]}")
    if (_SIGNAL_MA[0] <= low and high <= _SIGNAL_MA[1] and not places & _DRIVES) or places & _OF_SENSORS:
        span = "" if values is None else f" ({range_text(values)})"
        return signal.asked("current", f"{OF_SENSOR}{span} then quantity: what it measures, and a calibration")
    return None


def ohms_may_be_of_a_platinum_thermometer(signal: Called) -> Guess | None:
    """By the name, or by values that one has between the frost of a hall and the heat of a motor."""
    if not signal.likely("resistance") or "resistance" in signal.named:
        return None
    fits = None if signal.values is None else next((k for k in R0_OHM if _of_platinum(k, signal.values)), None)
    if fits is None and "temperature" not in signal.named and not _PLATINUM.match(signal.own):
        return None
    seen = f" ({range_text(signal.values)})"
    asked = f"calibration? what turns its ohms into degC?{seen} a curve (kind: pt100 to pt1000), or kind: linear"
    if fits is not None:
        curve = f"{{kind: {fits}}}"
        asked = f"calibration? a {fits.capitalize()}?{seen} then calibration: pt, and pt: {curve} under calibrations"
    return signal.asked("temperature", asked, "name" if fits is None else "values", "unit")


def a_unit_against_the_name_is_asked(signal: Called) -> Guess | None:
    first = signal.possible[0]
    if not signal.against or first in _SURELY:
        return None
    return signal.asked(first, f"quantity: the name says {signal.against[0]}, the unit {first}")


def a_length_may_be_of_a_probe_or_of_an_axis(signal: Called) -> Guess | None:
    if not signal.likely("position"):
        return None
    if signal.is_linear and _of_a_probe(signal.own):
        return signal.asked("displacement", "quantity: displacement, or the position of the axis?", "name", "unit")
    if axis_of(signal.own) is None:
        return signal.asked("position", "quantity: a length: position, or displacement?")
    return None


def else_it_is_the_likeliest_of_its_unit(signal: Called) -> Guess:
    return Guess(signal.possible[0], signal.unit, basis=("unit",))


RULES: tuple[Callable[[Called], Guess | None], ...] = (
    kelvins_are_a_temperature_or_a_difference,
    a_unit_of_humidity_says_so,
    a_delta_in_a_name_may_be_a_difference,
    name_and_unit_agree,
    of_quantities_that_share_a_unit_the_name_tells_which,
    turns_a_second_may_be_a_frequency,
    a_share_is_of_something,
    some_units_are_of_no_quantity,
    volts_of_a_probe_are_a_displacement,
    volts_are_of_something,
    milliamperes_may_be_of_a_sensor,
    ohms_may_be_of_a_platinum_thermometer,
    a_unit_against_the_name_is_asked,
    a_length_may_be_of_a_probe_or_of_an_axis,
    else_it_is_the_likeliest_of_its_unit,
)


def _of_platinum(kind: str, values: Values) -> bool:
    """Whether readings in ohm are those of a platinum thermometer on a machine."""
    low, high = degrees(np.array(values.usual), R0_OHM[kind])
    return bool(low >= _COLD_C and high <= _HOT_C)


def _of_a_probe(own: str) -> bool:
    """Whether a name with an axis says a probe, and no other place."""
    return (places_in(own) == {"probe"}) or (not places_in(own) and holds_word(_NEST, own))


def _in_degc(value: float, unit: str) -> float:
    factor, offset = units.to_degc(unit)
    return factor * value + offset


def _shares(unit: str, quantity: str) -> bool:
    """Whether a unit that several quantities share can be this one: %, deg, Hz, um/m."""
    if quantity in ("tilt", "angle"):
        return units.is_inclination(unit) and (quantity == "tilt" or "m/m" not in bare_unit(unit))
    if quantity in ("load", "humidity"):
        return normal_unit(unit) in units.SHARES
    return quantity == "rotational_speed" and units.converts(unit, quantity)
