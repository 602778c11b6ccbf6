"""The channels that this laboratory can log beside the displacement."""

from __future__ import annotations

from collections.abc import Mapping

from ..sensors import Sensor

SENSORS: Mapping[str, Sensor] = {
    "T_brg_f": Sensor("crio", "AI00_brg_f", "spindle.bearing.front", 0.02, "bearing_front 1"),
    "T_brg_r": Sensor("crio", "AI01_brg_r", "spindle.bearing.rear", 0.02, "bearing_rear 0.8, sleeve_3 0.2"),
    "T_head": Sensor("crio", "AI02_head", "headstock", 0.02, "headstock_1 0.5, headstock_2 0.4, mid 0.1"),
    "T_nut_Y": Sensor("crio", "AI03_nut_Y", "axis.y.nut", 0.05, "nut_y 0.9, slide_y 0.1"),
    "T_brg_Y": Sensor("crio", "AI04_brg_Y", "axis.y.bearing", 0.05, "bearing_y 0.85, column_front_5 0.15"),
    "T_nut_X": Sensor("crio", "AI05_nut_X", "axis.x.nut", 0.05, "nut_x 0.8, carriage_x 0.2"),
    "T_brg_X": Sensor("crio", "AI06_brg_X", "axis.x.bearing", 0.05, "bearing_x 0.9, bed_top_5 0.1"),
    "T_nut_Z": Sensor("crio", "AI07_nut_Z", "axis.z.nut", 0.05, "nut_z 0.8, slide_z 0.2"),
    "T_brg_Z": Sensor("crio", "AI08_brg_Z", "axis.z.bearing", 0.05, "bearing_z 0.85, bed_top_1 0.15"),
    "T_guide_Z": Sensor("crio", "AI09_guide_Z", "axis.z.guide", 0.05, "guide_z 0.9, slide_z 0.1"),
    "T_scale_Z": Sensor("crio", "AI10_scale_Z", "axis.z.scale", 0.02, "scale_z 0.95, enclosure 0.05"),
    "T_col_f": Sensor("crio", "AI11_col_f", "column.front", 0.02, "column_front_2 0.6, column_front_3 0.4"),
    "T_col_r": Sensor("crio", "AI12_col_r", "column.rear", 0.02, "column_rear_2 0.6, column_rear_3 0.4"),
    "T_col_t": Sensor("crio", "AI13_col_t", "column.top", 0.05, "column_front_5 0.5, column_rear_5 0.5"),
    "T_bed_top": Sensor("crio", "AI14_bed_top", "bed.top", 0.02, "bed_top_3 0.7, bed_top_4 0.3"),
    "T_bed_bot": Sensor("crio", "AI15_bed_bot", "bed.bottom", 0.02, "bed_bottom_3 0.6, bed_bottom_4 0.4"),
    "T_cool": Sensor("crio", "AI16_cool", "coolant.tank", 0.05, "coolant_tank 1"),
    "T_cool_ret": Sensor("crio", "AI17_cool_ret", "coolant.return", 0.1, "coolant_tank 0.6, chips 0.2, enclosure 0.2"),
    "T_ch_sup": Sensor("crio", "AI18_ch_sup", "chiller.supply", 0.05, "water_tank 1"),
    "T_ch_ret": Sensor("crio", "AI19_ch_ret", "chiller.return", 0.05, "water_3 0.8, water_plate 0.2"),
    "T_oilair": Sensor("crio", "AI20_oilair", "lubrication", 0.1, "oil_air 1"),
    "T_hyd": Sensor("crio", "AI21_hyd", "hydraulics", 0.05, "hydraulic_tank 1"),
    "T_B": Sensor("crio", "AI22_B", "rotary.b", 0.05, "bearing_b 0.7, table_b 0.3"),
    "T_tool": Sensor("crio", "AI23_tool", "tool", 0.1, "tool 0.5, holder 0.5"),
    "T_part": Sensor("crio", "AI24_part", "workpiece", 0.05, "part_1 0.5, part_2 0.5"),
    "T_chips": Sensor("crio", "AI25_chips", "conveyor", 0.1, "chips 1"),
    "T_encl": Sensor("crio", "AI26_encl", "enclosure", 0.1, "enclosure 1"),
    "T_hall": Sensor("crio", "AI27_hall", "hall", 0.05, "mid 1"),
    "T_hall_top": Sensor("crio", "AI28_hall_top", "hall.top", 0.05, "top 1"),
    "T_hall_low": Sensor("crio", "AI29_hall_low", "hall.bottom", 0.05, "low 1"),
    "T_floor": Sensor("crio", "AI30_floor", "floor", 0.05, "foundation 1"),
    "T_wind": Sensor("nc", "S1 Temp Wicklung", "spindle.motor", 1, "stator 1"),
    "T_mot_X": Sensor("nc", "X Temp Motor", "axis.x.motor", 1, "motor_x 1"),
    "T_mot_Y": Sensor("nc", "Y Temp Motor", "axis.y.motor", 1, "motor_y 1"),
    "T_mot_Z": Sensor("nc", "Z Temp Motor", "axis.z.motor", 1, "motor_z 1"),
    "T_mot_B": Sensor("nc", "B Temp Motor", "rotary.b.motor", 1, "motor_b 1"),
    "n_sp": Sensor("nc", "S1 Drehzahl Ist", "spindle", 1, quantity="rotational_speed"),
    "n_B": Sensor("nc", "B Drehzahl Ist", "rotary.b", 0.1, quantity="rotational_speed"),
    "v_X": Sensor("nc", "X Vorschub Ist", "axis.x", 0.01, quantity="feed"),
    "v_Y": Sensor("nc", "Y Vorschub Ist", "axis.y", 0.01, quantity="feed"),
    "v_Z": Sensor("nc", "Z Vorschub Ist", "axis.z", 0.01, quantity="feed"),
    "P_sp": Sensor("nc", "S1 Leistung", "spindle", 0.01, quantity="power"),
    "load_sp": Sensor("nc", "S1 Auslastung", "spindle", 1, quantity="load"),
    "cool_on": Sensor("nc", "M8", "coolant", 1, quantity="state"),
    "hyd_on": Sensor("nc", "Hydraulik Ein", "hydraulics", 1, quantity="state"),
    "chill_on": Sensor("nc", "Verdichter Ein", "chiller", 1, quantity="state"),
}
KEPT = ("n_sp", "T_brg_f", "T_hall")  # logged in each case
