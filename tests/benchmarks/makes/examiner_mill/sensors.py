"""The channels that this laboratory can log beside the displacement: Pt100s, the control, a recorder in the hall."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from ..bodies import Array
from ..sensors import UNITS as LOGGED
from ..sensors import Sensor

UNITS = {**LOGGED, "rotational_speed": "1/min", "feed": "mm/min", "position": "mm"}
SENSORS: Mapping[str, Sensor] = {
    "T_brg_f": Sensor("daq", "Pt01 bearing front", "spindle.bearing.front", 0.01, "bf 0.9, ho0 1"),
    "T_brg_r": Sensor("daq", "Pt02 bearing rear", "spindle.bearing.rear", 0.01, "br 0.85, ho3 1"),
    "T_head": Sensor("daq", "Pt03 headstock", "headstock", 0.01, "hd1 1"),
    "T_gear": Sensor("daq", "Pt04 gearbox oil", "spindle.gearbox", 0.01, "ge 0.85, hd1 1"),
    "T_belt": Sensor("daq", "Pt05 belt cover", "belt", 0.01, "be 0.8, hd2 1"),
    "T_chs": Sensor("daq", "Pt06 chiller supply", "chiller.supply", 0.01),
    "T_chr": Sensor("daq", "Pt07 chiller return", "chiller.return", 0.01),
    "T_nut_X": Sensor("daq", "Pt08 nut X", "axis.x.nut", 0.01, "nx 0.8, sx2 1"),
    "T_nut_Y": Sensor("daq", "Pt09 nut Y", "axis.y.nut", 0.01, "ny 0.8, sy2 1"),
    "T_nut_Z": Sensor("daq", "Pt10 nut Z", "axis.z.nut", 0.01, "nz 0.8, sz2 1"),
    "T_gd_X": Sensor("daq", "Pt11 guide X", "axis.x.guide", 0.01, "gx 0.8, sa1 1"),
    "T_gd_Y": Sensor("daq", "Pt12 guide Y", "axis.y.guide", 0.01, "gy 0.8, bt1 1"),
    "T_gd_Z": Sensor("daq", "Pt13 guide Z", "axis.z.guide", 0.01, "gz 0.8, cf2 1"),
    "T_scl_Y": Sensor("daq", "Pt14 scale Y", "axis.y.scale", 0.01, "ey0 1, sc 0.1"),
    "T_rtb": Sensor("daq", "Pt15 rotary bearing", "table.bearing", 0.01, "rt 0.9, ro0 1"),
    "T_rot": Sensor("daq", "Pt16 rotary body", "rotary.a", 0.01, "rt 0.3, ro0 1"),
    "T_tab": Sensor("daq", "Pt17 table", "table", 0.01, "tb1 1"),
    "T_chip": Sensor("daq", "Pt18 chip tray", "chip tray", 0.01, "cp 0.85, bt1 1"),
    "T_kss": Sensor("daq", "Pt19 coolant tank", "coolant.tank", 0.01),
    "T_bed_t": Sensor("daq", "Pt20 bed top", "bed.top", 0.01, "bt1 1"),
    "T_bed_b": Sensor("daq", "Pt21 bed bottom", "bed.bottom", 0.01, "bb1 1"),
    "T_col_f": Sensor("daq", "Pt22 column front", "column.front", 0.01, "cf1 1"),
    "T_col_r": Sensor("daq", "Pt23 column rear", "column.rear", 0.01, "cr2 1"),
    "T_col_lf": Sensor("daq", "Pt24 column left", "column.left", 0.01, "cf2 0.5, cr2 0.5"),
    "T_col_rt": Sensor("daq", "Pt25 column right", "column.right", 0.01, "cs1 1"),
    "T_mot_S": Sensor("nc", "Spindle motor temp", "spindle.motor", 0.1, "mo 0.9, hd2 1"),
    "T_mot_X": Sensor("nc", "Motor temp X", "axis.x.motor", 1, "mx 0.9, sa0 1"),
    "T_mot_Y": Sensor("nc", "Motor temp Y", "axis.y.motor", 1, "my 0.9, bt2 1"),
    "T_mot_Z": Sensor("nc", "Motor temp Z", "axis.z.motor", 1, "mz 0.9, cf3 1"),
    "T_cab": Sensor("nc", "Cabinet temp", "cabinet", 0.1, "ca 1, cr2 1"),
    "T_hyd": Sensor("nc", "Hydraulic oil", "hydraulics", 0.1, "hy 0.9, bb2 1"),
    "n_S": Sensor("nc", "nAct S1", "spindle", 1, quantity="rotational_speed"),
    "P_S": Sensor("nc", "Power S1", "spindle", 0.01, quantity="power"),
    "L_S": Sensor("nc", "Load S1", "spindle", 1, quantity="load"),
    "F_X": Sensor("nc", "Feed X", "axis.x", 1, quantity="feed"),
    "F_Y": Sensor("nc", "Feed Y", "axis.y", 1, quantity="feed"),
    "F_Z": Sensor("nc", "Feed Z", "axis.z", 1, quantity="feed"),
    "pos_Y": Sensor("nc", "Pos Y", "axis.y", 0.001, quantity="position"),
    "n_A": Sensor("nc", "nAct A", "rotary.a", 0.1, quantity="rotational_speed"),
    "cool_on": Sensor("nc", "Coolant", "coolant", 1, quantity="state"),
    "q_cool": Sensor("nc", "Coolant flow", "coolant", 0.1, quantity="flow"),
    "hyd_on": Sensor("nc", "Hydraulic pump", "hydraulics", 1, quantity="state"),
    "meas": Sensor("nc", "Measuring", "", 1, quantity="state"),
    "T_hall": Sensor("rec", "hall_mid", "hall", 0.05),
    "T_top": Sensor("rec", "hall_top", "hall.top", 0.05),
    "T_bot": Sensor("rec", "hall_bottom", "hall.bottom", 0.05),
    "T_door": Sensor("rec", "hall_door", "hall.door", 0.05),
    "I_sun": Sensor("rec", "pyranometer", "hall.sun", 1, quantity="irradiance"),
    "door_open": Sensor("rec", "door_contact", "hall.door", 1, quantity="state"),
    "rH": Sensor("rec", "humidity", "hall", 0.1, quantity="humidity"),
    "T_part": Sensor("rec", "ir_part", "workpiece", 0.1, "wp0 1, wk 0.15"),
    "T_tool": Sensor("rec", "ir_tool", "tool", 0.1, "tl0 1, tt 0.2"),
}
DECOYS: Mapping[str, Sensor] = {  # by the place of a hidden cause: goes with it, and does nothing
    "spindle": Sensor("nc", "T_drive_S", "spindle.drive", 0.1),
    "axis.x": Sensor("nc", "T_drive_X", "axis.x.drive", 0.1),
    "axis.y": Sensor("nc", "T_drive_Y", "axis.y.drive", 0.1),
    "axis.z": Sensor("nc", "T_drive_Z", "axis.z.drive", 0.1),
    "": Sensor("nc", "T_lube", "lubrication", 0.1),
}


def known(u: Mapping[str, Array], fluids: Mapping[str, Array], most_kw: float) -> dict[str, Array]:
    """What channels show that feel no body, shape (n,). u: inputs and airs. most_kw: power of the spindle."""
    away = np.sign(np.sin(np.arange(len(u["n"])))) * (u["vy"] > 0)
    return {
        "T_chs": fluids["chs"],
        "T_chr": fluids["chr"],
        "T_kss": fluids["tank"],
        "n_S": u["n"],
        "P_S": u["P"],
        "L_S": 100 * u["P"] / most_kw,
        "F_X": 1000 * u["vx"],
        "F_Y": 1000 * u["vy"],
        "F_Z": 1000 * u["vz"],
        "pos_Y": 250 + 120 * away,
        "n_A": u["na"],
        "cool_on": u["kss"],
        "q_cool": 18 * u["kss"],
        "hyd_on": u["hyd"],
        "meas": u["meas"],
        "T_hall": u["hall"],
        "T_top": u["top"],
        "T_bot": u["bottom"],
        "T_door": u["doorair"],
        "I_sun": u["sun"],
        "door_open": u["open"],
        "rH": u["rh"],
    }
