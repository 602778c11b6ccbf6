"""What a cycling driver did before the log began: a chiller does not start its cycle with the test.

A lag that starts in balance at the first sample of a cycle is wrong by up to the cycle's amplitude for a few time
constants. The cycle that the log shows first is put before it, so that the lag comes into the test in step.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from thermodata.effect.guard import guarded_bases, guarded_basis, read_only
from thermodata.modelling.inputs.drivers import CYCLE_S, cycle_mean, make_drivers
from thermodata.plugin import Drivers, Effect, Float1D, Float2D
from thermodata.view.grid.dataset import TestData

LEAD_S = 4 * 3600.0
ALIKE = 0.5  # autocorrelation at the period that makes it one


def led_drivers(
    test: TestData, effect: Effect, binding: Mapping[str, str], name: str | None = None
) -> tuple[Drivers, tuple[Drivers, int]]:
    """(`make_drivers`, the same `with_lead`); kept with the test, which each fit and each candidate asks of it."""
    coordinates = tuple(need.role for need in effect.needs if need.quantity == "position")
    key = "led", tuple(binding.items()), coordinates
    if key not in test.kept:
        drivers = make_drivers(test, effect, binding, name)
        test.kept[key] = drivers, with_lead(drivers)
    found: tuple[Drivers, tuple[Drivers, int]] = test.kept[key]
    return found


def with_lead(drivers: Drivers) -> tuple[Drivers, int]:
    """(drivers with rows before the test, how many). 0 rows where no driver cycles; the others were at rest."""
    n = len(drivers.t_s)
    if n < 8:
        return drivers, 0
    step = float((drivers.t_s[-1] - drivers.t_s[0]) / (n - 1))
    periods = {role: _period(values, step) for role, values in drivers.values.items()}
    if not any(periods.values()):
        return drivers, 0
    lead = round(LEAD_S / step)
    values = {role: np.concatenate([_lead_values(v, periods[role], lead), v]) for role, v in drivers.values.items()}
    valid = {role: np.concatenate([np.ones(lead, bool), v]) for role, v in drivers.valid.items()}
    t_s = drivers.t_s[0] + step * np.arange(-lead, n)
    return read_only(replace(drivers, t_s=t_s, values=values, valid=valid)), lead


def columns(effect: Effect, led: tuple[Drivers, int], params: Mapping[str, float]) -> Float2D:
    """The effect's basis on the test's own rows, shape (n, gains). EffectError: see `guarded_basis`."""
    drivers, lead = led
    return guarded_basis(effect, drivers, params)[lead:]


def columns_of_each(
    effect: Effect, led: Sequence[tuple[Drivers, int]], points: Sequence[Mapping[str, float]]
) -> list[Float2D]:
    """The same in each of several tests, at several points side by side, shape (n, points * gains) each."""
    found = guarded_bases(effect, [drivers for drivers, _ in led], points)
    return [own[lead:] for own, (_, lead) in zip(found, led, strict=True)]


def _period(values: Float1D, step: float) -> int:
    """Samples of one cycle at the start; 0 where there is none."""
    first = values[: round(CYCLE_S / step) + 1]
    if cycle_mean(first) is None:
        return 0
    x = first - first.mean()
    spectrum = np.fft.rfft(x, 2 * len(x))
    auto = np.fft.irfft(np.abs(spectrum) ** 2)[: len(x)] / np.arange(len(x), 0, -1)
    # the highest peak behind the first zero; a peak at zero lag is no period
    below = np.flatnonzero(auto < 0)
    if not len(below):
        return 0
    last = 2 * len(x) // 3
    behind = auto[below[0] : last]
    if not len(behind):
        return 0
    peak = int(below[0] + np.argmax(behind))
    return peak if auto[peak] > ALIKE * auto[0] else 0


def _lead_values(values: Float1D, period: int, lead: int) -> Float1D:
    if not period:
        return np.zeros(lead)
    times = -(-lead // period)
    return np.tile(values[:period], times)[-lead:]
