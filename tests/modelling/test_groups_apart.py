"""Groups that share a time constant though each has another one are told; those that have the same are not."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from thermodata.effect.lag import lag
from thermodata.modelling import fit_model
from thermodata.schema.answers.result import Check
from thermodata.view.grid.dataset import Dataset, TestData

from .conftest import CHANNELS, EFFECTS, STEP, Spec, make_test


def of_machine(test: TestData, machine: str, tau_s: float) -> TestData:
    """The same test on a machine whose spindle bearing warms the rest with another time constant."""
    bearing = 3e-3 * lag(test.values["speed"], 900, STEP)
    change = 1.5 * (lag(bearing, tau_s, STEP) - lag(bearing, 1200, STEP))
    return replace(test, machine=machine, values={**test.values, "dZ": test.values["dZ"] + change})


def told(spec: Spec, tau_s: float, **keys: object) -> list[Check]:
    machines = (("m1", 1200.0), ("m2", tau_s), ("m1", 1200.0), ("m2", tau_s))
    tests = tuple(of_machine(make_test(40 + k, "calibration"), m, tau) for k, (m, tau) in enumerate(machines))
    fitted = fit_model(spec({"effect": "spindle_bearing", **keys}, *EFFECTS[1:]), Dataset(STEP, tests, CHANNELS, "v1"))
    return [c for c in fitted.checks() if c.name.startswith("groups_apart")]


@pytest.mark.parametrize("tau_s", [400.0, 3000.0])
def test_machines_with_time_constants_of_their_own_are_told_with_both(spec: Spec, tau_s: float) -> None:
    (check,) = told(spec, tau_s, gain_by="machine")
    assert (check.name, check.passed) == ("groups_apart:spindle_bearing.tau", False)
    assert check.value is not None
    assert np.log(check.value) == pytest.approx(abs(np.log(tau_s / 1200.0)), rel=0.35)
    assert "m1" in check.advice
    assert "m2" in check.advice
    assert "shared: none" in check.advice


def test_machines_that_share_a_time_constant_or_have_their_own_are_not(spec: Spec) -> None:
    assert told(spec, 1200.0, gain_by="machine") == []
    assert told(spec, 1500.0, gain_by="machine") == []
    assert told(spec, 3000.0, gain_by="machine", shared="none") == []
