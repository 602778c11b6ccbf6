"""Units that a standard gives where a file writes none: MTConnect has one for each type of data item."""

from __future__ import annotations

from dataclasses import replace

from thermodata.draft.signals.quantity.guessed import Guess
from thermodata.plugin import Signal

# MTConnect part 2: an agent converts to these, and an adapter may not
_OF_TYPE = {
    "PathFeedrate": ("feed", "mm/s"),
    "AxisFeedrate": ("feed", "mm/s"),
    "Velocity": ("feed", "mm/s"),
    "Wattage": ("power", "W"),
    "Pressure": ("pressure", "Pa"),
    "Flow": ("flow", "l/s"),
    "Displacement": ("displacement", "mm"),
}
_OTHERWISE = "OVERRIDE"  # a subtype: in per cent
_BEGINS = "unit: "
PROTOCOL, SHDR = "protocol", "SHDR"
"""What a reader says of a signal that an adapter sent: without a type, and before its agent converts it."""


def with_standard_unit(found: Guess, signal: Signal) -> Guess:
    """With the unit of the standard, asked, where nothing else says one."""
    said = signal.properties
    quantity, unit = _OF_TYPE.get(said.get("type", "").removesuffix("TimeSeries"), (None, ""))
    open_unit = found.unit is None and any(q.startswith(_BEGINS) for q in found.questions)
    if open_unit and said.get(PROTOCOL) == SHDR:
        return _as_sent(found)
    if quantity != found.quantity or not open_unit or "dataItemId" not in said or said.get("subType") == _OTHERWISE:
        return found
    asked = next(q for q in found.questions if q.startswith(_BEGINS))
    values = asked[asked.rfind(" (") :] if asked.endswith(")") else ""
    by = f"unit: {unit}, as MTConnect's standard has it for {said['type']}? an adapter may send another{values}"
    return replace(found, unit=unit, questions=tuple(by if q == asked else q for q in found.questions))


def _as_sent(found: Guess) -> Guess:
    """With the standard's unit among those that are asked."""
    asked = next(q for q in found.questions if q.startswith(_BEGINS))
    unit = next((u for quantity, u in _OF_TYPE.values() if quantity == found.quantity), None)
    units, mark, values = asked.partition("?")
    also = f", or {unit}" if unit is not None and unit not in units.replace(",", "").split() else ""
    by = f"{units}{also}{mark} an adapter may send another than MTConnect's: nativeUnits in the agent's Devices.xml"
    return replace(found, questions=tuple(by + values if q == asked else q for q in found.questions))
