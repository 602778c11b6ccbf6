"""Names in a sentence."""

from __future__ import annotations

import pytest

from thermodata.schema.listed import listed, with_count, with_dots


@pytest.mark.parametrize(("n", "said"), [(0, ""), (1, "a"), (2, "a or b"), (4, "a, b, c or d")])
def test_the_last_of_several_has_a_word_before_it(n: int, said: str) -> None:
    assert listed("abcd"[:n], "or") == said


@pytest.mark.parametrize(
    ("n", "counted", "dotted"), [(0, "", ""), (2, "a, b", "a, b"), (4, "a, b and 2 more", "a, b, ...")]
)
def test_of_many_the_first_are_named(n: int, counted: str, dotted: str) -> None:
    assert with_count("abcd"[:n], 2) == counted
    assert with_dots(iter("abcd"[:n]), 2) == dotted
