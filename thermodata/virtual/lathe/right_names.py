"""What the library calls each cause of the lathe. Nothing else here knows the library.

It was made from docs/effects.md alone, when the causes stood. The machine was then softened once: castings, oil,
motor plate and coolant were changed where the right name held less than half of its cause.
"""

from __future__ import annotations

from dataclasses import replace

from thermodata.virtual.lathe.causes import CAUSES
from thermodata.virtual.lathe.logged.sensors import BY_NAME
from thermodata.virtual.truth.names import Names, right

_TABLE: Names = {
    "bearing_friction": right(
        [("spindle_bearing", "TS_brg_f"), ("spindle_bearing", "TS_brg_r"), ("spindle_friction", "n_S")],
        "TS_brg_f TS_brg_r n_S",
        "spindle",
    ),
    "belt_motor": right([("spindle_motor", "T_mot_S")], "T_mot_S", "spindle"),
    "nut_z": right([("feed_screw", "C01_nutZ"), ("feed_screw", "v_Z")], "C01_nutZ v_Z", "feed_z"),
    "nut_x": right([("feed_screw", "C02_nutX"), ("feed_screw", "v_X")], "C02_nutX v_X", "feed_x"),
    "hall_air": right([("ambient_frame", "A2_low"), ("ambient_frame", "A1_high")], "A1_high A2_low", "ambient"),
    # its drivers are both airs together; one alone is the family, not the layers
    "hall_layers": right([("vertical_gradient", "A1_high,A2_low")], "", "ambient"),
    "coolant_film": right([("coolant", "M_cool")], "M_cool C05_bedtop", "coolant"),
    "hydraulic_oil": right([("hydraulics", "C11_oil")], "C11_oil C07_rib p_hyd", "hydraulics"),
    "turret_gear": right([("turret_heat", "C08_turret"), ("turret_friction", "n_tool")], "C08_turret n_tool", "turret"),
    "hot_part": right([("workpiece", "C12_part"), ("cutting_power", "P_S")], "C12_part P_S", "workpiece cutting"),
    "probe_bracket": right([("probe_temperature", "C09_bracket")], "C09_bracket", "probe"),
    "guide_friction": right([("guideway", "C03_guide"), ("lag", "C03_guide")], "C03_guide", "guide_z"),
    "ring_expansion": right([("centrifugal_shift", "n_S")], "n_S", "centrifugal"),
    "seat_play": right([], "TS_brg_f C04_foot", ""),
    "chip_heap": right([], "", ""),
    "lost_stretch": right([], "C01_nutZ", ""),
}
RIGHT: Names = {
    cause: replace(r, places=tuple(at for s in CAUSES[cause].sensors if CAUSES[cause].known and (at := BY_NAME[s].at)))
    for cause, r in _TABLE.items()
}
