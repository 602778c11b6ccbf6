"""Tests that lie side by side in one sheet or file, each under its title, are asked about with what to do."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.commands import Say
from tests.draft.labs import workbook


def _rows(heads: list[list[str]]) -> list[list[object]]:
    found: list[list[object]] = [[*h] for h in heads]
    return found + [[k * 10, k * 0.1, 20 + k * 0.01, k * 10, k * 0.2, 20 + k * 0.02] for k in range(100)]


_SAME = ["t [s]", "dX [um]", "T [degC]"]


@pytest.mark.parametrize(
    ("heads", "asked"),
    [
        ([["S4000", "", "", "S8000", "", ""], [*_SAME, *_SAME]], True),
        ([["Versuch 1", "", "", "Versuch 2", "", ""], [*_SAME, *_SAME]], True),
        ([["NC", "", "", "DAQ", "", ""], [*_SAME, "t [s]", "n [rpm]", "F [mm/min]"]], False),  # two loggers of one
    ],
)
@pytest.mark.parametrize("book", [True, False])
def test_tables_of_the_same_columns_side_by_side(
    tmp_path: Path, say: Say, heads: list[list[str]], asked: bool, book: bool
) -> None:
    rows = _rows(heads)
    if book:
        workbook(tmp_path / "a.xlsx", rows)
    else:
        (tmp_path / "a.csv").write_text("\n".join(",".join(map(str, r)) for r in rows) + "\n", encoding="utf-8")
    assert say("init", tmp_path).code == 0
    text = (tmp_path / "campaign.yaml").read_text("utf-8")
    said = next((x for x in text.splitlines() if "stand side by side in" in x), "")
    assert bool(said) is asked
    if asked:
        assert "with the same columns: a test each? They are read as one test: put each into a" in said
        assert ('table: {sheet: "{test}"}' in said) is book
