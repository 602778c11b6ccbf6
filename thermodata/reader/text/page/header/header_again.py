"""Rows that stand above the data and again among it, as where a logger was started anew and its file went on. They are
no cells of the columns: a date that only the first row of each part has would not be one."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence

from thermodata.reader.text.cells.cell import Cell, is_number
from thermodata.reader.text.names.header import told_alike
from thermodata.reader.text.names.header_rows import texts_of


def repeats_of(head: Iterable[Sequence[Cell]]) -> Callable[[Sequence[Cell]], bool]:
    """Whether a row repeats one above the data, if with another spelling of a unit. head: the rows above the data."""
    above = {told_alike(cells) for row in head if sum(map(bool, cells := texts_of(row))) > 1}

    def repeats(row: Sequence[Cell]) -> bool:
        names = bool(above) and not any(is_number(c) or not (isinstance(c, str) or c is None) for c in row)
        return names and told_alike(texts_of(row)) in above

    return repeats
