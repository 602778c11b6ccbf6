"""Fitting finds what a known machine is made of."""

from __future__ import annotations

import copy
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from thermodata.effect.lag import lag
from thermodata.errors import SpecError, UsageError
from thermodata.export.control.of_model import ProgramRequest, program_of
from thermodata.modelling import fit_model
from thermodata.modelling.least_squares import coarse
from thermodata.modelling.versions.result import model_id
from thermodata.schema.files.model import Model
from thermodata.view.grid.dataset import Dataset, TestData

from .conftest import EFFECTS, TRUTH, Change, Spec


def test_time_constants_and_gains_are_found(world: Dataset, spec: Spec) -> None:
    found = fit_model(spec(*EFFECTS), world).parameters()
    assert set(found) == set(TRUTH)
    for name, truth in TRUTH.items():
        assert found[name].value == pytest.approx(truth, rel=0.03), name
        low, high = found[name].low, found[name].high
        assert low is not None
        assert high is not None
        assert low < found[name].value < high
    assert found["spindle_bearing.gain"].unit == "um/K"
    assert found["spindle_bearing.tau"].unit == "min"


def test_the_residual_of_an_unseen_test_is_its_noise(world: Dataset, spec: Spec) -> None:
    fitted = fit_model(spec(*EFFECTS), world).responses[0]
    for test in world.tests:
        residual = fitted.residual(test)[fitted.mask(test)]
        assert np.std(residual) == pytest.approx(0.3, abs=0.06), test.test
        # ten samples of noise make an unseen test's offset
        assert abs(residual.mean()) < 0.5
    assert fitted.noise == pytest.approx(0.3, abs=0.05)


def test_contributions_add_up_to_the_prediction(world: Dataset, spec: Spec) -> None:
    fitted = fit_model(spec(*EFFECTS), world).responses[0]
    test = world.test("c", "t6")
    parts = {term.id: term.contribution(test) for term in fitted.terms}
    assert np.allclose(sum(parts.values()), fitted.predict(test))
    speed = test.values["speed"]
    assert np.allclose(parts["centrifugal_shift"][speed == 9000], -8 * 0.81, rtol=0.03)
    assert np.allclose(fitted.measured(test) - fitted.predict(test) - fitted.offset(test), fitted.residual(test))


def test_the_state_restarts_at_each_test(world: Dataset, spec: Spec) -> None:
    turned = replace(world, tests=world.tests[::-1])
    a, b = (fit_model(spec(*EFFECTS), data).parameters() for data in (world, turned))
    for name in TRUTH:
        assert a[name].value == pytest.approx(b[name].value, rel=1e-4)


def test_offsets_of_tests_are_free(world: Dataset, spec: Spec, changed: Change) -> None:
    moved = changed(world, "t0", dZ=world.test("c", "t0").values["dZ"] + 5000.0)
    a, b = (fit_model(spec(*EFFECTS), data).parameters() for data in (world, moved))
    for name in TRUTH:
        assert a[name].value == pytest.approx(b[name].value, rel=1e-5)


def test_masked_samples_do_not_count(world: Dataset, spec: Spec) -> None:
    """Held values between measuring phases, a gap of NaN, and a probe that fails: flagged, so without effect."""
    tests = []
    for test in world.tests:
        y, good = test.values["dZ"].copy(), np.ones(len(test.t_s), bool)
        good[test.t_s % 1200 < 600] = False
        y[~good] += 300.0
        y[400:420] = np.nan
        tests.append(replace(test, values={**test.values, "dZ": y}, valid={**test.valid, "dZ": good}))
    fitted = fit_model(spec(*EFFECTS), replace(world, tests=tuple(tests)))
    for name, truth in TRUTH.items():
        assert fitted.parameters()[name].value == pytest.approx(truth, rel=0.05), name
    assert not fitted.responses[0].mask(tests[0])[400:420].any()


def test_history_before_the_window_runs_the_lags_and_is_not_fitted(world: Dataset, spec: Spec) -> None:
    cut = [replace(t, t_s=t.t_s - 7200.0, in_window=t.t_s >= 7200.0) for t in world.tests]
    fitted = fit_model(spec(*EFFECTS), replace(world, tests=tuple(cut)))
    for name, truth in TRUTH.items():
        assert fitted.parameters()[name].value == pytest.approx(truth, rel=0.05), name
    assert fitted.responses[0].mask(cut[0]).sum() == (cut[0].t_s >= 0).sum()


def test_a_cut_test_without_its_history_is_worse(world: Dataset, spec: Spec) -> None:
    fitted = fit_model(spec(*EFFECTS), world).responses[0]
    test = world.test("c", "t5")
    with_history = replace(test, t_s=test.t_s - 21600.0, in_window=test.t_s >= 21600.0)
    keep = test.t_s >= 21600.0
    without = replace(
        test,
        t_s=test.t_s[keep] - 21600.0,
        in_window=np.ones(keep.sum(), bool),
        values={k: v[keep] for k, v in test.values.items()},
        valid={k: v[keep] for k, v in test.valid.items()},
    )
    error = [float(np.sqrt(np.mean(fitted.residual(t)[fitted.mask(t)] ** 2))) for t in (with_history, without)]
    assert error[0] < 0.5 < error[1]


def test_an_effect_identified_first_is_refined_with_the_others(world: Dataset, spec: Spec) -> None:
    """The hall's effect comes from an idle test alone, and then from all tests together."""
    etve = _idle(world)
    data = replace(world, tests=(etve, *world.tests))
    alone = fit_model(spec("ambient_frame", calibrate_on=["etve"]), data).parameters()
    staged = spec(
        *EFFECTS[:2],
        {"effect": "ambient_frame", "calibrate_on": ["etve"]},
        *EFFECTS[3:],
        calibrate_on=["t0", "t1", "t2", "t3"],
    )
    fitted = fit_model(staged, data)
    hall = fitted.responses[0].terms[2]
    assert hall.alone is not None
    assert hall.alone[""].params["tau"] == alone["ambient_frame.tau"].value
    assert hall.alone[""].gains["gain"] == alone["ambient_frame.gain"].value
    assert not any(t.held for t in fitted.responses[0].terms)
    for name, truth in TRUTH.items():
        assert fitted.parameters()[name].value == pytest.approx(truth, rel=0.05), name
    assert not [c for c in fitted.checks() if c.name.startswith("moved_as_well")]
    # a model that counts heating only can't take an idle test in: there the effect is held
    held = fit_model(staged.model_copy(update={"phases": ["heating", "steady"]}), data)
    assert [t.held for t in held.responses[0].terms] == [False, False, True, False, False]
    assert held.parameters()["ambient_frame.gain"].value == alone["ambient_frame.gain"].value


def test_a_program_names_every_test_that_its_parameters_come_from(world: Dataset, spec: Spec, changed: Change) -> None:
    def named(model: Model, data: Dataset = world) -> str:
        return dict(program_of("m", fit_model(model, data, uncertainty=False), data, ProgramRequest(60.0)).about)[
            "fitted on"
        ]

    one = spec("spindle_bearing", calibrate_on=["t0", "t1"], verify_on=["t4"])
    grown = one.model_copy(update={"in_sample": True})
    assert (named(one), named(grown)) == ("t0, t1", "t0, t1, t4")
    assert named(grown, changed(world, "t1", dZ=None)) == "t0, t4"
    staged = spec("spindle_bearing", {"effect": "ambient_frame", "calibrate_on": ["t5"]}, calibrate_on=["t0"])
    assert named(staged) == "t0, t5"


def test_a_driver_that_moved_as_well_is_named_and_what_it_did_is_taken_out(world: Dataset, spec: Spec) -> None:
    """An idle test after work: what the cooling spindle did goes to the hall, until all are refined together."""
    etve = _idle(world)
    t = np.arange(721) * 60.0
    bearing = 12 * np.exp(-t / 5400)
    cooling = 1.5 * lag(bearing - bearing[0], 1200, 60.0)
    values = {**etve.values, "T_bearing": 22 + bearing, "dZ": etve.values["dZ"] + cooling}
    data = replace(world, tests=(replace(etve, values=values), *world.tests))
    staged = spec(
        *EFFECTS[:2],
        {"effect": "ambient_frame", "calibrate_on": ["etve"]},
        *EFFECTS[3:],
        calibrate_on=["t0", "t1", "t2", "t3"],
    )
    fitted = fit_model(staged, data)
    hall = fitted.responses[0].terms[2]
    assert hall.alone is not None
    assert abs(hall.alone[""].gains["gain"] + 3.0) > 1.0, "alone it takes what is not its own"
    assert hall.gains["gain"] == pytest.approx(-3.0, rel=0.03)
    (said,) = [c for c in fitted.checks() if c.name.startswith("moved_as_well")]
    assert said.name == "moved_as_well:ambient_frame:spindle_bearing"
    assert "T_bearing moved as well in etve" in said.advice
    assert f"to {hall.gains['gain']:.4g}" in said.advice


def _idle(world: Dataset) -> TestData:
    return replace(
        world.tests[0],
        test="etve",
        values={
            **world.tests[0].values,
            **{k: np.zeros(721) for k in ("speed", "coolant_on")},
            "T_bearing": np.full(721, 22.0),
            "T_nut": np.full(721, 21.0),
            "dZ": -3.0 * fit_hall(world),
        },
    )


def fit_hall(world: Dataset) -> Any:
    hall = world.tests[0].values["T_hall"]
    return lag(hall - hall[0], 14400.0, 60.0)


def test_values_may_carry_a_unit_of_their_own(world: Dataset, spec: Spec) -> None:
    said = {"fixed": {"tau": "0.5 h"}, "bounds": {"gain": [0, "3 um/K"]}}
    model = Model.model_validate_json(spec({"effect": "spindle_bearing", **said}).model_dump_json(by_alias=True))
    assert copy.deepcopy(model.effects[0].fixed["tau"]).text == "0.5 h"  # type: ignore[attr-defined]
    found = fit_model(model, world).parameters()["spindle_bearing.tau"]
    assert (found.value, found.unit) == (30.0, "min")
    with pytest.raises(SpecError, match="'tau' has another unit") as caught:
        fit_model(spec({"effect": "spindle_bearing", "fixed": {"tau": "3 K"}}), world)
    assert (caught.value.expected, caught.value.got) == ("min, or what converts to it", "3 K")


def test_a_gain_of_any_driver_takes_the_unit_that_it_is_told_in(world: Dataset, spec: Spec) -> None:
    lagged = {"effect": "lag", "drivers": {"u": "T_nut"}, "bounds": {"gain": [0, 9]}}
    told = fit_model(spec({**lagged, "fixed": {"gain": "0.002 mm/K"}}), world).parameters()["lag.gain"]
    assert (told.value, told.unit) == (pytest.approx(2.0), "um/K")


@pytest.mark.parametrize(
    ("said", "same"),
    [
        ({"bounds": {"tau": ["1e-3", 60]}}, {"bounds": {"tau": [0.001, 60.0]}}),  # YAML takes 1e-3 for a text
        ({"start": {"tau": "2"}}, {"start": {"tau": 2.0}}),
    ],
)
def test_the_digits_of_a_start_or_bound_make_no_other_model(
    spec: Spec, said: dict[str, Any], same: dict[str, Any]
) -> None:
    one, other = (model_id(spec({"effect": "spindle_bearing", **x}), "v") for x in (said, same))
    assert one == other


def test_a_bound_may_be_infinite(spec: Spec) -> None:
    said = spec({"effect": "spindle_bearing", "bounds": {"gain": [0, float("inf")]}})
    kept = Model.model_validate_json(said.model_dump_json(by_alias=True, exclude_none=True))
    assert kept.effects[0].bounds == {"gain": (0.0, float("inf"))}


@pytest.mark.filterwarnings("error")
def test_whole_numbers_as_bounds_are_kept_as_any_other(spec: Spec) -> None:
    given = spec("spindle_bearing").effects[0]
    whole, other = (given.model_copy(update={"bounds": {"tau": ends}}) for ends in ((1, 360), (1.0, 360.0)))
    assert whole.model_dump_json() == other.model_dump_json()


def test_fixed_values_and_bounds_are_kept(world: Dataset, spec: Spec) -> None:
    fixed = spec({"effect": "spindle_bearing", "fixed": {"gain": 2.0, "tau": 25.0}}, *EFFECTS[1:])
    found = fit_model(fixed, world).parameters()
    assert (found["spindle_bearing.gain"].value, found["spindle_bearing.tau"].value) == (2.0, 25.0)
    assert found["spindle_bearing.gain"].low is None
    bounded = spec({"effect": "spindle_bearing", "bounds": {"gain": [0.0, 1.0], "tau": [30.0, 60.0]}}, *EFFECTS[1:])
    fitted = fit_model(bounded, world)
    assert fitted.parameters()["spindle_bearing.gain"].value == pytest.approx(1.0)
    assert fitted.parameters()["spindle_bearing.tau"].value == pytest.approx(30.0, rel=1e-3)
    failed = {c.name for c in fitted.checks() if not c.passed}
    assert "at_bound:spindle_bearing.tau" in failed


def test_a_gain_for_each_machine_and_one_time_constant(world: Dataset, spec: Spec) -> None:
    data = _two_spindles(world)
    model = spec({"effect": "spindle_bearing", "gain_by": "conditions.spindle", "shared": ["tau"]}, *EFFECTS[1:])
    found = fit_model(model, data).parameters()
    assert found["spindle_bearing.gain[SP1]"].value == pytest.approx(1.5, rel=0.03)
    assert found["spindle_bearing.gain[SP2]"].value == pytest.approx(3.0, rel=0.03)
    assert found["spindle_bearing.tau"].value == pytest.approx(20.0, rel=0.03)
    free = spec({"effect": "spindle_bearing", "gain_by": "spindle", "shared": ["gain"]}, *EFFECTS[1:])
    own = fit_model(free, data).parameters()
    assert {"spindle_bearing.tau[SP1]", "spindle_bearing.tau[SP2]"} <= set(own)
    none = spec({"effect": "spindle_bearing", "gain_by": "spindle", "shared": "none"}, *EFFECTS[1:])
    assert fit_model(none, data).parameters() == own
    assert [none.effects[0].shares("tau"), model.effects[0].shares("tau"), free.effects[0].shares("tau")] == [
        False,
        True,
        False,
    ]


def _two_spindles(world: Dataset) -> Dataset:
    """Odd tests have a spindle whose bearing acts twice as much."""
    from thermodata.effect.lag import lag

    tests = []
    for i, test in enumerate(world.tests):
        more = 1.5 * lag(test.values["T_bearing"] - 22.0, 1200.0, 60.0) * (i % 2)
        tests.append(
            replace(
                test, values={**test.values, "dZ": test.values["dZ"] + more}, conditions={"spindle": f"SP{i % 2 + 1}"}
            )
        )
    return replace(world, tests=tuple(tests))


def test_a_group_that_no_calibration_test_had_is_not_predicted(world: Dataset, spec: Spec) -> None:
    data = _two_spindles(world)
    other = replace(data.tests[5], conditions={"spindle": "SP9"})
    data = replace(data, tests=(*data.tests[:5], other, *data.tests[6:]))
    model = spec({"effect": "spindle_bearing", "gain_by": "spindle"}, *EFFECTS[1:])
    fitted = fit_model(model, data).responses[0]
    assert not fitted.can_predict(other)
    assert fitted.can_predict(data.tests[6])


def test_a_slip_in_one_test(world: Dataset, spec: Spec, changed: Change) -> None:
    test = world.test("c", "t2")
    data = changed(world, "t2", dZ=test.values["dZ"] + 7.0 * (test.t_s >= 19800))
    model = spec(*EFFECTS, {"effect": "step", "tests": ["t2"]})
    fitted = fit_model(model, data)
    assert fitted.parameters()["step.gain"].value == pytest.approx(7.0, abs=0.3)
    assert fitted.parameters()["step.at"].value == pytest.approx(330.0, abs=3.0)
    assert not fitted.responses[0].terms[-1].contribution(data.tests[0]).any()


def test_tests_without_a_driver_are_skipped_and_named(world: Dataset, spec: Spec, changed: Change) -> None:
    fitted = fit_model(spec(*EFFECTS), changed(world, "t1", T_nut=None))
    assert fitted.skipped == ("c/t1: no driver for feed_screw",)
    assert fitted.parameters()["feed_screw.tau"].value == pytest.approx(90.0, rel=0.05)


def test_nothing_to_fit_is_said(world: Dataset, spec: Spec) -> None:
    dead = replace(
        world, tests=tuple(replace(t, valid={**t.valid, "dZ": np.zeros(len(t.t_s), bool)}) for t in world.tests)
    )
    with pytest.raises(UsageError, match="no sample counts"):
        fit_model(spec(*EFFECTS), dead)


@pytest.mark.parametrize("samples", [1, 2])
def test_a_step_about_as_long_as_the_tests(world: Dataset, spec: Spec, samples: int) -> None:
    def short(t: TestData) -> TestData:
        at = slice(None, samples)
        values, valid = ({k: v[at] for k, v in of.items()} for of in (t.values, t.valid))
        return replace(t, t_s=43200.0 * np.arange(samples), values=values, valid=valid, in_window=t.in_window[at])

    coarse = replace(world, tests=tuple(short(t) for t in world.tests), step_s=43200.0)
    if samples == 1:
        with pytest.raises(UsageError, match="step leaves one sample a test"):
            fit_model(spec(*EFFECTS), coarse)
    else:
        fitted = fit_model(spec("spindle_bearing"), coarse)
        assert all(p.low is None or np.isnan(p.low) for p in fitted.parameters().values())


def test_a_phase_that_no_test_has_is_refused_with_those_that_there_are(world: Dataset, spec: Spec) -> None:
    tests = tuple(replace(t, phases={"idle": (0.0, 20000.0)}) for t in world.tests)
    for wanted in ({"phases": ["warming"]}, {"phases": ["idle", "warming"]}):
        with pytest.raises(UsageError, match="no phase 'warming'") as error:
            fit_model(spec(*EFFECTS, **wanted), replace(world, tests=tests))
        assert error.value.expected == "cooling, heating, idle, steady"


def test_an_empty_model_predicts_nothing(world: Dataset, spec: Spec) -> None:
    fitted = fit_model(spec(), world).responses[0]
    assert not fitted.predict(world.tests[0]).any()
    assert fitted.noise is not None
    assert fitted.noise > 1.0


def test_phases_restrict_what_is_fitted(world: Dataset, spec: Spec) -> None:
    tests = tuple(replace(t, phases={"heating": (0.0, 20000.0)}) for t in world.tests)
    fitted = fit_model(spec(*EFFECTS, phases=["heating"]), replace(world, tests=tests)).responses[0]
    assert fitted.mask(tests[0]).sum() == (tests[0].t_s <= 20000.0).sum()


def test_many_samples_are_first_looked_at_on_a_coarse_grid(world: Dataset, spec: Spec, monkeypatch: Any) -> None:
    """The optimum is that of all samples, wherever the search started."""
    full = fit_model(spec(*EFFECTS), world, uncertainty=False).parameters()
    monkeypatch.setattr(coarse, "MANY", 2000)
    monkeypatch.setattr(coarse, "ENOUGH", 700)
    seen: list[int] = []
    monkeypatch.setattr(coarse, "coarser", lambda t, k, make=coarse.coarser: seen.append(k) or make(t, k))
    again = fit_model(spec(*EFFECTS), world, uncertainty=False).parameters()
    assert set(seen) == {5}
    for name, found in again.items():
        assert found.value == pytest.approx(full[name].value, rel=2e-3), name


def test_a_coarse_test_holds_means_of_what_is_valid(world: Dataset) -> None:
    test = world.tests[0]
    good = test.valid["dZ"].copy()
    good[:7] = False
    rough = coarse.coarser(replace(test, valid={**test.valid, "dZ": good}), 5)
    assert len(rough.t_s) == len(test.t_s) // 5
    assert rough.t_s[1] == test.t_s[5]
    assert not rough.valid["dZ"][0]
    assert rough.values["dZ"][1] == pytest.approx(test.values["dZ"][7:10].mean())
    assert rough.values["speed"][4] == pytest.approx(test.values["speed"][20:25].mean())
