"""Channels that nobody logged but everybody knows: `schedule: [[0 h, conditions.speed], [4 h, 0 rpm]]`."""

from __future__ import annotations

from typing import Any

import numpy as np

from thermodata.errors import SpecError
from thermodata.plugin import Array, Float1D, Int1D
from thermodata.schema.files.campaign import Channel, Test
from thermodata.schema.units.conversion import linear_conversion
from thermodata.schema.units.quantity import canonical
from thermodata.schema.units.value import value_in

GRID_S = 60.0


def steps(name: str, channel: Channel, test: Test) -> tuple[Float1D, Array]:
    """(times [s], values in the canonical unit, or text) of a scheduled channel; times from the recording's start."""
    times: list[float] = []
    values: list[Any] = []
    for at, what in channel.schedule or []:
        where = f"channels.{name}.schedule"
        if isinstance(what, str) and what.startswith("conditions."):
            key = what.removeprefix("conditions.")
            if key not in test.conditions:
                raise SpecError(
                    f"test '{test.id}' has no condition '{key}'",
                    where=where,
                    got=what,
                    expected=", ".join(f"conditions.{k}" for k in test.conditions) or "none",
                    hint="add it to the test's conditions, or write the value itself into the schedule",
                )
            what = test.conditions[key]
        times.append(value_in(at, "s"))
        values.append(str(what) if channel.quantity == "label" else _number(what, channel))
    order = np.argsort(times, kind="stable")
    kind = object if channel.quantity == "label" else np.float64
    return np.asarray(times, dtype=np.float64)[order], np.asarray(values, dtype=kind)[order]


def held(t_s: Float1D, times: Float1D, values: Array) -> Array:
    """The value that holds at each time, shape (n,); NaN or None before the first."""
    index = np.searchsorted(times, t_s, side="right") - 1
    missing: Any = None if values.dtype == object else np.nan
    held_values: Array = (
        np.where(index >= 0, values[np.maximum(index, 0)], missing)
        if len(values)
        else np.full(len(t_s), missing, dtype=values.dtype)
    )
    return held_values


def grid(from_ns: int, to_ns: int, changes_ns: Int1D) -> Int1D:
    """Every minute from start to end, and each change [ns], ascending."""
    regular = np.arange(from_ns, to_ns + 1, int(GRID_S * 1e9), dtype=np.int64)
    inside = changes_ns[(changes_ns >= from_ns) & (changes_ns <= to_ns)]
    return np.unique(np.concatenate([regular, inside, np.array([to_ns], dtype=np.int64)]))


def _number(value: Any, channel: Channel) -> float:
    target = canonical(channel.quantity)
    switch = {"true": 1.0, "on": 1.0, "false": 0.0, "off": 0.0}.get(str(value).strip().lower())
    if switch is not None:
        return switch
    if isinstance(value, int | float):
        # a bare number is in the channel's own unit
        factor, offset = linear_conversion(channel.unit or target, target)
        return factor * float(value) + offset
    return value_in(value, target)
