"""Counts in words."""

from __future__ import annotations

import pytest

from thermodata.reader.counted import counted


@pytest.mark.parametrize(
    ("n", "one", "said"), [(1, "row", "1 row"), (2, "row", "2 rows"), (1, "loss", "1 loss"), (0, "loss", "0 losses")]
)
def test_one_of_a_thing_is_no_many(n: int, one: str, said: str) -> None:
    assert counted(n, one) == said
