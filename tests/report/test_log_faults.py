"""A fault of several tests is told once."""

from __future__ import annotations

from typing import Any

from thermodata.report.text.diagnosis import diagnosis_text
from thermodata.report.verdict.log_faults import log_faults
from thermodata.schema.answers.diagnosis import Artefact

from .conftest import diagnosis


def fault(kind: Any, test: str, why: str = "T_a is stuck", at_s: float | None = None) -> Artefact:
    return Artefact(kind=kind, campaign="shop", test=test, at_s=at_s, size_um=None if at_s is None else 5.0, why=why)


FAULTS = [
    fault("sensor", "one"),
    fault("step", "one", "a slip", 30.0),
    fault("sensor", "two"),
    fault("sensor", "two", "T_b is stuck"),
    fault("step", "one", "a slip", 90.0),
    fault("step", "two", "a slip", 30.0),
    fault("parameters", "", "refit it"),
]


def test_what_several_tests_have_for_the_same_reason_stands_together_and_each_moment_alone() -> None:
    found = [(f.kind, [test for _, test in f.tests], f.at_s, f.why) for f in log_faults(FAULTS)]
    assert found == [
        ("sensor", ["one", "two"], None, "T_a is stuck"),
        ("step", ["one"], 30.0, "a slip"),
        ("sensor", ["two"], None, "T_b is stuck"),
        ("step", ["one"], 90.0, "a slip"),
        ("step", ["two"], 30.0, "a slip"),
        ("parameters", [None], None, "refit it"),
    ]
    assert log_faults([]) == []


def test_the_terminal_names_all_tests_of_a_fault_in_one_line() -> None:
    text = diagnosis_text(diagnosis().model_copy(update={"artefacts": FAULTS}))
    assert "  ! sensor in shop/one, shop/two. T_a is stuck\n" in text
    assert "  ! step in shop/one at 30 s: 5.00 um. a slip\n" in text
    assert "  ! parameters in all tests of shop. refit it" in text


def test_an_error_of_a_whole_test_is_no_size_of_its_fault() -> None:
    """How far a turned probe is off says how large the response was."""
    turned = Artefact(kind="sign", campaign="shop", test="two", at_s=None, size_um=2.94, why="it is turned")
    text = diagnosis_text(diagnosis().model_copy(update={"artefacts": [turned]}))
    assert "  ! sign in shop/two. it is turned" in text


def test_what_all_tests_share_names_no_test_and_is_null_in_json() -> None:
    (shared,) = log_faults([fault("parameters", "", "refit it")])
    assert shared.where == ["all tests"]
    assert '"test":null' in fault("parameters", "").model_dump_json()
