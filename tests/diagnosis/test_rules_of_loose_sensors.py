"""A temperature that answers by a smaller factor from one test on is told, where nothing else of the machine does."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import replace

import numpy as np
import pytest

from thermodata.diagnosis.answer import answer
from thermodata.diagnosis.sensors.loose import (
    Fall,
    between_the_same_tests,
    conditions_changed,
    left_out,
    loose_sensors,
    telling,
)
from thermodata.effect import effects
from thermodata.effect.lag import lag
from thermodata.modelling.fit.model import fit_model
from thermodata.plugin import Float1D
from thermodata.schema.answers.diagnosis import Diagnosis
from thermodata.schema.files.model import Model
from thermodata.view.grid.dataset import ChannelInfo, Dataset, TestData

from .conftest import STEP_S, make_data

TESTS, N = 8, 300
CHANNELS = {
    "dZ": ChannelInfo("dZ", "displacement", "um", at="tcp", axis="Z", source="daq"),
    "speed": ChannelInfo("speed", "rotational_speed", "rpm", at="spindle", source="cn"),
    "feed": ChannelInfo("feed", "feed", "m/min", at="axis.x", source="cn"),
    "T_front": ChannelInfo("T_front", "temperature", "degC", at="spindle.bearing.front", source="cn"),
    "T_rear": ChannelInfo("T_rear", "temperature", "degC", at="spindle.bearing.rear", source="cn"),
    "T_nut": ChannelInfo("T_nut", "temperature", "degC", at="axis.x.nut", source="cn"),
    "T_hall": ChannelInfo("T_hall", "temperature", "degC", at="hall", source="daq"),
}


def made(number: int) -> TestData:
    rng, t = np.random.default_rng([20, number]), np.arange(N) * STEP_S
    speed = np.repeat(rng.permutation([0.0, 0, 3000, 6000, 9000, 9000]), N // 6)
    feed = np.repeat(rng.permutation([0.0, 0, 0, 5, 10, 10]), N // 6)
    hall = 21 + 2 * np.sin(2 * np.pi * (t / 86400 + rng.uniform()))
    values = {
        "dZ": np.full(N, np.nan),
        "speed": speed,
        "feed": feed,
        "T_front": hall + lag(speed / 9000 * 15, 900, STEP_S),
        "T_rear": hall + lag(speed / 9000 * 12, 1500, STEP_S),
        "T_nut": hall + lag(feed / 10 * 8, 2400, STEP_S),
        "T_hall": hall,
    }
    for name in ("T_front", "T_rear", "T_nut", "T_hall"):
        values[name] = values[name] + rng.normal(0, 0.03, N)
    valid = {n: np.ones(N, bool) for n in values}
    return TestData(
        "c",
        f"t{number}",
        "mixed",
        "calibration",
        t,
        values,
        valid,
        np.ones(N, bool),
        channels=CHANNELS,
        start_unix_s=t[0],
    )


def machine() -> Dataset:
    tests = tuple(replace(made(i), start_unix_s=86400.0 * i) for i in range(TESTS))
    return Dataset(STEP_S, tests, CHANNELS)


def loosened(data: Dataset, factor: float, first: int, names: Collection[str] = ("T_front",)) -> Dataset:
    """From a test on these read so much of what their bodies do, and the air for the rest."""

    def one(test: TestData) -> TestData:
        read: Mapping[str, Float1D] = {
            n: test.values["T_hall"] + factor * (test.values[n] - test.values["T_hall"]) for n in names
        }
        return replace(test, values={**test.values, **read})

    return replace(data, tests=tuple(one(t) if i >= first else t for i, t in enumerate(data.tests)))


@pytest.mark.parametrize("factor", [0.25, 0.5])
def test_a_sensor_that_came_loose_is_told_with_the_first_test_and_how_much_it_answers(factor: float) -> None:
    [told] = loose_sensors(loosened(machine(), factor, 4), "dZ")
    assert (told.kind, told.campaign, told.test, told.size_um) == ("sensor_gain", "c", "t4", None)
    assert f"'T_front' answers {factor:.2f} times what it did up to 't3'" in told.why
    assert "3 tests bear it out, 4 before" in told.why
    assert "channels: {T_front: {absent: true}}" in told.why


def test_a_test_in_which_the_machine_rests_tells_neither() -> None:
    data = loosened(machine(), 0.4, 4)
    rest = {"speed": np.zeros(N)} | dict.fromkeys(("T_front", "T_rear"), data.tests[3].values["T_hall"])
    still = replace(data.tests[3], values={**data.tests[3].values, **rest})
    [told] = loose_sensors(replace(data, tests=(*data.tests[:3], still, *data.tests[4:])), "dZ")
    assert "what it did up to 't2'" in told.why
    assert "1 between tells neither" in told.why


def test_the_order_is_that_of_the_clocks() -> None:
    data = loosened(machine(), 0.5, 4)
    [told] = loose_sensors(replace(data, tests=data.tests[::-1]), "dZ")
    assert told.test == "t4"


@pytest.mark.parametrize("factor", [1.0, 0.7])
def test_a_sound_machine_and_a_small_fall_are_left_alone(factor: float) -> None:
    assert loose_sensors(loosened(machine(), factor, 4), "dZ") == []


def test_a_sensor_that_answers_more_did_not_come_loose() -> None:
    assert loose_sensors(loosened(machine(), 2.0, 4), "dZ") == []


@pytest.mark.parametrize(("first", "told"), [(1, 0), (2, 1), (6, 1), (7, 0)])
def test_two_tests_on_either_side_bear_it_out(first: int, told: int) -> None:
    assert len(loose_sensors(loosened(machine(), 0.4, first), "dZ")) == told


@pytest.mark.parametrize("names", [("T_front", "T_rear"), ("T_front", "T_nut"), ("T_front", "T_rear", "T_nut")])
def test_a_machine_in_which_several_fall_has_changed(names: tuple[str, ...]) -> None:
    assert loose_sensors(loosened(machine(), 0.4, 4, names), "dZ") == []


@pytest.mark.parametrize(("after", "told"), [("wet", 0), ("dry", 1)])
def test_a_condition_that_changed_there_explains_it(after: str, told: int) -> None:
    data = loosened(machine(), 0.4, 4)
    cut = [replace(t, conditions={"cut": "dry" if i < 4 else after}) for i, t in enumerate(data.tests)]
    assert len(loose_sensors(replace(data, tests=tuple(cut)), "dZ")) == told


def test_a_condition_that_takes_both_values_on_a_side_explains_nothing() -> None:
    [fall] = [a_fall(before=2, after=2)]
    seen = [replace(t, conditions={"speed": v}) for t, v in zip((*fall.before, *fall.after), (1, 2, 1, 1), strict=True)]
    assert not conditions_changed(replace(fall, before=tuple(seen[:2]), after=tuple(seen[2:])))
    assert conditions_changed(replace(fall, before=(seen[0],), after=(seen[1],)))


def placed(data: Dataset, name: str, at: str) -> Dataset:
    """The same with a channel at another place."""
    channels = {**data.channels, name: replace(data.channels[name], at=at)}
    return replace(data, channels=channels, tests=tuple(replace(t, channels=channels) for t in data.tests))


@pytest.mark.parametrize(
    ("at", "told"),
    [("coolant.tank", 0), ("hydraulics", 0), ("chiller.return", 0), ("spindle.gearbox", 1), ("bed", 1), ("T_tank", 1)],
)
def test_a_fluid_of_which_there_is_more_came_off_no_body(at: str, told: int) -> None:
    """A tank of another level was said to have a loose sensor."""
    assert len(loose_sensors(placed(loosened(machine(), 0.4, 4), "T_front", at), "dZ")) == told


def switched(data: Dataset, on: Collection[int], at: str, quantity: str = "state") -> Dataset:
    """With a switch that is on through the second half of some tests."""
    channels = {**data.channels, "on": ChannelInfo("on", quantity, "1", at=at, source="cn")}

    def one(number: int, test: TestData) -> TestData:
        course = np.where(np.arange(N) > N // 2, float(number in on), 0.0)
        values, valid = {**test.values, "on": course}, {**test.valid, "on": np.ones(N, bool)}
        return replace(test, values=values, valid=valid, channels=channels)

    return replace(data, channels=channels, tests=tuple(one(i, t) for i, t in enumerate(data.tests)))


@pytest.mark.parametrize(
    ("on", "at", "quantity", "told"),
    [
        (range(4), "coolant", "state", 0),
        (range(4, 8), "chiller", "flow", 0),
        (range(4, 8), "fan", "state", 0),
        (range(4, 8), "table", "state", 1),
        (range(3), "coolant", "state", 1),
        (range(8), "coolant", "state", 1),
        ((), "coolant", "state", 1),
    ],
)
def test_what_cools_on_one_side_alone_explains_it(on: Collection[int], at: str, quantity: str, told: int) -> None:
    found = loose_sensors(switched(loosened(machine(), 0.4, 4), on, at, quantity), "dZ")
    assert len(found) == told


def test_a_sensor_that_is_judged_faulty_says_nothing_more() -> None:
    data = loosened(machine(), 0.4, 4)
    failed = {**data.channels, "T_front": replace(data.channels["T_front"], faulty="offset")}
    assert loose_sensors(replace(data, channels=failed), "dZ") == []


@pytest.mark.parametrize(("share", "told"), [(0.49, 0), (0.51, 1)])
def test_half_of_a_test_must_be_measured(share: float, told: int) -> None:
    """Of the two tests before the fall."""
    data = loosened(machine(), 0.4, 2)
    part = np.diff(np.floor(np.arange(N + 1) * share)) > 0
    short = replace(data.tests[1], valid={**data.tests[1].valid, "T_front": part})
    assert len(loose_sensors(replace(data, tests=(data.tests[0], short, *data.tests[2:])), "dZ")) == told


def test_each_campaign_is_asked_by_itself() -> None:
    """Other sensors, other gains."""
    data = loosened(machine(), 0.4, 4)
    other = [replace(t, campaign="d") if i >= 4 else t for i, t in enumerate(data.tests)]
    assert loose_sensors(replace(data, tests=tuple(other)), "dZ") == []


@pytest.mark.parametrize(
    ("foretold", "tells"),
    [([2.0, 0.51, 0.49], [True, True, False]), ([4.0, 1.01, 0.99], [True, True, False]), ([0.49, 0.3], [False, False])],
)
def test_a_test_tells_where_enough_is_foretold(foretold: list[float], tells: list[bool]) -> None:
    assert telling(np.array(foretold)).tolist() == tells


def a_fall(before: int = 3, after: int = 3, first: int = 0, **other: float) -> Fall:
    """Of numbered tests from `first` on."""
    tests = [replace(made(0), test=f"t{i}") for i in range(first, first + before + after)]
    kept = {"ratio": 0.5, "drop": 0.8, "left": 0.05, "parted": 0.5} | other
    return Fall("T_front", tuple(tests[:before]), tuple(tests[before:]), **kept)


@pytest.mark.parametrize(
    ("fall", "plain"),
    [
        (a_fall(), True),
        (a_fall(before=2, after=2), True),
        (a_fall(before=1), False),
        (a_fall(after=1), False),
        (a_fall(drop=0.56), True),
        (a_fall(drop=0.64, parted=0.61), True),  # 0.5 ** 0.7 is 0.616
        (a_fall(drop=0.64, parted=0.62), False),
        (a_fall(drop=0.66, parted=0.62), True),
        (a_fall(drop=0.64, ratio=-0.1, parted=0.1), False),
        (a_fall(drop=0.66, ratio=-0.1, parted=0.1), True),
        (a_fall(drop=0.54), False),
        (a_fall(left=0.24), True),
        (a_fall(left=0.26), False),
        (a_fall(ratio=0.64), True),
        (a_fall(ratio=0.66), False),
        (a_fall(parted=0.84), True),
        (a_fall(parted=0.86), False),
    ],
)
def test_a_fall_is_plain_within_all_limits(fall: Fall, plain: bool) -> None:
    assert fall.plain is plain


@pytest.mark.parametrize(
    ("other", "together"),
    [
        (a_fall(drop=0.26), True),
        (a_fall(drop=0.24), False),
        (a_fall(before=1, after=5), False),
        (a_fall(before=3, after=1), True),
    ],
)
def test_another_that_fell_between_the_same_tests_is_the_machines_doing(other: Fall, together: bool) -> None:
    assert between_the_same_tests(other, a_fall()) is together


def test_it_is_told_beside_the_verdict_and_nothing_else_changes(spec: Model) -> None:
    def of(factor: float) -> Diagnosis:
        data = make_data()
        infos = {n: replace(c, source="daq") for n, c in data.channels.items()}
        data = replace(data, channels=infos, tests=tuple(replace(t, channels=infos) for t in data.tests))
        data = loosened(data, factor, 3, ("T_bearing",))
        return answer(fit_model(spec, data, uncertainty=False), data, effects(), "m").diagnosis

    found = of(0.4)
    assert [(a.kind, a.test) for a in found.artefacts if a.kind == "sensor_gain"] == [("sensor_gain", "t3")]
    assert found.put_right is None
    assert "sensor_gain" not in [a.kind for a in of(1.0).artefacts]


@pytest.mark.parametrize(("share", "gain"), [(0.01, 1 / 2), (0.04, 4 / 5)])
def test_what_hardly_moves_in_the_other_tests_is_foretold_with_a_small_gain(share: float, gain: float) -> None:
    """A hundredth of a column's squares is held against each gain, so that as much in the others halves it."""
    squares = np.array([share, 1.0 - share])
    _, along, _ = left_out(squares[:, None, None], squares[:, None], squares, np.ones(2))
    assert along[1] / squares[1] == pytest.approx(gain)
