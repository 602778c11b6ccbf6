"""The bodies of a five-axis trunnion machine, what heats them, and how each moves the tool.

Bed (front pf, rear pr, each in five layers from the top), columns left and right (cl, cr), crossbeam (xf, xr), saddle
and ram of Z (xs, rm, rr), spindle housing, shaft and tool (h, s, tl), screw (z), slide of Y (ys), drive and bearing
side of the trunnion (wa, wb), trunnion (ta), rotary table (r), workpiece (wp). The maker's estimates.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from ..bodies import pairs


@dataclass(frozen=True)
class Source:
    """A source or fluid of its own temperature. cause: what its heat is counted to. heat: capacity [kJ/K].
    surface: to its air [W/K]. flows: conductances to the bodies that it heats [W/K]."""

    cause: str
    heat: float
    surface: float
    air: str
    flows: str


ZONES = "kmtl"  # airs: cabin, hall, its top, its bottom
BODIES = """
    pf1 260 6 k, pf2 260 3 l, pf3 260 3 l, pf4 260 3 l, pf5 260 5 l, pr1 300 6 m, pr2 300 3 l, pr3 300 3 l,
    pr4 300 3 l, pr5 300 5 l, cl1 150 13 m, cl2 140 14 t, cr1 150 13 m, cr2 140 14 t, xf 170 10 t, xr 150 9 t,
    xs 60 4 t, rm1 45 3 t, rm2 45 3 k, rm3 40 3 k, rr 40 3 t, h1 9 1 k, h2 9 0.8 k, h3 10 0.8 k, h4 9 1 k,
    s1 3.5 0.6 k, s2 3 0.1 k, s3 3 0.1 k, s4 2.5 0.1 k, tl 1.5 0.8 k, z1 1.6 0.5 t, z2 1.6 0.5 t, z3 1.6 0.5 k,
    ys1 90 6 k, ys2 90 5 k, wa 55 5 k, ta1 28 2 k, ta2 28 2 k, ta3 28 2 k, wb 45 5 k, r1 9 1 k, r2 12 1.5 k,
    r3 14 2 k, wp 22 2.5 k
"""  # heat capacity [kJ/K], surface [W/K], air
JOINTS = """
    pf1-pf2 17, pf2-pf3 17, pf3-pf4 17, pf4-pf5 17, pr1-pr2 20, pr2-pr3 20, pr3-pr4 20, pr4-pr5 20, pf1-pr1 12,
    pf3-pr3 8, pf5-pr5 8, cl1-pr1 20, cr1-pr1 20, cl1-cl2 45, cr1-cr2 45, cl2-xf 25, cr2-xf 25, cl2-xr 20,
    cr2-xr 20, xf-xr 25, xs-xf 14, xs-xr 4, xs-rm1 12, xs-rr 8, rm1-rm2 30, rm2-rm3 30, rr-rm1 15, rr-rm2 10,
    rm3-h3 10, rm3-h2 8, h1-h2 14, h2-h3 14, h3-h4 14, s1-s2 8, s2-s3 8, s3-s4 7, s1-tl 3, s1-h1 5, s4-h4 5,
    z1-z2 1.2, z2-z3 1.2, z1-xs 2, z3-rm2 0.8, ys1-pf1 14, ys2-pf1 8, ys2-pr1 6, ys1-ys2 30, wa-ys2 14, wb-ys1 12,
    wa-ta1 9, ta1-ta2 22, ta2-ta3 22, ta3-wb 7, r1-ta2 6, r1-r2 12, r2-r3 12, wp-r2 10
"""  # conductances between bodies [W/K]
GROWTH = {  # of the tool against the table [um/K]
    "Z": """
        pf1 -1.7, pf2 -1.7, pf3 -1.7, pf4 -1.7, pf5 -1.7, pr1 1.7, pr2 1.7, pr3 1.7, pr4 1.7, pr5 1.7, cl1 2.6,
        cl2 2.6, cr1 2.6, cr2 2.6, xf 0.8, xr -0.8, xs -0.5, rm1 -1, rm2 -1.2, rm3 -1.2, rr 0.4, h1 -0.5, h2 -0.6,
        h3 -0.5, h4 -0.3, s1 -0.8, s2 -0.7, s3 -0.5, s4 -0.3, tl -0.8, z1 -1.5, z2 -1.5, z3 -0.8, ys1 -0.7,
        ys2 -0.7, wa -1, wb -0.9, ta1 -0.3, ta2 -0.7, ta3 -0.3, r1 -0.5, r2 -0.4, r3 -0.2, wp -1.2
""",
    "Y": """
        pf1 -6, pf2 -2.5, pf4 2, pf5 4, pr1 4, pr2 2, pr4 -1.5, pr5 -3, cl1 1.2, cr1 1.2, cl2 1, cr2 1, xf 6,
        xr -5, xs 2.2, rm1 1.5, rm2 1.5, rm3 1.8, rr -4, h1 0.8, h2 1.4, h3 1.8, h4 1, ys1 2.6, ys2 -3.4, wa -2,
        wb -1.6, ta1 -0.6, ta2 -1, ta3 -0.6, r1 -0.8, r2 -1.2, r3 -1.6, wp -1.4
""",
    "X": """
        cl1 2.2, cl2 3, cr1 -2.2, cr2 -3, xf 1.2, xr 1, xs 3, rm1 1, rm2 1, rm3 1, h2 0.8, h3 1.2, ys1 1, ys2 -1.2,
        wa -4.5, ta1 -3.4, ta2 -2.4, ta3 1.2, wb 2, r1 -0.8, r2 -1, r3 -1.2, wp -1.5, pf1 -1.2, pr1 1
""",
}
SOURCES: Mapping[str, Source] = {
    "bf": Source("bearing", 3, 9, "k", "s1 3, h1 4"),
    "br": Source("bearing", 2.5, 7, "k", "s4 2.5, h4 3.5"),
    "mo": Source("motor", 14, 1, "k", "s2 1.5, s3 2.5, h2 3, h3 4"),
    "cw": Source("chiller", 110, 8, "m", "h1 10, h2 22, h3 30, h4 14"),
    "lx": Source("linx", 16, 5, "t", "xs 9, xf 3"),
    "ly": Source("liny", 18, 4, "k", "ys1 8, ys2 10, pf1 3"),
    "lw": Source("lmcool", 90, 8, "m", "xs 12, ys1 14, ys2 14"),
    "nz": Source("screwz", 3, 7, "t", "z1 2, z2 3, z3 2, rm1 2"),
    "am": Source("rotA", 15, 2, "k", "wa 12, ta1 4"),
    "cm": Source("rotC", 12, 2, "k", "r1 7, ta2 4"),
    "kt": Source("kss", 900, 40, "l", "r2 2, r3 3, wp 4, ta2 1.5, wb 1.2, wa 1, pf1 2, s2 0.3, tl 0.5"),
    "ht": Source("hydr", 130, 14, "m", "pr1 16, pr2 8, cr1 6"),
    "ka": Source("cabin", 40, 180, "m", ""),
    "zm": Source("other", 7, 4, "t", "z1 0.03"),
    "cb": Source("other", 40, 12, "m", "cl1 0.1"),
}
CUT = "wp 0.045, r2 0.014, tl 0.003, s1 0.002, pf1 0.025, ta2 0.004"  # shares of the cutting power

MACHINE = """
    bf 220, br 130, visc 0.02, preload 0.03, iron 260, copper 700, idle 60, pump 350, chill 3000, mc 28, lx 240, ly 300,
    lc 20, lp 150, valve 220, nut 160, roll 90, hold 260, disc 110, ac 12, cc 10, tank 1100, oil 520, air 350, kW 18
"""  # losses [W], what those of the bearings hang on [1/K], flows of heat of the water [W/K], power [kW]
HALL = "out 1, day 2.5, fail 0.8, stir 0.5, layer 0.8, band 0.4, leak 0.13, load 2, cool 2.5"


def flows(source: Source) -> Mapping[str, float]:
    return pairs(source.flows) if source.flows else {}
