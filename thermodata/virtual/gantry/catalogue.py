"""The effects that a virtual machine can have, and hide: their drivers, and how they show on the axes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType


@dataclass(frozen=True, slots=True)
class Hideable:
    """drivers: role of the library effect -> channel, `{a}` the letter of the response's axis.

    axes: how the effect shows on X, Y and Z beside its share on the response (1 is as much).
    rms_um: root mean square that it reaches in its best test, from and to [um].
    """

    meaning: str
    family: str
    drivers: Mapping[str, str]
    axes: tuple[float, float, float]
    rms_um: tuple[float, float]
    only_z: bool = False


_ALL = {
    "spindle_bearing": Hideable(
        "the spindle grows with its bearings", "spindle", {"temperature": "T_bearing_front"}, (0.1, 0.3, 1), (8, 16)
    ),
    "spindle_motor": Hideable(
        "the headstock grows with the heat of the spindle motor",
        "spindle",
        {"temperature": "T_motor_spindle"},
        (0.1, 0.6, 1),
        (6, 12),
    ),
    "spindle_friction": Hideable(
        "a sleeve at the nose is heated by friction that no sensor sees",
        "spindle",
        {"speed": "spindle_speed"},
        (0.1, 0.2, 1),
        (6, 12),
    ),
    "centrifugal_shift": Hideable(
        "the shaft shifts with the square of the speed, at once",
        "centrifugal",
        {"speed": "spindle_speed"},
        (0.05, 0.05, 1),
        (4, 8),
    ),
    "ambient_frame": Hideable(
        "bed and portal follow the air of the hall", "ambient", {"temperature": "T_hall_bottom"}, (0.3, 0.7, 1), (4, 8)
    ),
    "vertical_gradient": Hideable(
        "guides at two heights follow the stratified air",
        "ambient",
        {"top": "T_hall_top", "bottom": "T_hall_bottom"},
        (0.6, 1, 0.4),
        (4, 7),
    ),
    "feed_screw": Hideable(
        "the screw grows with the friction of its nut", "feed_{a}", {"temperature": "T_nut_{A}"}, (0, 0, 0), (6, 12)
    ),
    "feed_motor": Hideable(
        "the bracket of the axis motor grows with its heat",
        "feed_{a}",
        {"temperature": "T_motor_{A}"},
        (0, 0, 0),
        (5, 10),
    ),
    "table_bearing": Hideable(
        "the table grows with its bearing", "table", {"temperature": "T_table_bearing"}, (0.2, 0.2, 1), (6, 12)
    ),
    "tool_elongation": Hideable("tool and holder grow", "tool", {"temperature": "T_tool"}, (0, 0, 1), (5, 10), True),
    "cutting_power": Hideable(
        "the part is heated by cutting", "cutting", {"power": "spindle_power"}, (0.3, 0.3, 1), (6, 12)
    ),
    "coolant": Hideable(
        "plates that the cutting fluid wets are cooled", "coolant", {"state": "coolant_on"}, (0.4, 0.5, 1), (4, 8)
    ),
    "coolant_temperature": Hideable(
        "the sleeve that the chiller feeds follows its temperature",
        "coolant",
        {"temperature": "T_coolant"},
        (0.1, 0.3, 1),
        (3, 5),
    ),
    "hydraulics": Hideable(
        "the foot beside the hydraulic tank is heated", "hydraulics", {"temperature": "T_tank"}, (0.5, 0.6, 1), (5, 10)
    ),
    "column_bending": Hideable(
        "the column bends: the cabinet heats its rear side",
        "column",
        {"warm_side": "T_column_rear", "cold_side": "T_column_front"},
        (0.1, 1, 0.5),
        (5, 10),
    ),
    "probe_temperature": Hideable(
        "the holder of the probes grows", "probe", {"temperature": "T_fixture"}, (0.5, 0.6, 1), (3.5, 5)
    ),
}
EFFECTS: Mapping[str, Hideable] = MappingProxyType(_ALL)
HIDEABLE: Mapping[str, str] = MappingProxyType({name: h.meaning for name, h in _ALL.items()})


def drivers_of(effect: str, axis: str) -> dict[str, str]:
    """role -> channel of an effect, for a response along `axis`."""
    return {role: channel.replace("{A}", axis) for role, channel in EFFECTS[effect].drivers.items()}


def family_of(effect: str, axis: str) -> str:
    return EFFECTS[effect].family.replace("{a}", axis.lower())
