"""A unit at the end of a name that counts only beside the quantity that the name says: 'spindle_speed_Hz',
'torque_kNm', 'feed_mm_s', 'probe_z_m'."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping

from thermodata.draft.signals import units
from thermodata.draft.signals.quantity.guessed import range_text
from thermodata.draft.signals.values import Values
from thermodata.schema.units.unit import is_unit

# units in lower case behind a name, as ROS and pandas have them, only beside such a quantity: 'power_hp',
# but 'pump_hp' is of high pressure, 'T_kw' of cooling water, and 'T_spindle_m' of a motor
_BESIDE: Mapping[str, Mapping[str, str]] = {
    # one letter alone may be an axis or a phase: 'drive_power_w', 'motor_current_a'
    "power": {"kw": "kW", "hp": "hp", "w": "W"},
    "displacement": {"m": "m", "nm": "nm", "in": "in"},
    "position": {"m": "m", "in": "in", "ft": "ft"},
    "temperature": {"k": "K"},
}
_LOWER_AT_END = re.compile(r"(?<=[^_.\s])_([a-z]{1,2})$")
_INCH_AT_END = re.compile(r"(?<=[^_\s])(?:\s+|, ?)(in|ft)\.?$")  # 'X pos in', 'Z Height, in.'
_INPUT_AT_END = re.compile(r"(?<=[^_.,\s])(?:_|\s+)in$")
_COLDEST_K = 250.0
_SHARE_AT_END = re.compile(r"(?<=[^_.\s])[_.\s](pu|p\.u\.|frac|fract|fraction|ratio)$", re.IGNORECASE)
_MOST_KW = 500.0  # of a phase W, in kW; a machine's power in W goes beyond
_SMALL_IN = 0.004  # a tenth of a millimetre; a few micrometres if it were in mm
_FURTHEST_M = 0.05  # no tool is displaced by more
_SEPARATED = re.compile(
    r"[_.\s](?:(?P<above>[^\W\d_]+3?)_(?P<below>s|min|h|m|m2)|(?P<a_second>[^\W\d_]{1,3})ps|(?P<whole>[^\W\d_]{2,}))$"
)
_OR_NUMBER = re.compile(r"[_.\s]1_s$")  # 'speed_1_s': turns a second, or what is set of the first
# what two letters in lower case, or longer words, say beside a unit: 'pressure_at', the foot of a column
_SHORT = ("hz", "cm", "uv", "kv")
_WORDS = ("foot", "feet", "turn", "count")


def unit_of_quantity(name: str, quantity: str | None, values: Values | None) -> str | None:
    """The unit at the end of a name that says such a quantity: 'power_kw', 'probe_z_m', 'spindle_speed_Hz'. None
    where the values speak against it."""
    share = _SHARE_AT_END.search(name.strip())
    if share is not None and share[1].lower() in units.SHARE_WORDS.get(quantity or "", ()):
        return "pu"
    match = _LOWER_AT_END.search(name.strip()) or _INCH_AT_END.search(name.strip())
    unit = _BESIDE.get(quantity or "", {}).get(match[1]) if match else None
    if unit is None:
        return next((u for u in _said(name) if quantity is not None and units.may_be(u, quantity)), None)
    if unit == "m" and quantity == "displacement":
        return unit if values is not None and values.high - values.low < _FURTHEST_M else None
    if unit == "W":
        return unit if values is not None and values.high > _MOST_KW else None
    if unit == "K":
        return unit if values is not None and values.low > _COLDEST_K else None
    return unit


def inch_asked(name: str, quantity: str | None, values: Values | None) -> str | None:
    """What to ask of an 'in' that may be the inch of an axis, or say where something comes in: 'X(IN)', a coolant's
    inlet; 'axis_position_in', an input of a PLC; 'dX_in', a probe's. None of another."""
    if units.may_be_an_inlet(name):
        return "unit: inch, or is (IN) an inlet? then quantity: temperature or flow, with its own unit"
    if quantity == "position" and _INPUT_AT_END.search(name.strip()):
        return "unit: inch, or is 'in' an input? then its own unit"
    if quantity == "displacement" and _INPUT_AT_END.search(name.strip()) and not _is_inch(values):
        return f"unit: inch, or is 'in' an input, or inside? then um, mm or V ({range_text(values)})"
    return None


def _is_inch(values: Values | None) -> bool:
    """Whether values are a displacement in inches, and too small to be one in mm or V."""
    return values is not None and max(-values.low, values.high) <= _SMALL_IN


def strange(name: str, quantity: str | None) -> str | None:
    """The end of a name that looks like a unit, though none of its quantity: 'speed_m_s' of a spindle. None where none
    does."""
    if quantity in (None, "state", "label"):
        return None
    if quantity == "rotational_speed" and _OR_NUMBER.search(name.strip()):
        return "1_s"
    return next((u for u in _said(name) if quantity and _is_strange(u, quantity)), None)


def _is_strange(unit: str, quantity: str) -> bool:
    """A least value is no rate ('T_degC_min'), nor is what stands low or behind on a machine ('T_bearing_V_h')."""
    above, _, below = unit.partition("/")
    own = units.may_be(above, quantity)
    if below and (own if below == "min" else quantity == "temperature" and not own):
        return False
    return not units.may_be(unit, quantity) and _is_written_as_unit(unit)


def _said(name: str) -> Iterator[str]:
    """What the end of a name may say as a unit, the longest first."""
    match = _SEPARATED.search(name.strip())
    if match is None:
        return
    if match["above"]:
        made = f"{match['above']}/{match['below']}"
    else:
        made = f"{match['a_second']}/s" if match["a_second"] else match["whole"]
    # two capitals are an abbreviation as well: 'power_MW', a mean; 'power_HP', of high pressure
    short = (
        match["whole"] is not None and len(made) == 2 and (made.isupper() or (made.islower() and made not in _SHORT))
    )
    if not short and made.lower() not in _WORDS and is_unit(made):
        yield made


def _is_written_as_unit(text: str) -> bool:
    """With a stroke, or in small letters and capitals as no word is: 'kNm', 'MPa'."""
    return "/" in text or (not text.islower() and not text.isupper() and not text.istitle())
