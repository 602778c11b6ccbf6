"""Eighteen causes that move this mill's tool, what names them rightly, and which a case hides."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ..truth import KINDS, Plan


@dataclass(frozen=True)
class Cause:
    """right, twins: candidate ids. mix: by axis, the bodies that move the tool, with their shares; none: speed does."""

    mix: Mapping[str, str]
    right: str
    twins: str


def _both(mix: str) -> Mapping[str, str]:
    return {"Y": mix, "Z": mix}


_COLUMN = """
    column_front_1 5, column_rear_1 -5, column_front_2 4, column_rear_2 -4, column_front_3 3, column_rear_3 -3,
    column_front_4 2, column_rear_4 -2, column_front_5 1, column_rear_5 -1
"""
_BED = "bed_top_2 0.7, bed_top_3 1, bed_top_4 0.7, bed_bottom_2 -0.7, bed_bottom_3 -1, bed_bottom_4 -0.7"
_CUT = "cutting_power:P_sp cutting_load:load_sp lag:P_sp lag:load_sp"
_WET = (
    "coolant_temperature:T_cool coolant_heat:T_cool,cool_on "
    "coolant_temperature:T_cool_ret coolant_heat:T_cool_ret,cool_on"
)
CAUSES: Mapping[str, Cause] = {
    "bearing": Cause(
        {"Y": "bearing_front 1, shaft_front 0.4, headstock_1 0.2", "Z": "bearing_front 1, shaft_front 0.6"},
        "spindle_bearing:T_brg_f spindle_bearing:T_brg_r spindle_friction:n_sp",
        "lag:T_brg_f lag:T_brg_r lag:n_sp",
    ),
    "motor": Cause(
        {"Y": "stator 1, rotor 0.15, headstock_2 0.1", "Z": "stator 1, rotor 0.2"},
        "spindle_motor:T_wind",
        f"lag:T_wind spindle_friction:n_sp {_CUT}",
    ),
    "centrifugal": Cause({"Z": ""}, "centrifugal_shift:n_sp", "static:n_sp lag:n_sp spindle_friction:n_sp"),
    "chiller": Cause(
        _both("cooled_plate 1"),
        "chiller_temperature:T_ch_sup chiller_temperature:T_ch_ret",
        "lag:T_ch_sup lag:T_ch_ret",
    ),
    "oilair": Cause(_both("lubrication_ring 1"), "lag:T_oilair", ""),
    "tool": Cause({"Z": "tool 1, holder 0.6"}, "tool_elongation:T_tool", f"lag:T_tool {_CUT}"),
    "yscrew": Cause(
        {"Y": "nut_y 1, screw_y_2 0.3, screw_y_3 0.4"},
        "feed_screw:T_nut_Y feed_screw:T_brg_Y feed_screw:v_Y",
        "feed_motor:T_mot_Y lag:T_nut_Y lag:T_brg_Y lag:v_Y lag:T_mot_Y",
    ),
    "zguide": Cause(
        _both("guide_z 1, slide_z 0.5"),
        "guideway:T_guide_Z",
        "lag:T_guide_Z feed_screw:T_nut_Z feed_screw:T_brg_Z feed_screw:v_Z feed_motor:T_mot_Z lag:T_nut_Z "
        "lag:T_brg_Z lag:v_Z lag:T_mot_Z lag:T_scale_Z",
    ),
    "xfeed": Cause(
        {"Y": "bearing_x 1, nut_x 0.5, screw_x_2 0.5, motor_x 0.2"},
        "feed_screw:T_brg_X feed_screw:T_nut_X feed_screw:v_X",
        "feed_motor:T_mot_X lag:T_brg_X lag:T_nut_X lag:v_X lag:T_mot_X",
    ),
    "scale": Cause({"Z": "scale_z 1"}, "lag:T_scale_Z", "guideway:T_guide_Z lag:T_guide_Z"),
    "column": Cause(
        _both(_COLUMN), "column_bending:T_col_r,T_col_f", f"{_WET} coolant:cool_on lag:cool_on lag:T_col_f lag:T_col_r"
    ),
    "gradient": Cause(
        _both("cover_top 1, cover_bottom -1"),
        "vertical_gradient:T_hall_top,T_hall_low",
        "lag:T_hall_top lag:T_hall_low ambient_skin:T_hall_top ambient_skin:T_hall_low ambient_frame:T_hall_low "
        "ambient_frame:T_hall_top",
    ),
    "hall": Cause(
        _both("frame 1, frame_foot 0.2"),
        "ambient_frame:T_hall ambient_frame:T_hall_top ambient_frame:T_hall_low ambient_skin:T_hall",
        "lag:T_hall lag:T_hall_top lag:T_hall_low",
    ),
    "bed": Cause(
        _both(_BED),
        "bed_bending:T_bed_top,T_bed_bot",
        f"lag:T_bed_top lag:T_chips {_WET} coolant:cool_on lag:cool_on {_CUT}",
    ),
    "coolant": Cause(_both("trough 1, fixture 0.2"), _WET, "coolant:cool_on lag:T_cool lag:T_cool_ret lag:cool_on"),
    "hydraulics": Cause(_both("hydraulic_block 1"), "hydraulics:T_hyd hydraulics:hyd_on", "lag:T_hyd lag:hyd_on"),
    "rotary": Cause(
        _both("bearing_b 1, table_b 0.6"),
        "rotary_axis:T_B rotary_friction:n_B rotary_axis:T_mot_B",
        "lag:T_B lag:n_B lag:T_mot_B",
    ),
    "part": Cause(_both("part_1 1, part_2 0.8"), "workpiece:T_part", f"lag:T_part {_CUT} {_WET} coolant:cool_on"),
}
BASE: Mapping[str, tuple[str, str]] = {  # effects of a first model, with the channel of their temperature
    "bearing": ("spindle_bearing", "T_brg_f"),
    "hall": ("ambient_frame", "T_hall"),
    "motor": ("spindle_motor", "T_wind"),
    "zguide": ("guideway", "T_guide_Z"),
    "yscrew": ("feed_screw", "T_nut_Y"),
    "hydraulics": ("hydraulics", "T_hyd"),
    "rotary": ("rotary_axis", "T_B"),
}
UNSEEN = ("hydraulics", "rotary", "oilair", "part", "xfeed", "coolant")  # where a case is not logged


def plan(case: int, rng: np.random.Generator) -> Plan:
    """Kind, axis and hidden causes: 24 cases in a row have the kinds in the order of `KINDS`.

    Of those with one cause every third is weak.
    """
    block, place = divmod(case, 24)
    order = [str(k) for k in np.random.default_rng(7_304 + block).permutation(list(CAUSES))]
    kind = KINDS[place].replace("weak", "one")
    hidden: list[str] = []
    if kind == "one":
        hidden = [order[place]]
    elif kind == "two":
        hidden = [order[(2 * place + k) % len(order)] for k in (0, 1)]
    elif kind == "not_logged":
        hidden = [[k for k in order if k in UNSEEN][place - KINDS.index(kind)]]
    axes = [axis for axis in "YZ" if all(axis in CAUSES[k].mix for k in hidden)]
    if not axes:  # the first, with the next that moves the tool along its axis
        axes = list(CAUSES[hidden[0]].mix)
        hidden[1] = next(k for k in order if k not in hidden and axes[0] in CAUSES[k].mix)
    return Plan(kind, str(rng.choice(axes)), tuple(hidden), kind == "one" and place % 3 == 2)
