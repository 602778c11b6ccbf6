"""A table of tests beside the files: which row is of which test, and what an empty cell says."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import pytest

from tests.draft.labs import workbook
from thermodata.errors import SpecError
from thermodata.schema.files.load import load_campaign


def conditions(folder: Path, rows: Sequence[Sequence[object]], *numbers: str, suffix: str = "csv") -> list[object]:
    """Of the tests of these numbers, by a table of nr and air."""
    for number in numbers:
        (folder / f"T{number}.csv").write_text("x")
    if suffix == "csv":
        (folder / "list.csv").write_text("".join(f"{a};{b}\n" for a, b in rows))
    else:
        workbook(folder / f"list.{suffix}", rows)
    path = folder / "c.yaml"
    path.write_text(
        "schema: thermodata/campaign/1\nid: c\nsources: {nc: {reader: cnc}}\ntests_from:\n"
        f'  files: "T{{nr}}.csv"\n  table: {{file: list.{suffix}, key: nr, columns: {{air: air}}}}\n'
        "  units: {air: degC}\n"
    )
    return [t.conditions for t in load_campaign(path).tests]


@pytest.mark.parametrize("suffix", ["csv", "xlsx"])
def test_long_numbers_of_tests_are_told_apart(tmp_path: Path, suffix: str) -> None:
    rows = [("nr", "air"), (20260301, 20), (20260302, 30)]
    assert conditions(tmp_path, rows, "20260301", "20260302", suffix=suffix) == [{"air": "20 degC"}, {"air": "30 degC"}]


def test_a_value_keeps_its_digits(tmp_path: Path) -> None:
    assert conditions(tmp_path, [("nr", "air"), (1, 1234567.25)], "1") == [{"air": "1234567.25 degC"}]


@pytest.mark.parametrize("suffix", ["csv", "xlsx"])
def test_an_empty_cell_is_no_condition(tmp_path: Path, suffix: str) -> None:
    rows = [("nr", "air"), (1, ""), (2, 20.5)]
    assert conditions(tmp_path, rows, "1", "2", suffix=suffix) == [{}, {"air": "20.5 degC"}]


def test_two_rows_of_one_test_that_differ_are_refused(tmp_path: Path) -> None:
    with pytest.raises(SpecError, match="two rows for nr = 1") as refused:
        conditions(tmp_path, [("nr", "air"), (1, 20), ("01", 30)], "1")
    assert refused.value.got == "air: '20' and '30' in list.csv"


def test_two_rows_that_agree_are_one(tmp_path: Path) -> None:
    assert conditions(tmp_path, [("nr", "air"), (1, 20), ("1.0", "20.0"), ("", 7), ("", 8)], "1") == [
        {"air": "20 degC"}
    ]
