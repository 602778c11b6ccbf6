"""The volumes of a flat-bed lathe in its hall, what heats them, and how each moves the turret against the spindle.

Shaft (s), its bearings, pulley, motor, chuck, cylinder (bf, br, pul, mot, chk, cyl), headstock and feet (h, f), bed
above and below in eight (t, b), foundation (fd), apron, saddle, cross slide (ap, sa, cs), turret with drive and
motor (tu, td, lm), screws with nut, bearing and motor (z, x), guide (gd), tailstock (ta, tq), workpiece (w), tanks of
hydraulics and coolant (ht, ct), chips (ch), the room of work (en). The maker's estimates.
"""

from __future__ import annotations

from collections.abc import Mapping

HEAT = """
    s1 2.6, s2 2.6, s3 2.6, s4 2.6, s5 2.6, bf 1.4, br 1.1, pul 3, mot 24, chk 12, cyl 6, hf 28, hm 42, hr 26,
    hl 14, f1 38, f2 40, t1 32, t2 32, t3 32, t4 32, t5 32, t6 32, t7 32, t8 32, b1 62, b2 62, b3 62, b4 62, b5 62,
    b6 62, b7 62, b8 62, fd 3000, ap 24, sa 46, cs 24, tu 20, td 6, lm 4, z1 2, z2 2, z3 2, z4 2, z5 2, z6 2,
    nz 2.4, bz 2.6, mz 6, x1 1, x2 1, x3 1, nx 1.6, bx 1.5, mx 4, gd 14, ta 30, tq 2.4, w1 2.5, w2 2.5, w3 2.5,
    ht 60, ct 650, ch 16, en 8
"""  # heat capacities [kJ/K]
LINKS = """
    s1-chk 5, s1-s2 4, s2-s3 4, s3-s4 4, s4-s5 4, s1-bf 6, s2-bf 5, s4-br 6, bf-hf 14, br-hr 11, pul-s5 6,
    pul-hr 2, mot-f1 6, mot-hr 3, cyl-s5 3, cyl-hr 2, hf-hm 22, hm-hr 22, hl-hm 8, hl-hf 5, hl-hr 5, hf-f2 14,
    hm-f2 9, hm-f1 9, hr-f1 14, f1-t1 16, f2-t2 18, chk-w1 4, w1-w2 0.5, w2-w3 0.5, w3-tq 0.8, tq-ta 5, ta-t7 16,
    sa-t4 9, sa-t5 9, sa-gd 8, gd-t4 8, gd-t5 8, gd-t3 5, ap-sa 14, cs-sa 12, tu-cs 12, td-tu 5, lm-tu 4, lm-td 2,
    bz-t2 5, mz-bz 3, bz-z1 1.2, z1-z2 0.45, z2-z3 0.45, z3-z4 0.45, z4-z5 0.45, z5-z6 0.45, nz-z2 1, nz-z3 1.4,
    nz-z4 1, nz-ap 3, bx-sa 4, mx-bx 2.2, bx-x1 0.9, x1-x2 0.4, x2-x3 0.4, nx-x2 1.2, nx-x1 0.8, nx-cs 2.5,
    ht-b1 8, ht-b2 7, ht-f1 3, ch-t3 5, ch-t4 8, ch-t5 8, ch-b4 5, ch-b5 5, ct-b6 5, ct-b7 7, en-t4 4, en-t5 4,
    en-tu 4, en-chk 3, en-hf 3, en-cs 4, en-ta 4, en-w2 1, en-sa 4, t1-b1 26, t2-b2 26, t3-b3 26, t4-b4 26,
    t5-b5 26, t6-b6 26, t7-b7 26, t8-b8 26, b1-fd 4, b2-fd 4, b3-fd 4, b4-fd 4, b5-fd 4, b6-fd 4, b7-fd 4, b8-fd 4,
    t1-t2 14, t2-t3 14, t3-t4 14, t4-t5 14, t5-t6 14, t6-t7 14, t7-t8 14, b1-b2 24, b2-b3 24, b3-b4 24, b4-b5 24,
    b5-b6 24, b6-b7 24, b7-b8 24
"""  # conductances between volumes [W/K]
AIR: Mapping[str, str] = {  # conductances to the layers of the hall's air [W/K]
    "top": "hl 9, hf 5, hm 7, hr 6, tu 2, en 4",
    "mid": """
        f1 6, f2 4, pul 2.5, cyl 2, mot 7, t1 5, t2 4, t6 5, t7 4, t8 7, ap 5, sa 4, cs 3, mz 3, mx 2, ta 5,
        z5 0.3, z6 0.3, en 4
""",
    "low": "ht 10, ct 45, ch 3, fd 40, b1 9, b2 9, b3 9, b4 9, b5 9, b6 9, b7 9, b8 9",
}
GUST = {"top": 0.15, "mid": 0.5, "low": 1.0}  # how the draught of the hall's door spreads
WASH = "t3 9, t4 14, t5 14, t6 7, chk 8, w1 5, td 5, tu 2, en 8, ch 6, cs 2"  # to the coolant while it flows [W/K]
FAN = "chk 6, hf 5, en 5, s1 1, pul 5, hr 4, w1 2"  # to the air that the chuck moves at full speed [W/K]
GROWTH: Mapping[str, str] = {  # of the turret against the main spindle [um/K]
    "Z": """
        s1 -0.9, s2 -0.5, bf -0.3, hf -1, hm -0.8, hr -0.3, f1 0.3, f2 -0.5, hl -0.3, chk -0.6, w1 -0.4, w2 -0.2,
        pul -0.1, mot -0.2, cyl -0.4, t1 0.3, t2 0.9, t3 1.1, t4 0.9, t5 0.4, b1 -0.4, b2 -0.5, b3 -0.6, b4 -0.5,
        b5 -0.3, z1 0.9, z2 1, z3 0.6, bz 0.5, nz 0.3, sa 0.5, ap 0.3, cs 0.3, tu -1.1, td -0.8, lm -0.2, gd 0.3,
        ht 0.4, ta -0.3, tq -0.8, ch 0.3
""",
    "X": """
        hf 1.7, hm 0.9, hr 0.4, f1 0.5, f2 1.1, hl 0.4, bf 0.6, s1 0.3, s4 -0.1, pul 0.1, mot 0.3, cyl 0.1,
        t1 -0.4, t2 -0.8, t3 0.4, t4 0.9, t5 0.8, t6 0.3, b1 0.5, b2 0.6, b3 -0.3, b4 -0.8, b5 -0.8, b6 -0.3,
        sa -1.2, cs -1.3, ap -0.2, x1 -1.1, x2 -1, x3 -0.4, nx -0.4, bx -0.5, mx -0.1, tu -1.6, td -1.4, lm -0.3,
        gd -0.8, z2 0.1, nz 0.2, ht 0.3, ta 0.2, tq 0.3, w1 0.3
""",
    "Y": """
        hf 1.4, hm 0.9, hr 0.3, f1 1, f2 1.5, hl 0.2, bf 0.5, s1 0.2, mot 0.3, pul 0.1, cyl 0.1, t2 0.5, t3 -0.5,
        t4 -0.8, t5 -0.6, b2 0.4, b3 -0.5, b4 -0.8, b5 -0.6, sa -1, cs -1.1, ap -0.2, tu -1.4, td -0.6, lm -0.2,
        gd -0.7, nz -0.2, z2 -0.1, nx -0.3, x2 -0.2, bx -0.2, ht 0.4, ta 0.2, tq 0.2, ch -0.2, w1 0.2
""",
}
SOURCES: Mapping[str, str] = {  # heat of each cause at full drive [W]
    "bearing": "bf 250, br 140, s2 25",
    "belt": "pul 130, mot 520, hr 50",
    "hydraulics": "ht 650, cyl 50, tu 25",
    "zscrew": "nz 55, bz 24, mz 60, z2 14, z3 12",
    "xscrew": "nx 26, bx 12, mx 30, x2 8",
    "guide": "gd 190",
    "coolant": "ct 620, ch 40",
    "cutting": "w1 110, w2 30, td 45, chk 25",
    "chips": "ch 400",
    "turret": "td 120, lm 110",
    "tailstock": "tq 130, w3 15",
    "sun": "hl 110, t8 50, en 60",
    "air": "",
    "door": "",
}
