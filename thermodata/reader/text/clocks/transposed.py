"""A table that lies on its side: each row is a signal, and one of them the time."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

from thermodata.reader.text.cells.cell import Cell, number_of
from thermodata.reader.text.cells.first_rows import FirstRows

_WIDE, _TIMES = 20, 4  # columns at least, and as a multiple of the rows
ADVICE = (
    "its rows are signals, and columns would be times: transpose it (in a spreadsheet copy, then paste special, "
    "Transpose), so that each signal is a column with its name above, and the time is the first"
)


def is_transposed(seen: FirstRows) -> bool:
    """Whether a table is far wider than long, and numbers rise all along one of its rows."""
    wide = len(seen.names) >= max(_WIDE, _TIMES * len(seen.rows))
    return wide and any(_rises_along_row(row) for row in (seen.names, *seen.rows))


def _rises_along_row(row: Sequence[Cell]) -> bool:
    """Along the row, but for a name at its begin."""
    numbers = [number_of(cell) for cell in row[1:] if cell not in ("", None)]
    known = [n for n in numbers if n is not None]
    return len(known) == len(numbers) >= _WIDE - 1 and all(a < b for a, b in pairwise(known))
