"""Worlds: the same by seed, different by seed, with a hidden effect that a lab could find."""

from __future__ import annotations

import pickle
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from thermodata.errors import UsageError
from thermodata.view.grid.dataset import Dataset
from thermodata.virtual import HIDEABLE, World, dataset, make_world
from thermodata.virtual.gantry.binned import to_dataset
from thermodata.virtual.gantry.catalogue import EFFECTS, drivers_of
from thermodata.virtual.gantry.levers import own_um


@pytest.fixture(scope="module")
def worlds(once: Callable[[str, Callable[[Path], object]], Path]) -> dict[str, World]:
    def make(folder: Path) -> None:
        made = {hide: make_world(hide, 7) for hide in HIDEABLE}
        (folder / "worlds").write_bytes(pickle.dumps(made))

    read: dict[str, World] = pickle.loads((once("worlds", make) / "worlds").read_bytes())
    return read


def test_there_are_at_least_ten_effects_to_hide() -> None:
    assert len(HIDEABLE) >= 10
    assert all(len(meaning) > 10 for meaning in HIDEABLE.values())


@pytest.mark.parametrize("hide", sorted(HIDEABLE))
def test_a_hidden_effect_shows_in_three_tests_and_the_locked_one(worlds: dict[str, World], hide: str) -> None:
    world = worlds[hide]
    rms = world.rms_um[hide]
    assert sum(v > 2.0 for v in rms.values()) >= 3
    assert all(rms[r.op.id] > 2.0 for r in world.runs if r.op.role == "locked")
    assert max(rms.values()) < 20.0


@pytest.mark.parametrize("hide", sorted(HIDEABLE))
def test_the_baseline_lacks_the_hidden_effect_only(worlds: dict[str, World], hide: str) -> None:
    world = worlds[hide]
    known = [e.effect for e in world.baseline().effects]
    assert sorted([*known, hide]) == sorted(world.present)
    names = {s.name for s in world.sensors}
    for e in world.present:
        assert set(drivers_of(e, world.axis).values()) <= names, f"{e} is not measured"


def test_the_machine_of_the_demo_stays_as_it_is(worlds: dict[str, World]) -> None:
    """README.md prints what the demo says of seed 7."""
    world = worlds["feed_screw"]
    assert world.axis == "Z"
    assert {e: round(float(v[2]), 4) for e, v in world.levers.items()} == {
        "spindle_bearing": -0.4262,
        "ambient_frame": -0.2554,
        "cutting_power": -0.2713,
        "table_bearing": -0.7725,
        "feed_screw": 0.2653,
    }


def test_with_nothing_hidden_the_baseline_has_all() -> None:
    world = make_world("none", 3, tests=3, hours=3)
    assert [e.effect for e in world.baseline().effects] == list(world.present)
    assert 4 <= len(world.present) <= 7


def test_the_displacement_is_the_sum_of_the_contributions_and_the_noise(worlds: dict[str, World]) -> None:
    world = worlds["feed_screw"]
    for run in world.runs:
        rest = run.displacement - np.sum(list(run.contributions.values()), axis=0)
        assert np.std(rest) < 3 * world.noise_um
        for c in run.contributions.values():
            np.testing.assert_allclose(c[:, 0], 0.0, atol=1e-9)


def test_what_the_world_holds_is_physical(worlds: dict[str, World]) -> None:
    for world in worlds.values():
        for run in world.runs:
            hot = {n: v for n, v in run.readings.items() if n.startswith("T_")}
            assert all(v.min() > 10.0 and v.max() < 90.0 for v in hot.values())
            total = run.displacement[world.axis_index][run.op.measuring]
            assert np.ptp(total) < 150.0
        high = next(r for r in world.runs if r.op.kind == "spindle" and r.op.speed.max() >= 8000)
        assert 10.0 < np.ptp(high.readings["T_bearing_front"]) < 45.0


def test_the_same_seed_gives_the_same_data_and_another_one_another_machine() -> None:
    a, _ = dataset("coolant", 2, tests=3, hours=4)
    b, _ = dataset("coolant", 2, tests=3, hours=4)
    c, _ = dataset("coolant", 3, tests=3, hours=4)
    for x, y in zip(a.tests, b.tests, strict=True):
        for name in x.values:
            np.testing.assert_array_equal(x.values[name], y.values[name])
    assert not np.array_equal(a.tests[-1].values["dZ"], c.tests[-1].values["dZ"])


def test_the_dataset_is_complete(worlds: dict[str, World]) -> None:
    data: Dataset = to_dataset(worlds["table_bearing"], 60.0)
    assert {t.role for t in data.tests} == {"calibration", "verification", "locked"}
    for test in data.tests:
        assert set(test.values) == set(data.channels)
        assert all(len(v) == len(test.t_s) == 720 for v in test.values.values())
        response = test.values["dZ"]
        np.testing.assert_array_equal(np.isfinite(response), test.valid["dZ"])
        assert np.all(np.diff(test.t_s) == 60.0)
    feed = next(t for t in data.tests if t.kind == "linear_axis")
    assert 0.1 < feed.valid["dZ"].mean() < 0.9  # measured between the moves only


def test_a_cause_that_is_not_measured_is_in_no_channel() -> None:
    data, model = dataset("feed_motor", 4, tests=3, hours=3, measured=False)
    assert "T_motor_Z" not in data.channels or "T_motor_Y" not in data.channels
    needed = {c for e in model.effects for c in e.drivers.values()}
    assert needed <= set(data.channels)


def test_a_copy_of_a_known_effect_is_not_its_own() -> None:
    world = make_world("none", 3, tests=3, hours=4)
    ops = [r.op for r in world.runs]
    lever = np.ones(3)
    units = [
        {
            "spindle_bearing": r.contributions["spindle_bearing"][2],
            "twin": r.contributions["spindle_bearing"][2],
            "other": np.sin(r.op.t_s / 2000.0),
        }
        for r in world.runs
    ]
    levers = {"spindle_bearing": lever, "twin": lever}
    assert own_um("twin", levers, 2, units, ops) < 1e-3
    assert own_um("other", levers | {"other": lever}, 2, units, ops) > 0.1


@pytest.mark.parametrize(
    ("kwargs", "word"),
    [
        ({"hide": "feed_scerw"}, "feed_screw"),
        ({"tests": 1}, "locked"),
        ({"seed": -1}, "seed"),
        ({"hours": 0.5}, "heat"),
    ],
)
def test_what_cannot_be_simulated_is_refused(kwargs: dict[str, object], word: str) -> None:
    with pytest.raises(UsageError, match=word):
        make_world(**kwargs)  # type: ignore[arg-type]


def test_a_sum_of_lags_comes_near_but_does_not_reach_the_noise() -> None:
    from thermodata.modelling.fit.model import fit_model

    world = make_world("none", 2)
    data = to_dataset(world, 120.0)
    response = fit_model(world.baseline(), data).responses[0]
    calibration = [t for t in data.tests if t.role == "calibration"]
    rest = np.concatenate([response.residual(t)[response.mask(t)] for t in calibration])
    signal = np.concatenate([t.values[world.response][t.valid[world.response]] for t in calibration])
    assert np.sqrt(np.mean(rest**2)) < 1.0 < 5.0 < np.std(signal)
    assert np.sqrt(np.mean(rest**2)) > 0.5 * world.noise_um


def test_every_hideable_effect_is_in_the_library_with_its_drivers() -> None:
    from thermodata.effect.registry import effects

    library = effects()
    for name, h in EFFECTS.items():
        assert name in library
        assert set(h.drivers) <= {n.role for n in library[name].needs}
        assert library[name].family.replace("{s}", "") == h.family
