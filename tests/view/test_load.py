"""The data that models are fitted to: grid, masks, drivers without holes, history, descriptions."""

from __future__ import annotations

import json
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from thermodata.errors import UsageError
from thermodata.schema.flag import Flag
from thermodata.view import load_dataset

Build = Callable[..., Any]


def describe(b: Any, campaign: str, test: str) -> None:
    b.channel(campaign, test, "dZ", axis="Z", at="tcp", relative_to="table", sensor='{"resolution": "50 nm"}')
    b.channel(campaign, test, "T1", "temperature", at="spindle.bearing.front")
    b.channel(campaign, test, "program", "label")


def test_values_are_the_bins_of_sql(build: Build) -> None:
    b = build()
    rng = np.random.default_rng(1)
    t = np.arange(0.0, 900.0, 0.7)
    for test in ("z", "y", "x"):  # neither the order of names nor of paths
        b.test("c", test)
        describe(b, "c", test)
        b.tidy(
            "c",
            test,
            t,
            {
                "dZ": (rng.normal(size=t.size), rng.choice([0, 1, 8, 128], t.size)),
                "T1": rng.normal(size=t.size),
                "program": ["P"] * t.size,
            },
            name=f"{'zyx'.index(test)}{test}",
        )
    store = b.store()
    data = load_dataset(store, "c", 10)
    assert [x.test for x in data.tests] == ["z", "y", "x"]
    assert data.step_s == 10.0
    assert set(data.channels) == {"dZ", "T1"}
    for test in data.tests:
        with store.reader() as con:
            want = con.execute("select t_s, dZ, T1 from binned('c', ?, 10)", [test.test]).fetchnumpy()
        assert test.t_s.tolist() == want["t_s"].tolist()
        for name in ("dZ", "T1"):
            np.testing.assert_allclose(test.values[name], np.ma.filled(want[name], np.nan), rtol=1e-12)
            assert test.values[name].dtype == np.float64
        assert test.valid["dZ"].tolist() == np.isfinite(test.values["dZ"]).tolist()
        assert test.in_window.all()


def test_drivers_are_bridged_and_displacements_not(build: Build) -> None:
    b = build()
    b.test("c", "a")
    describe(b, "c", "a")
    t = np.arange(0.0, 3600.0, 10.0)
    flags = np.where((t >= 600) & (t < 780) | (t >= 1800) & (t < 2400), int(Flag.STUCK), 0)
    b.tidy("c", "a", t, {"dZ": (t, flags), "T1": (t, flags)})
    test = load_dataset(b.store(), ["c"], 30).tests[0]
    short, long = (test.t_s >= 600) & (test.t_s < 780), (test.t_s >= 1800) & (test.t_s < 2400)
    assert np.isnan(test.values["dZ"][short | long]).all()
    assert not test.valid["dZ"][short | long].any()
    assert test.values["T1"][~long] == pytest.approx(test.t_s[~long] + 10)
    assert np.isnan(test.values["T1"][long]).all()
    assert test.valid["T1"].tolist() == np.isfinite(test.values["T1"]).tolist()


def test_a_slow_driver_is_interpolated_and_a_late_one_reaches_back(build: Build) -> None:
    b = build()
    b.test("c", "a")
    describe(b, "c", "a")
    b.tidy("c", "a", np.arange(0.0, 3600.0), {"dZ": np.arange(3600.0)})
    slow = np.arange(30.0, 3600.0, 120.0)
    b.tidy("c", "a", slow, {"T1": slow}, source="pt")
    test = load_dataset(b.store(), ["c"], 30).tests[0]
    assert test.values["T1"][1:-2] == pytest.approx(test.t_s[1:-2])
    assert test.values["T1"][0] == 30.0
    assert test.valid["T1"].all()


def test_states_are_held(build: Build) -> None:
    b = build()
    b.test("c", "a")
    b.channel("c", "a", "door", "state", source="plc")
    b.channel("c", "a", "dZ")
    b.tidy("c", "a", np.arange(0.0, 600.0), {"dZ": np.zeros(600)})
    b.tidy("c", "a", [40.0, 400.0], {"door": [1.0, 0.0]}, source="plc")
    test = load_dataset(b.store(), ["c"], 60).tests[0]
    assert test.values["door"].tolist() == [1.0] * 6 + [0.0] * 4
    assert test.valid["door"].all()


def test_a_history_comes_first_and_outside_the_window(build: Build) -> None:
    b = build()
    b.test("c", "a")
    describe(b, "c", "a")
    for part, t in (("test", np.arange(0.0, 300.0)), ("history", np.arange(-600.0, 0.0))):
        b.tidy("c", "a", t, {"dZ": t, "T1": t}, part=part)
    test = load_dataset(b.store(), ["c"], 60).tests[0]
    assert test.t_s.tolist() == list(np.arange(-600.0, 300.0, 60.0))
    assert test.in_window.tolist() == [False] * 10 + [True] * 5
    assert test.values["T1"] == pytest.approx(test.t_s + 29.5)


def test_descriptions(build: Build) -> None:
    b = build()
    b.test(
        "c",
        "a",
        kind="etve",
        role="verification",
        zero_s=120.0,
        start_state="warm",
        conditions='{"speed": 9000.0, "air": "on", "feed": "10 m/min", "coolant": true}',
        pose='{"X": "1 m"}',
        tool='{"length": 120.0}',
        phases='{"idle": [0, 7200]}',
    )
    describe(b, "c", "a")
    b.add(
        "machine",
        campaign="c",
        test="a",
        machine="138",
        attributes=json.dumps({"spindle": "SP1", "speed": 1.0, "axes": {"Y": {"preload": "2.1 kN"}}}),
    )
    b.tidy("c", "a", np.arange(0.0, 100.0), {"dZ": np.zeros(100), "T1": np.zeros(100), "program": ["x"] * 100})
    data = load_dataset(b.store(), ["c"], 10)
    test = data.tests[0]
    assert test.key == ("c", "a")
    assert (test.kind, test.role, test.zero_s, test.start_state, test.machine) == (
        "etve",
        "verification",
        120.0,
        "warm",
        "138",
    )
    assert test.conditions == {
        "spindle": "SP1",
        "axes.Y.preload": 2100.0,
        "pose.X": 1000.0,
        "tool.length": 120.0,
        "speed": 9000.0,
        "air": "on",
        "feed": 10.0,
        "coolant": 1.0,
    }
    assert test.phases == {"idle": (0.0, 7200.0)}
    assert test.start_unix_s == 1_772_000_000.0
    assert test.channels["dZ"].axis == "Z"
    assert test.channels["dZ"].resolution == pytest.approx(0.05)
    assert list(test.channels) == ["dZ", "T1"]
    assert data.data_version == "v1"


@pytest.mark.parametrize(
    ("measuring", "masks"),
    [
        ("meas > 0.5 and clamped > 0.5 and n < 5", ["meas"]),
        ({"when": "meas > 0.5", "in_range": None, "settle": 0.0, "for": 1.0}, ["meas"]),
        ({"when": None, "in_range": {"meas": [0.5, 1.5]}, "settle": 0.0, "for": None}, ["meas"]),
        ("in_range", []),
        ("clamped > 0.5", []),
        (None, []),
    ],
)
def test_a_state_at_no_place_that_measuring_reads_is_its_mask(build: Build, measuring: Any, masks: list[str]) -> None:
    """A part of the machine, or what turns it, may do something all the same."""
    b = build()
    b.test("c", "a", measuring=None if measuring is None else json.dumps(measuring))
    b.channel("c", "a", "dZ", axis="Z", at="tcp")
    b.channel("c", "a", "meas", "state")
    b.channel("c", "a", "clamped", "state", at="table")
    b.channel("c", "a", "n", "rotational_speed")
    b.tidy("c", "a", np.arange(0.0, 100.0), {name: np.zeros(100) for name in ("dZ", "meas", "clamped", "n")})
    data = load_dataset(b.store(), ["c"], 10)
    assert [n for n, c in data.tests[0].channels.items() if c.is_mask] == masks
    assert [n for n, c in data.channels.items() if c.is_mask] == masks


def test_overrides_of_a_channel_belong_to_their_test(build: Build) -> None:
    b = build()
    for test, place in (("a", "hall.top"), ("b", "hall.door")):
        b.test("c", test)
        b.channel("c", test, "T1", "temperature", at=place)
        b.tidy("c", test, [0.0, 10.0], {"T1": [1.0, 2.0]})
    data = load_dataset(b.store(), ["c"], 10)
    assert [t.channels["T1"].at for t in data.tests] == ["hall.top", "hall.door"]


def test_relative_clocks_have_no_hour_of_the_day(build: Build) -> None:
    b = build()
    b.test("c", "a", clock="relative")
    b.tidy("c", "a", [0.0, 10.0], {"T1": [1.0, 2.0]})
    assert load_dataset(b.store(), ["c"], 10).tests[0].start_unix_s is None


def test_several_campaigns_and_chosen_channels(build: Build) -> None:
    b = build()
    for campaign in ("c2", "c1", "c3"):
        b.test(campaign, "a")
        describe(b, campaign, "a")
        b.tidy(campaign, "a", [0.0, 10.0], {"dZ": [1.0, 2.0], "T1": [3.0, 4.0]})
    b.test("c1", "bare")
    store = b.store()
    data = load_dataset(store, ["c2", "c1"], 10, channels=["T1"])
    assert [t.key for t in data.tests] == [("c2", "a"), ("c1", "a")]
    assert list(data.channels) == ["T1"]
    assert data.data_version not in ("", "v1")
    assert data.data_version == load_dataset(store, ["c1", "c2"], 20).data_version


@pytest.mark.parametrize(
    ("campaign", "step", "channels", "word"),
    [
        ("x", 10, None, "no campaign 'x'"),
        ("c", 0, None, "a step is positive"),
        ("c", float("nan"), None, "a step is"),
        ("c", 10, ["T_1"], "did you mean 'T1'"),
        ("c", 1e-7, None, "choose a longer step"),
    ],
)
def test_refusals(build: Build, campaign: str, step: float, channels: list[str] | None, word: str) -> None:
    b = build()
    b.test("c", "a")
    describe(b, "c", "a")
    b.tidy("c", "a", [0.0, 10.0], {"dZ": [1.0, 2.0], "T1": [3.0, 4.0]})
    with pytest.raises(UsageError, match=word):
        load_dataset(b.store(), campaign, step, channels)
