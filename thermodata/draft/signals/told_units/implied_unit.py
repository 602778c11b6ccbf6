"""The unit of a signal whose quantity is known: as its file or its name says it, or as its values imply it."""

from __future__ import annotations

from dataclasses import replace

from thermodata.draft.signals.quantity.guessed import Guess, range_text
from thermodata.draft.signals.told_units.doubted_units import MOST_OF_ONE, SHARED, hottest_c, is_fired
from thermodata.draft.signals.values import Values
from thermodata.schema.units.quantity import STATES
from thermodata.schema.units.unit import normal_unit

_IMPLIED = {
    "temperature": "degC",
    "rotational_speed": "rpm",
    "position": "mm",
    "load": "%",
    "humidity": "%",
    "current": "A",
    "torque": "N m",
    "voltage": "V",
}
_COLDEST_K = 250.0  # of a machine and its hall; 235 is 23.5 degC in tenths
_PLAUSIBLE = {
    "temperature": (-40.0, 200.0),
    "rotational_speed": (-60_000.0, 60_000.0),
    "position": (-30_000.0, 30_000.0),
    "load": (-400.0, 400.0),
    "humidity": (0.0, 100.0),
    "current": (-1000.0, 1000.0),
    "torque": (-5000.0, 5000.0),
    "voltage": (-1000.0, 1000.0),
}
_HINTS = {
    "displacement": "um, mm, m or V?",
    "feed": "m/min or mm/min?",
    "power": "kW, W or hp?",
    "pressure": "bar or MPa?",
    "flow": "l/min?",
    "irradiance": "W/m2?",
}


def with_unit(found: Guess, text: str, unit: str | None, written: str | None, values: Values | None) -> Guess:
    """With the unit as it would be written; a question where nothing says it. text: the name with those of the groups
    above; unit: as the file writes it; written: the one in the name; values: of a sample, None where there is none."""
    quantity = found.quantity or ""
    if quantity in STATES:
        return replace(found, unit=None)
    if unit is not None and normal_unit(unit) != "dimensionless":
        return _in_range(replace(found, unit=unit), text, values)
    if written is not None:
        basis = ("name",) if found.basis == ("name", "unit") else found.basis
        return _in_range(replace(found, unit=written, basis=basis), text, values)
    if unit is not None and quantity in SHARED:
        return _share(found, unit, values)
    if quantity in SHARED and values is not None and _may_be_of_one(values):
        asked = f'unit: "%", or is 1 100 %? then unit: pu ({range_text(values)})'
        return replace(found, unit=None, sure=False, questions=(*found.questions, asked))
    implied = _IMPLIED.get(quantity)
    if implied and values is not None and _plausible(quantity, values):
        basis = found.basis if "values" in found.basis else (*found.basis, "values")
        # the file says '-' or '1', which an ingest would hold against the unit
        return replace(found, unit=implied, sure=False, basis=basis, instead_of=unit)
    in_kelvins = quantity == "temperature" and values is not None and values.low > _COLDEST_K and values.high < 450
    if in_kelvins and values is not None and not is_fired(text):
        if values.whole:
            asked = f"unit: K, or tenths of a degree (0.1 degC)? ({range_text(values)})"
            return replace(found, unit=None, sure=False, questions=(*found.questions, asked))
        return replace(found, unit="K", sure=False, basis=(*found.basis, "values"), instead_of=unit)
    if implied and values is None and quantity in ("temperature", "rotational_speed"):
        asked = f"unit: {implied}?"
        return replace(found, unit=implied, sure=False, questions=(*found.questions, asked), instead_of=unit)
    hint = _HINTS.get(quantity, "")
    asked = f"unit: {hint} ({range_text(values)})" if hint else f"unit? ({range_text(values)})"
    return replace(found, unit=None, sure=False, questions=(*found.questions, asked))


def _share(found: Guess, unit: str, values: Values | None) -> Guess:
    """A load or a humidity whose file says '-' or '1': of 1, where it stays below, or else of 100."""
    if values is not None and values.high > MOST_OF_ONE:
        basis = (*found.basis, "values")
        return replace(found, unit="%", instead_of=unit, sure=False, basis=basis)
    asked = f'unit: the file says \'{unit}\', so 1 is read as 100 %; if 1 is 1 %: unit: "%", instead_of: "{unit}"'
    return replace(found, unit=unit, sure=False, questions=(*found.questions, f"{asked} ({range_text(values)})"))


def _may_be_of_one(values: Values) -> bool:
    """Whether a share without a unit stays so low that it may count from 0 to 1; whole numbers are per cent."""
    return not values.constant and not values.whole and max(-values.low, values.high) <= MOST_OF_ONE


def _plausible(quantity: str, values: Values) -> bool:
    low, high = _PLAUSIBLE[quantity]
    least, most = values.usual
    return least >= low and most <= high and not (quantity == "temperature" and values.switch)


def _in_range(found: Guess, text: str, values: Values | None) -> Guess:
    """A question where the values cannot be that: a temperature of 4000 degC is counts of a converter, or a broken
    sensor."""
    if values is None or found.quantity != "temperature" or normal_unit(found.unit or "") != "degC":
        return found
    if values.median > hottest_c(text) or values.median < -100:
        return replace(found, sure=False, questions=(*found.questions, f"values {values.span()}: raw counts, or K?"))
    return found
