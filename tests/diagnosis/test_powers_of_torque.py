"""A control that logs torque and speed of its drives, and no power: what they heat together is named."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from thermodata.diagnosis.answer import answer
from thermodata.effect import effects
from thermodata.effect.lag import lag
from thermodata.modelling.fit.model import fit_model
from thermodata.plugin import Float1D
from thermodata.schema.answers.diagnosis import Diagnosis
from thermodata.view.grid.dataset import ChannelInfo, Dataset, TestData

from .conftest import STEP_S, N, base, make_data

TORQUES = {
    "M_S": ChannelInfo("M_S", "torque", "N m", at="spindle.motor"),
    "M_X": ChannelInfo("M_X", "torque", "N m", at="axis.x"),
    "v_X": ChannelInfo("v_X", "feed", "m/min", at="axis.x"),
}
Heat = Callable[[TestData], Float1D]


def body(heat: Float1D, um: float) -> Float1D:
    """What a distributed body does of a heat: a quick part of it and a slow one."""
    return um * (0.6 * lag(heat, 1500.0, STEP_S) + 0.4 * lag(heat, 5400.0, STEP_S))


def data_of(heat: Heat, um: float) -> Dataset:
    """A part's weight on the table and the depth of its cuts change torques at the same speeds."""
    machine = make_data()
    tests = []
    for k, test in enumerate(machine.tests):
        rng = np.random.default_rng(900 + k)
        levels = {"M_S": rng.choice([0.0, 5.0, 20.0, 60.0], 8), "M_X": rng.choice([1.0, 4.0, 12.0], 8)}
        logged = {name: np.repeat(level, N // 8) + rng.normal(0, 0.05, N) for name, level in levels.items()}
        logged["v_X"] = np.repeat(rng.choice([0.0, 4.0, 20.0], 12), N // 12)
        logged["M_S"] = logged["M_S"] * (test.values["spindle_speed"] > 0)
        values = {**test.values, **logged}
        one = replace(
            test,
            values=values,
            valid={**test.valid, **{name: np.ones(N, bool) for name in logged}},
            channels={**machine.channels, **TORQUES},
        )
        values["dZ"] = test.values["dZ"] + body(heat(one), um)
        tests.append(one)
    return Dataset(STEP_S, tuple(tests), {**machine.channels, **TORQUES})


def power(test: TestData) -> Float1D:
    return np.asarray(test.values["M_S"] * test.values["spindle_speed"] * 2 * np.pi / 60e3)


def of_screw(test: TestData) -> Float1D:
    return np.asarray(test.values["M_X"] * test.values["v_X"] / 100)


def of_winding(test: TestData) -> Float1D:
    return np.asarray((test.values["M_S"] / 50) ** 2)


def asked(data: Dataset) -> Diagnosis:
    return answer(fit_model(base(), data, uncertainty=False), data, effects(), "m").diagnosis


@pytest.mark.parametrize(
    ("heat", "um", "name", "channels"),
    [
        (power, 1.0, "cutting_torque", ["M_S", "spindle_speed"]),
        (of_screw, 12.0, "screw_power", ["M_X", "v_X"]),
        (of_winding, 20.0, "spindle_motor_losses", ["M_S"]),
    ],
)
def test_a_heat_that_no_single_channel_tells_is_named(heat: Heat, um: float, name: str, channels: list[str]) -> None:
    found = asked(data_of(heat, um))
    assert found.verdict == "effect"
    best = found.candidates[0]
    assert (best.effect, best.drivers, best.claimed) == (name, channels, True)
    assert best.locked_rmse_um_after is not None
    assert best.locked_rmse_um_before is not None
    assert best.locked_rmse_um_after < 0.6 * best.locked_rmse_um_before


def test_torques_beside_a_machine_that_lacks_nothing_are_not_named() -> None:
    found = asked(data_of(power, 0.0))
    assert found.verdict in ("none", "refine")
    assert not any(c.claimed for c in found.candidates)
