"""At which points of its nonlinear parameters a candidate is asked."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import product

import numpy as np

from thermodata.plugin import Float1D, Param
from thermodata.schema.units.quantity import SECONDS_PER_UNIT


def grid(params: Iterable[Param], step_s: float) -> list[dict[str, float]]:
    """Points of the nonlinear parameters: time constants evenly in their logarithm, and half as close beyond
    their bounds; others evenly."""
    params = tuple(params)
    if not params:
        return [{}]
    count = {1: 10, 2: 5}.get(len(params), 3)
    axes = []
    for p in params:
        seconds = SECONDS_PER_UNIT.get(p.unit)
        lower = max(p.lower, step_s / 4 / seconds) if seconds else p.lower
        if p.reach is not None and p.upper > lower:
            # nor does what is added reach what a sample does not resolve
            resolved = min(lower, max(p.reach[0], step_s / 4 / seconds)) if seconds else p.reach[0]
            axes.append(_within_and_beyond((lower, p.upper), (resolved, p.reach[1]), count))
        elif seconds or (p.lower > 0 and p.upper / p.lower > 10):
            axes.append(np.geomspace(max(lower, 1e-9), max(p.upper, lower), count))
        else:
            axes.append(np.linspace(p.lower, p.upper, min(count, 4)))
    return [{p.name: float(v) for p, v in zip(params, values, strict=True)} for values in product(*axes)]


def _within_and_beyond(bounds: tuple[float, float], reach: tuple[float, float], count: int) -> Float1D:
    """count points within the bounds, and those beyond them twice as far apart."""
    (first, last), within = bounds, np.geomspace(*bounds, count)
    apart = 2 * np.log(last / first) / (count - 1)
    below, above = (max(round(float(np.log(ratio) / apart)), 0) for ratio in (first / reach[0], reach[1] / last))
    shorter, longer = np.geomspace(reach[0], first, below + 1)[:-1], np.geomspace(last, reach[1], above + 1)[1:]
    return np.concatenate([shorter, within, longer])
