"""The channels that this laboratory can log beside the displacement: RTDs, the control, a recorder in the hall."""

from __future__ import annotations

from collections.abc import Mapping

from ..sensors import UNITS as LOGGED
from ..sensors import Sensor

UNITS = {**LOGGED, "rotational_speed": "1/min"}
SENSORS: Mapping[str, Sensor] = {
    "T_lager_v": Sensor("daq", "RTD01 Lager vorn", "spindle.bearing.front", 0.02, "bf 0.92, h1 0.08"),
    "T_lager_h": Sensor("daq", "RTD02 Lager hinten", "spindle.bearing.rear", 0.02, "br 0.8, h4 0.2"),
    "T_spikopf": Sensor("daq", "RTD03 Spindelgehäuse", "headstock", 0.02, "h2 1"),
    "T_kw_vl": Sensor("daq", "RTD04 Kühler VL", "chiller.supply", 0.02, "cw 1"),
    "T_kw_rl": Sensor("daq", "RTD05 Kühler RL", "chiller.return", 0.02, "cw 0.7, h3 0.3"),
    "T_lm_vl": Sensor("daq", "RTD06 LM Wasser VL", "chiller.supply", 0.02, "lw 1"),
    "T_lm_rl": Sensor("daq", "RTD07 LM Wasser RL", "chiller.return", 0.02, "lw 0.8, lx 0.1, ly 0.1"),
    "T_mutter_z": Sensor("daq", "RTD08 Mutter Z", "axis.z.nut", 0.05, "nz 0.9, rm1 0.1"),
    "T_wange": Sensor("daq", "RTD09 Wange A", "rotary.a", 0.02, "wa 1"),
    "T_tisch": Sensor("daq", "RTD10 Tischplatte", "table", 0.05, "r2 1"),
    "T_tab_lager": Sensor("daq", "RTD11 Lager C", "table.bearing", 0.05, "cm 0.5, r1 0.5"),
    "T_wst": Sensor("daq", "RTD12 Werkstück", "workpiece", 0.05, "wp 1"),
    "T_kss": Sensor("daq", "RTD13 KSS Tank", "coolant.tank", 0.05, "kt 1"),
    "T_kss_rl": Sensor("daq", "RTD14 KSS Rücklauf", "coolant.return", 0.1, "kt 0.6, pf1 0.2, r3 0.2"),
    "T_bett_o": Sensor("daq", "RTD15 Bett oben", "bed.top", 0.02, "pf1 1"),
    "T_bett_u": Sensor("daq", "RTD16 Bett unten", "bed.bottom", 0.02, "pf5 1"),
    "T_st_l": Sensor("daq", "RTD17 Ständer links", "column.left", 0.02, "cl1 0.5, cl2 0.5"),
    "T_st_r": Sensor("daq", "RTD18 Ständer rechts", "column.right", 0.02, "cr1 0.5, cr2 0.5"),
    "T_qt_v": Sensor("daq", "RTD19 Querträger vorn", "crossbeam.front", 0.02, "xf 1"),
    "T_qt_h": Sensor("daq", "RTD20 Querträger hinten", "crossbeam.rear", 0.02, "xr 1"),
    "T_ram_v": Sensor("daq", "RTD21 Z-Schieber vorn", "ram.front", 0.02, "rm2 1"),
    "T_ram_h": Sensor("daq", "RTD22 Z-Schieber hinten", "ram.rear", 0.02, "rr 1"),
    "T_fue_y": Sensor("daq", "RTD23 Führung Y", "axis.y.guide", 0.05, "ys1 0.7, pf1 0.3"),
    "T_kab": Sensor("daq", "RTD24 Kabine", "enclosure", 0.1, "ka 1"),
    "T_mot": Sensor("nc", "Spindle motor temperature", "spindle.motor", 1, "mo 1"),
    "T_lin_x": Sensor("nc", "Motor temperature X", "axis.x.motor", 1, "lx 1"),
    "T_lin_y": Sensor("nc", "Motor temperature Y", "axis.y.motor", 1, "ly 1"),
    "T_mot_z": Sensor("nc", "Motor temperature Z", "axis.z.motor", 1, "zm 1"),
    "T_A": Sensor("nc", "Motor temperature A", "rotary.a", 1, "am 1"),
    "T_C": Sensor("nc", "Motor temperature C", "rotary.c", 1, "cm 1"),
    "T_hyd": Sensor("nc", "Hydraulic oil", "hydraulics", 0.5, "ht 1"),
    "T_schrank": Sensor("nc", "Cabinet", "cabinet", 1, "cb 1"),
    "n_sp": Sensor("nc", "Spindle speed", "spindle", 1, quantity="rotational_speed"),
    "P_sp": Sensor("nc", "Spindle power", "spindle", 0.01, quantity="power"),
    "L_sp": Sensor("nc", "Spindle load", "spindle", 1, quantity="load"),
    "v_X": Sensor("nc", "Feed X", "axis.x", 0.01, quantity="feed"),
    "v_Y": Sensor("nc", "Feed Y", "axis.y", 0.01, quantity="feed"),
    "v_Z": Sensor("nc", "Feed Z", "axis.z", 0.01, quantity="feed"),
    "n_A": Sensor("nc", "Speed A", "rotary.a", 0.01, quantity="rotational_speed"),
    "n_C": Sensor("nc", "Speed C", "rotary.c", 0.01, quantity="rotational_speed"),
    "M_A": Sensor("nc", "Torque A", "rotary.a", 1, quantity="torque"),
    "kss_ein": Sensor("nc", "Coolant on", "coolant", 1, quantity="state"),
    "q_kss": Sensor("nc", "Coolant flow", "coolant", 0.1, quantity="flow"),
    "hyd_ein": Sensor("nc", "Hydraulics on", "hydraulics", 1, quantity="state"),
    "mess": Sensor("nc", "Measuring position", "", 1, quantity="state"),
    "T_halle": Sensor("rec", "hall_mid", "hall", 0.05),
    "T_oben": Sensor("rec", "hall_top", "hall.top", 0.05),
    "T_unten": Sensor("rec", "hall_floor", "hall.bottom", 0.05),
    "T_aussen": Sensor("rec", "outdoor", "outside", 0.1),
    "rF": Sensor("rec", "humidity", "hall", 0.5, quantity="humidity"),
}
