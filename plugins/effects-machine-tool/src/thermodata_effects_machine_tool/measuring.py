"""What measuring adds that a model can take out: a mandrel's run-out seen as an offset, a sensor that drifts.

Diagnosis does not ask for these by itself: they are no cause in the machine.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from thermodata.effect.lag import lag, step_of
from thermodata.plugin import Drivers, Float2D, Gain, Need, Param

from .shared import column, gain, tau

MEAN_S = 10.0  # over so long an alias must turn round once, or a log of it is an offset


class RunoutAlias:
    """A probe that is not synchronised samples a turning mandrel; at some speeds its run-out stands still.

        d = A |sinc(f_a 10 s)|, f_a = |n / 60 - m f_s| with the nearest whole m

    A [um], n [rpm], f_s [Hz] the probe's sampling rate, f_a [Hz] the alias; 0 where the mandrel stands.
    Source: sampling of a sine: what a mean over 10 s leaves of it; bounds:
    docs/model.md#bounds-of-the-effects
    """

    name = "runout_alias"
    asked = False
    family = "artefact"
    meaning = "run-out of a turning mandrel that sampling turns into an offset at some speeds (gain_by: test)"
    equation = "d = A |sinc(f_a 10 s)|, f_a = |n / 60 - m f_s| with the nearest whole m"
    telltale = (
        "an offset at whole multiples of the sampling rate, such as 6000 rpm and 10 Hz; told apart by 1 % of speed"
    )
    source = "sampling of a sine: what a mean over 10 s leaves of it; bounds: docs/model.md#bounds-of-the-effects"
    not_in_control = "it is the run-out of a mandrel as a probe sees it, which the control does not have"
    needs = (Need("speed", "rotational_speed", ("{s}spindle",)),)
    params: tuple[Param, ...] = (Param("rate", "Hz", 10.0, 0.5, 1000.0, "sampling rate of the probe"),)
    gains: tuple[Gain, ...] = (gain("um", 0.5, 30, "offset where the run-out stands still"),)

    def basis(self, drivers: Drivers, p: Mapping[str, float]) -> Float2D:
        turns = np.abs(drivers.values["speed"]) / 60.0
        alias = np.abs(turns - np.round(turns / p["rate"]) * p["rate"])
        return column(np.where(turns > 0, np.abs(np.sinc(alias * MEAN_S)), 0.0))


class SensorDrift:
    """A temperature sensor drifts, and the effect that it drives takes that along.

        d = k F_tau{t}

    k [um/h], tau [min] of the effect that the sensor drives, t [h] from the test's start.
    Source: docs/artefacts.md; bounds: docs/model.md#bounds-of-the-effects
    """

    name = "sensor_drift"
    asked = False
    family = "artefact"
    meaning = "a sensor drifts, and its effect follows: k F{t}; belongs to one test (tests: [...])"
    equation = "d = k F_tau{t}"
    telltale = "a straight line that begins slowly, whatever the machine does; told apart by a second sensor"
    source = "docs/artefacts.md; bounds: docs/model.md#bounds-of-the-effects"
    not_in_control = "it is the drift of a sensor and grows without end"
    needs: tuple[Need, ...] = ()
    params: tuple[Param, ...] = (tau(60, 1, 1440),)
    gains: tuple[Gain, ...] = (gain("um/h", 0.01, 2, "drift of the contribution"),)

    def basis(self, drivers: Drivers, p: Mapping[str, float]) -> Float2D:
        since = drivers.t_s - drivers.t_s[0] if len(drivers.t_s) else drivers.t_s
        return column(lag(since / 3600.0, p["tau"] * 60.0, step_of(drivers)))
