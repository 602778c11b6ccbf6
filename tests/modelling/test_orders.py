"""Orders are chosen by what was left out, and the whole table says so."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.signal import lfilter

from thermodata.effect.lag import lag
from thermodata.errors import SpecError, UsageError
from thermodata.modelling import fit_model
from thermodata.modelling.compare.left_out_error import LeftOut
from thermodata.modelling.fit.orders import free_run_fit
from thermodata.modelling.model_file.transfer.as_effect import GivenFunction
from thermodata.modelling.predictions.left_out import folds, left_out_fit
from thermodata.plugin import Float1D
from thermodata.schema.files.model import Model
from thermodata.view.grid.dataset import ChannelInfo, Dataset, TestData

from .conftest import Spec

INFOS = {
    "dZ": ChannelInfo("dZ", "displacement", "um", "tcp", "Z"),
    "T": ChannelInfo("T", "temperature", "degC", "spindle.bearing"),
}
FUNCTION = {"effect": "transfer_function", "drivers": {"u": "T"}}


def _heat(rng: np.random.Generator, hours: float) -> Float1D:
    out, at = np.zeros(int(hours * 3600)), 600
    while at < len(out):
        length = int(rng.uniform(600, 7200))
        out[at : at + length] = rng.choice([0.0, 6.0, 12.0])
        at += length
    return out


def _test(seed: int, role: str, *, hours: float = 8, step: int = 60, slow: float = 0.0) -> TestData:
    """Two lags of 20 min and 3 h; slow: slow noise [um], which coefficients to spare would follow."""
    rng = np.random.default_rng(seed)
    warmth = lag(_heat(rng, hours), 900, 1.0)
    drift = slow * lag(rng.normal(0, np.sqrt(2 * 2400), len(warmth)), 2400, 1.0)
    y = 1.2 * lag(warmth, 1200, 1.0) + 2.0 * lag(warmth, 10800, 1.0) + drift + rng.normal(0, 0.3, len(warmth))
    n = len(y) // step
    read = 22 + np.round(warmth * 10) / 10
    values = {k: v[: n * step].reshape(n, step).mean(axis=1) for k, v in (("dZ", y), ("T", read))}
    valid = {k: np.ones(n, bool) for k in values}
    t_s = np.arange(n) * float(step)
    return TestData("c", f"s{seed}", "spectrum", role, t_s, values, valid, np.ones(n, bool), channels=INFOS)


def _data(*tests: TestData) -> Dataset:
    return Dataset(float(tests[0].t_s[1]), tests, INFOS)


def _tried(data: Dataset, spec: Spec, **more: Any) -> list[Any]:
    return list(fit_model(spec(FUNCTION | more), data).responses[0].tried)


@pytest.fixture(scope="module")
def noisy() -> Dataset:
    return _data(*(_test(k, "calibration", hours=6, slow=0.02) for k in range(3)))


def test_every_pair_is_in_the_table_and_one_is_chosen(noisy: Dataset, spec: Spec) -> None:
    table = _tried(noisy, spec, method="oe")
    assert {(r.numerator, r.denominator) for r in table} == {(n, d) for n in range(1, 5) for d in range(1, 5)}
    (chosen,) = [r for r in table if r.chosen]
    best = max(r.fit_left_out for r in table)
    assert chosen.fit_left_out >= best - 0.5
    fewer = [r for r in table if r.numerator + r.denominator < chosen.numerator + chosen.denominator]
    assert all(r.fit_left_out < best - 0.5 for r in fewer)


def test_the_fit_of_what_was_fitted_has_no_say(noisy: Dataset, spec: Spec) -> None:
    """It rises with the coefficients; what was left out does not."""
    table = _tried(noisy, spec, method="oe")
    by_fit = max(table, key=lambda r: r.fit_calibration)
    (chosen,) = [r for r in table if r.chosen]
    assert by_fit.numerator + by_fit.denominator > chosen.numerator + chosen.denominator
    assert chosen.fit_left_out >= by_fit.fit_left_out - 0.5
    assert by_fit.fit_left_out < by_fit.fit_calibration


def test_lags_stop_where_one_more_is_not_told(noisy: Dataset, spec: Spec) -> None:
    table = _tried(noisy, spec)
    pairs = [(r.numerator, r.denominator) for r in table]
    assert pairs == [(1, 1), (2, 1), (2, 2), (3, 2), (3, 3), (4, 3), (4, 4), (5, 4)][: len(pairs)]
    assert all(r.why for r in table[-2:])
    assert not any(r.chosen for r in table if r.why)
    (chosen,) = [r for r in table if r.chosen]
    assert chosen.denominator == 2


def test_a_direct_term_stands_beside_the_lags_where_the_data_want_it(spec: Spec) -> None:
    """Nearly all printed functions have one: a sensor that is slower than what it drives."""

    def with_direct(seed: int, role: str, direct: float) -> TestData:
        test = _test(seed, role, hours=16)
        warmth = test.values["T"] - 22
        y = direct * warmth + 3.0 * lag(warmth, 2400, 60.0) + np.random.default_rng(seed).normal(0, 0.1, len(warmth))
        return replace(test, values={**test.values, "dZ": y})

    for direct, orders in ((4.5, (2, 1)), (0.0, (1, 1))):
        data = _data(*(with_direct(k, r, direct) for k, r in enumerate(["calibration"] * 2 + ["verification"])))
        fitted = fit_model(spec(FUNCTION), data)
        response = fitted.responses[0]
        assert response.terms[0].bound.spec.orders == orders
        found = fitted.parameters()
        assert found["transfer_function.gain"].value == pytest.approx(3.0, rel=0.03)
        assert found["transfer_function.tau"].value == pytest.approx(40.0, rel=0.1)
        if direct:
            assert found["transfer_function.direct"].value == pytest.approx(direct, rel=0.03)
            assert found["transfer_function.direct"].unit == "um/K"
        assert np.std(response.residual(data.tests[2])) < 0.3


def test_each_order_of_oe_is_as_good_as_a_fit_of_it(spec: Spec) -> None:
    """A direct term and a slow return: one coefficient stands at the shortest lag, and two lie far away from there."""
    test = _test(3, "calibration", hours=16)
    warm = 9 * lag(((test.t_s > 900) & (test.t_s < 30000)).astype(float), 9000.0, 60.0)
    y = 2.0 * warm - 0.8 * lag(warm, 21000.0, 60.0) + np.random.default_rng(1).normal(0, 0.1, len(warm))
    data = _data(replace(test, values={"dZ": y, "T": 22 + warm}))
    tried = {(r.numerator, r.denominator): r.fit_calibration for r in _tried(data, spec, method="oe")}
    for orders in ((2, 1), (2, 2), (3, 2)):
        alone = fit_model(spec(FUNCTION | {"method": "oe", "orders": list(orders)}), data).responses[0]
        assert tried[orders] == pytest.approx(free_run_fit(alone, data.tests), abs=0.2), orders
    assert tried[2, 1] - tried[1, 1] > 2


def test_orders_are_open_beside_an_effect_with_tests_of_its_own(spec: Spec) -> None:
    """The effect that comes first stands last in the file, and either can have its orders open."""
    first, second = (_test(k, "calibration", hours=12) for k in (4, 5))
    hall = {t.test: np.sin(2 * np.pi * t.t_s / 43200) for t in (first, second)}
    infos = {**INFOS, "T_hall": ChannelInfo("T_hall", "temperature", "degC", "hall")}

    def with_hall(test: TestData, warm: float) -> TestData:
        air = 20 + 3 * hall[test.test]
        dz = warm * test.values["dZ"] - 6 * hall[test.test]
        values = {"dZ": dz, "T": 22 + warm * (test.values["T"] - 22), "T_hall": air}
        return replace(test, values=values, valid=dict.fromkeys(values, test.in_window), channels=infos)

    data = replace(_data(with_hall(first, 1.0), with_hall(second, 0.0)), channels=infos)
    air = {"effect": "transfer_function", "id": "air", "drivers": {"u": "T_hall"}, "calibrate_on": [second.test]}
    model = spec(FUNCTION | {"id": "heat"}, air, calibrate_on=[first.test], phases=["working"])
    timed = tuple(replace(t, phases={"working": (0.0, 1e6)}) for t in data.tests)
    fitted = fit_model(model, replace(data, tests=timed))
    chosen = {r.effect: (r.numerator, r.denominator) for r in fitted.responses[0].tried if r.chosen}
    assert set(chosen) == {"heat", "air"}
    assert chosen["air"][1] == 1


def test_one_test_is_cut_into_parts(spec: Spec) -> None:
    test = _test(1, "calibration", hours=12)
    data = _data(test)
    fitted = fit_model(spec(FUNCTION | {"orders": [2, 2]}), data).responses[0]
    parts = folds([test], lambda t: "dZ", fitted.mask)
    assert len(parts) == 4
    counted = np.sum([fitted.mask(t) for p in parts for t in p.left_out], axis=0)
    assert np.array_equal(counted, (fitted.mask(test) & (test.t_s >= 600)).astype(int))
    assert all(not (fitted.mask(p.train[0]) & fitted.mask(p.left_out[0])).any() for p in parts)
    total, worst = left_out_fit(parts, lambda train: fitted)
    assert worst <= total
    assert total == pytest.approx(99, abs=1.0)
    assert any(r.chosen for r in _tried(data, spec))


def test_a_left_out_test_is_not_fitted(noisy: Dataset) -> None:
    for fold in folds(noisy.tests, lambda t: "dZ", lambda t: t.in_window):
        assert not {t.test for t in fold.train} & {t.test for t in fold.left_out}
    many = [replace(noisy.tests[0], test=f"t{k}") for k in range(14)]
    grouped = folds(many, lambda t: "dZ", lambda t: t.in_window)
    assert len(grouped) == 6
    assert sorted(t.test for f in grouped for t in f.left_out) == sorted(t.test for t in many)


def _in_windows(test: TestData, every_s: float, measured_s: float) -> TestData:
    good = test.t_s % every_s < measured_s
    return replace(test, valid={**test.valid, "dZ": good})


def test_arx_counts_the_response_from_its_first_samples(spec: Spec) -> None:
    """A constant a test would take what the slow pole should say: the gain at rest came out a fourth too small."""
    tests = [_test(seed, "calibration", hours=16) for seed in (5, 6)]
    moved = [replace(t, values={**t.values, "dZ": t.values["dZ"] + 500.0 * k}) for k, t in enumerate(tests, 1)]
    model = spec(FUNCTION | {"method": "arx", "orders": [2, 2]})
    at_rest = []
    for each in (tests, moved):
        effect = fit_model(model, _data(*each)).responses[0].terms[0].effect
        assert isinstance(effect, GivenFunction)
        at_rest.append(effect.gain_at_rest)
    assert at_rest[0] == pytest.approx(1.2 + 2.0, rel=0.12)
    assert at_rest[1] == pytest.approx(at_rest[0], rel=1e-6)
    # where a test began warm nobody knows its zero, and a constant stands for it
    warm = [replace(t, start_state="warm") for t in moved]
    effect = fit_model(model, _data(*warm)).responses[0].terms[0].effect
    assert isinstance(effect, GivenFunction)
    assert effect.gain_at_rest < 0.9 * at_rest[0]


def test_what_tells_the_zero_of_the_only_test_is_never_left_out(spec: Spec) -> None:
    """A part that begins warm has no zero of its own: an ARX that counted from there was not stable, and lost to one
    with a FIT 10 points lower on an unseen test."""
    test, unseen = _test(0, "calibration", hours=24), _test(1, "verification", hours=24)
    for fold in folds([test], lambda t: "dZ", lambda t: t.in_window):
        assert fold.rest is not None
        assert fold.rest.valid["dZ"][:10].all()
        assert not fold.left_out[0].valid["dZ"][:10].any()
    fitted = fit_model(spec(FUNCTION | {"method": "arx"}), _data(test, unseen))
    assert all(r.why is None for r in fitted.responses[0].tried)
    plain = fit_model(spec(FUNCTION | {"method": "arx", "orders": [1, 3]}), _data(test, unseen))
    fits = [free_run_fit(f.responses[0], [unseen]) for f in (fitted, plain)]
    assert fits[0] > fits[1] + 5.0


def _late(test: TestData, steps: int, noise: float) -> TestData:
    """An ARX(2,2) of one-step noise whose driver comes so many steps late."""
    rng = np.random.default_rng(7)
    u = test.values["T"] - test.values["T"][0]
    driven = lfilter([*np.zeros(steps), 0.5, 0.3], [1.0, -1.7, 0.72], u)
    y = driven + lfilter([1.0], [1.0, -1.7, 0.72], rng.normal(0, noise, len(u)))
    return replace(test, values={**test.values, "dZ": y})


@pytest.mark.parametrize("steps", [0, 1, 5])
def test_arx_with_its_delay_given_finds_a_late_function(spec: Spec, steps: int) -> None:
    data = _data(_late(_test(1, "calibration"), steps, 0.0))
    fitted = fit_model(spec(FUNCTION | {"method": "arx", "orders": [2, 2], "delay": steps}), data)
    effect = fitted.responses[0].terms[0].effect
    assert isinstance(effect, GivenFunction)
    assert effect.num == pytest.approx([*np.zeros(steps), 0.5, 0.3], abs=1e-5)
    assert effect.den == pytest.approx([1.0, -1.7, 0.72], abs=1e-5)


@pytest.mark.parametrize("steps", [0, 1, 2])
def test_the_delay_of_an_arx_is_chosen_by_what_was_left_out(spec: Spec, steps: int) -> None:
    data = _data(*(_late(_test(k, "calibration"), steps, 0.02) for k in range(3)))
    fitted = fit_model(spec(FUNCTION | {"method": "arx"}), data)
    table = fitted.responses[0].tried
    chosen = next(r for r in table if r.chosen)
    assert [r.delay for r in table] == [0] * 16 + [1, 2]
    own = [r for r in table if (r.numerator, r.denominator) == (chosen.numerator, chosen.denominator)]
    assert chosen.fit_left_out == max(r.fit_left_out for r in own)
    assert chosen.delay == steps
    said = next(c.advice for c in fitted.checks() if c.name.startswith("orders:"))
    assert ("late" in said) == (chosen.delay > 0)


def test_a_delay_that_is_given_is_not_chosen_and_no_other_method_has_one(spec: Spec) -> None:
    data = _data(*(_late(_test(k, "calibration"), 2, 0.02) for k in range(2)))
    assert {r.delay for r in _tried(data, spec, method="arx", delay=1)} == {1}
    assert {r.delay for r in _tried(data, spec, method="oe")} == {0}
    with pytest.raises(SpecError, match="'delay' belongs to method arx") as refusal:
        fit_model(spec(FUNCTION | {"method": "oe", "orders": [2, 2], "delay": 1}), data)
    assert "dead_time" in str(refusal.value.hint)


def test_a_delay_that_the_file_leaves_open_is_chosen_beside_given_orders(spec: Spec) -> None:
    data = _data(*(_late(_test(k, "calibration"), 1, 0.02) for k in range(3)))
    fitted = fit_model(spec(FUNCTION | {"method": "arx", "orders": [2, 2]}), data)
    rows = fitted.responses[0].tried
    assert {(r.numerator, r.denominator) for r in rows} == {(2, 2)}
    assert [r.delay for r in rows] == [0, 1, 2]
    best = max(rows, key=lambda r: r.fit_left_out or -np.inf)
    assert [r.delay for r in rows if r.chosen] == [best.delay] == [1]


def test_given_orders_of_an_arx_are_fitted_where_too_little_is_left_to_choose_its_delay(spec: Spec) -> None:
    data = _data(_test(1, "calibration", hours=2), _test(2, "calibration", hours=0.4))
    given = FUNCTION | {"method": "arx", "orders": [4, 4]}
    fitted, said = (fit_model(spec(given | more), data).responses[0] for more in ({}, {"delay": 0}))
    assert [(r.delay, r.chosen) for r in fitted.tried] == [(0, False), (1, False), (2, False)]
    assert all("too few" in r.why for r in fitted.tried)
    assert fitted.terms[0].bound.spec.delay == 0
    np.testing.assert_array_equal(fitted.predict(data.tests[0]), said.predict(data.tests[0]))
    with pytest.raises(UsageError, match="too few"):
        fit_model(spec(given), _data(data.tests[1]))


@pytest.mark.parametrize("steps", [0, 1])
def test_a_delay_that_all_tests_chose_is_not_chosen_again_in_each_fold(
    spec: Spec, steps: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    data = _data(*(_late(_test(k, "calibration"), steps, 0.02) for k in range(3)))
    model = spec(FUNCTION | {"method": "arx", "orders": [2, 2]})
    left = LeftOut(model, data)
    assert left.whole.responses[0].terms[0].bound.spec.delay == steps

    def again(*_: object) -> None:
        raise AssertionError("chosen again")

    monkeypatch.setattr("thermodata.modelling.fit.model.choose_orders", again)
    said = spec(FUNCTION | {"method": "arx", "orders": [2, 2], "delay": steps})
    assert left.errors(model) == left.errors(said)


def test_arx_is_refused_on_measuring_windows_with_the_reason(spec: Spec) -> None:
    """Papers measure 10 s every 20 min; FIT in free run is -57 where that is fitted all the same."""
    whole = _test(1, "calibration", hours=4, step=1)
    windows = _data(_in_windows(whole, 1200.0, 10.0))
    arx = {"method": "arx", "orders": [2, 2]}
    with pytest.raises(UsageError, match="windows") as refusal:
        fit_model(spec(FUNCTION | arx), windows)
    assert "12 windows of about 10 s with pauses of about 1190 s" in str(refusal.value.got)
    assert "varpro" in str(refusal.value.hint)
    with pytest.raises(UsageError, match="windows"):
        fit_model(spec(FUNCTION | {"method": "arx"}), windows)
    fit_model(spec(FUNCTION | arx), _data(_in_windows(whole, 3600.0, 3000.0)))  # a record with gaps
    free = fit_model(spec(FUNCTION | {"orders": [2, 2]}), windows).responses[0]
    y, gap = whole.values["dZ"], whole.values["dZ"] - free.predict(whole)
    assert np.std(gap) < 0.1 * np.std(y)


def test_sixty_times_the_samples_take_no_more_than_six_times_as_long(spec: Spec) -> None:
    """Sixteen orders of 8 h at 1 Hz and at 60 s, processor time in one run: many samples are tried on means."""
    model = spec(FUNCTION | {"method": "oe"})
    fit_model(model, _data(_test(2, "calibration", hours=2)))

    def seconds(step: int) -> float:
        data = _data(_test(1, "calibration", step=step))
        start = time.process_time()
        fit_model(model, data)
        return time.process_time() - start

    assert seconds(1) < 6 * max(seconds(60), seconds(60))


def test_a_lag_more_fits_no_worse(spec: Spec) -> None:
    """The fewer lags are among the more: one of them may be of no time at all."""
    table = _tried(_data(_test(1, "calibration")), spec, method="oe")
    fit = {(r.numerator, r.denominator): r.fit_calibration for r in table}
    for numerator in (1, 2):
        for denominator in (2, 3, 4):
            assert fit[numerator, denominator] > fit[numerator, denominator - 1] - 1.0, (numerator, denominator)


def test_the_model_says_what_was_chosen(noisy: Dataset, spec: Spec) -> None:
    fitted = fit_model(spec(FUNCTION), noisy)
    (check,) = [c for c in fitted.checks() if c.name == "orders:transfer_function"]
    assert check.passed
    assert "thermodata orders" in check.advice
    given: Mapping[str, Any] = FUNCTION | {"orders": [1, 1]}
    assert not [c for c in fit_model(spec(given), noisy).checks() if c.name.startswith("orders")]
    assert isinstance(fitted.spec, Model)
