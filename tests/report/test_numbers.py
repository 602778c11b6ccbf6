"""Figures in words (report/words/numbers.py)."""

from __future__ import annotations

import pytest

from thermodata.report.words.numbers import change, in_units, number, probability_text, typeset


@pytest.mark.parametrize(
    ("p", "text"), [(0.0314, "p 0.031"), (1e-10, "p 1e-10"), (9e-11, "p below 1e-10"), (0.0, "p below 1e-10")]
)
def test_no_probability_is_told_as_zero(p: float, text: str) -> None:
    assert probability_text(p) == text


def test_a_text_with_tables_is_in_the_units_of_its_responses() -> None:
    text = "RMSE [um]\n0.5 um"
    assert in_units(text, {"dZ": "um"}) == text
    assert in_units(text, {"T": "K"}) == "RMSE [K] \n0.5 K"
    assert in_units("RMSE [um]", {"dZ": "um", "T": "K"}).endswith(
        "[*] in the unit of the row's response: dZ [um], T [K]"
    )


def test_a_page_has_a_dash_where_there_is_no_number() -> None:
    assert [typeset(text) for text in (number(None), change(None, 1.0), number(-1.0))] == ["–", "–", "−1.00"]
    assert typeset("lag-free") == "lag-free"
    line = "{effect: step, tests: [c/t], fixed: {at: 90 min, gain: -14}}"
    assert typeset(f"jumps by -14.0 um: write '- {line}' (2 um -> 1 um)") == (
        f"jumps by −14.0\u00a0µm: write '- {line}' (2\u00a0µm → 1\u00a0µm)"
    )


def test_a_change_of_nothing_has_no_sign() -> None:
    assert [change(4.0, after) for after in (2.0, 3.99, 4.0, 4.01, 4.03)] == ["-50 %", "0 %", "0 %", "0 %", "+1 %"]


@pytest.mark.parametrize(
    ("before", "after", "told"),
    [
        (27.9, 0.128, "-99.54 %"),
        (1.0, 0.011, "-99 %"),
        (1.0, 9.9, "+890 %"),
        (0.0341, 7.81, "x 229"),
        (1.0, 0.0000123, "-99.9988 %"),
        (1.0, 0.0, "-100 %"),
        (1.0, 3.0, "+200 %"),
    ],
)
def test_a_fall_by_almost_all_is_no_fall_by_all(before: float, after: float, told: str) -> None:
    assert change(before, after) == told
