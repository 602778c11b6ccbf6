"""Names and counts in a sentence."""

from __future__ import annotations

import pytest

from thermodata.schema.words.durations import how_long
from thermodata.schema.words.sentences import beside, counted, listed, with_count, with_dots


@pytest.mark.parametrize(("n", "said"), [(0, ""), (1, "a"), (2, "a or b"), (4, "a, b, c or d")])
def test_the_last_of_several_has_a_word_before_it(n: int, said: str) -> None:
    assert listed("abcd"[:n], "or") == said


@pytest.mark.parametrize(
    ("n", "counted", "dotted"), [(0, "", ""), (2, "a, b", "a, b"), (4, "a, b and 2 more", "a, b, ...")]
)
def test_of_many_the_first_are_named(n: int, counted: str, dotted: str) -> None:
    assert with_count("abcd"[:n], 2) == counted
    assert with_dots(iter("abcd"[:n]), 2) == dotted


@pytest.mark.parametrize(
    ("n", "one", "said"), [(1, "row", "1 row"), (2, "row", "2 rows"), (1, "loss", "1 loss"), (0, "loss", "0 losses")]
)
def test_one_of_a_thing_is_no_many(n: int, one: str, said: str) -> None:
    assert counted(n, one) == said


@pytest.mark.parametrize(("n", "said"), [(1, "1 more file was"), (0, "0 more files were"), (3, "3 more files were")])
def test_what_they_do_goes_with_how_many_they_are(n: int, said: str) -> None:
    assert counted(n, "more file", "was", "were") == said


@pytest.mark.parametrize(
    ("seconds", "said"), [(300.0, "5 min"), (4440.0, "74 min"), (9000.0, "2.5 h"), (406_080.0, "4.7 days")]
)
def test_a_length_of_time_is_said_in_the_unit_of_people(seconds: float, said: str) -> None:
    assert how_long(seconds) == said


@pytest.mark.parametrize(
    ("value", "limit", "said"),
    [
        (0.648, 0.65, "just under the limit of 65 %"),
        (0.51, 0.5, "just over the limit of 50 %"),
        (0.511, 0.5, "limit 50 %"),
        (0.636, 0.65, "limit 65 %"),
        (0.0, 0.15, "limit 15 %"),
    ],
)
def test_what_misses_its_limit_by_a_hair_is_said_to(value: float, limit: float, said: str) -> None:
    assert beside(value, limit) == said
