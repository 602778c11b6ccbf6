"""Counts in words."""

from __future__ import annotations

import pytest

from thermodata.schema.counted import counted


@pytest.mark.parametrize(
    ("n", "one", "said"), [(1, "row", "1 row"), (2, "row", "2 rows"), (1, "loss", "1 loss"), (0, "loss", "0 losses")]
)
def test_one_of_a_thing_is_no_many(n: int, one: str, said: str) -> None:
    assert counted(n, one) == said


@pytest.mark.parametrize(("n", "said"), [(1, "1 more file was"), (0, "0 more files were"), (3, "3 more files were")])
def test_what_they_do_goes_with_how_many_they_are(n: int, said: str) -> None:
    assert counted(n, "more file", "was", "were") == said
