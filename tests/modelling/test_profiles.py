"""Profiles of time constants, and tests that can't tell two of them apart."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from thermodata.effect.lag import lag
from thermodata.modelling import fit_model
from thermodata.modelling.fit.joint import fitted_problem
from thermodata.modelling.least_squares.labels import fastest_first
from thermodata.modelling.seen.profiles import profiles_of
from thermodata.modelling.terms.fitted import FittedModel
from thermodata.modelling.terms.fitted_response import Values
from thermodata.modelling.terms.parameters import interval
from thermodata.modelling.trust.checks.apart import cooled
from thermodata.modelling.trust.intervals.profile import Profile
from thermodata.schema.answers.result import Check, Parameter
from thermodata.view.grid.dataset import ChannelInfo, Dataset, TestData

from .conftest import Spec

CHANNELS = {
    c.name: c
    for c in (
        ChannelInfo("y", "displacement", "um", "tcp", "Z"),
        ChannelInfo("T", "temperature", "degC", "spindle"),
        ChannelInfo("T_far", "temperature", "degC", "hall"),
        ChannelInfo("speed", "rotational_speed", "rpm", "spindle"),
    )
}
TWO_LAGS = {"effect": "transfer_function", "id": "f", "orders": [2, 2], "drivers": {"u": "T"}}


def _test(seed: int, heat_h: float, cool_h: float, noise: float, lags: dict[float, float]) -> TestData:
    """Ten minutes of rest, heating, and cooling; the sensor has a lag of 20 min. lags: min -> um/K."""
    rng = np.random.default_rng(seed)
    n = int((heat_h + cool_h) * 60) + 1
    on = np.zeros(n)
    on[10 : int(heat_h * 60)] = 1.0
    u = lag(12 * on, 1200, 60)
    y = np.sum([gain * lag(u, tau * 60, 60) for tau, gain in lags.items()], axis=0)
    values = {
        "y": y + rng.normal(0, noise, n) + 4 * noise * lag(rng.normal(0, 1, n), 1200, 60),
        "T": 20 + u + rng.normal(0, 0.01, n),
        "T_far": 20 + rng.normal(0, 0.01, n),
        "speed": 5000 * on,
    }
    t = np.arange(n) * 60.0
    known = {name: np.ones(n, bool) for name in values}
    return TestData("c", f"t{seed}", "other", "calibration", t, values, known, np.ones(n, bool), channels=CHANNELS)


def _fit(spec: Spec, tests: Sequence[TestData], *effects: dict[str, Any]) -> FittedModel:
    return fit_model(spec(*effects, response={"channel": "y"}), Dataset(60.0, tuple(tests), CHANNELS))


def _told_apart(fitted: FittedModel) -> list[Check]:
    return [c for c in fitted.checks() if c.name.startswith("told_apart")]


def _hours(check: Check) -> float:
    return float(check.advice.split("about ")[1].split(" h of cooling")[0])


def _near_lags(cool_h: float) -> list[TestData]:
    return [_test(seed, 1.5, cool_h, 0.3, {60.0: 2.0, 150.0: 3.0}) for seed in (2, 3)]


def test_two_lags_that_the_tests_cannot_tell_apart_are_said_with_the_hours_that_are_missing(spec: Spec) -> None:
    check = _told_apart(_fit(spec, _near_lags(2.0), TWO_LAGS))[0]
    assert not check.passed
    assert check.value is not None
    assert check.value <= 1.0
    assert check.advice.startswith("these tests can't tell the two time constants apart")
    assert 1.0 <= _hours(check) <= 10.0


def test_with_the_hours_that_were_missing_they_are_apart(spec: Spec) -> None:
    missing = _hours(_told_apart(_fit(spec, _near_lags(2.0), TWO_LAGS))[0])
    fitted = _fit(spec, _near_lags(2.0 + missing), TWO_LAGS)
    check = _told_apart(fitted)[0]
    assert check.passed
    assert "are apart" in check.advice
    found = fitted.parameters()
    taus = sorted(found[f"f.tau_{i}"].value for i in (1, 2))
    assert taus == pytest.approx([60.0, 150.0], rel=0.25)


def test_two_effects_of_one_driver_are_asked_as_well(spec: Spec) -> None:
    two = [{"effect": "lag", "id": f"l{i}", "drivers": {"u": "T"}, "start": {"tau": 30.0 * i}} for i in (1, 3)]
    assert [c.passed for c in _told_apart(_fit(spec, _near_lags(2.0), *two))] == [False]
    assert [c.passed for c in _told_apart(_fit(spec, _near_lags(10.0), *two))] == [True]


def test_effects_of_two_drivers_or_with_held_lags_are_not_asked(spec: Spec) -> None:
    other = {"effect": "lag", "id": "far", "drivers": {"u": "T_far"}}
    held = {"effect": "lag", "id": "held", "drivers": {"u": "T"}, "fixed": {"tau": 30.0}}
    lone = {"effect": "lag", "id": "near", "drivers": {"u": "T"}}
    assert not _told_apart(_fit(spec, _near_lags(2.0), lone, other))
    assert not _told_apart(_fit(spec, _near_lags(2.0), lone, held))


def test_a_test_is_cooled_as_its_driver_cooled_before() -> None:
    test = _test(1, 2.0, 1.0, 0.01, {60.0: 1.0})
    longer = cooled(test, "T", 3.0)
    rows = len(test.t_s)
    assert len(longer.t_s) == rows + 180
    assert np.all(longer.values["speed"][rows:] == 0)
    assert np.ptp(longer.values["T_far"][rows:]) == 0
    left = longer.values["T"][rows:] - 20.0
    assert left[0] < test.values["T"][-1] - 20.0 + 0.05
    # the sensor's own lag is 20 min
    assert left[20] / left[0] == pytest.approx(np.exp(-1), rel=0.1)


def test_where_a_test_ends_hot_the_interval_reaches_further_up(spec: Spec) -> None:
    """A lag of 4 h heated for one: below it the error rises steeply, above hardly."""
    one = {"effect": "lag", "id": "l", "drivers": {"u": "T"}}
    tests = [_test(seed, 1.5, 0.0, 0.3, {240.0: 8.0}) for seed in (5, 6)]
    found = _fit(spec, tests, one).parameters()["l.tau"]
    assert found.low is not None
    assert found.low < 240.0
    assert found.high is None or found.high / found.value > 1.3 * found.value / found.low
    curve = profiles_of(_fit(spec, tests, one), Dataset(60.0, tuple(tests), CHANNELS)).curves[0]
    assert not curve.quadratic


def test_on_long_tests_the_profile_is_the_quadratic_interval(spec: Spec) -> None:
    one = {"effect": "lag", "id": "l", "drivers": {"u": "T"}}
    tests = [_test(seed, 3.0, 6.0, 0.3, {60.0: 3.0}) for seed in (5, 6)]
    fitted = _fit(spec, tests, one)
    curve = profiles_of(fitted, Dataset(60.0, tuple(tests), CHANNELS)).curves[0]
    assert curve.quadratic
    found = fitted.parameters()["l.tau"]
    assert (found.low, found.high) == pytest.approx((curve.low, curve.high), rel=1e-3)
    assert found.low is not None
    assert found.high is not None
    assert found.low * found.high == pytest.approx(found.value**2, rel=1e-6)


def test_the_curve_has_its_least_error_at_the_fitted_value(spec: Spec) -> None:
    tests = [_test(seed, 3.0, 6.0, 0.3, {60.0: 3.0}) for seed in (5, 6)]
    data = Dataset(60.0, tuple(tests), CHANNELS)
    curve = profiles_of(_fit(spec, tests, {"effect": "lag", "drivers": {"u": "T"}}), data).curves[0]
    values, errors = zip(*curve.curve, strict=True)
    assert list(values) == sorted(values)
    assert values[int(np.argmin(errors))] == pytest.approx(curve.value)
    assert errors[0] > min(errors) < errors[-1]


def test_a_version_of_add_is_asked_on_all_tests_that_it_was_fitted_to(spec: Spec) -> None:
    """A verification test took part in the choice, and acts by a slower lag."""
    tests = [_test(seed, 4.0, 6.0, 0.3, {60.0 if seed < 4 else 90.0: 3.0}) for seed in (2, 3, 4)]
    tests[2] = replace(tests[2], role="verification")
    data = Dataset(60.0, tuple(tests), CHANNELS)
    model = spec({"effect": "lag", "drivers": {"u": "T"}}, response={"channel": "y"})
    fitted = fit_model(model.model_copy(update={"in_sample": True}), data)
    curve = profiles_of(fitted, data).curves[0]
    assert min(curve.curve, key=lambda point: point[1])[0] == pytest.approx(curve.value, rel=1e-3)
    told = fitted.parameters()["lag.tau"]
    ends = (curve.low, curve.high) if curve.quadratic else (curve.profile_low, curve.profile_high)
    assert ends == pytest.approx((told.low, told.high), rel=1e-3)


def test_at_a_bound_the_profile_tells_the_other_end(spec: Spec) -> None:
    """A lag of one minute that may not be under five: the data set the upper end alone."""
    one = {"effect": "lag", "id": "l", "drivers": {"u": "T"}, "bounds": {"tau": [5.0, 600.0]}}
    tests = [_test(seed, 3.0, 6.0, 0.3, {1.0: 3.0}) for seed in (5, 6)]
    found = _fit(spec, tests, one).parameters()["l.tau"]
    assert found.value == pytest.approx(5.0, rel=1e-3)
    assert found.low is None
    assert found.high is not None
    assert 5.0 < found.high < 8.0


def test_the_faster_of_two_like_lags_is_the_first_wherever_the_search_ended(spec: Spec) -> None:
    """Started from the slow one as the first: their sum is the same, and what is said of each must not depend on it."""
    tests = [_test(seed, 3.0, 8.0, 0.1, {20.0: 2.0, 150.0: 3.0}) for seed in (5, 6)]
    fitted = _fit(spec, tests, TWO_LAGS)
    problem, x, _ = fitted_problem(fitted.responses[0], tests)
    swapped = x[::-1].copy()
    assert x[0] < x[1]
    assert fastest_first(problem, swapped) == pytest.approx(x)
    assert problem.residual(swapped) == pytest.approx(problem.residual(x), abs=1e-9)
    told = _fit(spec, tests, TWO_LAGS | {"start": {"tau_1": 150.0, "tau_2": 20.0}})
    problem, x, _ = fitted_problem(told.responses[0], tests)
    assert fastest_first(problem, x[::-1].copy()) == pytest.approx(x[::-1]), "the model file has told them apart"


def test_gains_of_lags_that_undo_each_other_keep_their_signs(spec: Spec) -> None:
    """Too short to tell two lags of 40 and 90 min apart: the gains may be many times as large, but of no other sign."""
    tests = [_test(seed, 1.5, 0.5, 0.2, {40.0: -2.0, 90.0: 4.0}) for seed in (2, 3)]
    found = _fit(spec, tests, TWO_LAGS).parameters()
    first, second = found["f.gain_1"], found["f.gain_2"]
    assert first.low is None
    assert first.high is not None
    assert second.low is not None
    assert second.high is None or second.high > 5 * second.value
    assert -2.0 < first.high < 0.0
    assert 0.0 < second.low < 4.0
    assert _is_inside(40.0, found["f.tau_1"]), found["f.tau_1"]
    assert _is_inside(90.0, found["f.tau_2"]), found["f.tau_2"]


def test_a_gain_whose_time_constant_stands_at_its_bound_is_not_known_by_that_bound(spec: Spec) -> None:
    """Half an hour of heating of a lag of 40 h: the gain goes with the time constant, which the tests do not tell."""
    one = {"effect": "lag", "id": "l", "drivers": {"u": "T"}, "bounds": {"tau": [5.0, 2880.0]}}
    tests = [_test(seed, 1.5, 0.5, 0.3, {2400.0: 60.0}) for seed in (7, 8)]
    fitted = _fit(spec, tests, one)
    tau, gain = fitted.parameters()["l.tau"], fitted.parameters()["l.gain"]
    assert _is_inside(2400.0, tau)
    assert _is_inside(60.0, gain)
    assert gain.low is not None
    assert gain.low < 0.6 * gain.value, "the shortest time constant allowed has a smaller gain"


def test_where_the_error_is_quadratic_a_gain_has_its_quadratic_interval(spec: Spec) -> None:
    tests = [_test(seed, 3.0, 6.0, 0.3, {60.0: 3.0}) for seed in (5, 6)]
    gain = _fit(spec, tests, {"effect": "lag", "id": "l", "drivers": {"u": "T"}}).parameters()["l.gain"]
    assert gain.low is not None
    assert gain.high is not None
    assert gain.high - gain.value == pytest.approx(gain.value - gain.low, rel=1e-6)


def _is_inside(true: float, found: Parameter) -> bool:
    return (found.low is None or found.low <= true) and (found.high is None or true <= found.high)


def _days(count: int) -> list[TestData]:
    """Many days of a part that follows within 3 min, beside one that takes 2 h."""
    found = []
    for seed in range(count):
        rng = np.random.default_rng(100 + seed)
        on = np.repeat(rng.integers(0, 2, 72), 20).astype(float)
        on[:10] = 0.0
        tool, hall = lag(15 * on, 120, 60), lag(np.repeat(rng.normal(0, 2, 12), 120), 3600, 60)
        hall -= hall[0]
        y = 2.0 * lag(tool, 180, 60) + 3.0 * lag(hall, 7200, 60) + rng.normal(0, 0.3, len(on))
        values = {"y": y, "T": 20 + tool, "T_far": 20 + hall, "speed": 5000 * on}
        known = {name: np.ones(len(on), bool) for name in values}
        t = np.arange(len(on)) * 60.0
        window = np.ones(len(on), bool)
        found.append(TestData("c", f"d{seed}", "other", "calibration", t, values, known, window, channels=CHANNELS))
    return found


def test_the_interval_of_a_lag_of_minutes_is_that_of_all_samples(spec: Spec, monkeypatch: pytest.MonkeyPatch) -> None:
    """Means over ten minutes err by more than the noise; they may stand for the samples only where they do not."""
    effects = [
        {"effect": "lag", "id": name, "drivers": {"u": channel}} for name, channel in (("tool", "T"), ("hall", "T_far"))
    ]
    days = _days(25)
    found = _fit(spec, days, *effects).parameters()
    monkeypatch.setattr("thermodata.modelling.fit.joint.rough", lambda *_: None)
    whole = _fit(spec, days, *effects).parameters()
    for name in ("tool.tau", "tool.gain", "hall.tau", "hall.gain"):
        assert (found[name].low, found[name].high) == pytest.approx((whole[name].low, whole[name].high), rel=1e-6)
    low, high = found["tool.tau"].low, found["tool.tau"].high
    assert low is not None
    assert high is not None
    assert high / low < 1.01
    assert _is_inside(3.0, found["tool.tau"])


def test_where_few_samples_show_the_same_they_are_searched_instead_of_all(
    spec: Spec, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A lag too long for 8 h in coarse noise: its interval reaches further up, on all samples and on means of some."""
    one = {"effect": "lag", "id": "l", "drivers": {"u": "T"}}
    tests = [_test(seed, 8.0, 0.0, 5.0, {600.0: 5.0}) for seed in range(20)]
    sizes = list[int]()
    searched = Profile.rise

    def rise(profile: Profile, at: float) -> float:
        sizes.append(profile.problem.design.n)
        return searched(profile, at)

    monkeypatch.setattr(Profile, "rise", rise)
    found = _fit(spec, tests, one).parameters()["l.tau"]
    few, sizes[:] = list(sizes), []
    monkeypatch.setattr("thermodata.modelling.fit.joint.rough", lambda *_: None)
    whole = _fit(spec, tests, one).parameters()["l.tau"]
    assert few
    assert sizes
    assert max(few) < min(sizes) / 2
    assert found.low == pytest.approx(whole.low, rel=0.1)


def test_an_interval_beyond_the_bounds_says_that_nothing_is_known(spec: Spec) -> None:
    """A driver that hardly moves tells nothing of its lag."""
    one = {"effect": "lag", "id": "l", "drivers": {"u": "T"}, "bounds": {"tau": [1.0, 600.0]}}
    tests = [_test(seed, 3.0, 6.0, 0.3, {60.0: 0.01}) for seed in (5, 6)]
    fitted = _fit(spec, tests, one)
    found = fitted.parameters()["l.tau"]
    assert (found.low, found.high) == (None, None)
    (check,) = [c for c in fitted.checks() if c.name == "not_determined:l.tau"]
    assert not check.passed
    assert "from 1 to 600 min" in check.advice
    known = _fit(spec, [_test(seed, 3.0, 6.0, 0.3, {60.0: 3.0}) for seed in (5, 6)], one)
    assert not [c for c in known.checks() if c.name.startswith("not_determined")]


def test_an_end_beyond_a_bound_is_open() -> None:
    values = Values({"tau": 200.0}, {"gain": 1.0}, half={"tau": 1.5, "gain": 3.0}, log_names=frozenset({"tau"}))
    low, high = interval("tau", values, (1.0, 600.0))
    assert low == pytest.approx(200.0 / np.exp(1.5))
    assert high is None
    assert interval("gain", values) == (-2.0, 4.0)
