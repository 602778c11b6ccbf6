"""What an answer of one or two open tests says of them."""

from __future__ import annotations

from typing import Any

import pytest

from tests.answers import candidate, diagnosis
from thermodata.report.verdict.verdict import verdict_sentence
from thermodata.schema.answers.candidate import LeftOut


def parts(*tests: str) -> list[LeftOut]:
    given: dict[str, Any] = {"campaign": "c", "to_s": 1.0, "acts": True, "rmse_um_before": 2.0, "rmse_um_after": 1.0}
    return [LeftOut(test=test, from_s=float(i), **given) for i, test in enumerate(tests)]


def said(verdict: str, *tests: str, **more: Any) -> str:
    return verdict_sentence(diagnosis(candidate("lag:T", left_out=parts(*tests)), verdict=verdict, **more))


@pytest.mark.parametrize("verdict", ["unknown", "none", "refine"])
def test_parts_of_one_test_are_told_with_what_is_wanting(verdict: str) -> None:
    text = said(verdict, "a", "a", "a", "a", open_tests=1, open_tests_asked=1)
    assert "; 1 open test took part, so errors are of parts of that one, which its other hours foretell: " in text
    assert "record more, each source (spindle, an axis, hall air) working in two of them" in text
    assert "locked ones" not in text


def test_locked_tests_that_are_there_may_be_taken() -> None:
    text = said("unknown", "a", "a", "b", "b", open_tests=2, open_tests_asked=2, locked_tests=3)
    assert "; 2 open tests took part, so errors are of parts of those, " in text
    assert "or take one of the 3 locked ones for it" in text


def test_nothing_is_said_where_tests_are_left_out_whole() -> None:
    assert "took part" not in said("unknown", "a", "b", "c", open_tests=3, open_tests_asked=3)


def test_that_others_could_not_take_part_is_told() -> None:
    text = said("unknown", "a", "a", open_tests=5, open_tests_asked=1)
    assert "1 of 5 open tests took part (for the others lack samples or a channel of the model)" in text


@pytest.mark.parametrize(
    ("asked", "open_tests", "told"),
    [
        (0, 0, "no test is open"),
        (0, 2, "none of 2 open tests took part, for none has enough samples"),
        (
            1,
            1,
            "1 open test took part, and it is too short for parts that foretell each other, but one is claimed only",
        ),
        (2, 2, "no effect of the library fits the channels that were logged"),
        (None, None, "one is claimed only where it also foretells a test that it was not fitted to"),
    ],
)
def test_what_can_t_be_told_says_why(asked: int | None, open_tests: int | None, told: str) -> None:
    found = diagnosis(verdict="not_testable", open_tests=open_tests, open_tests_asked=asked)
    assert f"these tests can't tell which effect is missing; {told}" in verdict_sentence(found)
