"""A horizontal milling centre of a research laboratory: ram, travelling headstock, column, turning table.

Forty-one bodies, nineteen causes: spindle bearing, motor and gearbox, chiller, screws, feed motor and guide,
hydraulics, table, coolant, cutting, cabinet, the ram's oil, sun, the hall's air and its layers, the probes' fixture,
the pull of speed. Tool against table is the growth and bending of all bodies along the chain, so that each cause is
distributed in time. Its numbers were chosen by its maker, who had not read the diagnosis, and vary from case to case.
"""

from __future__ import annotations

from datetime import datetime, timedelta
from pathlib import Path
from typing import Any

import numpy as np

from ..files import first_model
from ..truth import Plan, hidden, shown_and_gone, write_truth
from .causes import BASE, CAUSES, plan
from .laboratory import Laboratory
from .machine import Centre, scaled
from .programme import Run, programme
from .sensors import KEPT, SENSORS

TESTS = (  # kind, role, hours
    ("const", "calibration", 12),
    ("spectrum", "calibration", 10),
    ("axes", "calibration", 8),
    ("etve", "calibration", 24),
    ("cutting", "calibration", 8),
    ("mixed", "verification", 12),
    ("repeat", "verification", 3),
    ("mixed", "locked", 12),
    ("mixed", "locked", 10),
)
TABLE = ("table", "calibration", 8)


def write(folder: Path, case: int) -> dict[str, Any]:
    """Write campaign.yaml, model.yaml and raw/ into folder; returns the truth, which also stands in truth.json."""
    rng = np.random.default_rng(551_000 + case)
    asked = plan(case, rng)
    base = _base(rng, asked)
    want_um = _sizes(rng, asked, base)
    top_rpm = float(rng.choice([3500, 5000, 8000]))
    runs = _runs(rng, asked, top_rpm)
    temps, move, lost_um = scaled(Centre(rng, asked.axis, top_rpm), runs, want_um)
    chosen = _channels(rng, asked, base)
    shown = [name for name in SENSORS if name in chosen]
    laboratory = Laboratory(rng, folder, asked.axis, asked.kind, case)
    fault = laboratory.log(runs, temps, move, shown)
    laboratory.campaign(runs, shown)
    effects = ((BASE[k][0], BASE[k][1]) for k in base)
    first_model(folder / "model.yaml", f"hmc-{case:02d}", asked.axis, "60 s", effects)
    truth = {
        "case": case,
        "kind": asked.kind,
        "weak": asked.weak,
        "axis": asked.axis,
        "base": base,
        "logged": sorted(chosen),
        "um": {k: round(v, 2) for k, v in lost_um.items()},
        "fault": fault,
        "hidden": [hidden(k, lost_um[k], CAUSES[k].right, CAUSES[k].twins, chosen, asked.kind) for k in asked.hidden],
    }
    return write_truth(folder, truth)


def _base(rng: np.random.Generator, asked: Plan) -> list[str]:
    """Causes that the first model knows: one to four."""
    base = [k for k in ("bearing", "ambient") if k not in asked.hidden]
    spare = [k for k in BASE if asked.axis in CAUSES[k].axes and k not in (*base, *asked.hidden)]
    return base + [str(k) for k in rng.permutation(spare)[: int(rng.integers(0, 3)) + (not base)]]


def _sizes(rng: np.random.Generator, asked: Plan, base: list[str]) -> dict[str, float]:
    """Size of each cause [um]."""
    want = {k: float(rng.uniform(0.1, 0.5)) for k in CAUSES}
    want |= {k: 0.0 for k in ("fixture", "centrifugal") if asked.axis == "Y"}
    want |= {k: float(rng.uniform(9, 22) if k == "bearing" else rng.uniform(4, 10)) for k in base}
    little = {k: asked.weak or k == "fixture" for k in asked.hidden}
    return want | {k: float(rng.uniform(2, 4) if few else rng.uniform(5, 15)) for k, few in little.items()}


def _runs(rng: np.random.Generator, asked: Plan, top_rpm: float) -> list[Run]:
    """Nine or ten tests, one each other day."""
    tests = list(TESTS)
    if "table" in asked.hidden or rng.random() < 0.4:
        tests.insert(4, TABLE)
    day = datetime(2026, 1, 12) + timedelta(days=int(rng.integers(0, 14)))
    runs = []
    for j, (kind, role, hours) in enumerate(tests):
        start = day + timedelta(days=2 * j, hours=int(rng.integers(6, 11)), minutes=int(rng.integers(0, 60)))
        took = hours * rng.uniform(0.9, 1.25)
        runs.append(programme(rng, f"m{j + 1:02d}_{kind}", kind, role, start, top_rpm, took))
    return runs


def _channels(rng: np.random.Generator, asked: Plan, base: list[str]) -> set[str]:
    """Channels that are logged: those of the base and of what is hidden, and some more."""
    least = {*KEPT, *(channel for k in base for channel in BASE[k][1].values())}
    shown, gone = shown_and_gone(asked, CAUSES, least)
    gone -= shown
    rest = [k for k in SENSORS if k not in shown | gone]
    more = max(0, min(len(rest), int(rng.integers(16, 23)) - len(shown)))
    return shown | set(map(str, rng.choice(rest, more, replace=False)))
