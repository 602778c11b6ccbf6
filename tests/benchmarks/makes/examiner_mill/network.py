"""The volumes of a vertical centre with a rotary table, what heats them, and how each moves the tool.

Shaft and housing of the spindle (sh, ho), headstock (hd), column front, rear and sides (cf, cr, cs), bed top and bottom
(bt, bb), saddle, table, rotary table (sa, tb, ro), screws and scales of three axes (sx sy sz, ex ey ez), tool and
workpiece (tl, wp). Conduction between neighbours, a surface each to its air. The maker's estimates.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from ..bodies import pairs


@dataclass(frozen=True)
class Source:
    """A source of heat, of two nodes. cause: what its heat is counted to. heat: capacities of both [kJ/K]. between:
    them, surface: of the second [W/K]. losses: of inputs [W]. thins: fall of friction [1/K]. flows: into volumes [W/K].
    """

    cause: str
    heat: tuple[float, float]
    between: float
    surface: float
    losses: str
    thins: float
    flows: str


CHAINS = """
    sh 4 14 7 2 0.2 0.3, ho 4 30 18 3 0.2 0.3, hd 3 150 45 15 0.3 0.3, cf 4 420 35 55 -0.5 1, cr 4 420 35 62 -0.5 1,
    cs 2 160 15 35 0 0.8, bt 3 700 40 40 -0.7 -0.7, bb 3 800 40 45 -1 -1, sa 2 170 40 18 -0.4 -0.4,
    tb 3 190 35 26 -0.3 -0.3, ro 2 60 15 7 -0.1 0, sx 5 5 0.35 2.4 -0.3 -0.3, sy 5 5 0.35 2.2 -0.5 -0.5,
    sz 5 5 0.35 2.2 0 1, ex 1 2 1 0.9 -0.3 -0.3, ey 1 2 1 0.9 -0.5 -0.5, ez 1 2 1 0.9 0.4 0.4, tl 1 1.2 1 0.8 0 0,
    wp 1 24 1 5 0 0
"""  # volumes in a row: how many, heat capacity [kJ/K], between neighbours [W/K], surface [W/K], first and last place
LINKS = """
    sh0-ho0 4, sh1-ho0 2, sh3-ho3 4, ho0-hd0 12, ho2-hd1 14, ho3-hd2 8, hd2-cf2 12, hd2-cf3 6, cf0-cr0 9, cf1-cr1 9,
    cf2-cr2 9, cf3-cr3 12, cs0-cr1 14, cs0-cf1 14, cs1-cr3 14, cs1-cf3 14, cf0-bt2 25, cr0-bb2 25, bt0-bb0 20,
    bt1-bb1 20, bt2-bb2 22, sa0-bt0 9, sa1-bt1 9, tb0-sa0 7, tb2-sa1 7, ro0-tb1 9, wp0-ro1 6, tl0-sh0 1.5,
    sx0-sa0 0.8, sx2-tb1 0.4, sy0-bt2 0.8, sy2-sa1 0.4, sz4-cf3 0.8, sz2-hd2 0.4, ex0-tb0 0.6, ey0-sa0 0.6,
    ez0-cf2 0.6
"""  # conductances between rows [W/K]
GROWTH = {  # of the tool against the table [um/K], and its tilt T [urad/K]
    "X": """
        cs0 4, cs1 5, cf0 -1.5, cf1 -1.5, cr1 -1, tb0 -3, tb1 1.5, tb2 3.5, ro0 -3.4, ro1 -1.8, wp0 -1.2, sa0 1.2,
        sa1 -0.8, sx0 2.3, sx1 2.3, sx2 1.6, sx3 0.5, ex0 -5, hd1 0.6, ho1 0.3, bt0 0.6
""",
    "Y": """
        cf0 8, cf1 6, cf2 4, cf3 1.5, cr0 -8, cr1 -6, cr2 -4, cr3 -1.5, hd0 -2, hd1 -2.2, hd2 -2.6, ho1 -0.6,
        ho2 -0.6, sh1 -0.3, bt0 2, bt1 2.5, bt2 3, bb0 -1, bb1 -2, bb2 -2, sa0 2.5, sa1 3, sy0 2.3, sy1 2.3, sy2 1.5,
        sy3 0.4, ey0 -5, tb1 1, ro0 1.4, ro1 1.5, wp0 1.3
""",
    "Z": """
        cf0 2.3, cf1 2.3, cf2 1.4, cr0 2.3, cr1 2.3, cr2 1.4, cs0 0.5, hd0 -1.6, hd1 -0.9, hd2 0.7, ho0 -1.2,
        ho1 -1.2, ho2 -0.9, ho3 -0.5, sh0 -1.5, sh1 -1.2, sh2 -0.9, sh3 -0.5, bt0 -2.2, bt1 -2.4, bt2 0.4, bb0 -1.2,
        bb1 -1.3, sa0 -1.3, sa1 -1.3, tb0 -0.5, tb1 -1.2, tb2 -0.5, ro0 -1.5, ro1 -1.5, wp0 -1.5, tl0 -1.6, sz0 1,
        sz1 2.3, sz2 2.3, sz3 2.3, sz4 2.3, ez0 -4
""",
    "T": """
        cf0 9, cf1 9, cf2 7, cf3 2, cr0 -9, cr1 -9, cr2 -7, cr3 -2, hd0 -3, hd1 1.5, hd2 4.5, ho0 -1, ho3 1.5,
        bt0 -6, bt1 -7, bt2 -3, bb0 6, bb1 7, bb2 3, sa0 -2, sa1 3, ro0 -1.5
""",
}
SOURCES: Mapping[str, Source] = {  # the first three warm the chiller's water
    "bf": Source("bearing", (3, 8), 14, 7, "n^1.6 270", 0.012, "sh0 3, sh1 2, ho0 6, hd0 2"),
    "br": Source("bearing", (3, 7), 12, 6, "n^1.4 150", 0.012, "sh3 2, ho3 5, hd2 2"),
    "mo": Source("motor", (12, 26), 24, 14, "P 60, n^2 110", 0, "hd2 6, hd1 4, cf3 1, sh3 1"),
    "ge": Source("gearbox", (9, 30), 20, 9, "n^1.2 330, P 40", 0.015, "hd1 6, hd2 6, cf2 1"),
    "be": Source("belt", (3, 7), 8, 6, "n^1.1 210, P 18", 0, "hd2 5, hd1 2, cf3 1"),
    "hy": Source("hydraulics", (50, 60), 40, 22, "hyd 420", 0, "bb2 8, cr0 9, cs0 5"),
    "nx": Source("screw_X", (2.5, 3), 4, 3, "vx^1.2 7", 0.01, "sx1 0.7, sx2 0.9, sx3 0.7, tb1 0.6"),
    "ny": Source("screw_Y", (2.5, 3), 4, 3, "vy^1.2 8", 0.01, "sy1 0.7, sy2 0.9, sy3 0.7, sa1 0.6"),
    "nz": Source("screw_Z", (2.5, 3), 4, 3, "vz^1.2 7", 0.01, "sz1 0.7, sz2 0.9, sz3 0.7, hd2 0.5"),
    "mx": Source("fmot_X", (6, 12), 9, 7, "vx 8, on 10", 0, "sx0 0.7, sa0 3, tb0 0.6"),
    "my": Source("fmot_Y", (6, 12), 9, 7, "vy 8, on 12", 0, "sy0 0.7, bt2 3"),
    "mz": Source("fmot_Z", (7, 14), 9, 8, "vz 11, on 35", 0, "sz4 0.7, cf3 4, cr3 1.5"),
    "gx": Source("guide_X", (6, 16), 9, 5, "vx^1.3 8", 0.006, "sa0 4, sa1 3, tb0 3, tb2 4"),
    "gy": Source("guide_Y", (7, 18), 9, 5, "vy^1.3 9", 0.006, "bt0 4, bt1 5, sa0 2, sa1 3"),
    "gz": Source("guide_Z", (6, 16), 9, 5, "vz^1.3 9", 0.006, "hd2 4, cf2 5, cf3 3"),
    "sc": Source("scale", (3, 9), 3, 2, "air 26", 0, "ey0 1.2, sa0 1"),
    "rt": Source("rotary", (4, 14), 10, 5, "na^1.1 95", 0.008, "ro0 5, ro1 3, tb1 2"),
    "wk": Source("cut", (2, 5), 6, 3, "cut 45", 0, "wp0 6, ro1 1.5"),
    "cp": Source("chips", (14, 30), 16, 12, "cut 55", 0, "bt0 6, bt1 9, tb1 1"),
    "tt": Source("tool", (0.5, 1.2), 2, 2, "cut 14, n^2 12", 0, "tl0 2.5, sh0 0.7"),
    "ca": Source("cabinet", (14, 30), 20, 15, "on 60, P 18, vx 4, vy 4, vz 4", 0, "cr1 5, cr2 6, cr3 3"),
}
MEDIA = {  # what has a temperature of its own, and warms volumes [W/K]; hall and gradient: by their surfaces
    "chiller": "ho0 7, ho1 9, ho2 9, ho3 6, hd0 2, hd1 3",
    "coolant": "tb0 4, tb1 6, tb2 4, wp0 7, ro1 5, bt0 6, bt1 3, sa1 1.5, tl0 0.3",
    "hall": "",
    "gradient": "",
    "sun": "cs0 50, cs1 60, cr3 12",
    "door": "bt0 9, bt1 5, cf0 7, cf1 5, tb0 6, sa0 5, hd0 2",
}


def flows(field: str) -> Mapping[str, float]:
    """What a source or medium warms [W/K]."""
    text = SOURCES[field].flows if field in SOURCES else MEDIA[field]
    return pairs(text) if text else {}
