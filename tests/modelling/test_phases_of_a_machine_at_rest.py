"""When a machine works is told by all its tests: the noise of a power meter at rest is no work."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from thermodata.modelling.inputs.phases import activity, phases
from thermodata.plugin import Float1D
from thermodata.view.grid.at_work import SHARE, limits_of, with_limits
from thermodata.view.grid.dataset import ChannelInfo, TestData

N, STEP = 480, 60.0
CHANNELS = {
    "dZ": ChannelInfo("dZ", "displacement", "um", at="tcp", axis="Z", relative_to="table"),
    "speed": ChannelInfo("speed", "rotational_speed", "rpm"),
    "power": ChannelInfo("power", "power", "kW"),
}


def run(seed: int, speed: Float1D, machine: str = "m1") -> TestData:
    rng = np.random.default_rng(seed)
    power = 3.4 * (speed / 12000) + rng.normal(0, 0.02, N)
    values = {"dZ": rng.normal(0, 0.2, N).cumsum(), "speed": speed, "power": power}
    valid = {name: np.ones(N, bool) for name in values}
    t_s = np.arange(N) * STEP
    return TestData(
        "c", f"t{seed}", "other", "calibration", t_s, values, valid, valid["dZ"], machine=machine, channels=CHANNELS
    )


def turning() -> Float1D:
    return np.where((np.arange(N) > 10) & (np.arange(N) < 300), 12000.0, 0.0)


def test_the_noise_of_a_meter_at_rest_is_no_work() -> None:
    idle, working = with_limits([run(1, np.zeros(N)), run(2, turning())])
    assert activity(idle) is None
    assert phases(idle, "dZ") == {}
    assert set(phases(working, "dZ")) == {"heating", "steady", "cooling"}
    assert phases(working, "dZ")["cooling"][300:].all()


def test_a_machine_that_never_works_in_any_test_rests() -> None:
    for test in (*with_limits([run(1, np.zeros(N)), run(2, np.zeros(N))]), run(3, np.zeros(N))):
        assert activity(test) is None


def test_each_machine_has_its_own_largest_value() -> None:
    large, small = with_limits([run(1, turning()), run(2, turning() / 100, "m2")])
    assert large.at_work["speed"] == pytest.approx(SHARE * 12000)
    assert small.at_work["speed"] == pytest.approx(SHARE * 120)


def test_a_speed_that_is_another_one_in_each_sample_is_work_and_no_noise() -> None:
    speed = np.random.default_rng(4).uniform(1000, 12000, N)
    (spectrum,) = with_limits([run(4, speed)])
    working = activity(spectrum)
    assert working is not None
    assert working.all()


def test_a_meter_is_asked_in_the_test_where_it_moves_least() -> None:
    wild = np.random.default_rng(5).uniform(1000, 12000, N)
    limits = limits_of([run(5, wild), run(6, np.zeros(N))])
    assert limits["power"] == pytest.approx(5 * 0.02, rel=0.15)


def test_a_power_that_is_another_one_in_each_sample_is_work_but_for_its_pauses() -> None:
    """No speed is logged, and the machine cuts in all of its tests."""
    cuts = [run(8 + k, np.random.default_rng(k).uniform(3000, 12000, N)) for k in range(2)]
    for k, test in enumerate(cuts):
        test.values["power"][:60] = np.random.default_rng(k).normal(0, 0.02, 60)
        del test.values["speed"]
    for test in (*with_limits(cuts), cuts[0]):  # one alone, too
        working = activity(test)
        assert working is not None
        assert not working[:60].any()
        assert working[60:].all()


def test_a_channel_without_a_value_tells_nothing() -> None:
    test = run(7, np.full(N, np.nan))
    test = replace(test, values={**test.values, "power": np.zeros(N)})
    assert limits_of([test]) == {}


@pytest.mark.parametrize("standby", [0.0, 0.3, 0.8])
def test_what_a_machine_takes_in_standby_is_no_work(standby: float) -> None:
    """Whether or not a speed is logged beside its power."""
    tests = [run(20, np.zeros(N)), run(21, turning())]
    for test in tests:
        test.values["power"][:] += standby
        del test.values["speed"]
    idle, working = with_limits(tests)
    assert activity(idle) is None
    assert set(phases(working, "dZ")) == {"heating", "steady", "cooling"}
    assert phases(working, "dZ")["cooling"][300:].all()


def test_the_least_work_of_tests_that_never_rest_is_no_standby() -> None:
    tests = [run(22, np.full(N, 4000.0)), run(23, np.full(N, 12000.0))]
    for test in tests:
        del test.values["speed"]
    for test in with_limits(tests):
        working = activity(test)
        assert working is not None
        assert working.all()
