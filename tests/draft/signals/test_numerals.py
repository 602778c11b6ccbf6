"""Numbers that stay words for what stands behind them are asked, and never surely a text (signals/numerals.py)."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from thermodata.draft.make import draft_files
from thermodata.draft.signals.numerals import numeral_question, numerals_of
from thermodata.draft.signals.values import joined, values_of


def _line(folder: Path, cells: list[str]) -> str:
    rows = [
        f"2026-05-11T06:00:{i:02d}Z,{name},{value}"
        for i, c in enumerate(cells)
        for name, value in (("a", c), ("n", "800"))
    ]
    (folder / "day.csv").write_text("\n".join(["time,name,value", *rows, ""]), "utf-8")
    draft_files(folder)
    return next(x for x in (folder / "campaign.yaml").read_text("utf-8").splitlines() if "signal: a" in x)


def test_a_letter_behind_some_numbers_of_a_long_table_is_asked(tmp_path: Path) -> None:
    line = _line(tmp_path, [f"{7 + i / 10:.1f} K" if i % 4 == 0 else f"{800 + i}" for i in range(50)])
    assert "is K a unit, or thousands of one? write bare numbers" in line
    assert "'7.0 K' beside '801'" in line
    assert "sure:" not in line


def test_words_with_numbers_in_them_stay_words(tmp_path: Path) -> None:
    line = _line(tmp_path, [f"tool {i % 12} of 7.5 K" for i in range(50)])
    assert "quantity: label}   # sure: text" in line


@pytest.mark.parametrize(
    ("cells", "units"),
    [
        ([f"{i}.5" for i in range(12)], None),
        ([f"{i}.5 µm" for i in range(12)], ("0.5 μm", "")),
        ([f"{i},5 °C" if i % 2 else f"{i},5" for i in range(12)], ("1,5 °C", "0,5")),
        ([f"{i}.5k" if i % 2 else f"{i}00" for i in range(12)], ("1.5k", "000")),
    ],
)
def test_numbers_are_told_from_what_stands_behind_them(cells: list[str], units: tuple[str, str] | None) -> None:
    found = numerals_of([*cells, None, ""])
    assert found is not None
    assert (found.units, int(np.isfinite(found.numbers).sum())) == (units, 12)


@pytest.mark.parametrize("cells", [[f"{i}.5 frobs" for i in range(12)], [f"{i} mm" for i in range(12)], ["1.5 K"] * 12])
def test_lots_of_words_and_few_values_are_no_measured_numbers(cells: list[str]) -> None:
    assert numerals_of(cells) is None


def test_what_is_asked_goes_by_what_may_be_meant() -> None:
    assert numeral_question(("1,5 °C", "0,5")).endswith(
        "is °C the unit of all? write bare numbers of one unit into the file"
    )
    assert "is kept as text, which has no value: in °C?" in numeral_question(("1,5 °C", ""))
    assert "is k a unit, or thousands of one?" in numeral_question(("1.5k", ""))


def test_what_one_of_two_files_says_of_them_is_kept() -> None:
    bare, both = (np.array([f"{i}.5{end if i % 2 else ''}" for i in range(12)], object) for end in ("", " K"))
    for one, other in ((bare, both), (both, bare)):
        found = joined(values_of(one), values_of(other))
        assert found is not None
        assert found.units == ("1.5 K", "0.5")
