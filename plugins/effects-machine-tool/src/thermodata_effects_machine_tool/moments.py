"""What happens at a moment that the log marks: a tool change, a pulse of oil, a homing.

A moment is where a flag rises. Diagnosis does not ask for these by itself: a flag that rises seldom goes with anything.
"""

from __future__ import annotations

from collections.abc import Mapping
from itertools import pairwise

import numpy as np

from thermodata.effect.lag import lag, step_of
from thermodata.plugin import Drivers, Float1D, Float2D, Gain, Need, Param

from .shared import column, gain, tau

_IN_CONTROL = "its flag is an event, which the programs for a control do not read"


def rises(flag: Float1D) -> Float1D:
    """1 where a flag goes above a half, else 0; shape (n,). One that is up when the record begins has not risen."""
    up = flag > 0.5
    return np.asarray(np.diff(up.astype(np.int8), prepend=up[:1].astype(np.int8)) > 0, dtype=np.float64)


class ToolChange:
    """A tool warms in the spindle, and a change puts a cold one in.

        d = k x, tau dx/dt + x = dT, x = 0 at each change

    k [um/K], tau [min], dT [K] of the spindle or of the tool's heat.
    Source: [mares2017] eq. 9, e3, with a state that each change resets; bounds:
    docs/model.md#bounds-of-the-effects
    """

    name = "tool_change"
    asked = False
    family = "tool"
    meaning = "a tool warms with the spindle, and each change puts a cold one in: k F{dT}, from 0 at the flag"
    equation = "d = k x, tau dx/dt + x = dT, x = 0 at each change"
    telltale = "a drop at the tool change and a new rise after it; told apart by the log of tool numbers"
    source = "[mares2017] eq. 9, e3, with a state that each change resets; bounds: docs/model.md#bounds-of-the-effects"
    not_in_control = _IN_CONTROL
    needs = (Need("temperature", "temperature", ("spindle", "tool")), Need("change", "state", ("tool",)))
    params: tuple[Param, ...] = (tau(10, 1, 120),)
    gains: tuple[Gain, ...] = (gain("um/K", 0.1, 30, "displacement at rest a kelvin"),)

    def basis(self, drivers: Drivers, p: Mapping[str, float]) -> Float2D:
        warm, step = drivers.values["temperature"], step_of(drivers)
        edges = [0, *np.flatnonzero(rises(drivers.values["change"])), len(warm)]
        parts = [lag(warm[a:b], p["tau"] * 60.0, step) for a, b in pairwise(edges) if b > a]
        return column(np.concatenate(parts) if parts else warm)


class Lubrication:
    """A pulse of oil cools or lifts what it reaches, and that fades.

        d = k sum exp(-(t - t_i) / tau), t_i where the pump starts

    k [um] a pulse, tau [min].
    Source: docs/model.md#bounds-of-the-effects
    """

    name = "lubrication"
    asked = False
    family = "lubrication"
    meaning = "each pulse of oil moves the axis, and that fades: k sum exp(-(t - t_i)/tau)"
    equation = "d = k sum exp(-(t - t_i) / tau), t_i where the pump starts"
    telltale = "the same small course again and again; told apart by changing the interval"
    source = "docs/model.md#bounds-of-the-effects"
    not_in_control = _IN_CONTROL
    needs = (Need("pump", "state", ("lubrication",)),)
    params: tuple[Param, ...] = (tau(10, 0.5, 120),)
    gains: tuple[Gain, ...] = (gain("um", 0.2, 3, "displacement a pulse"),)

    def basis(self, drivers: Drivers, p: Mapping[str, float]) -> Float2D:
        from scipy.signal import lfilter

        keep = float(np.exp(-step_of(drivers) / (p["tau"] * 60.0)))
        return column(lfilter([1.0], [1.0, -keep], rises(drivers.values["pump"])))


class Homing:
    """Servos off or a reference run leave the axis elsewhere.

        d = A N(t), N the commands so far

    A [um] a command.
    Source: docs/model.md#bounds-of-the-effects
    """

    name = "homing"
    asked = False
    family = "homing"
    meaning = "each homing or servo off leaves the axis elsewhere: A N(t); size differs a test (gain_by: test)"
    equation = "d = A N(t), N the commands so far"
    telltale = "a jump at a command that stays; told apart by repeating the command"
    source = "docs/model.md#bounds-of-the-effects"
    not_in_control = _IN_CONTROL
    needs = (Need("command", "state", ("axis.{a}", "cnc")),)
    params: tuple[Param, ...] = ()
    gains: tuple[Gain, ...] = (gain("um", 1, 10, "displacement a command"),)

    def basis(self, drivers: Drivers, p: Mapping[str, float]) -> Float2D:
        return column(np.cumsum(rises(drivers.values["command"])))
