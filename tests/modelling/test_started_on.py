"""A test that begins with something on: whether it had run before stands in its error, and is told by nothing else."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from thermodata.effect.lag import lag
from thermodata.modelling.fit.model import fit_model
from thermodata.modelling.versions.result import make_result
from thermodata.schema.answers.result import Check
from thermodata.schema.files.model import Model
from thermodata.view.grid.dataset import ChannelInfo, Dataset, TestData

STEP = 60.0
INFOS = {
    "dZ": ChannelInfo("dZ", "displacement", "um", "tcp", "Z"),
    "Coolant": ChannelInfo("Coolant", "state", "1", "coolant"),
}
SPEC = Model.model_validate(
    {
        "schema": "thermodata/model/1",
        "name": "m",
        "campaign": "c",
        "response": {"axis": "Z", "at": "tcp"},
        "effects": [{"effect": "coolant", "drivers": {"state": "Coolant"}}],
    }
)


def a_test(
    k: int, role: str, *, on: bool, share: float = 0.0, level: float = 0.0, to: int = 55, gain: float = 9.0
) -> TestData:
    """Ten hours of a switch. on: at the first sample, until minute `to`. share: of its rest that it had reached before.
    level: of an error that begins with the eleventh minute [um]. gain: of the switch [um]."""
    rng = np.random.default_rng(k)
    t = np.arange(600) * STEP
    state = np.repeat(rng.permutation([0.0, 1.0] * 5), 60)
    state[:to] = float(on)
    state[to : to + 60] = 0.0
    y = gain * (lag(state, 1500.0, STEP) + share * np.exp(-t / 1500.0)) + rng.normal(0, 0.2, 600)
    y += np.where(t >= 660.0, level, 0.0)
    values = {"dZ": y, "Coolant": state}
    valid = {name: np.ones(600, bool) for name in values}
    return TestData("c", f"t{k}", "mixed", role, t, values, valid, np.ones(600, bool), channels=INFOS)


def said(*tests: TestData, **spec: Any) -> list[Check]:
    data = Dataset(STEP, (a_test(1, "calibration", on=False), a_test(2, "calibration", on=False), *tests), INFOS)
    result = make_result(fit_model(SPEC.model_copy(update=spec), data), data, "m")
    return [c for c in result.checks if c.name.startswith("on_at_start:")]


@pytest.mark.parametrize(("share", "told"), [(0.0, False), (0.6, False), (0.75, True), (1.0, True)])
def test_what_had_run_for_longer_than_a_time_constant_before_the_test_is_told(share: float, told: bool) -> None:
    assert bool(said(a_test(3, "verification", on=True, share=share))) is told


def test_it_says_what_is_on_how_much_that_makes_and_what_to_do() -> None:
    (one,) = said(a_test(3, "verification", on=True, share=1.0))
    assert (one.name, one.threshold, one.passed) == ("on_at_start:c/t3", 0.5, False)
    assert one.value == pytest.approx(0.03, abs=0.03)
    assert one.advice.startswith("t3 begins with Coolant at 1, and the model counts it as switched on there: ")
    assert "a window of the test that begins 74 min later, with history: recording" in one.advice
    assert "start_state: warm frees the start in a fit, and not in this error" in one.advice


def test_a_window_that_begins_so_much_later_does_without_the_level() -> None:
    whole = a_test(3, "verification", on=True, share=1.0)
    later = replace(whole, t_s=whole.t_s - 74 * 60.0, in_window=whole.t_s >= 74 * 60.0)
    errors = []
    for test in (whole, later):
        data = Dataset(STEP, (a_test(1, "calibration", on=False), test), INFOS)
        rows = make_result(fit_model(SPEC, data), data, "m").scores
        errors.append(next(s.rmse_um for s in rows if (s.test, s.phase) == ("t3", "all")))
    assert errors == [pytest.approx(7.5, abs=0.7), pytest.approx(0.4, abs=0.2)]


def test_on_for_hours_it_asks_for_what_was_before() -> None:
    slow = {"effects": [SPEC.effects[0].model_copy(update={"fixed": {"tau": 120.0}})]}
    test = a_test(3, "verification", on=True)
    before = replace(test, values={**test.values, "dZ": 9.0 * lag(test.values["Coolant"] - 1.0, 7200.0, STEP)})
    others = [a_test(k, "calibration", on=False) for k in (1, 2)]
    slower = [replace(t, values={**t.values, "dZ": 9.0 * lag(t.values["Coolant"], 7200.0, STEP)}) for t in others]
    data = Dataset(STEP, (*slower, before), INFOS)
    checks = make_result(fit_model(SPEC.model_copy(update=slow), data), data, "m").checks
    (one,) = [c for c in checks if c.name.startswith("on_at_start:")]
    assert "a recording, or a window, that begins before it was switched on" in one.advice


@pytest.mark.parametrize(
    "change",
    [
        lambda test: replace(test, start_state="warm"),
        lambda test: replace(test, in_window=test.t_s >= 600.0),  # cut from a recording, with its history
    ],
)
def test_a_test_that_says_how_it_began_is_left_alone(change: Callable[[TestData], TestData]) -> None:
    assert not said(change(a_test(3, "verification", on=True, share=1.0)))


def test_a_level_of_another_cause_is_none_of_it() -> None:
    assert not said(a_test(3, "verification", on=False, level=-7.0))
    assert not said(a_test(3, "verification", on=True, level=7.0))


@pytest.mark.parametrize(("gain", "told"), [(0.9, False), (0.0, True)])
def test_a_switch_that_does_little_in_its_test_was_switched_on_there(gain: float, told: bool) -> None:
    """A tenth of its gain from the first sample on is no rest that it had reached; nothing at all may be one."""
    assert bool(said(a_test(3, "verification", on=True, to=600, gain=gain))) is told


def test_what_was_fitted_with_it_may_begin_warm() -> None:
    tests = (a_test(3, "calibration", on=True, share=1.0), a_test(4, "calibration", on=False))
    (one,) = said(*tests)
    assert one.advice.endswith("start_state: warm leaves the start of the test free in the fit")


def test_a_locked_test_is_not_looked_at() -> None:
    assert not said(a_test(3, "locked", on=True, share=1.0))
