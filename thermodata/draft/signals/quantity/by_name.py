"""What a signal without a unit measures, by its name, and where that says nothing by its values."""

from __future__ import annotations

from thermodata.draft.signals.quantity.guessed import NOTHING, Guess, range_text
from thermodata.draft.signals.values import Values
from thermodata.draft.words.axis import axis_of
from thermodata.draft.words.vocabulary import places_in

_AIR = {"hall", "floor", "bearing", "coolant", "outside", "window"}
# what creeps there is a temperature [degC], and so far at most [K]
_COLDEST_C, _HOTTEST_C, _FURTHEST_K = 5, 80, 60


def by_name(own: str, named: tuple[str, ...], values: Values | None, dtype: str) -> Guess:
    """What a signal without a unit measures. own: its name; named: the quantities that this says; values: a sample of
    them, where there is one."""
    told = _without_the_weaker(named, own)
    if "state" in told and (len(told) == 1 or dtype.startswith(("int", "uint"))):
        return Guess("state", basis=("name",))
    told = tuple(q for q in told if q != "state")
    if len(told) > 1 and "rotational_speed" in told and "feed" in told:
        told = tuple(q for q in told if q != "rotational_speed")
    if len(told) > 1 and "displacement" in told and "position" in told:
        return Guess(None, why_not=f"quantity: displacement or position? ({range_text(values)})")
    if len(told) > 1:
        return Guess(None, why_not=f"quantity: {' or '.join(told)}? ({range_text(values)})")
    if told:
        return Guess(told[0], basis=("name",), sure=False)
    return _by_place(own, values)


def _without_the_weaker(named: tuple[str, ...], own: str) -> tuple[str, ...]:
    """'current' is an adjective beside another quantity, and no name of a temperature says anything else."""
    told = tuple(q for q in named if not (q == "current" and len(named) > 1 and "current" in own))
    temperatures = tuple(q for q in told if q in ("temperature", "temperature_difference"))
    return temperatures or told


def _by_place(own: str, values: Values | None) -> Guess:
    """Of a name that says no quantity."""
    if (axis_of(own) or "") in ("x", "y", "z") and places_in(own) == {"probe"}:
        return Guess("displacement", basis=("name",))  # 'probe X'
    if values is not None and _creeps(values):
        if places_in(own) & _AIR:
            return Guess("temperature", basis=("name", "values"))
        low, high = values.usual
        asked = f"quantity: {low:.4g} to {high:.4g}, changing slowly: a temperature in degC?"
        return Guess("temperature", basis=("values",), questions=(asked,))
    if "door" in places_in(own) and (values is None or values.distinct <= 2):
        return Guess("state", basis=("name",))
    return Guess(None, why_not=f"{NOTHING} ({range_text(values)})")


def _creeps(values: Values) -> bool:
    """Whether they change slowly, and lie where the temperatures of machines do."""
    low, high = values.usual
    in_range = low >= _COLDEST_C and high <= _HOTTEST_C and high - low <= _FURTHEST_K
    return not values.constant and values.slow and in_range
