"""What the library calls each cause: the table that answers are marked by. Nothing else here knows the library.

It was made from docs/effects.md alone, when the causes stood. The machine was then softened once: castings, oil,
motor plate and coolant were changed where the right name held less than half of its cause.

exact: an effect on a sensor of the cause's own body or power. equivalent: another effect whose channels are all among
the cause's drivers, for the data of such a driver can't say how it acts. family: what the library files under the same
heading. All else is wrong, and so is the right effect on a channel of another body.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

Mark = Literal["exact", "equivalent", "family", "wrong"]


@dataclass(frozen=True, slots=True)
class Right:
    """exact: (effect, channels in the order of its roles), the nearest first. drivers: channels of the cause."""

    exact: tuple[tuple[str, tuple[str, ...]], ...]
    drivers: frozenset[str]
    families: frozenset[str]


def _right(exact: Sequence[tuple[str, str]], drivers: str, families: str) -> Right:
    pairs = tuple((effect, tuple(channels.split(","))) for effect, channels in exact)
    return Right(pairs, frozenset(drivers.split()), frozenset(families.split()))


RIGHT: Mapping[str, Right] = {
    "bearing_friction": _right(
        [("spindle_bearing", "TS_brg_f"), ("spindle_bearing", "TS_brg_r"), ("spindle_friction", "n_S")],
        "TS_brg_f TS_brg_r n_S",
        "spindle",
    ),
    "belt_motor": _right([("spindle_motor", "T_mot_S")], "T_mot_S", "spindle"),
    "nut_z": _right([("feed_screw", "C01_nutZ"), ("feed_screw", "v_Z")], "C01_nutZ v_Z", "feed_z"),
    "nut_x": _right([("feed_screw", "C02_nutX"), ("feed_screw", "v_X")], "C02_nutX v_X", "feed_x"),
    "hall_air": _right([("ambient_frame", "A2_low"), ("ambient_frame", "A1_high")], "A1_high A2_low", "ambient"),
    # its drivers are both airs together; one alone is the family, not the layers
    "hall_layers": _right([("vertical_gradient", "A1_high,A2_low")], "", "ambient"),
    "coolant_film": _right([("coolant", "M_cool")], "M_cool C05_bedtop", "coolant"),
    "hydraulic_oil": _right([("hydraulics", "C11_oil")], "C11_oil C07_rib p_hyd", "hydraulics"),
    "turret_gear": _right(
        [("turret_heat", "C08_turret"), ("turret_friction", "n_tool")], "C08_turret n_tool", "turret"
    ),
    "hot_part": _right([("workpiece", "C12_part"), ("cutting_power", "P_S")], "C12_part P_S", "workpiece cutting"),
    "probe_bracket": _right([("probe_temperature", "C09_bracket")], "C09_bracket", "probe"),
    "guide_friction": _right([("guideway", "C03_guide"), ("lag", "C03_guide")], "C03_guide", "guide_z"),
    "ring_expansion": _right([("centrifugal_shift", "n_S")], "n_S", "centrifugal"),
    "seat_play": _right([], "TS_brg_f C04_foot", ""),
    "chip_heap": _right([], "", ""),
    "lost_stretch": _right([], "C01_nutZ", ""),
}


def mark(cause: str, effect: str, channels: Sequence[str], family: str) -> Mark:
    """An effect on its channels against a cause."""
    right = RIGHT[cause]
    if (effect, tuple(channels)) in right.exact:
        return "exact"
    if channels and right.drivers.issuperset(channels):
        return "equivalent"
    return "family" if family in right.families else "wrong"


def right_channel(cause: str, channel: str) -> bool:
    """Whether a channel alone names the cause, for methods that rank channels."""
    return channel in RIGHT[cause].drivers or any(channel in channels for _, channels in RIGHT[cause].exact)
