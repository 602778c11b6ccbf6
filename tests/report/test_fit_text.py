"""The words of fits and comparisons (report/text/fit.py)."""

from __future__ import annotations

from typing import Any

from tests.stored_fits import fit_of, score_of
from thermodata.report.text.fit import compare_text, fit_text, no_common_test
from thermodata.schema.answers.result import FitResult, Parameter, Score


def _score(test: str, campaign: str = "spring") -> Score:
    return score_of(test, campaign=campaign, rmse_um=1.5, max_um=2.0, n=100)


def _fit(name: str, scores: list[Score], **more: Any) -> FitResult:
    return fit_of(f"{name}123456", scores, name=name, **more)


def test_a_parameter_of_an_effect_whose_gain_is_0_changes_nothing() -> None:
    values = {"nut.tau": 33.0, "nut.gain": 0.0, "nut2.tau": 44.0, "nut2.gain[a]": 0.0, "nut2.gain[b]": 1.0}
    parameters = {name: Parameter(value=value, unit="min") for name, value in values.items()}
    lines = fit_text(_fit("one", [_score("heat")], parameters=parameters)).splitlines()
    told = {line.split()[0]: line for line in lines if line.startswith("nut")}
    assert told["nut.tau"].endswith("changes nothing: gain 0")
    assert not any("changes nothing" in line for name, line in told.items() if name != "nut.tau")


def test_models_without_a_common_test_stand_below_each_other() -> None:
    two = [_fit("one", [_score("heat")]), _fit("other", [_score("heat", "autumn")])]
    text = compare_text(two)
    assert text.startswith("no test in common (one one123 of spring; other other1 of autumn): nothing stands beside")
    assert "thermodata portability" in text
    assert text.count("RMSE [um]") == 2
    assert " - " not in text.replace("\n", " ")
    assert no_common_test([two[0], two[0]]) == ""
    assert no_common_test(two[:1]) == ""
