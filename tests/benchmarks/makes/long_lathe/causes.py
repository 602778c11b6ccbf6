"""Fourteen causes, nine of which a case can hide; what names them rightly, and what each case hides."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ..truth import Plan


@dataclass(frozen=True)
class Cause:
    """What moves the tool. right: candidate ids, the best first. twins: of the same part or the same heat."""

    right: str
    twins: str

    @property
    def names(self) -> str:
        return f"{self.right} {self.twins}"


@dataclass(frozen=True)
class Hidden(Plan):
    """acts: whether the hidden causes move the tool along the axis that is asked."""

    acts: bool


CAUSES: Mapping[str, Cause] = {
    "belt": Cause(
        "spindle_motor:T_mot", "lag:T_mot lag:T_belt cutting_power:P_S1 lag:P_S1 cutting_load:load_S1 lag:load_S1"
    ),
    "hydraulics": Cause(
        "hydraulics:T_hyd hydraulics:hyd_on", "lag:T_hyd lag:hyd_on hydraulics:T_cyl lag:T_cyl lag:T_bed_l"
    ),
    "zscrew": Cause(
        "feed_screw:T_nut_Z feed_screw:T_brg_Z feed_screw:v_Z",
        "lag:T_nut_Z lag:T_brg_Z lag:v_Z feed_motor:T_mot_Z lag:T_mot_Z guideway:T_guide_Z lag:T_guide_Z",
    ),
    "xscrew": Cause(
        "feed_screw:T_nut_X feed_screw:T_brg_X feed_screw:v_X",
        "lag:T_nut_X lag:T_brg_X lag:v_X feed_motor:T_mot_X lag:T_mot_X",
    ),
    "guide": Cause("guideway:T_guide_Z", "lag:T_guide_Z feed_screw:v_Z lag:v_Z feed_screw:T_nut_Z lag:T_nut_Z"),
    "coolant": Cause(
        "coolant_temperature:T_cool coolant_heat:T_cool,cool_on coolant:cool_on", "lag:T_cool lag:cool_on"
    ),
    "turret": Cause(
        "turret_heat:T_turret turret_friction:n_live turret_heat:T_live", "lag:T_turret lag:n_live lag:T_live"
    ),
    "air": Cause(
        "ambient_frame:T_hall ambient_frame:T_hall_top ambient_frame:T_hall_low ambient_frame:T_door",
        "lag:T_hall lag:T_hall_top lag:T_hall_low lag:T_bed_l lag:T_bed_bot ambient_skin:T_hall "
        "ambient_skin:T_hall_top ambient_skin:T_hall_low",
    ),
    "door": Cause(
        "ambient_frame:T_door ambient_frame:T_hall_low ambient_skin:T_door ambient_skin:T_hall_low",
        "lag:T_door lag:T_hall_low lag:door_open vertical_gradient:T_hall_top,T_hall_low "
        "ambient_frame:T_hall ambient_skin:T_hall",
    ),
}
BASE: Mapping[str, tuple[str, str, str]] = {  # effects of a first model: effect, role of its driver, channel
    "bearing": ("spindle_bearing", "temperature", "T_brg_f"),
    "speed": ("spindle_friction", "speed", "n_S1"),
    "air": ("ambient_frame", "temperature", "T_hall"),
    "zscrew": ("feed_screw", "temperature", "T_nut_Z"),
    "belt": ("spindle_motor", "temperature", "T_mot"),
}
MORE = {"air": 0.5, "zscrew": 0.25, "belt": 0.2}  # how often a first model has them beside the spindle
WEAK = (2, 15)  # cases of a block whose cause has half the size and less
CASES: Sequence[tuple[str, str, str, bool]] = (  # kind (`half`: acts in half of the tests only), hidden, axis, acts
    ("one", "air", "Z", True),
    ("one", "hydraulics", "Z", True),
    ("one", "zscrew", "Z", True),
    ("none", "", "Z", True),
    ("one", "coolant", "X", True),
    ("two", "belt zscrew", "Z", True),
    ("one", "air", "X", False),
    ("one", "belt", "X", True),
    ("not_logged", "hydraulics", "X", True),
    ("half", "turret", "Z", True),
    ("one", "door", "Z", True),
    ("none", "", "X", True),
    ("one", "zscrew", "X", False),
    ("two", "air coolant", "Z", True),
    ("half", "xscrew", "X", True),
    ("one", "guide", "X", True),
    ("none", "", "Z", True),
    ("one", "hydraulics", "X", False),
)


def plan(case: int, _: np.random.Generator) -> Hidden:
    """What a case hides, of which nothing is drawn: further blocks hide other causes of the same kinds."""
    block, place = divmod(case, len(CASES))
    kind, said, axis, acts = CASES[place]
    pool = [k for k in CAUSES if k not in ("air", "door")]
    hidden = [k if k in ("air", "door") else pool[(pool.index(k) + 3 * block) % len(pool)] for k in said.split()]
    return Hidden(kind, axis, tuple(hidden), place in WEAK, acts)
