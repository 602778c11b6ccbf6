"""A five-axis machining centre with a trunnion table, and what its laboratory logs.

A gantry on a bed of polymer concrete in five layers, linear motors with their own water, a screw of Z without a scale,
a motor spindle with a chiller of two temperatures, torque motors of which A also holds a tilted table, coolant, cabin,
a hall whose air-conditioning fails: 44 bodies, 15 sources, 16 causes. The tool moves by the growth of all bodies of the
chain, bed and beams bend with it. Its numbers were chosen by its maker, who had not read the diagnosis.
"""

from __future__ import annotations

from collections.abc import Sequence
from datetime import datetime, timedelta
from pathlib import Path
from typing import Any

import numpy as np

from ..bodies import Array
from ..files import document
from ..truth import Plan, hidden, write_truth
from .causes import BASE, CAUSES, plan
from .laboratory import Laboratory
from .machine import NAMES, Machine, scaled
from .programme import HOURS, Run, run


def write(folder: Path, case: int) -> dict[str, Any]:
    """Write campaign.yaml, model.yaml and raw/ into folder; returns the truth, which also stands in truth.json."""
    rng = np.random.default_rng([28, 20261127, case])
    asked = plan(case, rng)
    base, name = _base(rng, asked), f"trunnion-{case:02d}"
    m = Machine(rng)
    runs = _runs(rng, asked, base, m)
    want_um = _sizes(rng, asked, base)
    shown = {*asked.hidden, *base, "hall", "other"}
    size = {k: 1.0 if k in shown else 0.03 for k in NAMES}
    shares, sources, part, um, size = scaled(m, runs, asked.axis, want_um, size)
    laboratory = Laboratory(rng, folder, name, asked, base, (m.w["top"], m.w["kW"]))
    move = {a: m.moves(a, shares, runs, size).sum(1) for a in "XYZ"}
    fault = laboratory.log(runs, move, shares.sum(1), sources)
    laboratory.campaign(runs)
    _first_model(folder / "model.yaml", name, asked.axis, base)
    logged = set(laboratory.shown)
    truth = {
        "case": case,
        "kind": asked.kind,
        "weak": asked.weak,
        "axis": asked.axis,
        "base": base,
        "fault": fault,
        "hidden": [hidden(k, um[k], CAUSES[k].right, CAUSES[k].twins, logged, asked.kind) for k in asked.hidden],
        "um": {k: round(a, 2) for k, a in um.items()},
        "size": {k: round(a, 4) for k, a in size.items()},
        "lab": laboratory.told,
        "tests": [[r.id, r.role, round(r.steps / 60, 1), _range(part[-r.steps :, :, j])] for j, r in enumerate(runs)],
    }
    return write_truth(folder, truth)


def _range(part: Array) -> float:
    """Of a test's displacement [um]. part: (time, cause)."""
    return round(float(np.ptp(part.sum(1))), 1)


def _base(rng: np.random.Generator, asked: Plan) -> list[str]:
    """Causes that the first model knows: the hall and at most three."""
    able = [k for k in dict.fromkeys(map(str, rng.permutation(BASE))) if k not in asked.hidden]
    return ["hall", *[k for k in able if asked.axis in CAUSES[k].axes][: int(rng.integers(0, 4))]]


def _sizes(rng: np.random.Generator, asked: Plan, base: Sequence[str]) -> dict[str, float]:
    """Size of each cause but the hall [um]."""
    want = {k: float(rng.uniform(0.1, 0.4)) for k in CAUSES if k != "hall"}
    want |= {k: float(rng.uniform(5, 14)) for k in base[1:]}
    return want | {k: float(rng.uniform(2, 4.5) if asked.weak else rng.uniform(5, 15)) for k in asked.hidden}


def _runs(rng: np.random.Generator, asked: Plan, base: Sequence[str], m: Machine) -> list[Run]:
    """At most fourteen tests, a day each, with those in which hidden and known causes show; at most three locked."""
    roles = ("locked", "calibration", "calibration")
    plan = [(CAUSES[k].test, role) for k in asked.hidden for role in roles[: 3 if k == asked.hidden[0] else 2]]
    plan += [("misch", "locked"), ("misch", "verification"), ("ruhe", "calibration")]
    plan += [(CAUSES[k].test, "calibration") for k in [*base[1:]] * (2 if len(base) < 4 else 1)]
    plan += [("stufen", "locked")] * (not asked.hidden)
    plan += [("temper", "verification")] * bool({"kss", "hydr", "chiller", "lmcool"} & {*asked.hidden, *base})
    more = int(rng.integers(0, 4))
    plan += [(str(rng.choice(list(HOURS))), str(rng.choice(["calibration", "verification"]))) for _ in range(more)]
    while sum(role == "locked" for _, role in plan) > 3:
        plan.remove(next(p for p in plan if p[1] == "locked" and p[0] != "misch"))
    plan = [plan[i] for i in rng.permutation(len(plan))][:14]
    month = int(rng.choice([1, 2, 4, 5, 6, 7, 8, 9, 11]))
    day, runs = datetime(2025, month, int(rng.integers(1, 9))), []
    for j, (kind, role) in enumerate(plan):
        runs.append(run(rng, f"{kind}_{j + 1:02d}", kind, role, day, m.w["top"], m.hall))
        end = runs[-1].start + timedelta(minutes=runs[-1].steps)
        day = end.replace(hour=0, minute=0) + timedelta(days=1)
    return runs


def _first_model(path: Path, campaign: str, axis: str, base: Sequence[str]) -> None:
    """The model that the laboratory begins with: each cause by its best name."""
    effects = []
    for k in base:
        effect, channels = CAUSES[k].right.split()[0].split(":")
        drivers = dict(zip(("temperature", "state"), channels.split(","), strict=False))
        effects.append({"effect": effect, "drivers": drivers})
    said = {
        "schema": "thermodata/model/1",
        "name": "baseline",
        "campaign": campaign,
        "response": {"axis": axis, "at": "tcp"},
        "step": "120 s",
        "effects": effects,
    }
    document(path, said)
