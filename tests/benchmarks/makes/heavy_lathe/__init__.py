"""A heavy horizontal lathe in an unheated hall, and what its works' laboratory logs.

Twenty-four bodies, fifteen causes: spindle bearing, gearbox, motor, oil and chiller, live tool, bending of ram and bed,
workpiece, screw, guide, foundation, the hall's air and its layers, the probe's holder. A cause moves the tool by one to
three bodies, so that it comes distributed in time. Its numbers were chosen by its maker, who had not read the
diagnosis, and vary from case to case.
"""

from __future__ import annotations

from collections.abc import Sequence
from datetime import datetime, timedelta
from pathlib import Path
from typing import Any

import numpy as np

from ..bodies import Array, felt
from ..files import first_model
from ..truth import Plan, hidden, shown_and_gone, write_truth
from .causes import BASE, CAUSES, plan
from .laboratory import Laboratory
from .machine import AT, Lathe, simulate
from .programme import Run, programme
from .sensors import CHANNELS, KEPT, SENSORS

TESTS = (  # kind, role, hours
    ("const", "calibration", 16),
    ("spectrum", "calibration", 16),
    ("axes", "calibration", 10),
    ("idle", "calibration", 34),
    ("live", "calibration", 4),
    ("cutting", "calibration", 12),
    ("mixed", "verification", 20),
    ("repeat", "verification", 4),
    ("mixed", "locked", 24),
    ("cutting", "locked", 10),
)


def write(folder: Path, case: int) -> dict[str, Any]:
    """Write campaign.yaml, model.yaml and raw/ into folder; returns the truth, which also stands in truth.json."""
    rng = np.random.default_rng(880_000 + case)
    asked = plan(case, rng)
    base = [k for k in ("bearing", "ambient") if k not in asked.hidden]
    base += [k for k in ("gearbox", "part") if k not in asked.hidden and rng.random() < 0.4]
    want_um = _sizes(rng, asked, base)
    top_rpm = float(rng.choice([250, 400, 630]))
    runs = _runs(rng, top_rpm)
    states = simulate(Lathe(rng, top_rpm), runs)
    move = _displacement(rng, [temps for temps, _ in states], want_um)
    chosen = _channels(rng, asked, base)
    shown = [name for name in SENSORS if name in chosen]
    laboratory = Laboratory(rng, folder, asked.kind, case)
    fault = laboratory.log(runs, states, move, shown)
    laboratory.campaign(runs, shown)
    effects = ((BASE[k][0], BASE[k][1]) for k in base)
    first_model(folder / "model.yaml", f"lathe-{case:02d}", asked.axis, "120 s", effects)
    truth = {
        "case": case,
        "kind": asked.kind,
        "weak": asked.weak,
        "base": base,
        "logged": sorted(chosen),
        "um": want_um,
        "fault": fault,
        "hidden": [hidden(k, want_um[k], CAUSES[k].right, CAUSES[k].twins, chosen, asked.kind) for k in asked.hidden],
    }
    return write_truth(folder, truth)


def _sizes(rng: np.random.Generator, asked: Plan, base: Sequence[str]) -> dict[str, float]:
    """Size of each cause [um]: its largest part of the displacement."""
    want = {k: float(rng.uniform(0.1, 0.5)) for k in CAUSES}
    want |= {k: float(rng.uniform(7, 18)) for k in base}
    return want | {k: float(rng.uniform(2, 4) if asked.weak else rng.uniform(5, 15)) for k in asked.hidden}


def _runs(rng: np.random.Generator, top_rpm: float) -> list[Run]:
    """Ten tests with idling of 10 to 30 h between them."""
    day, minute = int(rng.integers(0, 40)), int(rng.integers(0, 300))
    start, runs = datetime(2026, 1, 12, 6) + timedelta(days=day, minutes=minute), []
    for j, (kind, role, hours) in enumerate(TESTS):
        inputs = programme(rng, kind, hours * rng.uniform(0.9, 1.2), top_rpm)
        runs.append(Run(f"L{j + 1:02d}_{kind}", kind, role, start, inputs))
        start += timedelta(minutes=runs[-1].steps + int(rng.integers(600, 1800)))
    return runs


def _displacement(rng: np.random.Generator, temps: Sequence[Array], want_um: dict[str, float]) -> list[Array]:
    """Tool against workpiece in each test, shape (time,) [um]. temps: (time, node) [degC] of each."""
    move: list[Array] = [np.zeros(len(t)) for t in temps]
    for k, cause in CAUSES.items():
        parts = [felt(AT, cause.mix, t - t[0]) for t in temps]
        scale = want_um[k] / max(float(np.abs(p).max()) for p in parts) * rng.choice([-1, 1])
        move = [m + scale * p for m, p in zip(move, parts, strict=True)]
    return move


def _channels(rng: np.random.Generator, asked: Plan, base: Sequence[str]) -> set[str]:
    """Channels that are logged: those of the base and of what is hidden, and some more."""
    least = {*KEPT, *(channel for k in base for channel in BASE[k][1].values())}
    shown, gone = shown_and_gone(asked, CAUSES, least)
    rest = [k for k in SENSORS if k not in shown | gone]
    more = rng.choice(rest, min(len(rest), CHANNELS - len(shown)), replace=False)
    return (shown | set(map(str, more))) - gone
