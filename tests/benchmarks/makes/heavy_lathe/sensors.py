"""The channels that this laboratory can log beside the displacement."""

from __future__ import annotations

from collections.abc import Mapping

from ..sensors import Sensor

SENSORS: Mapping[str, Sensor] = {
    "T_bearing_front": Sensor(
        "lv", "Pt1 lozisko vreteno P", "spindle.bearing.front", 0.02, "bearing_front 0.85, headstock 0.15"
    ),
    "T_bearing_rear": Sensor(
        "lv", "Pt2 lozisko vreteno Z", "spindle.bearing.rear", 0.02, "bearing_rear 0.9, headstock 0.1"
    ),
    "T_headstock": Sensor("lv", "Pt3 vretenik", "headstock", 0.02, "headstock 0.6, headstock_wall 0.4"),
    "T_gear_housing": Sensor("lv", "Pt4 prevodovka skrin", "spindle.gearbox", 0.02, "gear_housing 0.95, mid 0.05"),
    "T_gear_oil": Sensor("lv", "Pt5 prevodovka olej", "spindle.gearbox", 0.1, "gear_oil 1"),
    "T_motor": Sensor("nc", "Motor temp S1 [°C]", "spindle.motor", 1.0, "motor 1"),
    "T_tank": Sensor("lv", "Pt6 nadrz HS olej", "hydraulics", 0.02, "tank 1"),
    "T_chiller": Sensor("lv", "Pt7 chladic vystup", "chiller.supply", 0.05, "oil_supply 1"),
    "T_live": Sensor("lv", "Pt8 nahaneny nastroj", "milling_spindle.bearing", 0.02, "live_tool 0.9, ram_front 0.1"),
    "T_ram_front": Sensor("lv", "Pt9 smykadlo vpredu", "ram.front", 0.02, "ram_front 0.95, mid 0.05"),
    "T_ram_rear": Sensor("lv", "Pt10 smykadlo vzadu", "ram.rear", 0.02, "ram_rear 0.95, mid 0.05"),
    "T_chuck": Sensor("xl", "skličidlo IR [°C]", "chuck", 0.5, "chuck 0.8, mid 0.2"),
    "T_part": Sensor("xl", "obrobek [°C]", "workpiece", 0.1, "workpiece 0.9, mid 0.1"),
    "T_bed_top": Sensor("lv", "Pt11 loze nahore", "bed.top", 0.02, "bed_top 1"),
    "T_bed_bottom": Sensor("lv", "Pt12 loze dole", "bed.bottom", 0.02, "bed_bottom 1"),
    "T_carriage": Sensor("lv", "Pt13 suport", "saddle", 0.02, "carriage 1"),
    "T_nut_X": Sensor("lv", "Pt14 matice X", "axis.x.nut", 0.05, "nut_x 0.8, carriage 0.2"),
    "T_guide_Z": Sensor("lv", "Pt15 vedeni Z", "axis.z.guide", 0.05, "guide_z 0.9, bed_top 0.1"),
    "T_holder": Sensor("lv", "Pt16 drzak sondy", "fixture", 0.02, "probe_holder 1"),
    "T_hall": Sensor("xl", "vzduch hala [°C]", "hall", 0.1, "mid 1"),
    "T_hall_top": Sensor("xl", "vzduch strop [°C]", "hall.top", 0.1, "top 1"),
    "T_hall_low": Sensor("xl", "vzduch podlaha [°C]", "hall.bottom", 0.1, "low 1"),
    "T_floor": Sensor("xl", "základ [°C]", "floor", 0.05, "foundation 0.8, floor_slab 0.2"),
    "T_outside": Sensor("xl", "venku [°C]", "outside", 0.1, "out 1"),
    "speed": Sensor("nc", "S1 actual [rpm]", "spindle", 0.1, quantity="rotational_speed"),
    "n_motor": Sensor("nc", "M1 actual [rpm]", "spindle.motor", 1, quantity="rotational_speed"),
    "range": Sensor("nc", "Gear range [1]", "spindle.gearbox", 1, quantity="state"),
    "P_motor": Sensor("nc", "S1 power [kW]", "spindle", 0.1, quantity="power"),
    "load": Sensor("nc", "S1 load [%]", "spindle", 1, quantity="load"),
    "n_live": Sensor("nc", "S2 actual [rpm]", "milling_spindle", 1, quantity="rotational_speed"),
    "feed_X": Sensor("nc", "X feed [m/min]", "axis.x", 0.001, quantity="feed"),
    "feed_Z": Sensor("nc", "Z feed [m/min]", "axis.z", 0.001, quantity="feed"),
    "pump": Sensor("nc", "HS pump [1]", "hydraulics", 1, quantity="state"),
    "chiller_on": Sensor("nc", "Chiller run [1]", "chiller", 1, quantity="state"),
}
KEPT = ("T_bearing_front", "T_hall", "speed", "T_bearing_rear", "T_headstock")  # logged in each case
CHANNELS = 25  # logged at most
