"""What the known effects may still do while a candidate is asked for, and what is judged (diagnosis/investigate.py)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from thermodata.diagnosis import investigate as investigating
from thermodata.diagnosis.candidates import CandidateEffect
from thermodata.diagnosis.investigate import Investigation, base_columns, investigate, slack_columns
from thermodata.diagnosis.problem import Problem
from thermodata.diagnosis.scored import Scored
from thermodata.effect import effects
from thermodata.modelling.fit import fit_model
from thermodata.modelling.fitted import FittedModel, FittedResponse
from thermodata.schema.model import EffectSpec, Model
from thermodata.view.dataset import Dataset

from .conftest import make_data
from .hand_made import scored


@pytest.fixture(scope="module")
def data() -> Dataset:
    return make_data(tests=4)


@pytest.fixture(scope="module")
def fitted(data: Dataset) -> FittedModel:
    model = Model.model_validate(
        {
            "schema": "thermodata/model/1",
            "name": "base",
            "campaign": "c",
            "response": {"axis": "Z", "at": "tcp"},
            "step": "120 s",
            "effects": [{"effect": "spindle_bearing", "drivers": {"temperature": "T_bearing"}}],
        }
    )
    return fit_model(model, data, uncertainty=False)


def test_a_known_effect_may_grow_and_its_time_constant_move(data: Dataset, fitted: FittedModel) -> None:
    """One column a gain, that doubles it; one a time constant, that stretches it by e to first order."""
    response, test = fitted.responses[0], data.tests[0]
    (term,) = response.terms
    columns = base_columns(response, test)
    assert columns.shape == (len(test.t_s), 2)
    np.testing.assert_allclose(columns[:, 0], term.contribution(test))
    little = 1e-3
    longer = {**term.params, "tau": term.params["tau"] * np.exp(little)}
    slope = (term.bound.columns(test, longer) @ [term.gains["gain"]] - term.contribution(test)) / little
    np.testing.assert_allclose(columns[:, 1], slope, atol=0.01 * np.abs(slope).max())


def test_a_known_effect_may_act_five_times_faster_and_slower_at_a_price(data: Dataset, fitted: FittedModel) -> None:
    response, test = fitted.responses[0], data.tests[0]
    (term,) = response.terms
    columns = slack_columns(response, test)
    assert columns.shape == (len(test.t_s), 2)
    for j, factor in enumerate((0.2, 5.0)):
        other = {**term.params, "tau": term.params["tau"] * factor}
        changed = term.bound.columns(test, other) @ [term.gains["gain"]]
        np.testing.assert_allclose(columns[:, j], changed - term.contribution(test))


def test_a_known_effect_that_is_absent_in_a_test_can_do_nothing_there(data: Dataset) -> None:
    model = Model.model_validate(
        {
            "schema": "thermodata/model/1",
            "name": "base",
            "campaign": "c",
            "response": {"axis": "Z", "at": "tcp"},
            "step": "120 s",
            "effects": [EffectSpec(effect="spindle_bearing", drivers={"temperature": "T_bearing"}, tests=["t0", "t1"])],
        }
    )
    response = fit_model(model, data, uncertainty=False).responses[0]
    assert base_columns(response, data.tests[0]).any()
    assert not base_columns(response, data.tests[2]).any()
    assert not slack_columns(response, data.tests[2]).any()


class TestJudged:
    """Ranking is replaced by evidence made by hand: what matters is what is asked for, and against which measure."""

    def investigated(
        self,
        monkeypatch: pytest.MonkeyPatch,
        data: Dataset,
        fitted: FittedResponse,
        ranked: Sequence[Scored],
        beside: Sequence[Scored] = (),
        **more: Any,
    ) -> Investigation:
        self.asked: list[list[str]] = []

        def rank(problem: Problem, candidates: Sequence[CandidateEffect], seed: int = 0) -> list[Scored]:
            self.asked.append([c.id for c in candidates])
            return list(ranked if len(self.asked) == 1 else beside)

        monkeypatch.setattr(investigating, "rank", rank)
        return investigate(fitted, data, fitted_tests(data), effects(), **more)

    def test_the_measure_is_that_of_the_response_and_the_models_families(
        self, monkeypatch: pytest.MonkeyPatch, data: Dataset, fitted: FittedModel
    ) -> None:
        found = self.investigated(monkeypatch, data, fitted.responses[0], [])
        whole = np.concatenate([t.values["dZ"] - t.values["dZ"].mean() for t in fitted_tests(data)])
        assert found.measure.spread == pytest.approx(np.sqrt(np.mean(whole**2)))
        assert found.measure.rows == len(whole)
        assert found.measure.noise == pytest.approx(0.1, rel=0.2)
        assert found.measure.families == {"spindle"}
        assert "spindle_bearing:T_bearing" not in self.asked[0]
        assert found.judgement.verdict == "not_testable"

    def test_a_plain_lag_in_the_model_gives_no_family_away(
        self, monkeypatch: pytest.MonkeyPatch, data: Dataset
    ) -> None:
        model = Model.model_validate(
            {
                "schema": "thermodata/model/1",
                "name": "base",
                "campaign": "c",
                "response": {"axis": "Z", "at": "tcp"},
                "step": "120 s",
                "effects": [{"effect": "lag", "drivers": {"u": "T_bearing"}}],
            }
        )
        response = fit_model(model, data, uncertainty=False).responses[0]
        assert self.investigated(monkeypatch, data, response, []).measure.families == frozenset()

    def test_the_second_effect_is_the_simplest_of_the_best_three_that_pass(
        self, monkeypatch: pytest.MonkeyPatch, data: Dataset, fitted: FittedModel
    ) -> None:
        rows = sum(len(t.t_s) for t in fitted_tests(data))
        weight = rows / 1000.0  # hand-made evidence is of 1000 rows

        def of(name: str, channel: str, before: float, after: float, **more: Any) -> Scored:
            one = scored(name, channels=(channel,), before=before * 4, after=after * 4, **more)
            return replace(one, sse_before=one.sse_before * weight, sse_after=one.sse_after * weight)

        first = of("first", "T_nut_X", 1.0, 0.7, drop=0.6)
        hopeless = [of(f"bad{i}", "T_hall", 0.7, 0.6, p_value=0.5) for i in range(3)]
        good = of("good", "T_tank", 0.7, 0.1)
        for place, expected in ((2, "effect"), (3, "unknown")):
            ranked = [*hopeless[:place], good]
            found = self.investigated(monkeypatch, data, fitted.responses[0], [first], ranked)
            assert len(self.asked) == 2
            assert found.judgement.verdict == expected
            assert found.judgement.second is (good if expected == "effect" else None)

    def test_wrong_parameters_are_those_of_the_model_that_is_asked_about(
        self, monkeypatch: pytest.MonkeyPatch, data: Dataset, fitted: FittedModel
    ) -> None:
        refitted = fitted.responses[0]
        (term,) = refitted.terms
        doubled = {g: replace(v, gains={"gain": 2 * v.gains["gain"]}) for g, v in term.groups.items()}
        wrong = replace(refitted, terms=(replace(term, groups=doubled),))
        ranked = [scored(before=0.1, after=0.1, p_value=0.5)]
        as_it_is = self.investigated(monkeypatch, data, refitted, ranked)
        asked_about = self.investigated(monkeypatch, data, refitted, ranked, as_fitted=wrong)
        assert [a.kind for a in as_it_is.artefacts] == []
        assert [a.kind for a in asked_about.artefacts] == ["parameters"]
        assert asked_about.spots[0].rmse_um > 5 * as_it_is.spots[0].rmse_um, "weak spots are those of the same model"


def test_an_unlucky_zero_is_no_error(data: Dataset, fitted: FittedModel) -> None:
    """The first samples, which give a test that was not fitted its offset, are 50 um off: 5 of 360."""
    first = np.where(np.arange(360) < 5, 50.0, 0.0)
    tests = [replace(t, values={**t.values, "dZ": t.values["dZ"] + first}) for t in fitted_tests(data)]
    response = replace(fitted.responses[0], calibrate=frozenset())
    assert np.abs(np.mean(response.residual(tests[0]))) > 40.0
    assert investigating._error_of(response, tests) == pytest.approx(50.0 * np.sqrt(5 / 360), rel=0.05)


def fitted_tests(data: Dataset) -> list[Any]:
    return [t for t in data.tests if t.role != "locked"]
