"""A sensor that is declared to read in coarser steps than its readings take: a model believes what is declared."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from thermodata.errors import ThermodataError
from thermodata.schema.units.conversion import linear_conversion
from thermodata.schema.units.quantity import canonical
from thermodata.schema.units.value import split_value
from thermodata.store.tidy.plan.plan import Bound
from thermodata.store.tidy.values.series import TestSeries

_MOST_ROWS = 100_000  # that are looked at
_FEWEST = 20  # steps, by which the usual one shows
_FINER = 0.5  # of the declared one


def resolution_in(unit: str, text: Any, raw_unit: str | None) -> float | None:
    """A sensor's resolution in the channel's unit, or None where that takes a calibration, or none is declared."""
    if text is None:
        return None
    try:
        number, written = split_value(text)
        factor, _ = linear_conversion(written or raw_unit or unit, unit)
    except ThermodataError:
        return None
    return abs(factor * number)


def finer_than_declared(series: TestSeries, here: Sequence[Bound], start: int, stop: int) -> tuple[str, ...]:
    """What is said of channels whose readings mostly take finer steps than their sensors are declared to have. here:
    channels of a stream, rows start to stop."""
    told = []
    for bound in here:
        sensor = bound.channel.sensor
        if sensor is None or bound.signal is None or bound.is_text:
            continue
        unit = canonical(bound.channel.quantity)
        declared = resolution_in(unit, sensor.resolution, bound.unit)
        usual = _usual_step(series, bound, start, min(stop, start + _MOST_ROWS)) if declared else None
        if declared and usual is not None and usual < _FINER * declared:
            told.append(
                f"channel '{bound.name}': its sensor is declared to read in steps of {declared:.3g} {unit}, and it was "
                f"read in steps of {usual:.2g} {unit}: correct resolution, which a model believes"
            )
    return tuple(told)


def _usual_step(series: TestSeries, bound: Bound, start: int, stop: int) -> float | None:
    """The median of the steps from reading to reading that are any; None where they are few, or can't be told."""
    try:
        x = series.values(bound, start, stop)[0]
    except ThermodataError:  # which is told where the channel is made
        return None
    steps = np.abs(np.diff(x[np.isfinite(x)]))
    steps = steps[steps > 1e-9 * max(1.0, float(np.abs(x[np.isfinite(x)]).max(initial=0.0)))]
    return float(np.median(steps)) if len(steps) >= _FEWEST else None
