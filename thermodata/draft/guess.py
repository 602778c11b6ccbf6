"""What a signal is: its quantity, unit, place and axis, by name, unit and values, and how sure that is.

The unit decides where the name does not, the name where there is no unit, the values where there is neither; what they
disagree on, and what none of them says, becomes a question. A quantity is never made up.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache

from thermodata.draft import units
from thermodata.draft.place import Place, axis_of, place_of
from thermodata.draft.values import Values
from thermodata.draft.vocabulary import DIFFERENCE, LIMIT, SETPOINT, foreign_in, places_in, quantities_in, says
from thermodata.draft.words import words
from thermodata.reader.text import split_unit
from thermodata.schema.quantity import is_unit, normal_unit

_IMPLIED = {"temperature": "degC", "rotational_speed": "rpm", "position": "mm", "load": "%", "humidity": "%",
            "current": "A", "torque": "N m", "voltage": "V"}
_PLAUSIBLE = {"temperature": (-40.0, 200.0), "rotational_speed": (-60_000.0, 60_000.0),
              "position": (-30_000.0, 30_000.0),
              "load": (-400.0, 400.0), "humidity": (0.0, 100.0), "current": (-1000.0, 1000.0),
              "torque": (-5000.0, 5000.0), "voltage": (-1000.0, 1000.0)}
# what creeps there between 5 and 80 is a temperature
_AIR = {"hall", "floor", "bearing", "coolant", "outside", "window"}
_WEAK = ("a time stamp", "a number")                    # words that stand beside others: 'Temp block 3'
_NEVER_DIFFERENCES = ("feed", "position", "rotational_speed", "torque", "current", "pressure")
_NEEDS_PLACE = ("temperature", "temperature_difference", "power", "load", "current", "torque", "position", "flow",
                "pressure", "displacement", "rotational_speed")


@dataclass(frozen=True, slots=True)
class Guess:
    """A channel as it would stand in a campaign file. quantity None: no quantity fits, `why_not` says why. unit None:
    none, or the file's own. sure: what was concluded leaves no doubt; basis: what it rests on ('name', 'unit',
    'values'); questions: what a person has to say."""

    quantity: str | None
    unit: str | None = None
    at: str | None = None
    axis: str | None = None
    sure: bool = False
    basis: tuple[str, ...] = ()
    questions: tuple[str, ...] = ()
    why_not: str | None = None

    def comment(self) -> str:
        """'sure: name and unit', 'guess: name only', or '? at: where on the machine?'."""
        if self.quantity is None:
            return f"? {self.why_not}"
        rests = " and ".join(self.basis)
        if self.questions:
            return f"? {', '.join(self.questions)}" + (f" ({rests})" if rests else "")
        if self.sure:
            return f"sure: {rests}"
        return f"guess: {rests}" + (" only" if len(self.basis) == 1 else "")


@lru_cache(maxsize=50_000)
def guess(name: str, unit: str | None, dtype: str = "float64", values: Values | None = None) -> Guess:
    """Quantity, unit, place and axis of a signal. unit: as the file writes it; values: of a sample, if there is one."""
    bare = split_unit(name)[0]                            # the 'min' of 'n [1/min]' is no limit
    own, text = words(_last(bare)), words(bare)
    written = units.from_name(_last(bare)) if not unit else None
    known = unit or written
    if known and not is_unit(known):
        found = _quantity(own, text, None, dtype, values)
        if _digital(dtype, values):
            return _place(found, own, text)
        asked = f"unit: the file says '{known}', which is no unit known here"
        return replace(_place(replace(found, unit=None), own, text), sure=False, questions=(asked,)) \
            if found.quantity else found
    found = _quantity(own, text, known, dtype, values)
    if found.quantity is None or found.quantity == "label":
        return found
    return _place(_unit(found, unit, written, values), own, text)


def _last(name: str) -> str:
    """The last part of a path of names: 'Temp/T06' -> 'T06', '/hall/air.top' -> 'air.top'."""
    return name.rstrip("/").rsplit("/", 1)[-1] or name


def _digital(dtype: str, values: Values | None) -> bool:
    return dtype in ("bool", "str") or (values is not None and values.switch)


def _quantity(own: str, text: str, unit: str | None, dtype: str, values: Values | None) -> Guess:
    if dtype == "str":
        return Guess("label", sure=True, basis=("text",))
    named = quantities_in(own) or quantities_in(text)
    foreign = foreign_in(own)
    bare = unit is None or normal_unit(unit) == "dimensionless"
    if dtype == "bool":
        return Guess("state", sure=True, basis=("type",))
    if bare and not foreign and _on_off(own, named, values):
        return Guess("state", basis=("name", "values") if values is not None else ("name",),
                     sure=values is not None and values.switch and "state" in named)
    if foreign and not _stronger(named, own, unit):
        return Guess(None, unit, why_not=f"{foreign}: none of the quantities")
    if says(DIFFERENCE, own) and "temperature" in named:
        named = ("temperature_difference", *(q for q in named if q != "temperature"))
    if not bare:
        assert unit is not None
        return _by_unit(named, unit, own, values)
    return _by_name(named, own, values, dtype)


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
    if normal_unit(unit) == "K" and "temperature" in (*named, "temperature"):
        return _kelvin(named, unit, values)
    if both and (both[0] != "voltage" or "displacement" not in both):
        return Guess(both[0], unit, sure=True, basis=("name", "unit"))
    if "displacement" in both:
        return Guess("displacement", unit, sure=True, basis=("name", "unit"))
    by_name = next((q for q in named if q not in ("state",) and _loosely(unit, q)), None)
    if by_name:
        return Guess(by_name, unit, sure=True, basis=("name", "unit"))
    if not possible:
        return Guess(None, unit, why_not=f"no quantity has the unit {unit}")
    normal, first = normal_unit(unit), possible[0]
    against = [q for q in named if q != "state"]
    if normal == "percent":
        return Guess(None, unit, why_not="a share in %: of what? quantity: load, humidity, or none")
    if first == "voltage" and not against and (axis_of(own) or "") in ("x", "y", "z") and places_in(own) <= {"probe"}:
        return Guess("displacement", unit, basis=("name", "unit"))      # 'probe X', in volts
    if first == "voltage":
        return Guess("voltage", unit, basis=("unit",), questions=("what does it measure? then: quantity, calibration",))
    if normal == "mA" and against:
        return Guess("current", unit, basis=("unit",), questions=(f"a sensor's 4..20 mA? of {against[0]}",))
    if against and first not in ("temperature", "rotational_speed"):
        return Guess(first, unit, basis=("unit",),
                     questions=(f"quantity: the name says {against[0]}, the unit {first}",))
    if first == "position" and axis_of(own) is None:
        return Guess("position", unit, basis=("unit",), questions=("quantity: a length: position, or displacement?",))
    return Guess(first, unit, basis=("unit",))


def _loosely(unit: str, quantity: str) -> bool:
    """Whether a unit that several quantities share can be this one: %, deg, Hz, um/m."""
    normal = normal_unit(unit)
    allowed = {"percent": ("load", "humidity"), "turn/second": ("rotational_speed",), "urad": ("tilt",),
               "deg": ("tilt", "angle"), "rpm": ("rotational_speed",)}
    return quantity in allowed.get(normal, ())


def _kelvin(named: tuple[str, ...], unit: str, values: Values | None) -> Guess:
    """K is a temperature above 200 and a difference below, unless the name says which."""
    if "temperature_difference" in named:
        return Guess("temperature_difference", unit, sure=True, basis=("name", "unit"))
    if values is not None and values.low > 200:
        return Guess("temperature", unit, sure="temperature" in named, basis=("unit", "values"))
    if values is not None and values.high < 150 and values.low < 60:
        return Guess("temperature_difference", unit, basis=("unit", "values"),
                     questions=(f"quantity: {values.span()} K is a difference; or are they degC?",))
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
        return Guess(None, why_not=f"quantity: displacement or position? ({_seen(values)})")
    if len(named) > 1:
        return Guess(None, why_not=f"quantity: {' or '.join(named)}? ({_seen(values)})")
    if named:
        return Guess(named[0], basis=("name",), sure=False)
    if values is not None and not values.constant and values.slow and values.low >= 5 and values.high <= 80 \
            and values.high - values.low <= 60:
        if places_in(own) & _AIR:
            return Guess("temperature", basis=("name", "values"))
        return Guess("temperature", basis=("values",),
                     questions=(f"quantity: {values.span()}, changing slowly: a temperature in degC?",))
    if "door" in places_in(own) and (values is None or values.distinct <= 2):
        return Guess("state", basis=("name",))
    return Guess(None, why_not=f"quantity and unit? ({_seen(values)})")


def _seen(values: Values | None) -> str:
    if values is None:
        return "no values seen"
    return f"always {values.span()}" if values.constant else f"values {values.span()}"


def _unit(found: Guess, unit: str | None, written: str | None, values: Values | None) -> Guess:
    """The unit as it would be written; a question where nothing says it."""
    quantity = found.quantity or ""
    if quantity in ("state", "label"):
        return replace(found, unit=None)
    if unit is not None and normal_unit(unit) != "dimensionless":
        return _in_range(replace(found, unit=unit), values)
    if written is not None:
        basis = ("name",) if found.basis == ("name", "unit") else found.basis
        return _in_range(replace(found, unit=written, basis=basis), values)
    implied = _IMPLIED.get(quantity)
    if implied and values is not None and _plausible(quantity, values):
        basis = found.basis if "values" in found.basis else (*found.basis, "values")
        return replace(found, unit=implied, sure=False, basis=basis)
    if quantity == "temperature" and values is not None and values.low > 200 and values.high < 450:
        return replace(found, unit="K", sure=False, basis=(*found.basis, "values"))
    if implied and values is None and quantity in ("temperature", "rotational_speed"):
        return replace(found, unit=implied, sure=False, questions=(*found.questions, f"unit: {implied}?"))
    hint = {"displacement": "um, mm or V?", "feed": "m/min or mm/min?", "power": "kW or W?", "pressure": "bar or MPa?",
            "flow": "l/min?"}.get(quantity, "")
    asked = f"unit: {hint} ({_seen(values)})" if hint else f"unit? ({_seen(values)})"
    return replace(found, unit=None, sure=False, questions=(*found.questions, asked))


def _plausible(quantity: str, values: Values) -> bool:
    low, high = _PLAUSIBLE[quantity]
    return values.low >= low and values.high <= high and not (quantity == "temperature" and values.switch)


def _in_range(found: Guess, values: Values | None) -> Guess:
    """A question where the values cannot be that: a temperature of 4000 degC is counts of a converter, or a broken
    sensor."""
    if values is None or found.quantity != "temperature" or normal_unit(found.unit or "") != "degC":
        return found
    if values.median > 400 or values.median < -100:
        return replace(found, sure=False, questions=(*found.questions, f"values {values.span()}: raw counts, or K?"))
    return found


def _place(found: Guess, own: str, text: str) -> Guess:
    if found.quantity == "position" and (axis_of(own) or "") in ("a", "b", "c") and "unit" not in found.basis:
        # a rotary axis stands at an angle, whatever length was taken for its unit
        found = replace(found, quantity="angle", unit="deg", sure=False, questions=("unit: deg?",))
    quantity = found.quantity or ""
    place, axis = place_of(own, quantity), axis_of(own)
    nowhere = not places_in(own) and axis is None and quantity != "displacement"
    if place.at is None or (quantity in _NEEDS_PLACE and nowhere):
        wider = place_of(text, quantity)
        if wider.at is not None and (places_in(text) or axis_of(text)) and not _group_is_test(text, own):
            # the folder of names above tells where: less sure than the name itself
            place = Place(wider.at, False, wider.question)
    axis = axis or (axis_of(text) if quantity in ("displacement", "tilt") else None)
    questions = list(found.questions)
    if place.question and (quantity in _NEEDS_PLACE or quantity == "state"):
        questions.append(place.question)
    letter = axis.upper() if axis and quantity in ("displacement", "tilt") else None
    if quantity == "displacement" and place.at == "tcp" and letter is None:
        questions.append("axis?")
    if says(SETPOINT, own) and quantity not in ("state", "displacement"):
        questions.append("a set value, not the actual one?")
    elif says(LIMIT, own) and quantity not in ("state", "displacement"):
        questions.append("a limit, or a reading?")
    elif says(DIFFERENCE, own) and quantity in _NEVER_DIFFERENCES:
        questions.append("a difference, not the quantity itself?")
    if found.basis == ("unit",) and place.sure and quantity not in ("position", "voltage"):
        found = replace(found, basis=("name", "unit"), sure=True)      # degC at a bearing: the name need not say T
    sure = found.sure and (place.sure or place.at is None) and not questions
    return replace(found, at=place.at, axis=letter, sure=sure, questions=tuple(dict.fromkeys(questions)))


def _group_is_test(text: str, own: str) -> bool:
    """A group called 'Spindle test 3' or 'measurement' names the test, not the place."""
    return says("test. tests. run. versuch. messung. measurement. mereni. 试验 测试", text.removesuffix(own))
