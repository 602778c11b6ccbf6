"""Nineteen causes that move this centre's tool, what names them rightly, and which a case hides."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ..truth import KINDS, Plan


@dataclass(frozen=True)
class Cause:
    """axes: it is asked of. right, twins: candidate ids. gone: channels that are not there where it is not logged."""

    axes: str
    right: str
    twins: str
    gone: str = ""


_FEED_Z = "feed_screw:T_nut_Z feed_screw:feed_Z"
_FEED_Y = "feed_screw:T_nut_Y feed_screw:feed_Y"
CAUSES: Mapping[str, Cause] = {
    "bearing": Cause(
        "ZY",
        "spindle_bearing:T_bearing",
        "spindle_bearing_2:T_bearing spindle_bearing:T_bearing_rear lag:T_bearing spindle_friction:speed lag:speed "
        "spindle_heating_cooling:T_bearing,speed lag:T_bearing_rear",
    ),
    "motor": Cause(
        "Z",
        "spindle_motor:T_motor_S",
        "lag:T_motor_S cutting_power:power lag:power spindle_gearbox:T_gear lag:T_gear",
    ),
    "gearbox": Cause(
        "ZY",
        "spindle_gearbox:T_gear",
        "lag:T_gear lag:T_head spindle_friction:speed lag:speed spindle_motor:T_motor_S lag:T_motor_S",
    ),
    "chiller": Cause("ZY", "chiller_temperature:T_chiller", "lag:T_chiller", "T_chiller"),
    "zdrive": Cause("Z", _FEED_Z, "lag:T_nut_Z lag:feed_Z feed_motor:T_motor_Z lag:T_motor_Z lag:T_scale_Z"),
    "zmotor": Cause("Z", "feed_motor:T_motor_Z", f"lag:T_motor_Z lag:T_nut_Z lag:feed_Z {_FEED_Z}"),
    "ydrive": Cause(
        "Y",
        _FEED_Y,
        "lag:T_nut_Y lag:feed_Y feed_motor:T_motor_Y lag:T_motor_Y guideway:T_guide_Y lag:T_guide_Y",
    ),
    "guide": Cause(
        "Y",
        "guideway:T_guide_Y",
        f"lag:T_guide_Y lag:feed_Y lag:T_nut_Y feed_motor:T_motor_Y lag:T_motor_Y {_FEED_Y}",
    ),
    "hydraulics": Cause("ZY", "hydraulics:T_hydraulics", "lag:T_hydraulics", "T_hydraulics T_bed"),
    "table": Cause("Z", "table_bearing:T_table table_bearing:speed_table", "lag:T_table lag:speed_table"),
    "coolant": Cause(
        "Z",
        "coolant_heat:T_coolant,coolant_on coolant_temperature:T_coolant coolant:coolant_on",
        "lag:T_coolant lag:coolant_on lag:T_bed",
    ),
    "ambient": Cause(
        "ZY",
        "ambient_frame:T_air ambient_frame:T_air_top ambient_frame:T_air_bottom",
        "lag:T_air lag:T_air_top lag:T_air_bottom ambient_skin:T_air lag:T_bed lag:T_scale_Z lag:T_scale_Y",
    ),
    "gradient": Cause(
        "Y",
        "vertical_gradient:T_air_top,T_air_bottom",
        "lag:T_air_top lag:T_air_bottom ambient_frame:T_air_top ambient_frame:T_air_bottom",
    ),
    "cabinet": Cause(
        "Z", "column_bending:T_col_rear,T_col_front", "lag:T_col_rear lag:T_col_front", "T_col_rear T_col_front"
    ),
    "ramoil": Cause(
        "Y", "ram_bending:T_ram_top,T_ram_bottom", "lag:T_ram_top lag:T_ram_bottom", "T_ram_top T_ram_bottom"
    ),
    "sun": Cause(
        "Z",
        "sun:G_window",
        "lag:G_window lag:T_col_rear lag:T_col_front column_bending:T_col_rear,T_col_front",
        "G_window T_col_rear T_col_front",
    ),
    "fixture": Cause("Z", "probe_temperature:T_fixture", "lag:T_fixture", "T_fixture"),
    "centrifugal": Cause("Z", "centrifugal_shift:speed", "static:speed lag:speed spindle_friction:speed"),
    "cutting": Cause("Z", "cutting_power:power", "lag:power spindle_motor:T_motor_S lag:T_motor_S"),
}
BASE: Mapping[str, tuple[str, Mapping[str, str]]] = {  # effects of a first model, with their drivers
    "bearing": ("spindle_bearing", {"temperature": "T_bearing"}),
    "ambient": ("ambient_frame", {"temperature": "T_air"}),
    "zdrive": ("feed_screw", {"temperature": "T_nut_Z"}),
    "gearbox": ("spindle_gearbox", {"temperature": "T_gear"}),
    "centrifugal": ("centrifugal_shift", {"speed": "speed"}),
    "ydrive": ("feed_screw", {"temperature": "T_nut_Y"}),
    "cabinet": ("column_bending", {"warm_side": "T_col_rear", "cold_side": "T_col_front"}),
}
UNSEEN = ("chiller", "hydraulics", "cabinet", "ramoil", "sun", "fixture")  # where a case is not logged


def plan(case: int, rng: np.random.Generator) -> Plan:
    """Kind, axis and hidden causes, so that 24 cases in a row have each kind as often as `KINDS`."""
    block, place = divmod(case, 24)
    order = np.random.default_rng(4100 + block)
    kind, names = KINDS[order.permutation(24)[place]], list(order.permutation(list(CAUSES)))
    first = str(names[place % len(names)])
    if kind == "not_logged":
        first = str(rng.choice(UNSEEN))
    axis = str(rng.choice(list(CAUSES[first].axes)))
    if kind in ("none", "outside", "fault"):
        return Plan(kind, axis, (), False)
    others = [k for k, c in CAUSES.items() if axis in c.axes and k not in (first, "bearing", "ambient")]
    hidden = (first, str(rng.choice(others))) if kind == "two" else (first,)
    return Plan("one" if kind == "weak" else kind, axis, hidden, kind == "weak")
