"""What a channel measures where nobody says it: by its unit, which often leaves no choice."""

from __future__ import annotations

from thermodata.schema.units.conversion import converts
from thermodata.schema.units.quantity import CANONICAL_UNIT
from thermodata.schema.units.scale import counted_unit
from thermodata.schema.units.unit import is_unit, normal_unit

_LENGTHS = ("displacement", "position")
_OF_THE_UNIT = {  # in a unit as it is spelled, where others convert to it: a share, an angle, a state are numbers
    "degC": ("temperature",),
    "degF": ("temperature",),
    "%": ("load", "humidity"),
    "1": ("state", "label"),
    "deg": ("angle", "tilt"),
    "rad": ("angle", "tilt"),
    "mrad": ("tilt", "angle"),
    "urad": ("tilt", "angle"),
}
_OF_PROBES = (("voltage",), ("current",))  # what one gives, which may be a displacement
_NUMBERS = ("tilt", "angle", "load", "humidity", "state", "label")


def quantities_of(unit: str, axis: str | None = None, at: str | None = None) -> tuple[str, ...]:
    """The quantities that a channel may have by its unit: one where that is plain, none where the unit tells none.
    axis, at: as declared: what is measured along an axis, or at the tool centre point, is its displacement, and a
    length at a machine axis is where that stands."""
    counted = counted_unit(unit)
    bare = counted[1] if counted is not None else unit
    found = _given_in(bare)
    at_axis = at is not None and at.startswith("axis.")
    displaced = axis is not None or at == "tcp"
    if set(found) != set(_LENGTHS):
        return ("displacement", *found) if displaced and found in _OF_PROBES else found
    if at_axis == displaced:
        return found
    return ("position",) if at_axis else ("displacement",)


def _given_in(unit: str) -> tuple[str, ...]:
    normal = normal_unit(unit)
    known = next((found for word, found in _OF_THE_UNIT.items() if normal == normal_unit(word)), None)
    if known is not None or not is_unit(unit):
        return known or ()
    found = tuple(q for q, own in CANONICAL_UNIT.items() if converts(unit, own))
    if found == ("torque",) and "N" not in unit:
        return ()  # an energy
    return () if found == _NUMBERS else found
