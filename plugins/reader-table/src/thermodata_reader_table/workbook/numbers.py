"""Cells of a workbook as numbers: those that are kept as text by the policy of all texts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from thermodata.plugin import Array, Bool1D
from thermodata.reader.text.cells.values.column import values_of
from thermodata.reader.text.cells.values.number import decimal_mark


@dataclass(frozen=True)
class Numbers:
    """values: shape (n,), NaN where a cell is none; odd: cells that are no numbers; over: which say overload."""

    values: Array
    odd: list[str]
    over: Bool1D


class NumberCells:
    """Reads the cells of one sheet. decimal: of numbers that stand as text."""

    def __init__(self, columns: Sequence[Sequence[Any]], declared: str | None) -> None:
        """columns: those that are no time; declared: the decimal mark, where the campaign file says it."""
        self._is_declared = declared is not None
        texts = (c for column in columns for c in column[:200] if c and isinstance(c, str))
        self._decimal = declared or decimal_mark(texts) or "."

    def of(self, cells: Sequence[Any]) -> Numbers:
        """Those of a column, n cells."""
        out, odd, over = np.full(len(cells), np.nan), list[str](), np.zeros(len(cells), bool)
        texts: list[int] = []
        for i, cell in enumerate(cells):
            if isinstance(cell, int | float):
                out[i] = cell
            elif isinstance(cell, str):
                if cell:
                    texts.append(i)
            elif cell is not None:
                odd.append(str(cell))
        if texts:
            found = values_of([cells[i] for i in texts], "float64", self._decimal, self._is_declared)
            out[texts], over[texts] = found.values, found.over
            odd += [cell for _, cell in found.odd]
        return Numbers(out, odd, over)
