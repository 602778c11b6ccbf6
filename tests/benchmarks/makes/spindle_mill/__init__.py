"""A horizontal bed mill with a motor spindle of 18,000 rpm, and what its laboratory and its control log.

Ninety-eight bodies, eighteen causes: spindle bearing and motor, the pull of speed, chiller, oil-air lubrication, tool,
screws, guide, scale, column, bed, coolant, hydraulics, rotary table, part, the hall's air and its layers. A cause moves
the tool by a group of bodies, so that it comes distributed in time; what is in no group of the case moves it next to
nothing. Its numbers were chosen by its maker, who had not read the diagnosis, and vary from case to case.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

import numpy as np

from ..bodies import Array, pairs
from ..files import document
from ..truth import Plan, channels, hidden, write_truth
from .causes import BASE, CAUSES, plan
from .laboratory import Laboratory
from .machine import SIZE, Mill, by_body, simulate
from .programme import Run, programme
from .sensors import KEPT, SENSORS

ACTS_IN = {"xfeed": "axes", "yscrew": "axes", "zguide": "axes", "scale": "axes", "rotary": "rot", "tool": "dry"}


def write(folder: Path, case: int) -> dict[str, Any]:
    """Write campaign.yaml, model.yaml and raw/ into folder; returns the truth, which also stands in truth.json."""
    rng = np.random.default_rng(260_000 + case)
    asked = plan(case, rng)
    rich = bool(rng.random() < 0.5)
    base = _base(rng, asked)
    want_um = _sizes(rng, asked, base)
    runs, mill = _runs(rng, asked), Mill(rng)
    states = simulate(mill, runs)
    parts = _displacement(rng, asked.axis, runs, [temps for temps, _ in states], want_um)
    chosen = _channels(rng, asked, base, rich)
    shown = [name for name in SENSORS if name in chosen]
    laboratory = Laboratory(rng, folder, asked.axis, asked.kind, case, mill.mean, shown)
    fault = laboratory.log(runs, states, [part.sum(1) for part in parts])
    laboratory.campaign(runs)
    _first_model(folder / "model.yaml", case, asked.axis, base)
    unlisted = np.concatenate([part[:, [k not in (*base, *asked.hidden) for k in CAUSES]].sum(1) for part in parts])
    truth = {
        "case": case,
        "kind": asked.kind,
        "weak": asked.weak,
        "axis": asked.axis,
        "rich": rich,
        "base": base,
        "logged": sorted(chosen),
        "fault": fault,
        "um": {k: round(v, 2) for k, v in want_um.items()},
        "noise_um": round(laboratory.noise_um, 3),
        "unlisted_rms_um": round(float(np.sqrt(np.mean(unlisted**2))), 3),
        "hidden": [hidden(k, want_um[k], CAUSES[k].right, CAUSES[k].twins, chosen, asked.kind) for k in asked.hidden],
    }
    return write_truth(folder, truth)


def _base(rng: np.random.Generator, asked: Plan) -> list[str]:
    """Causes that the first model knows: one to four."""
    first, spare = ([k for k in part if k not in asked.hidden] for part in (list(BASE)[:2], list(BASE)[2:]))
    return first + [k for k in spare if asked.axis in CAUSES[k].mix and rng.random() < 0.25][:2]


def _sizes(rng: np.random.Generator, asked: Plan, base: Sequence[str]) -> dict[str, float]:
    """Size of each cause [um]: its largest part of the displacement."""
    want = {k: float(rng.uniform(5, 9) if k == "hall" else rng.uniform(8, 15)) for k in base}
    for k in asked.hidden:
        um = float(rng.uniform(2, 4) if asked.weak else rng.uniform(5, 13))
        want[k] = um * (1.7 if k == "tool" else 1)
    others = [k for k, cause in CAUSES.items() if k not in want and asked.axis in cause.mix]
    return want | {k: float(rng.uniform(0, 0.05)) for k in others}


def _runs(rng: np.random.Generator, asked: Plan) -> list[Run]:
    """Four to fourteen tests, with those in which the hidden causes act, and idling of 15 to 35 h between them."""
    mine = dict.fromkeys(ACTS_IN[k] for k in asked.hidden if k in ACTS_IN)
    kinds = ["const", "spec", *mine, "prod"] if rng.random() < 0.5 else ["spec", "cut", *mine, "prod"]
    kinds += [k for k in ("cut", "idle", "axes", "rot", "dry", "prod") if k not in kinds and rng.random() < 0.5]
    tests = [(kind, "calibration") for kind in kinds]
    tests += [("prod" if rng.random() < 0.7 else "cut", "verification")] * int(rng.integers(0, 3))
    tests += [("prod", "locked")] * 2
    tests += [(str(rng.choice(["cut", "spec", "axes"])), "locked")] * int(rng.random() < 0.5)
    day, minute = int(rng.integers(0, 45)), int(rng.integers(0, 240))
    start, runs = datetime(2026, 2, 20, 6, tzinfo=UTC) + timedelta(days=day, minutes=minute), []
    for j, (kind, role) in enumerate(tests):
        runs.append(Run(f"{j + 1:02d}_{kind}", kind, role, start, programme(rng, kind)))
        start += timedelta(minutes=runs[-1].steps + int(rng.integers(900, 2100)))
    return runs


def _displacement(
    rng: np.random.Generator, axis: str, runs: Sequence[Run], temps: Sequence[Array], want_um: dict[str, float]
) -> list[Array]:
    """What each cause does to the tool in each test, shape (time, cause) [um]. temps: (time, node) [K] of each."""
    mixes = [cause.mix.get(axis) for cause in CAUSES.values()]
    shares = np.column_stack([by_body(pairs(mix) if mix else {}) for mix in mixes])
    growth = shares * rng.uniform(0.75, 1.3, (SIZE, 1))
    parts: list[Array] = [(t[:, :SIZE] - t[0, :SIZE]) @ growth for t in temps]
    if "centrifugal" in want_um:
        for part, r in zip(parts, runs, strict=True):
            part[:, list(CAUSES).index("centrifugal")] = r.inputs["speed"] ** 2 - r.inputs["speed"][0] ** 2
    most = np.max([np.abs(part).max(0) for part in parts], axis=0)
    scale = np.array([want_um.get(k, 0.0) for k in CAUSES]) / np.maximum(most, 1e-9) * rng.choice([-1, 1], len(CAUSES))
    return [part * scale for part in parts]


def _channels(rng: np.random.Generator, asked: Plan, base: Iterable[str], rich: bool) -> set[str]:
    """Channels that are logged: those of the base and of what is hidden by its best name, and some more."""
    kept = {*KEPT, *(BASE[k][1] for k in base)}
    causes = [CAUSES[k] for k in asked.hidden]
    unseen = asked.kind == "not_logged"
    gone = set().union(*(channels(f"{cause.right} {cause.twins}") for cause in causes if unseen))
    shown = kept.union(*(channels(cause.right.split()[0]) for cause in causes if not unseen))
    rest = [k for k, s in SENSORS.items() if s.mix and k not in shown | gone]
    felt = int(rng.integers(15, 26) if rich else rng.integers(7, 12))
    more = max(0, min(len(rest), felt - sum(bool(SENSORS[k].mix) for k in shown)))
    shown |= set(map(str, rng.choice(rest, more, replace=False)))
    shown |= {k for k, s in SENSORS.items() if not s.mix and rng.random() < (0.8 if rich else 0.45)}
    return shown - gone | kept


def _first_model(path: Path, case: int, axis: str, base: Iterable[str]) -> None:
    """The model that the laboratory begins with."""
    effects = [{"effect": BASE[k][0], "drivers": {"temperature": BASE[k][1]}} for k in base]
    said = {
        "schema": "thermodata/model/1",
        "name": "baseline",
        "campaign": f"hmill-{case:02d}",
        "response": {"axis": axis, "at": "tcp"},
        "step": "120 s",
        "effects": effects,
    }
    document(path, said)
