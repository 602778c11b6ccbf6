"""The versions of a model in words (history.py)."""

from __future__ import annotations

import pytest

from thermodata.report.collected.history import how_it_went


@pytest.mark.parametrize(
    ("errors", "said"),
    [
        ((2.0, 1.0), "fell"),
        ((2.0, 1.0, 1.0), "fell"),
        ((1.0, 1.001, 0.5), "fell"),
        ((1.0, 1.2), "rose"),
        ((1.0, 1.01), "rose"),
        ((2.0, 1.0, 1.5), "changed"),
        ((1.0, 1.001), "stayed"),
        ((1.0, 229.0), "rose"),
        ((1.0,), "stayed"),
    ],
)
def test_how_the_error_of_versions_went(errors: tuple[float, ...], said: str) -> None:
    """A change of less than half a percent is none."""
    assert how_it_went(errors) == said
