"""What the library calls each effect of this machine, for marking: which sensors are at its own bodies."""

from __future__ import annotations

from collections.abc import Iterable

from thermodata.virtual.gantry.catalogue import EFFECTS, drivers_of, family_of
from thermodata.virtual.gantry.heat.sensors import Sensor
from thermodata.virtual.truth.names import Names, right

# other bindings of the same effect, to channels of the same body or of the power that heats it; {A}: of the response
OTHERS = {
    "spindle_bearing": ("T_bearing_rear",),
    "ambient_frame": ("T_hall_top",),
    "feed_screw": ("feed_{A}",),
    "table_bearing": ("table_speed",),
    "hydraulics": ("pump_on",),
}
# one alone is the family, not the layers
TOGETHER = ("vertical_gradient",)


def names_of(axis: str, sensors: Iterable[Sensor]) -> Names:
    """Effect -> its names, for a response along an axis."""
    at = {s.name: s.at for s in sensors}
    found = {}
    for effect in EFFECTS:
        own = list(drivers_of(effect, axis).values())
        others = [c.replace("{A}", axis) for c in OTHERS.get(effect, ())]
        found[effect] = right(
            [(effect, ",".join(own)), *((effect, c) for c in others)],
            "" if effect in TOGETHER else " ".join([*own, *others]),
            family_of(effect, axis),
            [at[c] for c in own if c in at],
        )
    return found
