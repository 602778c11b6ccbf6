"""Figures in words (report/words.py)."""

from __future__ import annotations

import pytest

from thermodata.report.words import probability_text


@pytest.mark.parametrize(
    ("p", "text"), [(0.0314, "p 0.031"), (1e-10, "p 1e-10"), (9e-11, "p below 1e-10"), (0.0, "p below 1e-10")]
)
def test_no_probability_is_told_as_zero(p: float, text: str) -> None:
    assert probability_text(p) == text
