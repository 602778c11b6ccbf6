"""Effects without a place on the machine: a plain lag, a static gain, and what measuring itself adds."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from thermodata.plugin import Drivers, Float2D, Need, Param

from .shared import Lagged, column, gain, tau

_ANY = (Need("u", "*"),)


class Lag(Lagged):
    name = "lag"
    family = "generic"
    meaning = "one first-order lag of any channel: k F{u}"
    source = "the form that every printed function of first order has"
    needs = _ANY
    params = (tau(60, 1, 1440),)
    gains = (gain("um/u", 0, float("inf"), "displacement at rest a unit of the driver"),)


class Static:
    name = "static"
    refines = ("lag",)
    family = "generic"
    meaning = "a plain gain without a lag: k u"
    source = "paper 001, eq. 1: k (T_spindle - T_base)"
    needs = _ANY
    params = ()
    gains = (gain("um/u", 0, float("inf"), "displacement a unit of the driver"),)

    def basis(self, drivers: Drivers, p: Mapping[str, float]) -> Float2D:
        return column(drivers.values["u"])


class Step:
    name = "step"
    family = "artefact"
    meaning = "a step or slip of a probe at one moment: A H(t - at); belongs to one test (tests: [...])"
    source = "modelling.md section 5, row 30"
    needs = ()
    params = (Param("at", "min", 60.0, 0.0, 2880.0, "moment of the step, from the test's start"),)
    gains = (gain("um", 1, 100, "size"),)

    def basis(self, drivers: Drivers, p: Mapping[str, float]) -> Float2D:
        return column((drivers.t_s >= p["at"] * 60.0).astype(np.float64))


class Drift:
    name = "drift"
    family = "artefact"
    meaning = "a straight drift of a probe: k t"
    source = "modelling.md section 5, row 36"
    needs = ()
    params = ()
    gains = (gain("um/h", 0.05, 2, "drift"),)

    def basis(self, drivers: Drivers, p: Mapping[str, float]) -> Float2D:
        return column(drivers.t_s / 3600.0)


class WarmStart:
    name = "warm_start"
    family = "start"
    meaning = "the machine was not at rest when the test began: A exp(-t/tau); size differs a test (gain_by: test)"
    source = "modelling.md section 5, row 29"
    needs = ()
    params = (tau(60, 5, 720),)
    gains = (gain("um", 0.5, 20, "displacement that is still to go at the start"),)

    def basis(self, drivers: Drivers, p: Mapping[str, float]) -> Float2D:
        since = drivers.t_s - drivers.t_s[0] if len(drivers.t_s) else drivers.t_s
        return column(np.exp(-since / (p["tau"] * 60.0)))
