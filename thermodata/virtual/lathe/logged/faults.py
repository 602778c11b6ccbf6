"""What breaks: a temperature that jumps, sticks or wanders, and a probe that slips."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from thermodata.virtual.lathe.logged.recording import Run
from thermodata.virtual.lathe.programme import DT_S
from thermodata.virtual.truth.case import Fault


def blemish(runs: Sequence[Run], channel: str, rng: np.random.Generator) -> tuple[list[Run], Fault]:
    """From the middle of one open test on, a temperature reads 30 K more, sticks, or wanders by 3 K in 12 h."""
    opened = [i for i, r in enumerate(runs) if r.stretch.role != "locked"]
    first = int(rng.choice(opened[1:] or opened))
    kind = str(rng.choice(["offset", "stuck", "wander"]))
    at = runs[first].stretch.heat.work.n // 2
    bad = []
    for i, run in enumerate(runs):
        x = run.readings[channel].copy()
        start = at if i == first else 0
        if i >= first:
            if kind == "offset":
                x[start:] += 30.0
            elif kind == "stuck":
                x[start:] = x[start]
            else:
                x[start:] += 3.0 * np.sqrt(DT_S / 43_200) * np.cumsum(rng.standard_normal(len(x) - start))
        bad.append(replace(run, readings={**run.readings, channel: x}))
    return bad, Fault(kind, runs[first].stretch.id, at * DT_S, 30.0 if kind == "offset" else 0.0, channel)


def slip(runs: Sequence[Run], row: int, rng: np.random.Generator) -> tuple[list[Run], list[Fault]]:
    """One to three slips of the response's probe, each in an open test of its own."""
    opened = [i for i, r in enumerate(runs) if r.stretch.role != "locked"]
    bad, faults = list(runs), []
    for i in rng.choice(opened, size=min(int(rng.integers(1, 4)), len(opened)), replace=False):
        run = bad[int(i)]
        n = run.displacement.shape[1]
        at = int(rng.integers(n // 6, 5 * n // 6))
        size = float(rng.uniform(3, 16) * rng.choice([-1, 1]))
        moved = run.displacement.copy()
        moved[row, at:] += size
        bad[int(i)] = replace(run, displacement=moved)
        faults.append(Fault("step", run.stretch.id, at * DT_S, size, f"d{'XZ'[row]}"))
    return bad, faults
