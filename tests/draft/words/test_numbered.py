"""Tests that are numbered by one letter, which is no axis then (draft/words/numbered.py)."""

from __future__ import annotations

import pytest

from thermodata.draft.courses.kinds import kind_of
from thermodata.draft.words.numbered import without_number

LAB = ["Z00_pokus", "Z01_vreteno5000", "Z03_osaX_15m", "Z09_mix4", "Z10_chlazeni", "Z12_stul60"]


def test_the_letter_of_a_number_is_no_axis() -> None:
    called = without_number(LAB)
    assert list(called.values()) == ["pokus", "vreteno5000", "osaX_15m", "mix4", "chlazeni", "stul60"]
    kinds = {test: kind_of(name, []) for test, name in called.items()}
    assert kinds["Z10_chlazeni"].kind == "other"
    assert "axis" not in kinds["Z10_chlazeni"].conditions
    assert kinds["Z12_stul60"].kind == "rotary_axis"
    assert (kinds["Z03_osaX_15m"].kind, kinds["Z03_osaX_15m"].conditions["axis"]) == ("linear_axis", "X")


@pytest.mark.parametrize(
    "tests",
    [
        ["Z10_feed", "Z20_feed", "Z30_feed"],  # [m/min]
        ["X1_feed", "Y1_feed", "Z1_feed"],
        ["Z1", "Z2", "Z3"],
        ["Z1_slow", "Z2_fast"],
        ["Z1_slow", "Z1_fast", "Z2_slow"],
        ["Z1_slow", "Z2_mid", "Z3_fast", "spindle", "table"],
    ],
)
def test_what_need_be_no_number_stays(tests: list[str]) -> None:
    assert without_number(tests) == {t: t for t in tests}


def test_one_that_is_called_otherwise_stays_as_it_is() -> None:
    assert without_number([*LAB, "warmup"])["warmup"] == "warmup"
    assert without_number([*LAB, "warmup"])["Z10_chlazeni"] == "chlazeni"
