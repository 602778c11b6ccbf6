"""A flat-bed lathe in a laboratory whose campaign grew over half a year, and what it logs.

Sixty-five volumes, fourteen causes: bearings, belt and motor, hydraulics, screws, guide, coolant, cut and chips,
turret, tailstock, sun, the hall's air and its door. A cause moves the turret against the spindle by all volumes of the
chain. 18 to 43 tests, coarse Pt100s of which two are loose or sit elsewhere, a first model of one to three effects. Its
numbers were chosen by its maker, who had not read the diagnosis, and vary from case to case.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ..bodies import Array
from ..files import first_model
from ..truth import channels, hidden, write_truth
from .causes import BASE, CAUSES, MORE, Hidden, plan
from .laboratory import Laboratory
from .machine import CAUSES as HEATED
from .machine import Lathe, by_volume, simulate
from .network import GROWTH
from .programme import campaign
from .sensors import KEPT, SENSORS


def write(folder: Path, case: int) -> dict[str, Any]:
    """Write campaign.yaml, model.yaml and raw/ into folder; returns the truth, which also stands in truth.json."""
    rng = np.random.default_rng(280_000 + case)
    asked = plan(case, rng)
    base = _base(rng, asked)
    axes = ["X", "Z", "Y"] if rng.random() < 0.35 else ["X", "Z"]
    want_um = _sizes(rng, asked, base, axes)
    runs = campaign(rng, asked.hidden, asked.kind == "half")
    states = simulate(Lathe(rng), runs)
    move, heat = _moves(rng, asked, base, want_um, [temps for temps, _ in states])
    shown = _channels(rng, asked, base)
    kept = {*KEPT, *(BASE[k][2] for k in base)}.union(*(channels(CAUSES[k].names) for k in asked.hidden))
    laboratory = Laboratory(rng, folder, case, axes, shown, kept)
    laboratory.log(runs, states, move, heat)
    laboratory.campaign(runs)
    effects = ((BASE[k][0], {BASE[k][1]: BASE[k][2]}) for k in base)
    first_model(folder / "model.yaml", f"longlathe-{case:02d}", asked.axis, "180 s", effects)
    um, logged = want_um[asked.axis], set(shown)
    truth = {
        "case": case,
        "kind": asked.kind,
        "acts": asked.acts,
        "axis": asked.axis,
        "base": base,
        "logged": sorted(shown),
        "fault": None,
        "loose": laboratory.told,
        "want": {a: {k: round(v, 2) for k, v in w.items()} for a, w in want_um.items()},
        "hidden": [hidden(k, um[k], CAUSES[k].right, CAUSES[k].twins, logged, asked.kind) for k in asked.hidden],
        "gain": laboratory.gain,
        "ptp": {r.id: {a: round(float(np.ptp(move[a][j])), 2) for a in axes} for j, r in enumerate(runs)},
    }
    return write_truth(folder, truth)


def _base(rng: np.random.Generator, asked: Hidden) -> list[str]:
    """What the first model knows: the spindle by its bearing or its speed, and at most two more."""
    base = [str(rng.choice(["bearing", "speed"]))]
    base += [k for k, often in MORE.items() if k not in asked.hidden and rng.random() < often]
    return [k for k in base if k != "zscrew" or "guide" not in asked.hidden][:3]


def _known(base: Sequence[str]) -> list[str]:
    """The causes of a first model."""
    return ["bearing" if k == "speed" else k for k in base]


def _sizes(
    rng: np.random.Generator, asked: Hidden, base: Sequence[str], axes: Sequence[str]
) -> dict[str, dict[str, float]]:
    """Size of each cause in each axis [um]: its largest part of the displacement."""
    want = {a: {k: float(rng.uniform(0.15, 0.5)) for k in HEATED} for a in axes}
    for a in axes:
        want[a] |= {k: float(rng.uniform(12, 24) if k == "bearing" else rng.uniform(4, 9)) for k in _known(base)}
        if a != asked.axis or asked.acts:
            want[a] |= {k: float(rng.uniform(3, 4.5) if asked.weak else rng.uniform(5, 12)) for k in asked.hidden}
    want["X"]["air"] *= 0.3 if "air" in asked.hidden else 1
    return want


def _moves(
    rng: np.random.Generator,
    asked: Hidden,
    base: Sequence[str],
    want_um: dict[str, dict[str, float]],
    temps: Sequence[Array],
) -> tuple[dict[str, list[Array]], Array]:
    """By axis the displacement in each test, shape (time,) [um]; how much warmer each cause makes what is felt.

    temps: (time, volume, cause) [K] of each test.
    """
    move, heat = {}, np.ones(len(HEATED))
    for a in sorted(want_um, key=lambda x: x != asked.axis):
        growth = by_volume(GROWTH[a])
        growth = growth * rng.uniform(0.7, 1.4, len(growth))
        parts = [np.einsum("tnc,n->tc", t - t[0], growth) for t in temps]
        most = np.max([np.abs(part).max(0) for part in parts], axis=0)
        scale = np.array(list(want_um[a].values())) / np.maximum(most, 1e-9)
        if a == asked.axis:  # a stronger source is warmer, too, within reason
            inner = {*_known(base), *asked.hidden} - {"air", "door"}
            heat = np.where([k in inner for k in HEATED], np.clip(scale, 0.6, 1.8), 1.0)
        move[a] = [part @ scale for part in parts]
    return move, heat


def _channels(rng: np.random.Generator, asked: Hidden, base: Sequence[str]) -> list[str]:
    """Channels that are logged: those of the base and of what is hidden by its best name, and some more."""
    causes = [CAUSES[k] for k in asked.hidden]
    gone = set().union(*(channels(cause.names) for cause in causes if asked.kind == "not_logged"))
    shown = {"n_S1", *KEPT, *(BASE[k][2] for k in base)}
    shown = shown.union(*(channels(cause.right.split()[0]) for cause in causes))
    shown |= {c for cause in causes for c in sorted(channels(cause.right)) if rng.random() < 0.5}
    rest = [k for k in SENSORS if k not in shown | gone]
    more = min(len(rest), int(rng.integers(20, 31)) - len(shown))
    shown |= set(map(str, rng.choice(rest, more, replace=False)))
    return [k for k in SENSORS if k in shown - gone]
