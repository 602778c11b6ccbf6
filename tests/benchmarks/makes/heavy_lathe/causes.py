"""Fifteen causes that move this lathe's tool, what names them rightly, and which a case hides."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ..truth import KINDS, Plan


@dataclass(frozen=True)
class Cause:
    """What moves the tool: bodies with their shares, so that it comes distributed in time.

    right, twins: candidate ids. gone: channels that are not there where it is not logged.
    """

    mix: str
    right: str
    twins: str
    gone: str = ""


CAUSES: Mapping[str, Cause] = {
    "bearing": Cause(
        "bearing_front 0.6, headstock 0.4",
        "spindle_bearing:T_bearing_front",
        "spindle_bearing:T_bearing_rear lag:T_headstock lag:T_bearing_front",
    ),
    "gearbox": Cause(
        "gear_housing 0.7, gear_oil 0.3",
        "spindle_gearbox:T_gear_housing spindle_gearbox:T_gear_oil",
        "lag:T_gear_housing lag:T_gear_oil lag:range",
        "T_gear_housing T_gear_oil range n_motor",
    ),
    "motor": Cause(
        "motor 0.5, headstock_wall 0.1, motor 0.4",
        "spindle_motor:T_motor",
        "lag:T_motor lag:n_motor",
        "T_motor n_motor P_motor load",
    ),
    "oil": Cause(
        "tank 0.7, bearing_front 0.1, headstock 0.2",
        "hydraulics:T_tank",
        "hydraulics:pump lag:T_tank lag:pump chiller_temperature:T_chiller",
        "T_tank T_chiller pump chiller_on",
    ),
    "chiller": Cause(
        "oil_supply 0.9, tank 0.1",
        "chiller_temperature:T_chiller",
        "lag:T_chiller lag:chiller_on hydraulics:T_tank lag:T_tank",
        "T_chiller T_tank chiller_on pump",
    ),
    "live": Cause(
        "live_tool 0.5, ram_front 0.3, ram 0.2",
        "spindle_bearing:T_live spindle_friction:n_live",
        "lag:T_live lag:n_live lag:T_ram_front ram_bending:T_ram_rear,T_ram_front",
        "T_live n_live T_ram_front T_ram_rear",
    ),
    "ram_bending": Cause(
        "ram_rear 1, ram_front -1",
        "ram_bending:T_ram_rear,T_ram_front",
        "lag:T_ram_rear lag:T_ram_front lag:T_live spindle_bearing:T_live spindle_friction:n_live",
        "T_ram_rear T_ram_front T_live n_live",
    ),
    "part": Cause(
        "workpiece 0.8, chuck 0.2",
        "workpiece:T_part",
        "lag:T_part lag:T_chuck cutting_power:P_motor cutting_load:load lag:P_motor lag:load",
        "T_part T_chuck",
    ),
    "ambient": Cause(
        "bed_top 0.3, carriage 0.4, headstock_wall 0.3",
        "ambient_frame:T_hall ambient_frame:T_hall_low ambient_frame:T_hall_top",
        "lag:T_hall lag:T_bed_top lag:T_carriage lag:T_hall_low",
    ),
    "floor": Cause(
        "foundation 0.8, floor_slab 0.2", "floor:T_floor", "lag:T_floor lag:T_bed_bottom", "T_floor T_bed_bottom"
    ),
    "bed": Cause(
        "bed_top 1, bed_bottom -1",
        "bed_bending:T_bed_top,T_bed_bottom",
        "lag:T_bed_top lag:T_bed_bottom lag:T_guide_Z",
        "T_bed_top T_bed_bottom",
    ),
    "gradient": Cause(
        "top 0.6, low -0.6, ram_rear 0.1",
        "vertical_gradient:T_hall_top,T_hall_low",
        "lag:T_hall_top lag:T_hall_low",
        "T_hall_top T_hall_low",
    ),
    "screw": Cause(
        "nut_x 0.4, screw_x 0.6", "feed_screw:T_nut_X feed_screw:feed_X", "lag:T_nut_X lag:feed_X", "T_nut_X feed_X"
    ),
    "guide": Cause(
        "guide_z 0.7, carriage 0.1, guide_z 0.2",
        "guideway:T_guide_Z",
        "lag:T_guide_Z lag:feed_Z feed_screw:feed_Z",
        "T_guide_Z feed_Z",
    ),
    "fixture": Cause("probe_holder 1", "probe_temperature:T_holder", "lag:T_holder", "T_holder"),
}
BASE: Mapping[str, tuple[str, Mapping[str, str]]] = {  # effects of a first model, with their drivers
    "bearing": ("spindle_bearing", {"temperature": "T_bearing_front"}),
    "ambient": ("ambient_frame", {"temperature": "T_hall"}),
    "gearbox": ("spindle_gearbox", {"temperature": "T_gear_housing"}),
    "part": ("workpiece", {"temperature": "T_part"}),
}
UNSEEN = ("gearbox", "oil", "live", "floor", "part")  # where a case is not logged


def plan(case: int, rng: np.random.Generator) -> Plan:
    """Kind and hidden causes: 24 cases in a row have the kinds in the order of `KINDS`."""
    block, place = divmod(case, 24)
    kind, turn = KINDS[place], np.random.default_rng(77_000 + block)
    names = [str(k) for k in turn.permutation([k for k in CAUSES if k not in ("ambient", "fixture")])]
    if kind == "two":
        first = 2 * (place - KINDS.index("two"))
        return Plan(kind, "X", (names[first], names[first + 1]), False)
    if kind == "not_logged":
        return Plan(kind, "X", (str(rng.choice(UNSEEN)),), False)
    if kind in ("one", "weak"):
        return Plan("one", "X", (names[place],), kind == "weak")
    return Plan(kind, "X", (), False)
