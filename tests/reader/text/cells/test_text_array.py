"""Cells as an Arrow array."""

from __future__ import annotations

import subprocess
import sys

import pytest

from thermodata.reader.text.cells.values.arrow import text_array
from thermodata.reader.text.cells.values.column import values_of


@pytest.mark.parametrize("cells", [[], [""], ["1", "", "20.5"], ["µm", "°C", ""]])
def test_cells_stay_as_they_are(cells: list[str]) -> None:
    made = text_array(cells)
    made.validate(full=True)
    assert made.to_pylist() == cells


def test_numbers_that_are_all_plain_and_those_that_are_not() -> None:
    assert values_of(["1e3", " -2.5", ".5"], "float64").values.tolist() == [1000, -2.5, 0.5]
    mixed = values_of(["1e3", "", "1e999", "9007199254740993", "x"], "float64")
    assert mixed.values[:1].tolist() == [1000]
    assert mixed.empty.tolist() == [False, True, True, True, True]
    assert mixed.odd == ((2, "1e999"), (3, "9007199254740993"), (4, "x"))


def test_plain_numbers_need_no_pandas() -> None:
    code = """if True:
        import sys
        from thermodata.reader.text.cells.values.column import values_of
        values_of(["1", "2.5", "1e-3"], "float64")
        sys.exit("pandas" in sys.modules)"""
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
