"""What a verdict says of an effect that the model has and its tests do not determine."""

from __future__ import annotations

from typing import Any

import pytest

from tests.answers import diagnosis
from thermodata.report.verdict.verdict import verdict_sentence
from thermodata.schema.answers.result import Parameter
from thermodata.schema.answers.undetermined import Undetermined

GAIN = Parameter(value=3.2, unit="um/K", low=-0.1, high=6.5)


def one(effect: str = "screw", **more: Any) -> Undetermined:
    given: dict[str, Any] = {"drivers": ["T_nut"], "gains": {f"{effect}.gain": GAIN}, "does_um": 0.5}
    return Undetermined(effect=effect, **{**given, **more})


def said(*some: Undetermined) -> str:
    return verdict_sentence(diagnosis(model="0123456789", verdict="none", undetermined=list(some)))


def test_it_is_named_with_its_gain_and_what_the_model_leaves_without_it() -> None:
    text = said(one(elsewhere="V03", elsewhere_um=7.0, left_out_um=7.14, left_out_without_um=1.58))
    assert (
        "; the tests that were fitted do not determine screw: its gain is 3.20 um/K (95 %: -0.100 to 6.50), by which "
        "it does 7.00 um in V03, against 0.500 um at most in those, and where each open test is foretold by a fit to "
        "the others, the model errs by 7.14 um with it and by 1.58 um without: take it out (thermodata remove 01234567 "
        "screw) until there is a test in which T_nut moves and the rest does not"
    ) in text


@pytest.mark.parametrize(
    ("left", "without", "told"),
    [
        (2.0, 1.9, "take it out (thermodata remove 01234567 screw) until there is a test"),
        (2.0, 2.0, "so these tests need it as little: take it out (thermodata remove 01234567 screw), or add a test"),
        (2.0, 2.1, ": keep it, and add a test in which T_nut moves"),
        (None, None, "so add a test in which T_nut moves"),
    ],
)
def test_what_to_do_goes_by_the_error_without_it(left: float | None, without: float | None, told: str) -> None:
    assert told in said(one(left_out_um=left, left_out_without_um=without))


def test_an_end_that_no_test_sets_is_no_number() -> None:
    assert "(95 %: up to 6.50)" in said(one(gains={"screw.gain": GAIN.model_copy(update={"low": None})}))


def test_more_than_three_are_named_only() -> None:
    text = said(*(one(name) for name in "abcde"))
    assert text.count("do not determine") == 3
    assert "; nor do they determine d and e" in text


def test_nothing_is_said_where_all_are_determined() -> None:
    assert "determine" not in said()


def test_what_is_missing_is_added_first() -> None:
    """A bending that nobody modelled blurs the air: the advice below 'missing: ...' is not to take the air out."""
    some = [one("a"), one("b", elsewhere="V03", elsewhere_um=7.0), one("c"), one("d")]
    text = verdict_sentence(diagnosis(model="0123456789", verdict="effect", undetermined=some))
    assert (
        "the tests that were fitted do not determine a (3.20 um/K, 95 %: -0.100 to 6.50), b (3.20 um/K, 95 %: -0.100 "
        "to 6.50; 7.00 um in V03, against 0.500 um at most in those), c (3.20 um/K, 95 %: -0.100 to 6.50) and d: that "
        "may be for what is missing, so add it first and ask again"
    ) in text
    assert "remove" not in text


def test_of_two_gains_each_is_told() -> None:
    text = said(one(gains={"screw.gain": GAIN, "screw.lead": GAIN}))
    assert "its gain is 3.20 um/K (95 %: -0.100 to 6.50) and its lead is 3.20 um/K" in text
