"""Effects without a place on the machine: a plain lag, a static gain, and what measuring itself adds."""

from __future__ import annotations

from collections.abc import Collection, Mapping

import numpy as np

from thermodata.effect.law import Law
from thermodata.plugin import Drivers, Float2D, Need, Param

from .shared import Lagged, column, gain, tau

_ANY = (Need("u", "*"),)


class Lag(Lagged):
    """One first-order lag of any channel: it names no physics.

        d = k F_tau{u}

    k [um per unit of u], tau [min], u of any quantity.
    Source: [ljung1999] first-order transfer function; docs/model.md#the-model
    """

    name = "lag"
    family = "generic"
    meaning = "one first-order lag of any channel: k F{u}"
    equation = "d = k F_tau{u}"
    telltale = "whatever goes with the channel; told apart by declaring where the channel sits (at:)"
    source = "[ljung1999] first-order transfer function; docs/model.md#the-model"
    needs = _ANY
    params = (tau(60, 1, 1440),)
    gains = (gain("um/u", 0, float("inf"), "displacement at rest a unit of the driver"),)


class Static:
    """A plain gain without a lag.

        d = k u

    k [um per unit of u], u of any quantity.
    Source: [horejs2010] eq. 1, k (T_spindle - T_base)
    """

    name = "static"
    refines = ("lag",)
    family = "generic"
    meaning = "a plain gain without a lag: k u"
    equation = "d = k u"
    telltale = "goes with the channel at once; told apart from lag by a step of the driver"
    source = "[horejs2010] eq. 1, k (T_spindle - T_base)"
    needs = _ANY
    params = ()
    gains = (gain("um/u", 0, float("inf"), "displacement a unit of the driver"),)

    def basis(self, drivers: Drivers, p: Mapping[str, float]) -> Float2D:
        return column(drivers.values["u"])

    def law(self, roles: Collection[str], p: Mapping[str, float], step_s: float) -> tuple[Law, ...]:
        """The same as a formula; see `thermodata.effect.law`."""
        return ("u",)


class Step:
    """A probe or its fixture slips at one moment.

        d = A H(t - at)

    A [um], at [min] from the test's start, H the unit step.
    Source: docs/artefacts.md; bounds: docs/model.md#bounds-of-the-effects
    """

    name = "step"
    family = "artefact"
    meaning = "a step or slip of a probe at one moment: A H(t - at); belongs to one test (tests: [...])"
    equation = "d = A H(t - at)"
    telltale = "a jump between two samples that no command explains, and it stays; told apart by repeating the test"
    source = "docs/artefacts.md; bounds: docs/model.md#bounds-of-the-effects"
    not_in_control = "it is a slip of one probe in one test, which the control does not have"
    needs = ()
    params = (Param("at", "min", 60.0, 0.0, 2880.0, "moment of the step, from the test's start"),)
    gains = (gain("um", 1, 100, "size"),)

    def basis(self, drivers: Drivers, p: Mapping[str, float]) -> Float2D:
        return column((drivers.t_s >= p["at"] * 60.0).astype(np.float64))


class Drift:
    """A probe drifts along a straight line.

        d = k t

    k [um/h], t [h] from the test's start.
    Source: docs/artefacts.md; bounds: docs/model.md#bounds-of-the-effects
    """

    name = "drift"
    family = "artefact"
    meaning = "a straight drift of a probe: k t"
    equation = "d = k t"
    telltale = "a straight line whatever the machine does; told apart by a test at rest"
    source = "docs/artefacts.md; bounds: docs/model.md#bounds-of-the-effects"
    not_in_control = "it is the drift of a probe and grows without end, which the control does not have"
    needs = ()
    params = ()
    gains = (gain("um/h", 0.05, 2, "drift"),)

    def basis(self, drivers: Drivers, p: Mapping[str, float]) -> Float2D:
        return column(drivers.t_s / 3600.0)


class WarmStart:
    """The machine was not at rest when the test began; what was left fades.

        d = A exp(-t / tau)

    A [um], tau [min], t from the test's start.
    Source: docs/model.md#the-model; bounds: docs/model.md#bounds-of-the-effects
    """

    name = "warm_start"
    family = "start"
    meaning = "the machine was not at rest when the test began: A exp(-t/tau); size differs a test (gain_by: test)"
    equation = "d = A exp(-t / tau)"
    telltale = "a course at the start of each test that fades whatever follows; told apart by soaking for 12 h before"
    source = "docs/model.md#the-model; bounds: docs/model.md#bounds-of-the-effects"
    not_in_control = "it is what was left when a test began; a control goes on from its last state instead"
    needs = ()
    params = (tau(60, 5, 720),)
    gains = (gain("um", 0.5, 20, "displacement that is still to go at the start"),)

    def basis(self, drivers: Drivers, p: Mapping[str, float]) -> Float2D:
        since = drivers.t_s - drivers.t_s[0] if len(drivers.t_s) else drivers.t_s
        return column(np.exp(-since / (p["tau"] * 60.0)))
