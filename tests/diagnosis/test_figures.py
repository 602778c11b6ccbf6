"""Words and figures of two errors agree (weigh/figures.py, claims/rules.py)."""

from __future__ import annotations

import pytest

from thermodata.diagnosis.claims.in_words import in_words, on_locked
from thermodata.diagnosis.claims.rules_together import failed_rules
from thermodata.diagnosis.locked.held import RISES_ELSEWHERE
from thermodata.diagnosis.tell.candidate.why import where_it_acts
from thermodata.diagnosis.weigh.figures import from_to, way
from thermodata.diagnosis.weigh.foretold import Foretold, Looked

from .hand_made import measure, scored

DULL = 60.0


@pytest.mark.parametrize(
    ("before", "after", "said"),
    [
        (0.95, 0.94, "0.95 -> 0.94 um"),
        (0.953, 0.946, "0.953 -> 0.946 um"),
        (0.9531, 0.9512, "0.953 -> 0.951 um"),
        (0.95314, 0.95312, "0.95 -> 0.95 um"),
        (1.0, 1.0, "1.00 -> 1.00 um"),
    ],
)
def test_as_many_digits_are_told_as_tell_two_errors(before: float, after: float, said: str) -> None:
    assert from_to(before, after, "um") == said


@pytest.mark.parametrize(
    ("after", "said"),
    [(0.5, "falls"), (0.994, "falls"), (0.996, "hardly falls"), (1.0, "does not fall"), (1.1, "does not fall")],
)
def test_what_falls_by_no_per_cent_hardly_falls(after: float, said: str) -> None:
    assert way(1.0, after) == said


@pytest.mark.parametrize(("after", "said"), [(0.9, "falls by 10 % only"), (0.996, "hardly falls (limit")])
def test_a_rule_says_that_an_error_hardly_falls_and_not_by_how_little(after: float, said: str) -> None:
    (reason,) = failed_rules(scored(after=after, evidence=DULL), measure(), "um")[:1]
    assert f"the error {said}" in reason
    assert " 0 %" not in reason


@pytest.mark.parametrize(
    ("before", "after", "said"),
    [
        (1.0, 0.4, "falls by 60 % (1.00 -> 0.40 urad)"),
        (1.0, 0.999, "hardly changes (1.000 -> 0.999 urad)"),
        (1.0, 1.2, "rises by 20 % (1.00 -> 1.20 urad)"),
    ],
)
def test_a_share_of_an_error_is_told_with_the_error(before: float, after: float, said: str) -> None:
    assert in_words(Foretold(before, after, 1.0), "urad") == said


@pytest.mark.parametrize(
    ("tests", "where"), [(None, "on the locked tests, "), (frozenset({("c", "d")}), "tests in which it acts, ")]
)
def test_the_locked_error_is_said_to_be_that_with_a_free_offset(
    tests: frozenset[tuple[str, str]] | None, where: str
) -> None:
    first, added = Foretold(0.9, 0.3, 1.0, tests=tests), Foretold(1.05, 0.9, 1.0, tests=tests)
    said = on_locked(Looked(first, added, 0.0))
    assert f"{where}with a free offset a test, the error falls by 14 % (1.05 -> 0.90 um) with it added" in said
    assert "falls by 67 % (0.90 -> 0.30 um) where the effects of the model may act otherwise" in said
    assert "falls by 67 % (0.90 -> 0.30 um)" in on_locked(Looked(first, None, 0.0))


@pytest.mark.parametrize(
    ("count", "told"), [(6, "where it acts most (6 of 7 tests)"), (7, "where it acts (7 of 7 tests)")]
)
def test_what_does_less_than_a_fifth_of_its_largest_is_not_said_to_rest(count: int, told: str) -> None:
    """A screw that moves 14 um of 23 in one test and 146 in another acts in both."""
    assert where_it_acts(count, 7, "tests") == told
    assert "rests" not in RISES_ELSEWHERE
