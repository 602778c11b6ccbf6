"""The channels that this laboratory can log beside the displacement."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(frozen=True)
class Sensor:
    """A channel: place, name in its log, the bodies it averages (none: what the control knows), resolution, log."""

    at: str
    signal: str
    mix: str = ""
    step: float = 0.02
    log: str = "daq"
    quantity: str = "temperature"

    @property
    def column(self) -> str:
        """Its name with what stands behind it in the head of the hall's workbook."""
        return self.signal + _TAILS.get((self.log, self.quantity), "")


_TAILS = {("hall", "temperature"): " [°C]", ("hall", "irradiance"): " [W/m2]"}
SENSORS: Mapping[str, Sensor] = {
    "T_bearing": Sensor("spindle.bearing.front", "Teploty/T01 lozisko predni", "bearing_front 0.85, ram_bottom_1 0.15"),
    "T_bearing_rear": Sensor("spindle.bearing.rear", "Teploty/T02 lozisko zadni", "bearing_rear 0.8, ram_top_2 0.2"),
    "T_gear": Sensor("spindle.gearbox", "Teploty/T03 prevodovka", "gearbox 1"),
    "T_head": Sensor("headstock", "Teploty/T04 vretenik", "headstock 0.9, gearbox 0.1"),
    "T_ram_top": Sensor("ram.top", "Teploty/T05 smykadlo nahore", "ram_top_2 0.6, ram_top_3 0.4"),
    "T_ram_bottom": Sensor("ram.bottom", "Teploty/T06 smykadlo dole", "ram_bottom_2 0.6, ram_bottom_3 0.4"),
    "T_col_front": Sensor("column.front", "Teploty/T07 stojan predni", "column_front_2 0.7, column_front_1 0.3"),
    "T_col_rear": Sensor("column.rear", "Teploty/T08 stojan zadni", "column_rear_2 0.7, column_rear_3 0.3"),
    "T_bed": Sensor("bed", "Teploty/T09 loze", "bed_column 0.5, bed_table 0.5"),
    "T_scale_Z": Sensor("axis.z.scale", "Teploty/T10 pravitko Z", "scale_z 1"),
    "T_scale_Y": Sensor("axis.y.scale", "Teploty/T11 pravitko Y", "scale_y 1"),
    "T_nut_Z": Sensor("axis.z.nut", "Teploty/T12 matice Z", "nut_z 0.8, bed_table 0.2"),
    "T_nut_Y": Sensor("axis.y.nut", "Teploty/T13 matice Y", "nut_y 0.8, headstock 0.2"),
    "T_guide_Y": Sensor("axis.y.guide", "Teploty/T14 vedeni Y", "guide_y 0.9, column_front_2 0.1"),
    "T_table": Sensor("table.bearing", "Teploty/T15 stul lozisko", "table_bearing 0.8, table 0.2"),
    "T_hydraulics": Sensor("hydraulics", "Teploty/T16 hydraulika", "hydraulics 1"),
    "T_chiller": Sensor("chiller.supply", "Teploty/T17 chladic privod", "jacket 1"),
    "T_coolant": Sensor("coolant.tank", "Teploty/T18 emulze", "coolant_tank 1", 0.1),
    "T_fixture": Sensor("fixture", "Teploty/T19 drzak sond", "fixture 1"),
    "T_motor_S": Sensor("spindle.motor", "tMotSP", "motor 1", 1.0, "nc"),
    "T_motor_Z": Sensor("axis.z.motor", "tMotZ", "motor_z 1", 1.0, "nc"),
    "T_motor_Y": Sensor("axis.y.motor", "tMotY", "motor_y 1", 1.0, "nc"),
    "speed": Sensor("spindle", "nActSpeed", "", 1.0, "nc", "rotational_speed"),
    "power": Sensor("spindle", "pActSpindle", "", 0.01, "nc", "power"),
    "feed_Z": Sensor("axis.z", "vActZ", "", 0.001, "nc", "feed"),
    "feed_Y": Sensor("axis.y", "vActY", "", 0.001, "nc", "feed"),
    "speed_table": Sensor("table", "nActB", "", 0.1, "nc", "rotational_speed"),
    "coolant_on": Sensor("coolant", "bCoolant", "", 1.0, "nc", "state"),
    "T_air_top": Sensor("hall.top", "vzduch nahore", "top 1", 0.1, "hall"),
    "T_air_bottom": Sensor("hall.bottom", "vzduch dole", "low 1", 0.1, "hall"),
    "T_air": Sensor("hall", "vzduch u stroje", "mid 1", 0.1, "hall"),
    "G_window": Sensor("hall.window", "slunce", "", 1.0, "hall", "irradiance"),
}
KEPT = ("T_bearing", "T_air", "speed", "feed_Z", "feed_Y", "power", "speed_table")  # logged in each case
UNITS = {
    "temperature": "°C",
    "rotational_speed": "1/min",
    "power": "kW",
    "feed": "m/min",
    "state": "-",
}  # of the control
