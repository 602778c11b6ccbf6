"""A second lag where left-out tests want it: found where the machine is distributed, refused where it is not."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from threadpoolctl import threadpool_info, threadpool_limits

from thermodata.effect.lag import lag
from thermodata.modelling import fit_model, run
from thermodata.modelling.add import add
from thermodata.modelling.compare.left_out_error import Errors, LeftOut
from thermodata.modelling.terms.fitted import FittedModel
from thermodata.modelling.versions import second_lag
from thermodata.modelling.versions.as_foretold import beside_foretold
from thermodata.modelling.versions.second_lag import is_single_lag, with_second_lags
from thermodata.plugin import Float1D
from thermodata.schema.files.model import EffectSpec, Model
from thermodata.store.catalogue.models.findings import save_diagnosis
from thermodata.view.grid.dataset import Dataset

from ..answers import candidate, diagnosis
from .conftest import CHANNELS, STEP, Spec, Stored, make_test

Answer = Callable[[Float1D], Float1D]


def distributed(u: Float1D) -> Float1D:
    return 3.0 * lag(u, 600, STEP) + 2.0 * lag(u, 12000, STEP)


def single(u: Float1D) -> Float1D:
    return 5.0 * lag(u, 2400, STEP)


def two_alike(u: Float1D) -> Float1D:
    """One lag behind another of the same time constant: as two lags side by side these are two huge gains."""
    return 5.0 * lag(lag(u, 2400, STEP), 2400, STEP)


def machine(answer: Answer, roles: str = "cccvl") -> Dataset:
    """Eight hours a test, in which the nut acts as `answer` says and the bearing as one lag. roles: a letter a test."""
    tests = []
    for k, letter in enumerate(roles):
        role = {"c": "calibration", "v": "verification", "l": "locked"}[letter]
        test = make_test(k, role, hours=8.0)
        nut, bearing = (test.values[n] - test.values[n][0] for n in ("T_nut", "T_bearing"))
        noise = np.random.default_rng(100 + k).normal(0, 0.2, len(nut))
        tests.append(replace(test, values={**test.values, "dZ": answer(nut) + 2.0 * lag(bearing, 1800, STEP) + noise}))
    return Dataset(STEP, tuple(tests), CHANNELS, "v1")


@pytest.fixture(scope="module")
def world() -> Dataset:
    return machine(distributed)


@pytest.fixture
def both(spec: Spec) -> Model:
    return spec("spindle_bearing", {"effect": "lag", "drivers": {"u": "T_nut"}}, in_sample=True)


def test_a_distributed_part_gets_its_second_lag_and_no_other_part_does(world: Dataset, both: Model) -> None:
    refined = with_second_lags(both, world)
    (found,) = refined.lags
    assert (found.of, found.id) == ("lag", "lag_lag2")
    assert sorted(found.tau) == pytest.approx([10.0, 200.0], rel=0.1)
    assert found.after < 0.25 < found.before
    assert (found.better, found.tests) == (4, 4)
    assert refined.spec.effects[:2] == both.effects
    assert refined.notes == [str(found)]
    gains = {n: p.value for n, p in fit_model(refined.spec, world).parameters().items() if n.endswith("gain")}
    assert sorted((gains["lag.gain"], gains["lag_lag2.gain"])) == pytest.approx([2.0, 3.0], rel=0.1)


def test_one_lag_stays_one(both: Model) -> None:
    refined = with_second_lags(both, machine(single))
    assert refined.spec == both
    assert refined.lags == ()
    assert "none takes 20 % off" in refined.notes[0]


def test_heat_that_passes_two_bodies_alike_gets_two_lags_that_are_kept_apart(both: Model) -> None:
    """Where they would lie on each other their gains would be huge, and say nothing."""
    data = machine(two_alike)
    refined = with_second_lags(both, data)
    (found,) = refined.lags
    assert max(found.tau) / min(found.tau) == pytest.approx(1.5, rel=0.1)
    assert np.sqrt(np.prod(found.tau)) == pytest.approx(40.0, rel=0.05)
    assert found.before > 1.0 > 0.25 > found.after, "the noise is 0.2"
    gains = {n: p.value for n, p in fit_model(refined.spec, data).parameters().items() if n.endswith("gain")}
    assert sum((gains["lag.gain"], gains["lag_lag2.gain"])) == pytest.approx(5.0, rel=0.1)
    assert max(abs(gains["lag.gain"]), abs(gains["lag_lag2.gain"])) < 20.0


def test_two_lags_whose_bounds_leave_no_room_apart_stay_one(both: Model) -> None:
    """Half of the ratio below 40 min lies below the least that the file allows."""
    narrow = both.effects[1].model_copy(update={"bounds": {"tau": (38.0, 60.0)}})
    held = both.model_copy(update={"effects": [both.effects[0], narrow]})
    assert with_second_lags(held, machine(two_alike)).lags == ()


def test_lags_that_are_kept_apart_must_be_worth_it_too(both: Model, monkeypatch: pytest.MonkeyPatch) -> None:
    data = machine(two_alike)
    monkeypatch.setattr(second_lag, "APART", 30.0)
    assert with_second_lags(both, data).lags == ()


def test_the_limit_stands_between_a_fall_that_suffices_and_one_that_does_not(
    world: Dataset, both: Model, monkeypatch: pytest.MonkeyPatch
) -> None:
    left_out = LeftOut(both, world)
    (found,) = with_second_lags(both, world).lags
    spec = with_second_lags(both, world).spec
    before, after = left_out.errors(both), left_out.errors(spec)
    fall = 1 - max(after.over(before), after.typical(before))
    assert 1 - found.after / found.before >= fall
    for limit, taken in ((fall - 1e-6, 1), (fall + 1e-6, 0)):
        monkeypatch.setattr(second_lag, "FALL", limit)
        assert len(with_second_lags(both, world).lags) == taken


def test_locked_tests_take_no_part(world: Dataset, both: Model) -> None:
    wild = replace(world.tests[-1], values={**world.tests[-1].values, "dZ": world.tests[-1].values["dZ"] * -50.0})
    assert world.tests[-1].role == "locked"
    changed = replace(world, tests=(*world.tests[:-1], wild))
    assert with_second_lags(both, changed) == with_second_lags(both, world)


def test_two_tests_are_too_few(both: Model) -> None:
    refined = with_second_lags(both, machine(distributed, "ccl"))
    assert refined.spec == both
    assert refined.notes == ["no second lag: 2 open tests, and from 3 on they can be left out in turn"]


def test_the_error_of_left_out_tests_counts_samples_or_tests() -> None:
    one, two = ("dZ", ("c", "a")), ("dZ", ("c", "b"))
    before = Errors({one: 300, two: 100}, {one: 1.0, two: 9.0})
    after = Errors({one: 300, two: 100}, {one: 4.0, two: 1.0})
    assert before.rmse("dZ") == pytest.approx(np.sqrt(3.0))
    assert after.over(before) == pytest.approx(np.sqrt(3.25 / 3.0))
    assert after.typical(before) == pytest.approx(np.sqrt(2 * 1 / 3))
    assert after.better(before) == 1
    assert np.isnan(before.rmse("dX"))


@pytest.mark.parametrize(
    ("effect", "asked"),
    [
        ({"effect": "lag", "drivers": {"u": "T_nut"}}, True),
        ({"effect": "feed_screw"}, True),
        ({"effect": "lag", "drivers": {"u": "T_nut"}, "fixed": {"tau": 5}}, False),
        ({"effect": "lag", "drivers": {"u": "T_nut"}, "calibrate_on": ["t0"]}, False),
        ({"effect": "spindle_bearing_2"}, False),
        ({"effect": "centrifugal_shift"}, False),
        ({"effect": "warm_start"}, False),
        ({"effect": "transfer_function", "drivers": {"u": "T_nut"}}, False),
        ({"effect": "model", "name": "frame"}, False),
    ],
)
def test_only_a_single_free_lag_of_a_driver_is_asked(effect: dict[str, object], asked: bool) -> None:
    spec = EffectSpec.model_validate(effect)
    assert is_single_lag(spec, [spec]) is asked


def test_heating_and_cooling_apart_are_no_two_lags_of_one_effect() -> None:
    heating, cooling = (
        EffectSpec(effect="spindle_bearing", id=phase, phases=[phase]) for phase in ("heating", "cooling")
    )
    assert is_single_lag(heating, [heating, cooling])


def test_what_stands_twice_is_asked_for_no_third(world: Dataset, both: Model) -> None:
    twice = with_second_lags(both, world).spec
    assert not any(is_single_lag(e, twice.effects) for e in twice.effects if e.effect == "lag")
    assert with_second_lags(twice, world).spec == twice


def test_the_exponent_of_friction_is_held_as_fitted(spec: Spec) -> None:
    model = spec({"effect": "spindle_friction", "id": "heat"}, in_sample=True)
    data = machine(single)
    tests = tuple(
        replace(t, values={**t.values, "dZ": 40 * distributed((t.values["speed"] / 1e4) ** 1.5)}) for t in data.tests
    )
    refined = with_second_lags(model, replace(data, tests=tests))
    assert [lag.id for lag in refined.lags] == ["heat_lag2"]
    assert refined.spec.effects[-1].fixed["exponent"] == pytest.approx(1.5, abs=0.2)
    assert refined.spec.effects[-1].bounds["tau"] == (1.0, 480.0)


def test_a_second_lag_starts_anew(world: Dataset, spec: Spec) -> None:
    """Where the first one starts may lie outside of where a second one is searched."""
    wide = {"effect": "lag", "drivers": {"u": "T_nut"}, "start": {"tau": 5000}, "bounds": {"tau": [5, 6000]}}
    refined = with_second_lags(spec("spindle_bearing", wide, in_sample=True), world)
    assert [lag.id for lag in refined.lags] == ["lag_lag2"]
    assert refined.spec.effects[-1].start == {}
    fit_model(refined.spec, world, uncertainty=False)


def test_a_lag_that_can_no_longer_be_worth_it_is_not_fitted_to_the_end(
    both: Model, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The answer is the same, and the folds in which most is left come first."""
    fits: list[int] = []
    own = LeftOut._of_fold
    monkeypatch.setattr(LeftOut, "_of_fold", lambda self, spec, fold: fits.append(1) or own(self, spec, fold))
    for course in (single, distributed):
        data, found = machine(course), []
        for hopeless in (second_lag._is_hopeless, lambda so_far, now: False):
            fits.clear()
            with monkeypatch.context() as patched:
                patched.setattr(second_lag, "_is_hopeless", hopeless)
                found.append((with_second_lags(both, data), len(fits)))
        (quick, few), (whole, many) = found
        assert quick == whole
        assert few < many if course is single else few <= many


@pytest.mark.parametrize(
    ("squares", "samples", "hopeless"),
    [
        ({"a": 1.13}, 100, False),  # 0.64 of 7 times 100, less what others may leave
        ({"a": 4.47}, 100, False),
        ({"a": 4.49}, 100, True),
        ({"a": 4.49}, 99, False),  # other samples: nothing is known of them
        ({"b": 1.01, "c": 1.01}, 100, False),
        ({"b": 1.01, "c": 1.01, "d": 1.01}, 100, True),  # of five tests three get better at least
        ({"b": 0.99, "c": 0.99, "d": 0.99}, 100, False),
    ],
)
def test_what_is_hopeless_stays_so(squares: dict[str, float], samples: int, hopeless: bool) -> None:
    def errors(of: dict[str, float], n: int) -> Errors:
        places = {t: ("dZ", ("c", t)) for t in of}
        return Errors(dict.fromkeys(places.values(), n), {places[t]: x for t, x in of.items()})

    now = errors({"a": 3.0, "b": 1.0, "c": 1.0, "d": 1.0, "e": 1.0}, 100)
    assert errors({"a": 3.0, "b": 1.0, "c": 1.0, "d": 1.0, "e": 1.0}, 100).at_least(now) == pytest.approx(1.0)
    assert second_lag._is_hopeless(errors(squares, samples), now) is hopeless


def test_each_fit_of_a_fold_runs_on_one_core(both: Model, monkeypatch: pytest.MonkeyPatch) -> None:
    """Threads of the linear algebra library wait for each other in matrices that are so small."""
    from thermodata.modelling.fit import model

    seen: list[int] = []
    own = model._fit_model

    def looked(*args: Any, **how: Any) -> FittedModel:
        seen.append(max(one["num_threads"] for one in threadpool_info()))
        return own(*args, **how)

    monkeypatch.setattr(model, "_fit_model", looked)
    with threadpool_limits(2):
        LeftOut(both, machine(single)).errors(both)
    assert len(seen) == 5
    assert set(seen) == {1}


def test_what_was_foretold_with_one_lag_stands_beside_what_two_give(
    world: Dataset, spec: Spec, stored: Stored, tmp_path: Path
) -> None:
    """diagnose tells 3 um, the version leaves 0.2 um: neither is wrong, and add says what each is of."""
    store = stored(world, tmp_path)
    parent = run.fit(store, spec("spindle_bearing", name="parent"))
    name = "lag:T_nut"
    save_diagnosis(store, parent.model, diagnosis(candidate(name, claimed=True), model=parent.model))
    notes = add(store, parent.model, name).notes
    (said,) = [note for note in notes if "foretold" in note]
    assert said.startswith("diagnose foretold 5 -> 3 um on left-out tests with one lag for each effect")
    assert "With lag_lag2 beside them these tests" in said
    assert said.endswith("--plain adds what was foretold")
    assert not [note for note in add(store, parent.model, name, plain=True).notes if "foretold" in note]


def test_what_nobody_foretold_is_set_beside_nothing() -> None:
    lag = second_lag.SecondLag("lag", "lag_lag2", (10.0, 200.0), "min", 1.2, 0.2, "um", 4, 4)
    other = second_lag.SecondLag("bearing", "bearing_lag2", (10.0, 200.0), "min", 0.2, 0.1, "um", 4, 4)
    claims = [candidate(name, rank=k, claimed=True) for k, name in enumerate(("lag:T_nut", "lag:T_bed"), start=1)]
    found = diagnosis(*claims, candidate("lag:T_air", rank=3), named_rmse_um=1.0)
    assert beside_foretold(None, ["lag:T_nut"], [lag]) is None
    assert beside_foretold(found, ["lag:T_nut"], []) is None
    assert beside_foretold(found, ["lag:T_nut", "lag:by_hand"], [lag]) is None
    assert beside_foretold(found, ["lag:T_nut", "lag:T_air"], [lag]) is None, "told of no two but all claims"
    said = beside_foretold(found, ["lag:T_nut", "lag:T_bed"], [lag, other])
    assert said is not None
    assert "5 -> 1 um" in said
    assert "With lag_lag2 and bearing_lag2 beside them" in said
    assert "1.2 -> 0.1 um" in said
