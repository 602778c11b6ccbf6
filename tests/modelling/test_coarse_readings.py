"""Temperatures that are read in coarse steps (modelling/inputs/coarse_readings.py)."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from thermodata.modelling.fit.model import fit_model
from thermodata.modelling.inputs.coarse_readings import COARSE_K, drawn, said, smoothest, treads_of
from thermodata.plugin import Float1D
from thermodata.schema.files.model import Model
from thermodata.view.grid.dataset import ChannelInfo, Dataset, TestData

STEP_S = 60.0
N = 600
T_S = STEP_S * np.arange(N)
INFOS = {
    "T": ChannelInfo("T", "temperature", "degC", at="spindle.bearing.front"),
    "n": ChannelInfo("n", "rotational_speed", "rpm", at="spindle"),
    "dZ": ChannelInfo("dZ", "displacement", "um", at="tcp", axis="Z", relative_to="table"),
}


def lagged(u: Float1D, minutes: float) -> Float1D:
    """A first-order lag from balance."""
    keep, out = float(np.exp(-STEP_S / (60 * minutes))), np.empty(len(u))
    state = u[0]
    for i, value in enumerate(u):
        state = keep * state + (1 - keep) * value
        out[i] = state
    return out


def warming(seed: int) -> Float1D:
    """A bearing that warms by some 15 K and cools again, in stages [degC]."""
    rng = np.random.default_rng(seed)
    stages = np.repeat(rng.uniform(0, 18, 6), N // 6)
    return np.asarray(21.3 + lagged(stages - stages[0], 25.0))


def made(seed: int, tread: float, *, noise: float = 0.03) -> TestData:
    """A test whose displacement follows the bearing's true temperature; what is logged of it has steps."""
    rng = np.random.default_rng([seed, 1])
    true = warming(seed)
    read = np.round((true + noise * rng.standard_normal(N)) / tread) * tread if tread else true
    dz = 3.0 * (lagged(true, 20.0) - true[0]) + 0.1 * rng.standard_normal(N)
    values = {"T": read, "n": np.round(1000 * rng.random(N)), "dZ": dz}
    ok = {name: np.ones(N, dtype=np.bool_) for name in values}
    role = "calibration" if seed < 3 else "verification"
    inside = np.ones(N, dtype=np.bool_)
    return TestData("c", f"t{seed}", "spindle", role, T_S, values, ok, inside, channels=INFOS)


def campaign(tread: float) -> Dataset:
    return Dataset(STEP_S, tuple(made(seed, tread) for seed in range(4)), INFOS)


def test_the_course_is_drawn_nearer_to_the_truth_and_never_further_than_half_a_step() -> None:
    data = campaign(1.0)
    found = drawn(data)
    assert found.drawn_k == {"T": pytest.approx(1.0)}
    for test, before in zip(found.tests, data.tests, strict=True):
        true = warming(int(test.test[1:]))
        error, rounding = test.values["T"] - true, before.values["T"] - true
        assert np.sqrt(np.mean(error**2)) < 0.85 * np.sqrt(np.mean(rounding**2))
        assert np.abs(test.values["T"] - before.values["T"]).max() <= 0.5 + 1e-9
        assert (np.diff(test.values["T"]) == 0).mean() < 0.1, "no treads are left"
        assert test.values["n"] is before.values["n"]
        assert test.values["dZ"] is before.values["dZ"]


@pytest.mark.parametrize("tread", [0.0, 0.1, 0.25])
def test_what_is_read_finely_stays_as_it_is(tread: float) -> None:
    data = campaign(tread)
    assert tread < COARSE_K
    assert drawn(data) is data


def test_half_degrees_are_coarse() -> None:
    assert treads_of(campaign(0.5).tests) == {"T": pytest.approx(0.5)}


def declared(data: Dataset, resolution: float) -> Dataset:
    infos = {**INFOS, "T": replace(INFOS["T"], resolution=resolution)}
    return replace(data, tests=tuple(replace(t, channels=infos) for t in data.tests), channels=infos)


@pytest.mark.parametrize(("tread", "resolution"), [(1.0, 0.1), (0.1, 0.5), (1.0, 1.0)])
def test_a_declared_resolution_rules(tread: float, resolution: float) -> None:
    found = treads_of(declared(campaign(tread), resolution).tests)
    assert found == ({"T": resolution} if resolution >= COARSE_K else {})


def test_a_prediction_that_reads_whole_degrees_is_better_for_it() -> None:
    spec = Model.model_validate(
        {
            "schema": "thermodata/model/1",
            "name": "m",
            "campaign": "c",
            "response": {"axis": "Z", "at": "tcp"},
            "step": "60 s",
            "effects": [{"effect": "spindle_bearing", "drivers": {"temperature": "T"}}],
        }
    )

    def error(data: Dataset) -> float:
        response = fit_model(spec, data, uncertainty=False).responses[0]
        rest = [response.residual(t) for t in data.tests if t.role == "verification"]
        return float(np.sqrt(np.nanmean(np.concatenate(rest) ** 2)))

    assert error(drawn(campaign(1.0))) < error(campaign(1.0))


def test_what_was_not_read_stays_so() -> None:
    data = campaign(1.0)
    first = data.tests[0]
    read, ok = first.values["T"].copy(), first.valid["T"].copy()
    read[100:180], ok[300:320] = np.nan, False
    holes = replace(first, values={**first.values, "T": read}, valid={**first.valid, "T": ok})
    found = drawn(replace(data, tests=(holes, *data.tests[1:]))).tests[0]
    assert np.array_equal(np.isnan(found.values["T"]), np.isnan(read))
    assert np.array_equal(found.values["T"][300:320], read[300:320])
    assert found.valid["T"] is ok


def test_each_campaign_has_its_own_steps_and_a_test_of_a_few_samples_none() -> None:
    fine = tuple(replace(t, campaign="fine") for t in campaign(0.1).tests)
    few = {name: values[:4] for name, values in made(9, 1.0).values.items()}
    short = replace(made(9, 1.0), values=few, valid={n: np.ones(4, dtype=np.bool_) for n in few}, t_s=T_S[:4])
    data = Dataset(STEP_S, (*campaign(1.0).tests, *fine, short), INFOS)
    found = drawn(data)
    assert found.drawn_k == {"T": pytest.approx(1.0)}
    assert all(a is b for a, b in zip(found.tests[4:8], fine, strict=True))
    assert found.tests[8] is short


def test_who_reads_it_is_told() -> None:
    data = drawn(campaign(1.0))
    assert said(data, {"n"}) == []
    (sentence,) = said(data, {"T", "n"})
    assert sentence.startswith("T is read in steps of 1 K: as a driver it is drawn smoothly through the steps")
    both = replace(data, drawn_k={"T": 1.0, "U": 1.0, "V": 0.5})
    assert [s.partition(":")[0] for s in said(both, {"T", "U", "V"})] == [
        "V is read in steps of 0.5 K",
        "T, U are read in steps of 1 K",
    ]


def test_a_true_jump_stays_where_it_is() -> None:
    read = np.repeat([20.0, 45.0, 21.0], 100)[:, None]
    found = smoothest(read, np.full_like(read, 0.5), STEP_S)
    assert np.abs(found - read).max() <= 0.5
    assert np.flatnonzero(np.abs(np.diff(found[:, 0])) > 10).tolist() == [99, 199]


@pytest.mark.parametrize("step", [1.0, 0.1, 0.02, 0.01, 1e-3, 1e-6])
def test_no_grid_is_too_fine(step: float) -> None:
    read = np.round(np.sin(np.arange(20_000) / 900.0) * 9)[:, None]
    found = smoothest(read, np.full_like(read, 0.5), step)
    assert np.isfinite(found).all()
    assert np.abs(found - read).max() <= 0.5 + 1e-9


@settings(max_examples=60, deadline=None)
@given(
    st.lists(st.integers(-40, 120), min_size=5, max_size=80),
    st.sampled_from([1.0, 10.0, 60.0, 600.0]),
    st.sampled_from([0.25, 0.5, 2.5]),
)
def test_whatever_is_read_nothing_is_further_than_half_a_step(read: list[int], step: float, half: float) -> None:
    values = np.asarray(read, dtype=np.float64)[:, None]
    found = smoothest(values, np.full_like(values, half), step)
    assert np.isfinite(found).all()
    assert np.abs(found - values).max() <= half + 1e-9


def test_a_value_that_is_held_where_a_log_begins_late_is_no_step() -> None:
    """Before and after it the first and the last reading stand: levels, alike by chance, but no staircase."""
    tests = []
    for seed in range(4):
        test = made(seed, 0.0)
        short = {n: x[200:].copy() for n, x in test.values.items()}
        short["T"][:10], short["T"][-10:] = short["T"][10], short["T"][10] + 0.6 * (seed + 1)
        valid = {n: x[200:] for n, x in test.valid.items()}
        tests.append(replace(test, t_s=T_S[:-200], values=short, valid=valid, in_window=test.in_window[200:]))
    assert treads_of(tests) == {}
    assert treads_of([made(seed, 1.0) for seed in range(4)])["T"] == pytest.approx(1.0)
