"""What the words of a name say of a place, by the quantity that is measured there."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from thermodata.draft.words.switches import place_of_switch

_SIDES = ("front", "rear", "left", "right")
_BEAMS = ("column", "ram", "crossbeam", "bed")  # that bend with the difference of two sides
_PLAIN = (
    "headstock",
    "tailstock",
    "saddle",
    "workpiece",
    "fixture",
    "tool",
    "floor",
    "cabinet",
    "outside",
)
# whose displacement is none of the tool
_BODIES = {*_BEAMS, "headstock", "tailstock", "saddle", "table", "workpiece", "fixture", "floor"}
_BODIES |= {"bearing", "motor", "gearbox", "nut", "screw", "scale", "guide"}
_ON_AXIS = ("nut", "screw", "scale", "guide")


@dataclass(frozen=True, slots=True)
class Place:
    """at: dotted, or None. sure: the words leave no choice. question: what a person should say."""

    at: str | None
    sure: bool = False
    question: str | None = None


def _side(said: set[str], sides: tuple[str, ...] = _SIDES) -> str | None:
    found = [s for s in sides if s in said]
    return found[0] if len(found) == 1 else None


def _temperature(said: set[str], axis: str | None) -> Place:
    for rule in (_of_axis, _of_workhead, _of_drive, _of_fluid, _of_body, _of_room, _of_spindle, _of_hall, _of_rest):
        if (place := rule(said, axis)) is not None:
            return place
    if axis and axis in "xyz":
        return Place(None, question=f"at: axis.{axis}.motor, .nut, .screw, .scale, .guide or .bearing?")
    return Place(None, question="at: where on the machine?")


def _of_axis(said: set[str], axis: str | None) -> Place | None:
    on_axis = next((p for p in _ON_AXIS if p in said), None)
    if on_axis is None:
        return None
    part = "bearing" if on_axis == "screw" and "bearing" in said else on_axis
    if axis and axis in "xyz":
        return Place(f"axis.{axis}.{part}", part != "guide")
    return Place(None, question=f"at: which axis's {part}? e.g. axis.z.{part}")


def _of_workhead(said: set[str], _: str | None) -> Place | None:
    if "workhead" not in said:
        return None
    part = next((f".{p}" for p in ("bearing", "motor") if p in said), "")
    asked = f"at: where on the workhead? e.g. counter_spindle{part}, as a second spindle, or rotary.c{part}"
    return Place(None, question=asked)


def _of_drive(said: set[str], axis: str | None) -> Place | None:
    if "bearing" in said:
        return _bearing(said, axis)
    if "belt" in said and "motor" not in said:
        return _belt(said, axis)
    return _motor(said, axis) if said & {"motor", "drive"} else None


def _of_fluid(said: set[str], _: str | None) -> Place | None:
    if "in or out of a cooler" in said:
        return Place("chiller", question="at: chiller.supply or .return? out of the cooler, or out of the machine?")
    if "chiller" in said or ("coolant" in said and "spindle" in said):
        return Place("chiller" + _way(said))
    if "coolant" in said:
        return Place("coolant" + _way(said), not said & {"cabinet", "hall", "pump"})
    if "hydraulics" in said:
        return Place("hydraulics", True)
    if "lubrication" in said:
        return Place("lubrication", True)
    if "gearbox" in said:
        return Place("spindle.gearbox")
    if "oil" in said:
        return Place(None, question="at: hydraulics, lubrication, or coolant, where the oil cuts?")
    return None


def _of_body(said: set[str], _: str | None) -> Place | None:
    beam = next((b for b in _BEAMS if b in said), None)
    if beam is not None and (beam == "column" or "spindle" not in said):
        side = _side(said) or {"upper": "top", "lower": "bottom"}.get(_side(said, ("upper", "lower")) or "")
        sure = (bool(side) and len(said) == 2) if beam == "column" else said <= {beam, *_SIDES, "upper", "lower"}
        return Place(f"{beam}.{side}" if side else beam, sure)
    found = [p for p in _PLAIN if p in said]
    if found and "spindle" not in said - ({"spindle"} if "headstock" in found else set()):
        return Place(found[0], len(found) == 1)
    return Place("table", not said & {"hall"}) if "table" in said else None


def _of_room(said: set[str], _: str | None) -> Place | None:
    """Of what is around the machine, or what all of it is made of."""
    if "climate chamber" in said:
        return Place("hall")
    if "chamber" in said and "workspace" not in said:
        return Place(
            "enclosure", question="at: enclosure, the working space, or hall, of a chamber around the machine?"
        )
    if "granite" in said:
        return Place("bed", question="at: bed, column, crossbeam or table, of granite?")
    if "frame" in said:
        return Place(None, question="at: bed, column or crossbeam, of the frame?")
    if "workspace" in said:
        return Place("enclosure", said <= {"workspace", "enclosure", "hall", "chamber"})
    return None


def _of_spindle(said: set[str], _: str | None) -> Place | None:
    return Place("spindle", said == {"spindle"}) if "spindle" in said else None


def _of_hall(said: set[str], _: str | None) -> Place | None:
    if "window" in said or "sun" in said:
        return Place("hall.sun" if "sun" in said else "hall.window")
    if "pneumatics" in said:
        return Place("pneumatics")
    if "hall" in said:
        level = {"upper": ".top", "lower": ".bottom"}.get(_side(said, ("upper", "lower")) or "", "")
        level = ".door" if "door" in said else level
        return Place("hall" + level, not said & {"probe", "fan", "enclosure"})
    return Place("hall.door") if "door" in said else None


def _of_rest(said: set[str], _: str | None) -> Place | None:
    if "probe" in said:
        return Place("probe", question="at: is 'probe' the place, or only the sensor?")
    return Place("cnc") if "cnc" in said else None


def _bearing(said: set[str], axis: str | None) -> Place:
    side = _side(said, ("front", "rear"))
    if "table" in said:
        return Place("table.bearing", "spindle" not in said)
    if axis and axis in "xyz" and "spindle" not in said and not side:
        return Place(f"axis.{axis}.bearing")
    if axis and axis in "abc" and "spindle" not in said:
        return Place(f"rotary.{axis}")
    if "motor" in said:
        return Place("spindle.motor" if "spindle" in said else None, question="at: the motor's bearing?")
    if side:
        return Place(f"spindle.bearing.{side}", axis is None and not said & {"table", "tool"})
    return Place("spindle.bearing", question="at: spindle.bearing.front or .rear?")


def _motor(said: set[str], axis: str | None) -> Place:
    part = "motor" if "motor" in said else "drive"
    if "spindle" in said and not axis:
        return Place(f"spindle.{part}", part == "motor")
    if axis and axis in "xyz":
        # 'spindle' beside an axis letter: the ball screw's motor, or the spindle's of machine Z?
        return Place(f"axis.{axis}.{part}", "spindle" not in said)
    if axis:
        return Place(f"rotary.{axis}.{part}")
    if said & {"hydraulics", "pump", "coolant"}:
        return Place("hydraulics" if "hydraulics" in said else "coolant")
    if "table" in said:
        return Place("table.motor")
    return Place(None, question="at: which motor? e.g. spindle.motor, axis.x.motor")


def _belt(said: set[str], axis: str | None) -> Place:
    if axis:
        return Place(None, question="at: of the axis's belt: its motor, or its screw? e.g. axis.x.motor")
    asked = None if "spindle" in said else "at: spindle.gearbox, of the belt between motor and spindle?"
    return Place("spindle.gearbox", question=asked)


def _way(said: set[str]) -> str:
    way = _side(said, ("supply", "return", "tank"))
    return f".{way}" if way else ""


def _speed(said: set[str], axis: str | None) -> Place:
    for other in ("fan", "pump", "tool", "chiller"):
        if other in said:
            return Place(other if other != "tool" else "spindle", question=f"at: the speed of the {other}?")
    if "workhead" in said:
        return Place("rotary.c")
    if "spindle" in said and not axis:
        return Place("spindle", True)
    if "table" in said:
        return Place("table", True)
    if axis == "c":
        return Place("table", question="at: table, or rotary.c of a head?")
    if axis == "b":
        return Place("rotary.b", question="at: rotary.b or table?")
    if axis == "a":
        return Place("rotary.a")  # it tilts: what turns about a vertical axis is the table
    if axis:
        return Place(f"axis.{axis}.motor")
    return Place("spindle")


def _driven(said: set[str], axis: str | None) -> Place:
    """Power, load, current and torque."""
    if "workhead" in said:
        return Place("rotary.c")
    if "spindle" in said and not axis:
        return Place("spindle", True)
    if axis:
        return Place(f"axis.{axis}" if axis in "xyz" else f"rotary.{axis}", True)
    for other in ("hydraulics", "coolant", "chiller", "lubrication", "table", "cabinet", "pump", "fan"):
        if other in said:
            return Place(other, other != "pump")
    return Place(None, question="at: of what? e.g. spindle, axis.x")


def _on_axis(said: set[str], axis: str | None) -> Place:
    if axis:
        return Place(f"axis.{axis}" if axis in "xyz" else f"rotary.{axis}", True)
    return Place(None, question="at: which axis?")


def _feed(said: set[str], axis: str | None) -> Place:
    # without more, a control's feed is that along its path
    of_a_part = Place(None, question="at: which axis? e.g. axis.x; a feed along a path: no 'at'")
    return _on_axis(said, axis) if axis else of_a_part if "more than a feed" in said else Place(None)


def _fluid(said: set[str], axis: str | None) -> Place:
    for key in ("hydraulics", "lubrication", "chiller", "coolant", "pneumatics"):
        if key in said:
            return Place(key + (_way(said) if key in ("coolant", "chiller") else ""), True)
    if "hall" in said:  # 'air pressure': of the hall, or of the compressed air?
        return Place("pneumatics", question="at: pneumatics, or hall?")
    return Place(None, question="at: coolant, hydraulics or else?")


def _state(said: set[str], axis: str | None) -> Place:
    return Place(*place_of_switch(said, axis))


def _displacement(said: set[str], axis: str | None) -> Place:
    if "compensation" in said:
        return Place("cnc.compensation", True)
    if "stator" in said:
        return Place("stator", question="at: stator, the spindle's standing part, or tcp?")
    elsewhere = said & _BODIES
    if elsewhere:
        return Place(None, question=f"at: tcp, or the {min(elsewhere)} itself?")
    return Place("tcp", True)


def _humidity(said: set[str], axis: str | None) -> Place:
    return Place("enclosure") if "workspace" in said else Place("hall", "hall" in said)


def _irradiance(said: set[str], axis: str | None) -> Place:
    return Place("hall.sun", "sun" in said)


RULES: dict[str, Callable[[set[str], str | None], Place]] = {
    "temperature": _temperature,
    "temperature_difference": _temperature,
    "rotational_speed": _speed,
    "feed": _feed,
    "power": _driven,
    "load": _driven,
    "current": _driven,
    "torque": _driven,
    "position": _on_axis,
    "flow": _fluid,
    "pressure": _fluid,
    "state": _state,
    "displacement": _displacement,
    "tilt": _displacement,
    "humidity": _humidity,
    "irradiance": _irradiance,
}
