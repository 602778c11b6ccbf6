"""A table that stands on its side: a row a signal, a column a time."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

from thermodata.errors import FormatError
from thermodata.reader.text.cells.cell import Cell, is_number, is_stamp, number_of
from thermodata.reader.text.names.time_header import is_time_header

_FEWEST_TIMES = 10
_MOST_ROWS = 200  # signals and what stands above them
_SHARE = 0.9
_PASTED = "copy it, and paste it with 'transpose' into a sheet of its own"


def refuse_sideways(rows: Sequence[Sequence[Cell]], where: str, how: str = _PASTED) -> None:
    """FormatError where one row holds dates behind a name, or numbers that rise and is called a time, and the rows
    below it numbers behind a name. how: a table is turned round."""
    if not 2 <= len(rows) <= _MOST_ROWS:
        return
    for i, row in enumerate(rows):
        head, cells = _row(row)
        if head is None or len(cells) < max(_FEWEST_TIMES, len(rows)):
            continue
        times = [number_of(c) for c in cells]
        rising = all(a is not None and b is not None and a < b for a, b in pairwise(times))
        dated = sum(map(is_stamp, cells)) > _SHARE * len(cells)
        others = [_row(r) for r in rows[i + 1 :] if any(c not in ("", None) for c in r)]
        signals = [h for h, c in others if h is not None and c and sum(map(is_number, c)) > _SHARE * len(c)]
        if (dated or (rising and is_time_header(head))) and signals and len(signals) > _SHARE * len(others):
            raise FormatError(
                "a table on its side: each row is a signal, each column a time",
                where=where,
                expected="a column a signal, a row a time",
                got=f"row {i + 1} '{head}' holds {len(cells)} times; rows below it: {', '.join(signals[:4])}",
                hint=f"turn it round: {how}",
            )


def _row(row: Sequence[Cell]) -> tuple[str | None, list[Cell]]:
    """(the name that a row begins with, what stands behind it); no name where it begins with something else."""
    first = row[0] if row else None
    if not isinstance(first, str) or not first.strip() or is_number(first) or is_stamp(first):
        return None, []
    return first.strip(), [c for c in row[1:] if c not in ("", None)]
