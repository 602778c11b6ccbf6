"""Times at second 60: a leap second, as clocks of GPS write it, or one that was rounded up. They are read as the
minute after it, as clocks without leap seconds show them."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from thermodata.plugin import Int1D, Loss
from thermodata.reader.text.cells.time_forms.time_pattern import TimeFormat
from thermodata.reader.text.cells.values.arrow import text_array
from thermodata.schema.words.sentences import counted

_SIXTY = "60"


def at_second_sixty(cells: Any, form: TimeFormat) -> Int1D:
    """The rows whose cell says second 60. cells: an Arrow string array or a list, shape (n,)."""
    import pyarrow.compute as pc

    pattern = form.pattern
    if pattern is None or "S" not in pattern.groupindex:
        return np.empty(0, np.int64)
    column = text_array(cells) if isinstance(cells, list) else cells
    held = pc.match_substring(column, _SIXTY).fill_null(False).to_numpy(zero_copy_only=False)
    some: Int1D = np.flatnonzero(held)
    return some[[_says_sixty(pattern.fullmatch(column[k].as_py())) for k in some.tolist()]] if some.size else some


def _says_sixty(match: re.Match[str] | None) -> bool:
    return match is not None and match["S"] == _SIXTY


def said_of_sixty(times: int, first: str) -> str:
    """What is told of so many times. first: the cell of the first one."""
    told = counted(times, "time")
    are, their = ("is", "its") if times == 1 else ("are", "their")
    return f"{told} at second 60 {are} read as the minute after {their} own ('{first.strip()[:40]}')"


@dataclass(slots=True)
class SecondsSixty:
    """Counts such times over the parts of a file."""

    times: int = 0
    _first: str = ""
    _line: int = 0
    _at_ns: int | None = None

    def add(self, columns: Sequence[Any], forms: Sequence[TimeFormat], lines: Int1D, t_ns: Int1D) -> None:
        """A part's rows: of each format its cells; lines, t_ns: of the rows, shape (n,)."""
        for cells, form in zip(columns, forms, strict=False):
            rows = at_second_sixty(cells, form)
            if rows.size and not self.times:
                at = int(rows[0])
                self._first, self._line, self._at_ns = str(cells[at]), int(lines[at]) + 1, int(t_ns[at])
            self.times += int(rows.size)

    def told(self, name: str) -> list[Loss]:
        """One loss for all: rows stand a second after where a leap second was."""
        if not self.times:
            return []
        reason = said_of_sixty(self.times, self._first)
        return [Loss(f"{name} line {self._line}", self._at_ns, self._at_ns, None, reason)]
