"""Which lines are rows by how many cells they have."""

from __future__ import annotations

import numpy as np
import pytest

from thermodata.reader.text.rows.grid import Grid
from thermodata.reader.text.rows.typed import parse


@pytest.mark.parametrize("ending", [b"", b'1;"2\n3"\n'], ids=["by Arrow", "line by line"])
@pytest.mark.parametrize(("exact", "lines"), [(False, [4, 6]), (True, [4])])
def test_empty_cells_behind_the_last_column(ending: bytes, exact: bool, lines: list[int]) -> None:
    """A doubled delimiter at the end and one that shifts the cells look alike; a line of them alone is nothing."""
    grid = Grid(";", ".", ("float64", "str"), quoted=True, exact=exact)
    rows = parse(b"1;a\n;;;;\n2;b;\n" + ending, 4, grid)
    np.testing.assert_array_equal(rows.line, lines + ([7] if ending else []))
    assert [bad.line for bad in rows.bad] == ([6] if exact else [])
    assert rows.columns[1].values.tolist()[-1] == ("2\n3" if ending else "a" if exact else "b")
