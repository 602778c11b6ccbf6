"""Others fitted anew beside an optimum, and the optimum that sweeps over coarse values miss."""

from __future__ import annotations

import sys
from dataclasses import replace
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path

import numpy as np
import pytest

from thermodata.effect.lag import lag
from thermodata.modelling import fit_model
from thermodata.modelling.fit.joint import fitted_problem
from thermodata.modelling.inputs.drivers import start_deviation, start_value
from thermodata.modelling.least_squares.labels import fastest_first, swappable_lags
from thermodata.modelling.least_squares.search import Problem, search
from thermodata.modelling.trust.intervals.anew import could_fall, fit_anew
from thermodata.modelling.trust.intervals.coordinate import Searched
from thermodata.modelling.trust.intervals.estimate import Estimate
from thermodata.modelling.trust.intervals.profile import Profile
from thermodata.plugin import Float1D, Float2D
from thermodata.schema.files.model import Model
from thermodata.view.grid.dataset import ChannelInfo, Dataset, TestData

CHANNELS = {
    "y": ChannelInfo("y", "displacement", "um", "tcp", "Z"),
    "T": ChannelInfo("T", "temperature", "degC", "spindle"),
    "T_far": ChannelInfo("T_far", "temperature", "degC", "hall"),
}
TWO = (
    {"effect": "lag", "id": "a", "drivers": {"u": "T"}},
    {"effect": "lag", "id": "b", "drivers": {"u": "T_far"}},
)


def _test(seed: int) -> TestData:
    rng, n = np.random.default_rng(seed), 600
    near = lag(np.repeat(rng.choice([0.0, 10.0], 10), 60), 900, 60)
    far = lag(np.repeat(rng.normal(0, 3, 10), 60), 1800, 60)
    y = 2.0 * lag(near, 1800, 60) - 3.0 * lag(far, 6000, 60) + rng.normal(0, 0.3, n)
    values = {"y": y, "T": 20 + near, "T_far": 20 + far}
    known = {name: np.ones(n, bool) for name in values}
    return TestData(
        "c", f"t{seed}", "other", "calibration", np.arange(n) * 60.0, values, known, np.ones(n, bool), channels=CHANNELS
    )


@pytest.fixture(scope="module")
def fitted() -> tuple[Problem, Float1D, Float2D]:
    """A problem of two lags at its optimum, and the slopes of the prediction there."""
    tests = tuple(_test(k) for k in (1, 2))
    text = {"schema": "thermodata/model/1", "name": "m", "campaign": "c", "step": "60 s"}
    model = Model.model_validate(text | {"response": {"channel": "y"}, "effects": TWO})
    problem, x, _ = fitted_problem(fit_model(model, Dataset(60.0, tests, CHANNELS)).responses[0], tests)
    slopes = Estimate(problem, x, problem.gains(problem.matrix(x))).slopes()
    assert slopes is not None
    return problem, x, slopes


@pytest.mark.parametrize("by", [-0.3, 0.05, 0.4])
def test_beside_an_optimum_the_others_end_where_a_search_ends(
    fitted: tuple[Problem, Float1D, Float2D], by: float
) -> None:
    problem, x, slopes = fitted
    part = Searched(0, problem.free[0]).held(problem, float(x[0]) + by, x[1:])
    searched = part.residual(search(part, x[1:]))
    found = fit_anew(part, x[1:], slopes[:, 1:], 1e-7)
    assert found is not None
    assert found.residual @ found.residual == pytest.approx(searched @ searched, rel=1e-6)
    before = part.residual(x[1:])
    left = float(before @ before) - could_fall(part, x[1:], before, slopes[:, 1:])
    assert left == pytest.approx(searched @ searched, rel=1e-2)


@pytest.mark.parametrize("wrong", [-1.0, 0.05, 20.0])
def test_slopes_that_are_wrong_are_noticed_by_what_their_steps_bring(
    fitted: tuple[Problem, Float1D, Float2D], wrong: float
) -> None:
    problem, x, slopes = fitted
    part = Searched(0, problem.free[0]).held(problem, float(x[0]) + 0.3, x[1:])
    found = fit_anew(part, x[1:] + 1.0, wrong * slopes[:, 1:], 1e-7)
    searched = part.residual(search(part, x[1:]))
    assert found is None or found.residual @ found.residual == pytest.approx(searched @ searched, rel=1e-5)


def test_a_search_ends_in_the_deepest_valley() -> None:
    """This machine has a shallow one at the fastest hall, where sweeps end while the spindle's lag is coarse."""
    path = Path(__file__).parents[1] / "benchmarks" / "coverage.py"
    loaded = spec_from_file_location("coverage_of_intervals", path)
    assert loaded is not None
    assert loaded.loader is not None
    coverage = module_from_spec(loaded)
    sys.modules[loaded.name] = coverage
    loaded.loader.exec_module(coverage)
    machine = coverage.make_machine("two effects", "slow", 3050)
    text = {"schema": "thermodata/model/1", "name": "m", "campaign": "c", "step": "60 s", "response": {"axis": "Z"}}
    model = Model.model_validate(text | {"effects": coverage.CASES["two effects"]})
    fit = fit_model(model, Dataset(60.0, machine.tests, coverage.INFOS), uncertainty=False)
    problem, x, _ = fitted_problem(fit.responses[0], machine.tests)
    true = np.log([machine.truth["spindle.tau"], machine.truth["hall.tau"]])
    found, from_truth = problem.residual(x), problem.residual(search(problem, true))
    assert found @ found <= (1 + 1e-6) * (from_truth @ from_truth)


def test_a_driver_that_creeps_while_it_starts_is_known_the_less() -> None:
    rng = np.random.default_rng(3)
    errors, said = [], []
    for _ in range(200):
        creep = rng.normal(0, 0.02)  # [K] a sample, within the noise
        values = 20.0 + creep * (np.arange(600) + 0.5) + rng.normal(0, 0.02, 600)
        errors.append(start_value(values, 60.0) - 20.0)
        said.append(start_deviation(values, 60.0))
    # by the noise alone what is said is half of what it is
    assert 0.75 < np.sqrt(np.mean(np.square(said)) / np.mean(np.square(errors))) < 1.4


def test_of_a_driver_at_rest_the_start_is_known_by_its_noise() -> None:
    rng = np.random.default_rng(4)
    said = [start_deviation(20.0 + rng.normal(0, 0.02, 600), 60.0) for _ in range(200)]
    assert np.median(said) == pytest.approx(0.02 / np.sqrt(5), rel=0.3)


@pytest.mark.parametrize("along", [False, True])
def test_a_like_lag_that_is_passed_ends_where_a_search_ends(along: bool) -> None:
    """Slopes of the optimum took it for a point on the wrong side of the border, whose error is many times as large."""
    text = {"schema": "thermodata/model/1", "name": "m", "campaign": "c", "step": "60 s", "response": {"channel": "y"}}
    effect = {"effect": "transfer_function", "drivers": {"u": "T"}, "orders": [2, 2]}
    model = Model.model_validate(text | {"effects": [effect]})
    tests = []
    for seed in (1, 2):
        test, rng = _test(seed), np.random.default_rng(seed)
        warm = test.values["T"] - 20
        y = 1.2 * lag(warm, 1200, 60) + 2.0 * lag(warm, 6000, 60) + rng.normal(0, 0.3, len(warm))
        tests.append(replace(test, values={**test.values, "y": y}))
    fit = fit_model(model, Dataset(60.0, tuple(tests), CHANNELS), uncertainty=False)
    problem, x, _ = fitted_problem(fit.responses[0], tests)
    x = fastest_first(problem, x)
    estimate = Estimate(problem, x, problem.gains(problem.matrix(x)))
    for place, by in ((0, 0.2), (1, -0.2)):
        of = Searched(place, problem.free[place], swappable_lags(problem))
        way = estimate.along(place, [0, 1]) if along else None
        profile = Profile(problem, x, of, lambda moved: 1.0, way, estimate.slopes())
        at = float(x[1 - place]) + by
        part = of.held(problem, at, of.others(x))
        searched = part.residual(search(part, np.clip(of.others(x), *part.box())))
        assert profile.least + profile.rise(at) == pytest.approx(searched @ searched, rel=1e-3)
