"""Drivers that move, for the kit for effects: for each way to satisfy what an effect needs."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from thermodata.plugin import Drivers, Effect, Float1D, Need

STEP_S = 60.0
_BINARY = frozenset({"state"})
_TOP = {"rotational_speed": 9000.0, "feed": 15.0, "power": 8.0, "position": 500.0, "temperature": 15.0}
FINER = 6  # samples of the finer grid in one of the coarse one: 10 s


def variants(effect: Effect) -> Iterator[Drivers]:
    """Drivers that move, for each way to satisfy the needs (where all are optional: one at a time)."""
    if effect.needs and all(n.optional for n in effect.needs):
        for need in effect.needs:
            yield _drivers((need,))
    else:
        yield _drivers(effect.needs)


def _drivers(needs: tuple[Need, ...], n: int = 720) -> Drivers:
    t = np.arange(n, dtype=np.float64) * np.float64(STEP_S)
    values: dict[str, Float1D] = {}
    for i, need in enumerate(needs):
        top = _TOP.get(need.quantity, 1.0)
        switched = np.repeat(np.arange(n // 90 + 1) % (2 + i) > 0, 90)[:n].astype(np.float64)
        wave = np.sin(2 * np.pi * t / (86400.0 / (2 + i))) ** 2
        values[need.role] = top * (
            switched if need.quantity in _BINARY or "speed" in need.quantity else 0.5 * wave + 0.5 * switched * wave
        )
    return Drivers(t, values, {r: np.ones(n, bool) for r in values}, {})


def shortened(drivers: Drivers, n: int) -> Drivers:
    """The first n samples of all drivers."""
    return Drivers(
        drivers.t_s[:n],
        {r: v[:n] for r, v in drivers.values.items()},
        {r: v[:n] for r, v in drivers.valid.items()},
        drivers.conditions,
    )


def start(effect: Effect) -> Mapping[str, float]:
    return {p.name: p.start for p in effect.params}


def on_finer_grid(drivers: Drivers) -> Drivers:
    """The same course, straight between samples; what switches does so at the sample."""
    n = len(drivers.t_s)
    rows = np.arange((n - 1) * FINER + 1) / FINER
    t = drivers.t_s[0] + rows * STEP_S
    values = {
        role: v[np.floor(rows + 1e-9).astype(int)] if len(np.unique(v)) <= 2 else np.interp(rows, np.arange(n), v)
        for role, v in drivers.values.items()
    }
    return Drivers(t, values, {r: np.ones(len(t), bool) for r in values}, drivers.conditions)
