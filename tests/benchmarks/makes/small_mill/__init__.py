"""A small mill: a three-axis C-frame machine of a job shop, and what its laboratory logs.

Thirty bodies, thirteen causes: spindle bearing and motor, screws, feed motor and guide, cabinet, coolant, cutting, the
hall's air and its layers, the probe's bracket, the pull of speed. The displacement is the growth and bending of these
bodies summed along the chain from tool to table, so that each cause is distributed in time. Its numbers were chosen by
its maker, who had not read the diagnosis, and vary from case to case.
"""

from __future__ import annotations

from datetime import datetime, timedelta
from pathlib import Path
from typing import Any

import numpy as np

from ..files import first_model
from ..truth import Plan, hidden, write_truth
from .causes import BASE, CAUSES, plan
from .laboratory import SENSORS, Laboratory
from .machine import Mill, scaled
from .programme import Run, programme


def write(folder: Path, case: int) -> dict[str, Any]:
    """Write campaign.yaml, model.yaml and raw/ into folder; returns the truth, which also stands in truth.json."""
    rng = np.random.default_rng(770_000 + case)
    asked = plan(case, rng)
    base = _base(rng, asked)
    want_um, wet = _sizes(rng, asked, base)
    top_rpm = float(rng.choice([6000, 8000, 10000]))
    runs = _runs(rng, top_rpm, wet)
    temps, move, lost_um = scaled(Mill(rng, asked.axis, top_rpm), runs, want_um)
    chosen = _channels(rng, asked, base, wet)
    shown = [name for name in SENSORS if name in chosen]
    laboratory = Laboratory(rng, folder, asked.axis, asked.kind)
    fault = laboratory.log(runs, temps, move, shown)
    laboratory.campaign(case, runs, shown)
    effects = ((BASE[k][0], {"temperature": BASE[k][1]}) for k in base)
    first_model(folder / "model.yaml", f"mill-{case:02d}", asked.axis, "60 s", effects)
    truth = {
        "case": case,
        "kind": asked.kind,
        "weak": asked.weak,
        "axis": asked.axis,
        "base": base,
        "logged": sorted(chosen),
        "fault": fault,
        "um": {k: round(v, 2) for k, v in lost_um.items()},
        "hidden": [hidden(k, lost_um[k], CAUSES[k].right, CAUSES[k].twins, chosen, asked.kind) for k in asked.hidden],
    }
    return write_truth(folder, truth)


def _base(rng: np.random.Generator, asked: Plan) -> list[str]:
    """Causes that the first model knows: one to four."""
    able = [k for k, c in CAUSES.items() if asked.axis in c.axes]
    base = [k for k in ("bearing", "ambient") if k not in asked.hidden]
    spare = [k for k in BASE if k in able and k not in (*base, *asked.hidden)]
    more = [k for k in spare if rng.random() < (0.5 if len(base) < 2 else 0.35)]
    return base + (more[: 4 - len(base)] if base else ["motor"])


def _sizes(rng: np.random.Generator, asked: Plan, base: list[str]) -> tuple[dict[str, float], bool]:
    """Size of each cause [um], and whether the shop uses coolant."""
    want = {k: float(rng.uniform(0.1, 0.5)) if asked.axis in c.axes else 0.2 for k, c in CAUSES.items()}
    want |= {k: float(rng.uniform(8, 25) if k == "bearing" else rng.uniform(3, 9)) for k in base}
    want |= {k: float(rng.uniform(1.8, 3.8) if asked.weak else rng.uniform(5, 15)) for k in asked.hidden}
    wet = bool("coolant" in asked.hidden or rng.random() < 0.5)
    want["coolant"] *= wet
    return want, wet


def _runs(rng: np.random.Generator, top_rpm: float, wet: bool) -> list[Run]:
    """Eight to ten tests, one a day."""
    tests = [(kind, "calibration") for kind in ("const", "steps", "axis", "idle", "cut")]
    tests += [("mixed", "verification"), ("mixed", "locked"), ("mixed", "locked")]
    tests += [("const", "calibration")] * (rng.random() < 0.5) + [("cut", "verification")] * (rng.random() < 0.4)
    day = datetime(2026, 2, 2) + timedelta(days=int(rng.integers(0, 12)))
    runs = []
    for j, (kind, role) in enumerate(tests):
        start = day + timedelta(days=j, hours=int(rng.integers(7, 11)), minutes=int(rng.integers(0, 60)))
        runs.append(programme(rng, kind, f"t{j + 1:02d}_{kind}", role, start, top_rpm, wet))
    return runs


def _channels(rng: np.random.Generator, asked: Plan, base: list[str], wet: bool) -> set[str]:
    """Channels that are logged: those of the base and of what is hidden, and some more."""
    shown = {"T_brg", "T_hall", "speed_S", "pos_Z"} | {BASE[k][1] for k in base}
    gone: set[str] = set()
    for k in asked.hidden:
        needed = CAUSES[k].sensors.split()
        if asked.kind == "not_logged":
            gone |= {*needed, *(["T_table"] if k == "coolant" else [])}
        else:  # a nut without its sensor is told by its feed
            shown |= set(needed[1:] if needed[0] in ("T_nutZ", "T_nutY") and rng.random() < 0.25 else needed)
    rest = [k for k in SENSORS if k not in shown | gone and (wet or k not in ("T_cool", "coolant_on"))]
    more = max(0, min(len(rest), int(rng.integers(7, 10)) - len(shown)))
    return shown | set(map(str, rng.choice(rest, more, replace=False)))
