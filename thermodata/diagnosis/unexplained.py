"""What can be said of a residual that nothing logged explains: how slow it is, when and in which state it comes."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from thermodata.diagnosis.problem import Problem
from thermodata.plugin import Float1D
from thermodata.schema.result import Unknown, WeakSpot


def characterise(problem: Problem, spots: Sequence[WeakSpot]) -> Unknown:
    """How fast the autocorrelation decays, which hours of the day stand out, the states of the weak spots."""
    return Unknown(
        time_constants_h=_time_constants(problem),
        hours_of_day=_hours(problem),
        states=list(dict.fromkeys(s.state for s in spots[:5])),
    )


def _time_constants(problem: Problem) -> list[float]:
    """Where the residual's autocorrelation, pooled over tests, falls to 1/e. Empty where it is white or never falls."""
    longest = max((len(b.residual) for b in problem.blocks), default=0) // 2
    if longest < 4:
        return []
    power = np.zeros(longest)
    count = np.zeros(longest)
    for block in problem.blocks:
        x = block.residual - block.residual.mean()
        n = len(x)
        spectrum = np.abs(np.fft.rfft(x, 2 * n)) ** 2
        auto = np.fft.irfft(spectrum)[:n]
        m = min(n, longest)
        power[:m] += auto[:m]
        count[:m] += n
    rho = power / np.maximum(count, 1)
    if rho[0] <= 0:
        return []
    below = np.flatnonzero(rho / rho[0] < np.exp(-1))
    if not len(below) or below[0] <= 1:
        return []
    return [float(round(below[0] * problem.step_s / 3600, 3))]


def _hours(problem: Problem) -> list[float]:
    """Hours of the day (UTC) whose mean residual stands out in most of the days that cover them."""
    days: list[tuple[Float1D, Float1D]] = []
    for block in problem.blocks:
        if block.test.start_unix_s is None:
            continue
        hour = (block.test.start_unix_s + block.t_s) / 3600 % 24
        days.append((hour, block.residual))
    if len(days) < 3:
        return []
    rms = float(np.sqrt(np.mean(np.concatenate([r for _, r in days]) ** 2)))
    hours = []
    for h in range(24):
        means = [
            float(r[(hour >= h) & (hour < h + 1)].mean()) for hour, r in days if ((hour >= h) & (hour < h + 1)).any()
        ]
        if len(means) >= 3 and abs(np.mean(means)) > rms and abs(np.sum(np.sign(means))) >= 0.8 * len(means):
            hours.append(float(h))
    return hours
