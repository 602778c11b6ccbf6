"""Thirteen causes that move this mill's tool, what names them rightly, and which a case hides."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ..truth import KINDS, Plan


@dataclass(frozen=True)
class Cause:
    """axes: it is asked of, the better one first. sensors: logged where it is hidden. right, twins: candidate ids."""

    axes: str
    sensors: str
    right: str
    twins: str


CAUSES: Mapping[str, Cause] = {
    "bearing": Cause(
        "ZY",
        "T_brg",
        "spindle_bearing:T_brg",
        "lag:T_brg lag:T_head spindle_friction:speed_S lag:speed_S spindle_heating_cooling:T_brg,speed_S lag:T_mot "
        "spindle_bearing_2:T_brg speed_dependent_gain:T_brg,speed_S spindle_motor:T_mot",
    ),
    "motor": Cause(
        "ZY",
        "T_mot",
        "spindle_motor:T_mot",
        "lag:T_mot cutting_load:load_S lag:load_S spindle_friction:speed_S lag:speed_S",
    ),
    "zscrew": Cause(
        "Z",
        "T_nutZ feed_Z",
        "feed_screw:T_nutZ feed_screw:feed_Z screw_growth:T_nutZ,pos_Z",
        "lag:T_nutZ lag:feed_Z feed_motor:T_motZ lag:T_motZ guideway:T_guideZ lag:T_guideZ",
    ),
    "zmotor": Cause(
        "Z", "T_motZ", "feed_motor:T_motZ", "lag:T_motZ feed_screw:feed_Z lag:feed_Z feed_screw:T_nutZ lag:T_nutZ"
    ),
    "ambient": Cause(
        "ZY",
        "T_hall",
        "ambient_frame:T_hall ambient_frame:T_airT ambient_frame:T_airB",
        "lag:T_hall ambient_skin:T_hall lag:T_airT lag:T_airB vertical_gradient:T_airT,T_airB",
    ),
    "gradient": Cause(
        "Z",
        "T_airT T_airB",
        "vertical_gradient:T_airT,T_airB",
        "lag:T_airT lag:T_airB ambient_frame:T_airT ambient_skin:T_airT ambient_frame:T_airB",
    ),
    "coolant": Cause(
        "Z",
        "T_cool coolant_on",
        "coolant_heat:T_cool,coolant_on coolant_temperature:T_cool coolant:coolant_on",
        "lag:T_cool lag:coolant_on lag:T_table",
    ),
    "cutting": Cause("Z", "load_S", "cutting_load:load_S", "lag:load_S spindle_motor:T_mot lag:T_mot"),
    "centrifugal": Cause(
        "Z", "speed_S", "centrifugal_shift:speed_S", "lag:speed_S static:speed_S spindle_friction:speed_S"
    ),
    "fixture": Cause("Z", "T_fix", "probe_temperature:T_fix", "lag:T_fix"),
    "cabinet": Cause("Y", "T_colR T_colF", "column_bending:T_colR,T_colF", "lag:T_colR lag:T_colF lag:T_cab"),
    "yscrew": Cause("Y", "T_nutY feed_Y", "feed_screw:T_nutY feed_screw:feed_Y", "lag:T_nutY lag:feed_Y"),
    "guide": Cause(
        "Y",
        "T_guideZ feed_Z",
        "guideway:T_guideZ",
        "lag:T_guideZ feed_screw:feed_Z lag:feed_Z feed_screw:T_nutZ lag:T_nutZ feed_motor:T_motZ lag:T_motZ "
        "column_bending:T_colR,T_colF",
    ),
}
BASE: Mapping[str, tuple[str, str]] = {  # effects of a first model, with the channel of their temperature
    "bearing": ("spindle_bearing", "T_brg"),
    "ambient": ("ambient_frame", "T_hall"),
    "zscrew": ("feed_screw", "T_nutZ"),
    "yscrew": ("feed_screw", "T_nutY"),
    "motor": ("spindle_motor", "T_mot"),
    "fixture": ("probe_temperature", "T_fix"),
}
HIDDEN = (
    *("motor", "zscrew", "cabinet", "coolant", "gradient", "cutting", "bearing", "guide", "ambient", "fixture"),
    *("zmotor", "yscrew", "centrifugal"),
)
LOGGED = ("bearing", "ambient", "centrifugal", "cutting", "zscrew", "yscrew")  # by every laboratory


def plan(case: int, rng: np.random.Generator) -> Plan:
    """Kind, axis and hidden causes, so that 24 cases in a row have each kind as often as `KINDS`."""
    block, place = divmod(case, 24)
    order = np.random.default_rng(9100 + block)
    kind = KINDS[order.permutation(24)[place]]
    turn = int(order.permutation(13)[place % 13] if kind in ("one", "weak") else rng.integers(13))
    if kind in ("none", "outside", "fault"):
        return Plan(kind, str(rng.choice(["Z", "Y"], p=[0.7, 0.3])), (), False)
    first = HIDDEN[(turn + block) % 13]
    axis = CAUSES[first].axes[0 if rng.random() < 0.7 else -1]
    hidden: tuple[str, ...] = (first,)
    if kind == "two":
        others = [k for k, c in CAUSES.items() if axis in c.axes and k not in (first, "ambient", "bearing")]
        hidden = (first, str(rng.choice(others)))
    if kind == "not_logged" and first in LOGGED:
        hidden, axis = (("coolant",), "Z") if rng.random() < 0.5 else (("cabinet",), "Y")
    return Plan("one" if kind == "weak" else kind, axis, hidden, kind == "weak")
