"""What a signal is: its quantity, by unit where there is one, else by name, else by values. Never made up."""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np

from thermodata.draft.signals import units
from thermodata.draft.signals.numerals import asked
from thermodata.draft.signals.values import Values
from thermodata.draft.words.axis import axis_of
from thermodata.draft.words.listed import says
from thermodata.draft.words.vocabulary import DIFFERENCE, foreign_in, places_in, quantities_in
from thermodata.reader.times.time_units import found_epoch
from thermodata.schema.units.quantity import normal_unit
from thermodata.schema.units.spelling import bare_unit, is_of_humidity

NO_READING = "no reading"  # begins what is said of a column that nobody need be asked about
NOTHING = "quantity and unit?"  # begins what is asked of a signal of which neither name nor values say anything
_WEAK = ("a time stamp", "a number")  # words that stand beside others: 'Temp block 3'
_DELTA = re.compile(r"(?:d|δ) ?t(?:emp)?\b")  # 'dT_front', which begins at 0
_NO_HALL_C = 10.0  # colder than any machine that stands in a hall
# what creeps there between 5 and 80 is a temperature
_NEST = "nest. nid. nido."  # that holds the probes
OF_SENSOR = "a sensor's 4..20 mA?"  # begins the question for what such a signal measures
_SIGNAL_MA = (3.5, 21.0)  # NAMUR NE 43: what a sensor sends, with the marks of its failures
# places of parts whose current is that of a drive, and of ones that have none
_DRIVES = frozenset({"motor", "spindle", "pump", "fan", "drive"})
_OF_SENSORS = frozenset({"bearing", "bed", "column", "table", "hall", "floor", "outside", "window", "probe", "coolant"})
_AIR = {"hall", "floor", "bearing", "coolant", "outside", "window"}


@dataclass(frozen=True, slots=True)
class Guess:
    """A channel as it would stand in a campaign file. quantity None: no quantity fits, `why_not` says why. unit None:
    none, or the file's own; instead_of: the file's, where `unit` replaces it. sure: what was concluded leaves no
    doubt; basis: what it rests on ('name', 'unit',
    'values'); questions: what a person has to say."""

    quantity: str | None
    unit: str | None = None
    at: str | None = None
    axis: str | None = None
    sure: bool = False
    basis: tuple[str, ...] = ()
    questions: tuple[str, ...] = ()
    why_not: str | None = None
    instead_of: str | None = None

    def comment(self) -> str:
        """'sure: name and unit', 'guess: name only', or '? at: where on the machine?'."""
        if self.quantity is None:
            return str(self.why_not) if (self.why_not or "").startswith(NO_READING) else f"? {self.why_not}"
        rests = " and ".join(self.basis)
        if self.questions:
            return f"? {', '.join(self.questions)}" + (f" ({rests})" if rests else "")
        if self.sure:
            return f"sure: {rests}"
        return f"guess: {rests}" + (" only" if len(self.basis) == 1 else "")


def quantity_of(own: str, text: str, unit: str | None, dtype: str, values: Values | None) -> Guess:
    """What a signal measures. own: its name; text: the name with what stands over it; unit: None where the file says
    none; values: a sample of them, where there is one."""
    bare = unit is None or normal_unit(unit) == "dimensionless"
    if dtype == "str":
        if bare and values is not None and values.numerals:
            if values.units is not None:
                return Guess(None, unit, why_not=f"{asked(values.units)}, or quantity: label if they measure nothing")
            why = f"numbers kept as text ({values.span()}), which have no value: write them as numbers into the file"
            return Guess(None, unit, why_not=f"{why}, or quantity: label if they measure nothing")
        if bare and values is not None and values.text and not foreign_in(own):
            return Guess("state", basis=("name", "values") if places_in(own) else ("values",))  # ON and OFF
        if bare:
            return Guess("label", sure=True, basis=("text",))
        # numbers in a spelling that is none would be kept as words, and be missed in every view of values
        return Guess(None, unit, why_not=f"text, though {unit} is a unit of numbers: thermodata preview shows it")
    named = quantities_in(own) or quantities_in(text)
    foreign = foreign_in(own)
    if dtype == "bool":
        return Guess("state", sure=True, basis=("type",))
    if bare and values is not None and _since_a_date(values):
        return Guess(None, unit, why_not="a count of seconds since 1970: none of the quantities")
    if bare and values is not None and values.counts_rows and not named:
        return Guess(None, unit, why_not=f"{NO_READING}: it counts the rows")
    if bare and not foreign and _on_off(own, named, values):
        return Guess(
            "state",
            basis=("name", "values") if values is not None else ("name",),
            sure=values is not None and values.switch and "state" in named,
        )
    if foreign and not _stronger(named, own, unit):
        return Guess(None, unit, why_not=f"{foreign}: none of the quantities")
    if says(DIFFERENCE, own) and "temperature" in named:
        named = ("temperature_difference", *(q for q in named if q != "temperature"))
    if not bare:
        assert unit is not None
        return _by_unit(named, unit, own, values)
    return _by_name(named, own, values, dtype)


def _since_a_date(values: Values) -> bool:
    """Whether numbers are Unix time, in whatever unit of it, by their size."""
    return (found_epoch(np.array([values.low, values.high], np.float64)) or "").startswith("unix")


def _on_off(own: str, named: tuple[str, ...], values: Values | None) -> bool:
    """A switch by its values (0 and 1), or by a name that says so ('bDoor', 'coolant on') with values that allow it."""
    if values is not None and values.switch:
        return True
    fits = values is None or (values.whole and values.low >= 0 and values.high <= 1)
    return fits and ("state" in named or (own.startswith("b ") and not named and bool(places_in(own))))


def _stronger(named: tuple[str, ...], own: str, unit: str | None) -> bool:
    """Whether the unit proves a quantity that the name has too, beside a word of something else ('Temp block 3')."""
    if unit is None:
        return False
    possible = units.quantities_of(unit)
    weak = (foreign_in(own) or "").startswith(_WEAK)
    return possible[:1] in (("temperature",), ("rotational_speed",)) or (weak and any(q in possible for q in named))


def _by_unit(named: tuple[str, ...], unit: str, own: str, values: Values | None) -> Guess:
    possible = units.quantities_of(unit)
    both = [q for q in possible if q in named]
    if (size := units.kelvins(unit)) is not None:
        return _kelvin(named, unit, size, values)
    if is_of_humidity(unit):
        other = next((q for q in named if q not in ("state", "humidity")), None)
        if other and "%" not in unit:  # the right-hand one of two bearings, as well
            return Guess(None, unit, why_not=f"quantity: {other}, or humidity? the name says {other}, and then {unit}")
        asked = (f"quantity: {other}? the unit says humidity",) if other else ()
        sure = "humidity" in named and not asked
        return Guess("humidity", unit, sure=sure, basis=("name", "unit") if sure else ("unit",), questions=asked)
    if (
        both[:1] == ["temperature"]
        and _DELTA.match(own)
        and (values is None or _in_degc(values.low, unit) < _NO_HALL_C)
    ):
        which = f"quantity: temperature_difference, or temperature? the name may say a difference, in {unit}"
        return Guess("temperature", unit, basis=("name", "unit"), questions=(which,))
    if both and (both[0] != "voltage" or "displacement" not in both):
        return Guess(both[0], unit, sure=True, basis=("name", "unit"))
    if "displacement" in both:
        return Guess("displacement", unit, sure=True, basis=("name", "unit"))
    by_name = next((q for q in named if q not in ("state",) and _loosely(unit, q)), None)
    if by_name:
        return Guess(by_name, unit, sure=True, basis=("name", "unit"))
    normal = normal_unit(unit)
    if not possible and units.converts(unit, "rotational_speed") and "hz" not in unit.casefold():
        turns = f"quantity: rotational_speed, in turns a second, or a frequency? ({range_text(values)})"
        return Guess(None, unit, why_not=turns)
    if not possible and normal not in units.SHARES:
        return Guess(None, unit, why_not=f"no quantity has the unit {unit}")
    against = [q for q in named if q != "state"]
    if normal in units.SHARES:
        return Guess(None, unit, why_not=f"a share in {unit}: of what? quantity: load, humidity, or none")
    first = possible[0]
    if first == "voltage" and not against and (axis_of(own) or "") in ("x", "y", "z") and places_in(own) <= {"probe"}:
        return Guess("displacement", unit, basis=("name", "unit"))  # 'probe X', in volts
    if first == "voltage":
        return Guess("voltage", unit, basis=("unit",), questions=("what does it measure? then: quantity, calibration",))
    if normal == "mA" and (sent := _of_a_sensor(against, own, values)):
        return Guess("current", unit, basis=("unit",), questions=(sent,))
    if against and first not in ("temperature", "rotational_speed"):
        return Guess(
            first, unit, basis=("unit",), questions=(f"quantity: the name says {against[0]}, the unit {first}",)
        )
    if first == "position" and (axis_of(own) or "") in ("x", "y", "z") and _of_a_probe(own):
        how = "quantity: displacement, or the position of the axis?"
        return Guess("displacement", unit, basis=("name", "unit"), questions=(how,))
    if first == "position" and axis_of(own) is None:
        return Guess("position", unit, basis=("unit",), questions=("quantity: a length: position, or displacement?",))
    return Guess(first, unit, basis=("unit",))


def _of_a_sensor(against: list[str], own: str, values: Values | None) -> str | None:
    """What to ask of milliamperes that are a sensor's signal by the quantity or the place in the name, or by where they
    stand; None of a drive's."""
    places = places_in(own)
    low, high = (0.0, 0.0) if values is None else values.usual
    if against:
        return f"{OF_SENSOR} of {against[0]}"
    if (_SIGNAL_MA[0] <= low and high <= _SIGNAL_MA[1] and not places & _DRIVES) or places & _OF_SENSORS:
        span = "" if values is None else f" ({range_text(values)})"
        return f"{OF_SENSOR}{span} then quantity: what it measures, and a calibration"
    return None


def _of_a_probe(own: str) -> bool:
    """Whether a name with an axis says a probe, and no other place."""
    return (places_in(own) == {"probe"}) or (not places_in(own) and says(_NEST, own))


def _in_degc(value: float, unit: str) -> float:
    factor, offset = units.to_degc(unit)
    return factor * value + offset


def _loosely(unit: str, quantity: str) -> bool:
    """Whether a unit that several quantities share can be this one: %, deg, Hz, um/m."""
    if quantity in ("tilt", "angle"):
        return units.is_inclination(unit) and (quantity == "tilt" or "m/m" not in bare_unit(unit))
    if quantity in ("load", "humidity"):
        return normal_unit(unit) in units.SHARES
    return quantity == "rotational_speed" and units.converts(unit, quantity)


def _kelvin(named: tuple[str, ...], unit: str, size: float, values: Values | None) -> Guess:
    """K is a temperature above 200 and a difference below, unless the name says which. size: of the unit [K]."""
    if "temperature_difference" in named:
        return Guess("temperature_difference", unit, sure=True, basis=("name", "unit"))
    if values is not None and values.low * size > 200:
        return Guess("temperature", unit, sure="temperature" in named, basis=("unit", "values"))
    if values is not None and values.high * size < 150 and values.low * size < 60:
        return Guess(
            "temperature_difference",
            unit,
            basis=("unit", "values"),
            questions=(f"quantity: {values.span()} {unit} is a difference; or are they degC?",),
        )
    return Guess("temperature", unit, basis=("unit",), questions=("quantity: temperature, or temperature_difference?",))


def _by_name(named: tuple[str, ...], own: str, values: Values | None, dtype: str) -> Guess:
    named = tuple(q for q in named if not (q == "current" and len(named) > 1 and "current" in own))
    if "temperature" in named or "temperature_difference" in named:
        named = tuple(q for q in named if q in ("temperature", "temperature_difference"))
    if "state" in named and (len(named) == 1 or dtype.startswith(("int", "uint"))):
        return Guess("state", basis=("name",))
    named = tuple(q for q in named if q != "state")
    if len(named) > 1 and "rotational_speed" in named and "feed" in named:
        named = tuple(q for q in named if q != "rotational_speed")
    if len(named) > 1 and "displacement" in named and "position" in named:
        return Guess(None, why_not=f"quantity: displacement or position? ({range_text(values)})")
    if len(named) > 1:
        return Guess(None, why_not=f"quantity: {' or '.join(named)}? ({range_text(values)})")
    if named:
        return Guess(named[0], basis=("name",), sure=False)
    if (axis_of(own) or "") in ("x", "y", "z") and places_in(own) == {"probe"}:
        return Guess("displacement", basis=("name",))  # 'probe X'
    if (
        values is not None
        and not values.constant
        and values.slow
        and values.usual[0] >= 5
        and values.usual[1] <= 80
        and values.usual[1] - values.usual[0] <= 60
    ):
        if places_in(own) & _AIR:
            return Guess("temperature", basis=("name", "values"))
        return Guess(
            "temperature",
            basis=("values",),
            questions=(
                f"quantity: {values.usual[0]:.4g} to {values.usual[1]:.4g}, changing slowly: a temperature in degC?",
            ),
        )
    if "door" in places_in(own) and (values is None or values.distinct <= 2):
        return Guess("state", basis=("name",))
    return Guess(None, why_not=f"{NOTHING} ({range_text(values)})")


def range_text(values: Values | None) -> str:
    """Between which values a signal lies, in words."""
    if values is None:
        return "no values seen"
    return f"always {values.span()}" if values.constant else f"values {values.span()}"
