"""The channels that this laboratory can log beside the displacement: Pt100s, the control, a logger in the hall."""

from __future__ import annotations

from collections.abc import Mapping

from ..sensors import Sensor

SENSORS: Mapping[str, Sensor] = {
    "T_brg_f": Sensor("daq", "Pt01 loz P", "spindle.bearing.front", 0.1, "bf 0.8, hf 0.2"),
    "T_brg_r": Sensor("daq", "Pt02 loz Z", "spindle.bearing.rear", 0.1, "br 0.8, hr 0.2"),
    "T_head": Sensor("daq", "Pt03 vretenik", "headstock", 0.1, "hm 0.9, top 0.1"),
    "T_belt": Sensor("daq", "Pt04 kryt remene", "belt_guard", 0.1, "pul 0.5, hr 0.3, mid 0.2"),
    "T_mot": Sensor("nc", "S1 motor temp", "spindle.motor", 1, "mot 1"),
    "T_cyl": Sensor("daq", "Pt05 valec", "hydraulics.cylinder", 0.1, "cyl 0.9, mid 0.1"),
    "T_hyd": Sensor("daq", "Pt06 nadrz HY", "hydraulics.tank", 0.1, "ht 0.95, low 0.05"),
    "T_turret": Sensor("daq", "Pt07 rev hlava", "turret", 0.1, "tu 0.5, td 0.45, en 0.05"),
    "T_live": Sensor("nc", "S2 motor temp", "turret.motor", 1, "lm 1"),
    "T_nut_Z": Sensor("daq", "Pt08 matice Z", "axis.z.nut", 0.1, "nz 0.8, ap 0.2"),
    "T_brg_Z": Sensor("daq", "Pt09 loz sroubu Z", "axis.z.bearing", 0.1, "bz 0.85, t2 0.15"),
    "T_mot_Z": Sensor("nc", "Z motor temp", "axis.z.motor", 1, "mz 1"),
    "T_nut_X": Sensor("daq", "Pt10 matice X", "axis.x.nut", 0.1, "nx 0.8, cs 0.2"),
    "T_brg_X": Sensor("daq", "Pt11 loz sroubu X", "axis.x.bearing", 0.1, "bx 0.8, sa 0.2"),
    "T_mot_X": Sensor("nc", "X motor temp", "axis.x.motor", 1, "mx 1"),
    "T_guide_Z": Sensor("daq", "Pt12 vedeni Z", "axis.z.guide", 0.1, "gd 0.8, t4 0.2"),
    "T_cool": Sensor("daq", "Pt13 nadrz KSS", "coolant.tank", 0.1, "ct 1"),
    "T_bed_top": Sensor("daq", "Pt14 loze nahore", "bed.top", 0.1, "t4 0.6, t5 0.4"),
    "T_bed_bot": Sensor("daq", "Pt15 loze dole", "bed.bottom", 0.1, "b4 0.5, b5 0.5"),
    "T_bed_l": Sensor("daq", "Pt16 loze vlevo", "bed.left", 0.1, "b1 0.9, low 0.1"),
    "T_tray": Sensor("daq", "Pt17 vana trisek", "conveyor", 0.1, "ch 0.9, en 0.1"),
    "T_tail": Sensor("daq", "Pt18 konik", "tailstock", 0.1, "tq 0.8, ta 0.2"),
    "T_encl": Sensor("daq", "Pt19 prac prostor", "enclosure", 0.1, "en 1"),
    "T_part": Sensor("daq", "Pt20 obrobek", "workpiece", 0.1, "w1 0.7, w2 0.2, en 0.1"),
    "T_saddle": Sensor("daq", "Pt21 suport", "saddle", 0.1, "sa 0.9, mid 0.1"),
    "T_hall": Sensor("hall", "hala", "hall", 0.1, "mid 1"),
    "T_hall_top": Sensor("hall", "hala strop", "hall.top", 0.1, "top 1"),
    "T_hall_low": Sensor("hall", "hala podlaha", "hall.bottom", 0.1, "low 1"),
    "T_door": Sensor("hall", "vrata", "hall.door", 0.1, "vr 1"),
    "T_floor": Sensor("hall", "zaklad", "floor", 0.1, "fd 1"),
    "I_sun": Sensor("hall", "slunce", "hall.sun", 5, quantity="irradiance"),
    "n_S1": Sensor("nc", "S1 speed", "spindle", 1, quantity="rotational_speed"),
    "n_live": Sensor("nc", "S2 speed", "turret", 1, quantity="rotational_speed"),
    "v_X": Sensor("nc", "X feed", "axis.x", 0.001, quantity="feed"),
    "v_Z": Sensor("nc", "Z feed", "axis.z", 0.001, quantity="feed"),
    "P_S1": Sensor("nc", "S1 power", "spindle", 0.1, quantity="power"),
    "load_S1": Sensor("nc", "S1 load", "spindle", 1, quantity="load"),
    "hyd_on": Sensor("nc", "HY pump", "hydraulics", 1, quantity="state"),
    "cool_on": Sensor("nc", "M8", "coolant", 1, quantity="state"),
    "door_open": Sensor("hall", "vrata otevrena", "hall.door", 1, quantity="state"),
}
KEPT = ("T_brg_f", "T_hall")  # logged rightly in each case
