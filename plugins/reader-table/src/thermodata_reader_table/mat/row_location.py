"""Where a row stands in a MAT file: the index of its vectors."""

from __future__ import annotations

from pathlib import Path

from thermodata.plugin import Source
from thermodata.schema.words.sentences import with_count
from thermodata_reader_table.mat.files import opened
from thermodata_reader_table.mat.timed_streams import Clocked
from thermodata_reader_table.timed_rows import nth_timed_row

_NAMED = 12  # variables that are told one by one
_ROWS = 1_000_000  # whose times are read at once


def locate(path: Path, source: Source, stream: str, row: int) -> str | None:
    """`index 812 of Z, T1` as MATLAB counts; a column of a matrix is `M(3)`."""
    with opened(path) as tree:
        found = next((s for s in Clocked(tree, source, path.name).streams if s.name == stream), None)
        if found is None:
            return None
        at = nth_timed_row((found.times(a, a + _ROWS) for a in range(0, found.time.length, _ROWS)), row)
        if at is None:
            return None
        return f"index {at + 1} of {with_count([c.name for c in found.columns], _NAMED)}"
