"""The heat of a whole campaign, before any geometry or sensor: strata of one seed share it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from thermodata.virtual.lathe.causes import Heat
from thermodata.virtual.lathe.heat.hall import Air, Hall
from thermodata.virtual.lathe.heat.march import SOAK_H, Task, solve_all
from thermodata.virtual.lathe.programme import DT_S, campaign, work

SOAK_STEPS = 120
EPOCH_S = 1_757_203_200.0  # 2025-09-07 00:00 UTC


@dataclass(frozen=True, slots=True)
class Stretch:
    """One test. heat: of the machine; air: of the hall; start_unix_s: UTC."""

    id: str
    role: str
    heat: Heat
    air: Air
    start_unix_s: float


@lru_cache(maxsize=3)
def stretches(seed: int, open_tests: int, idle: bool, hours: float) -> tuple[Stretch, ...]:
    """The tests of a seed. hours: of a usual test; idle ones last up to three times as long."""
    rng = np.random.default_rng([seed, open_tests, int(idle), 15_485_863])
    hall = Hall.draw(rng)
    planned = []
    for number, (kind, role) in enumerate(campaign(rng, open_tests, idle)):
        length = hours * (rng.uniform(1.2, 3.0) if kind == "idle" else rng.uniform(0.7, 1.2))
        job = work(kind, rng, length)
        before = np.linspace(job.hour[0] - SOAK_H, job.hour[0], SOAK_STEPS)
        # one course of the hall, on the fine grid over both, so that the test goes on where the soak ends
        whole = np.arange(job.hour[0] - SOAK_H, job.hour[-1] + 1e-9, DT_S / 3600)
        every = hall.air(whole, rng)

        def at(t: np.ndarray, whole: np.ndarray = whole, every: Air = every) -> Air:
            return Air(*(np.interp(t, whole, getattr(every, name)) for name in Air.__slots__))

        soak, air = at(before), at(job.hour)
        start = EPOCH_S + 86_400 * 3 * number + 3600 * float(job.hour[0])
        planned.append((f"t{number + 1:02d}_{kind}", role, start, job, air, soak))
    solved = solve_all([Task(job, air, soak, on) for on in (True, False) for *_, job, air, soak in planned])
    working, off = solved[: len(planned)], solved[len(planned) :]
    return tuple(
        Stretch(name, role, Heat(job, full, quiet), air, start)
        for (name, role, start, job, air, _), full, quiet in zip(planned, working, off, strict=True)
    )
