"""Scores: free run, not clipped, and locked tests stay closed."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from thermodata.modelling import fit_model
from thermodata.modelling.inputs.phases import activity, phases
from thermodata.modelling.predictions.score import IN_SAMPLE, figures, peak_sum, scores
from thermodata.modelling.predictions.table import prediction_columns, prediction_tables
from thermodata.modelling.versions.result import make_result, model_id
from thermodata.view.grid.dataset import Dataset, TestData

from .conftest import EFFECTS, Change, Spec


def test_fit_is_the_papers_and_is_not_clipped() -> None:
    y = np.array([0.0, 10.0, 20.0, 30.0])
    assert figures(y, np.zeros(4))["fit"] == 100.0
    assert figures(y, y - y.mean())["fit"] == pytest.approx(0.0)
    assert figures(y, 3 * (y - y.mean()))["fit"] == pytest.approx(-200.0)
    assert figures(np.full(4, 5.0), np.ones(4))["fit"] is None
    found = figures(y, np.array([1.0, -2.0, 1.0, 0.0]))
    assert found == {
        "fit": found["fit"],
        "rmse_um": pytest.approx(np.sqrt(1.5)),
        "ptp_um": 30.0,
        "ptp_residual_um": 3.0,
        "max_um": 2.0,
    }
    assert peak_sum(np.array([3.0, 5.0])) == 8.0
    assert set(figures(y[:0], y[:0]).values()) == {None}
    assert set(figures(y[:1], y[:1]).values()) == {None}, "its offset is taken from it"
    assert figures(y[:2], np.array([-1.0, 1.0]))["rmse_um"] == 1.0


def test_locked_tests_are_not_scored(world: Dataset, spec: Spec) -> None:
    fitted = fit_model(spec(*EFFECTS), world)
    assert {s.role for s in scores(fitted, world, "m")} == {"calibration", "verification"}
    assert [t.test for t in fitted.tests(world, "locked")] == ["t7"]
    assert ("c", "t7", "dZ") not in prediction_tables(fitted, world)


def test_every_test_has_a_row_for_the_whole_and_for_its_phases(world: Dataset, spec: Spec) -> None:
    rows = scores(fit_model(spec(*EFFECTS), world), world, "m")
    whole = [s for s in rows if s.phase == "all"]
    assert [s.test for s in whole] == [f"t{k}" for k in range(7)]
    assert all(s.fit is not None and s.fit > 90 for s in whole)
    assert {s.phase for s in rows} >= {"all", "heating", "cooling"}
    for test in {s.test for s in rows}:
        parts = sum(s.n for s in rows if s.test == test and s.phase != "all")
        assert parts <= next(s.n for s in whole if s.test == test)


def test_the_offset_of_an_unseen_test_is_its_first_ten_minutes(world: Dataset, spec: Spec) -> None:
    response = fit_model(spec(*EFFECTS), world).responses[0]
    test = world.test("c", "t5")
    gap = response.measured(test) - response.predict(test)
    assert response.offset(test) == pytest.approx(gap[:10].mean())
    assert response.offset(world.tests[0]) == pytest.approx(
        (response.measured(world.tests[0]) - response.predict(world.tests[0])).mean()
    )
    # an offset wrong on purpose in the first minutes is not hidden by the rest
    late = replace(test, zero_s=60.0)
    assert response.offset(late) == pytest.approx(gap[0])


def test_tests_without_the_response_have_no_score(world: Dataset, spec: Spec, changed: Change) -> None:
    data = changed(world, "t6", dZ=None)
    assert "t6" not in {s.test for s in scores(fit_model(spec(*EFFECTS), data), data, "m")}


def test_verification_that_was_fitted_says_so(world: Dataset, spec: Spec) -> None:
    model = spec(*EFFECTS, in_sample=True)
    fitted = fit_model(model, world)
    assert {s.role for s in scores(fitted, world, "m")} == {"calibration", IN_SAMPLE}
    plain = fit_model(spec(*EFFECTS), world)
    assert fitted.parameters()["coolant.tau"].value != plain.parameters()["coolant.tau"].value


def test_phases_are_told_from_what_the_machine_does(world: Dataset) -> None:
    test = world.tests[0]
    n = len(test.t_s)
    on = (test.t_s > 3600) & (test.t_s < 25200)
    y = np.where(test.t_s < 3600, 0, 20 * (1 - np.exp(-(test.t_s - 3600) / 3000)))
    test = replace(
        test,
        values={"speed": on * 6000.0, "dZ": np.where(test.t_s > 25200, y * 0.5, y)},
        valid={k: np.ones(n, bool) for k in ("speed", "dZ")},
    )
    found = phases(test, "dZ")
    assert set(found) == {"heating", "steady", "cooling"}
    assert test.t_s[found["heating"]].min() == 3660
    assert test.t_s[found["steady"]].min() == pytest.approx(3600 + 3000 * np.log(10), abs=120)
    assert test.t_s[found["cooling"]].min() == 25200
    assert not (found["heating"] & found["cooling"]).any()
    declared = replace(test, phases={"idle": (0.0, 3600.0)})
    assert list(phases(declared, "dZ")) == ["idle"]
    still = replace(test, values={"speed": np.zeros(n), "dZ": y})
    assert activity(still) is None
    assert phases(still, "dZ") == {}


def test_the_prediction_table_shows_every_part(world: Dataset, spec: Spec) -> None:
    response = fit_model(spec(*EFFECTS), world).responses[0]
    test = replace(world.tests[5], t_s=world.tests[5].t_s - 3600, in_window=world.tests[5].t_s >= 3600)
    table = prediction_columns(response, test)
    assert table["t_s"][0] == 0.0
    parts = [v for k, v in table.items() if k.startswith("c__")]
    assert len(parts) == len(EFFECTS)
    assert np.allclose(np.sum(parts, axis=0) + response.offset(test), table["predicted"])
    assert np.allclose(table["measured"] - table["predicted"], table["residual"])
    assert table["valid"].dtype == bool


def test_the_id_follows_the_spec_and_the_data(world: Dataset, spec: Spec) -> None:
    a, b = spec("spindle_bearing"), spec("spindle_motor")
    assert model_id(a, "v1") == model_id(spec("spindle_bearing"), "v1")
    assert len({model_id(a, "v1"), model_id(b, "v1"), model_id(a, "v2")}) == 3


def test_the_result_is_what_the_commands_print(world: Dataset, spec: Spec) -> None:
    fitted = fit_model(spec(*EFFECTS), world)
    result = make_result(fitted, world, "abc", parent="xyz")
    assert (result.model, result.parent, result.response, result.before) == ("abc", "xyz", "dZ", None)
    assert result.model_validate_json(result.model_dump_json()) == result


@pytest.mark.parametrize(
    ("counted", "told"), [(0, "none of its samples counts"), (1, "which gives its offset"), (2, "")]
)
def test_a_test_that_scores_nothing_has_no_error_and_a_check(
    world: Dataset, spec: Spec, counted: int, told: str
) -> None:
    def few(test: TestData) -> TestData:
        good = np.zeros(len(test.t_s), bool)
        good[100 : 100 + counted] = True
        return replace(test, valid={**test.valid, "dZ": good})

    data = replace(world, tests=tuple(few(t) if t.test == "t5" else t for t in world.tests))
    result = make_result(fit_model(spec(*EFFECTS), data), data, "m")
    score = next(s for s in result.scores if s.test == "t5" and s.phase == "all")
    assert score.n == counted
    assert (score.rmse_um is None) == (score.max_um is None) == bool(told)
    checks = [c for c in result.checks if c.name == "not_scored:c/t5"]
    assert [told in c.advice and not c.passed for c in checks] == [True] * bool(told)
