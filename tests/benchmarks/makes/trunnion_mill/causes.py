"""Sixteen causes that move this machine's tool, what names them rightly, and which a case hides."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ..truth import Plan, channels


@dataclass(frozen=True)
class Cause:
    """axes: in which it acts. test: in which it shows. right: candidate ids. others: of the same part or heat."""

    axes: str
    test: str
    right: str
    others: str

    @property
    def twins(self) -> str:
        """The others, and a lag of each right channel."""
        lags = dict.fromkeys(f"lag:{c}" for one in self.right.split() for c in one.split(":")[1].split(","))
        return " ".join([self.others, *lags])

    @property
    def gone(self) -> str:
        """Channels that are not there where it is not logged; table and workpiece always may be."""
        return " ".join(channels(f"{self.right} {self.twins}") - {"T_tisch", "T_wst"})


CAUSES: Mapping[str, Cause] = {
    "bearing": Cause(
        "ZY",
        "dauer",
        "spindle_bearing:T_lager_v spindle_bearing:T_lager_h spindle_friction:n_sp",
        "lag:T_spikopf spindle_bearing_2:T_lager_v spindle_heating_cooling:T_lager_v,n_sp",
    ),
    "motor": Cause("ZY", "stufen", "spindle_motor:T_mot", "cutting_load:L_sp cutting_power:P_sp lag:L_sp lag:P_sp"),
    "chiller": Cause("ZY", "temper", "chiller_temperature:T_kw_vl chiller_temperature:T_kw_rl", ""),
    "linx": Cause("YX", "achsen", "feed_motor:T_lin_x", "feed_screw:v_X lag:v_X"),
    "liny": Cause("YZ", "achsen", "feed_motor:T_lin_y guideway:T_fue_y", "feed_screw:v_Y lag:v_Y"),
    "lmcool": Cause("YZ", "temper", "chiller_temperature:T_lm_vl chiller_temperature:T_lm_rl", ""),
    "screwz": Cause("Z", "achsen", "feed_screw:T_mutter_z feed_screw:v_Z", "feed_motor:T_mot_z lag:T_mot_z"),
    "rotA": Cause("XZ", "schwenk", "rotary_axis:T_A rotary_axis:T_wange rotary_friction:n_A", "lag:M_A"),
    "rotC": Cause(
        "ZYX",
        "schwenk",
        "rotary_axis:T_C table_bearing:T_tab_lager rotary_friction:n_C",
        "table_bearing:T_tisch lag:T_tisch",
    ),
    "kss": Cause(
        "ZYX",
        "fraesen",
        "coolant_heat:T_kss,kss_ein coolant_heat:T_kss_rl,kss_ein coolant_temperature:T_kss "
        "coolant_temperature:T_kss_rl coolant:kss_ein coolant:q_kss",
        "lag:T_tisch table_bearing:T_tisch workpiece:T_wst lag:T_wst",
    ),
    "hydr": Cause("YX", "schwenk", "hydraulics:T_hyd hydraulics:hyd_ein", ""),
    "cabin": Cause("ZY", "fraesen", "lag:T_kab", "lag:T_tisch lag:T_wst workpiece:T_wst lag:T_wange"),
    "cut": Cause("ZY", "fraesen", "cutting_load:L_sp workpiece:T_wst cutting_power:P_sp", "lag:T_tisch"),
    "strat": Cause(
        "YX",
        "ruhe",
        "vertical_gradient:T_oben,T_unten",
        "ambient_frame:T_oben ambient_skin:T_oben ambient_frame:T_unten ambient_skin:T_unten",
    ),
    "centri": Cause("Z", "stufen", "centrifugal_shift:n_sp", "static:n_sp spindle_friction:n_sp"),
    "hall": Cause(
        "ZYX", "ruhe", "ambient_frame:T_halle ambient_skin:T_halle ambient_frame:T_oben ambient_frame:T_unten", ""
    ),
}
BASE = ("bearing", "bearing", "motor", "chiller", "screwz", "rotC", "kss", "linx", "liny")  # beside the hall
KINDS = (
    *("one", "two", "one", "none", "one", "weak", "one", "not_logged", "one", "two", "one", "weak", "one"),
    *("none", "one", "fault", "two", "one", "weak", "outside", "one", "two", "none", "weak", "not_logged", "three"),
)
COUNT = {"one": 1, "weak": 1, "not_logged": 1, "two": 2, "three": 3}
HIDDEN = (
    *("rotA", "kss", "screwz", "chiller", "linx", "rotC", "motor", "hydr", "liny", "cut", "lmcool", "strat"),
    *("bearing", "centri"),
)


def plan(case: int, rng: np.random.Generator) -> Plan:
    """Kind, axis and hidden causes, so that 26 cases in a row have each kind as often as `KINDS`."""
    block, place = divmod(case, len(KINDS))
    kind, turn = KINDS[place], sum(k in ("one", "weak") for k in KINDS[:place])
    count, pool = COUNT.get(kind, 0), [str(k) for k in rng.permutation(HIDDEN) if k != "strat"]
    first = pool[0]
    if kind in ("one", "weak"):
        first = HIDDEN[(turn + block) % len(HIDDEN)]
    elif kind == "not_logged":
        first = str(rng.choice(["cabin", "rotA"]))
    axis = str(rng.choice(list(CAUSES[first].axes if count else "ZZYX")))
    hidden = [first, *(k for k in pool if k != first and axis in CAUSES[k].axes)][:count]
    return Plan("one" if kind == "weak" else kind, axis, tuple(hidden), kind == "weak")
