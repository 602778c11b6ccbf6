"""A vertical machining centre with a rotary table as fourth axis, and what its laboratory logs.

C-frame: table on saddle on bed, headstock on column, screws with and without scales: 53 volumes, 21 sources of heat,
27 causes. Every source has a field of its own in the structure, temperatures and growths are sums of fields, and how
strongly a source couples to the structure is scaled by case. An examiner made it who had read what the program
promises, not how it comes to a verdict.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ..files import document
from ..truth import Plan, logged, write_truth
from .causes import CAUSES, known, plan
from .laboratory import Laboratory
from .machine import Machine, scaled
from .programme import campaign

ROLES = {  # of an effect's drivers, where it is not one temperature
    "lag": ["u"],
    "coolant_heat": ["temperature", "state"],
    "vertical_gradient": ["top", "bottom"],
    "sun": ["irradiance"],
    "centrifugal_shift": ["speed"],
}
TILT = 2.5  # urad that count as much as 1 um


def write(folder: Path, case: int) -> dict[str, Any]:
    """Write campaign.yaml, model.yaml and raw/ into folder; returns the truth, which also stands in truth.json."""
    rng = np.random.default_rng([29, 77, case])
    asked = plan(case, rng)
    base, small = known(case, rng, asked)
    m = Machine(rng)
    runs = campaign(rng, _tests(rng, asked, base), m.top_rpm, m.most_kw)
    want = _sizes(rng, asked, base, small)
    shift_um = want["centri"] * float(rng.choice([-1, 1]))
    scale = TILT if asked.axis == "T" else 1.0
    states, parts, size = scaled(m, runs, asked.axis, {k: x * scale for k, x in want.items()})
    move = [m.moves(s.fields.sum(2), r.during()["n"], shift_um) for s, r in zip(states, runs, strict=True)]
    laboratory = Laboratory(rng, folder, case, asked, base, m.most_kw)
    fault = laboratory.log(runs, states, move)
    laboratory.campaign(runs)
    _first_model(folder / "model.yaml", laboratory.id, asked.axis, base)
    um = {k: round(max(part[k] for part in parts), 2) for k in size} | {"centri": round(abs(shift_um), 2)}
    shown = {*laboratory.shown}
    truth = {
        "case": case,
        "kind": asked.kind,
        "weak": asked.weak,
        "axis": asked.axis,
        "unit": "urad" if asked.axis == "T" else "um",
        "base": base,
        "small": small,
        "fault": fault,
        "hidden": [
            {
                "cause": k,
                "um": um[k],
                "right": logged(CAUSES[k].right, shown),  # where it is not logged, its speed may be
                "twins": logged(CAUSES[k].twins, shown),
            }
            for k in asked.hidden
        ],
        "um": um,
        "coupling": {k: round(x, 3) for k, x in size.items()},
        "lab": laboratory.told,
        "tests": [
            [
                r.id,
                r.role,
                round(r.steps / 60, 1),
                round(float(np.ptp(moved[asked.axis])), 1),
                {k: round(part.get(k, 0), 1) for k in asked.hidden},
            ]
            for r, moved, part in zip(runs, move, parts, strict=True)
        ],
    }
    return write_truth(folder, truth)


def _tests(rng: np.random.Generator, asked: Plan, base: Sequence[str]) -> list[tuple[str, str]]:
    """Kinds and roles of the tests, with those in which hidden and known causes show."""
    lead = CAUSES[asked.hidden[0]].test if asked.hidden else "steps"
    own = dict.fromkeys(CAUSES[k].test for k in (*base, *asked.hidden))
    tests = [("idle", "calibration"), ("const", "calibration")]
    tests += [(kind, "calibration") for kind in own if kind != "idle"]
    tests += [("steps", "verification"), ("day", "verification"), (lead, "verification"), ("day", "locked")]
    tests += [(CAUSES[k].test, "locked") for k in asked.hidden or base[:1]]
    tests += [("table", "calibration")] * (rng.random() < 0.3)
    return tests + [("axes", "verification")] * (rng.random() < 0.4)


def _sizes(rng: np.random.Generator, asked: Plan, base: Sequence[str], small: Sequence[str]) -> dict[str, float]:
    """Size of each cause [um]."""
    want = dict.fromkeys(CAUSES, 0.02) | {k: float(rng.uniform(0.3, 1.2)) for k in small}
    want |= {k: float(rng.uniform(6, 14)) for k in base}
    return want | {k: float(rng.uniform(2, 4.5) if asked.weak else rng.uniform(5, 12)) for k in asked.hidden}


def _first_model(path: Path, campaign: str, axis: str, base: Sequence[str]) -> None:
    """The model that the laboratory begins with: each cause by its best name."""
    effects = []
    for k in base:
        effect, channels = CAUSES[k].best.split(":")
        drivers = dict(zip(ROLES.get(effect, ["temperature"]), channels.split(","), strict=True))
        effects.append({"effect": effect, "drivers": drivers})
    said = {
        "schema": "thermodata/model/1",
        "name": "baseline",
        "campaign": campaign,
        "response": {"channel": "tilt_A"} if axis == "T" else {"axis": axis, "at": "tcp"},
        "step": "60 s",
        "effects": effects,
    }
    document(path, said)
