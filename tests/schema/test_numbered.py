"""Names that no other has."""

from __future__ import annotations

import pytest

from thermodata.schema.words.numbered import numbered


@pytest.mark.parametrize(
    ("taken", "mark", "found"),
    [(set(), "#", "T"), ({"T"}, "#", "T#2"), ({"T", "T#2", "T#4"}, "#", "T#3"), ({"T", "T2"}, "", "T3")],
)
def test_a_name_that_is_taken_has_the_first_free_number(taken: set[str], mark: str, found: str) -> None:
    assert numbered("T", taken.__contains__, mark) == found
