"""Rows that have two times, when what they hold began and when it ended: 'Start;Ende;T mean'. Which one a mean stands
at is said and asked: half of an interval is more than many a lag."""

from __future__ import annotations

import re
from collections.abc import Sequence

from thermodata.reader.text.cells.cell import Cell, is_dated, is_empty, is_stamp
from thermodata.reader.text.cells.first_rows import FirstRows
from thermodata.reader.times.open_questions import ASK

_BEGIN = re.compile(
    r"(?i)(?:^|[\W_])(?:start|begin|beginn|anfang|von|from|début|debut|inicio|inizio|začátek)(?:$|[\W_])"
)
_END = re.compile(r"(?i)(?:^|[\W_])(?:ende?|stop|bis|to|fin|fine|konec)(?:$|[\W_])")
_MOST = 0.9  # of the rows, that begin where the one before ended


def interval_note(columns: Sequence[int], seen: FirstRows) -> list[str]:
    """The note on rows from one time to another; none where they have one. columns: of the time that is taken."""
    own = columns[-1]
    if not _are_stamps(own, seen.rows):
        return []
    for other in (i for i in range(len(seen.names)) if i not in columns and _are_stamps(i, seen.rows)):
        ends = _follows(own, other, seen.rows) or bool(
            _END.search(seen.names[own]) and _BEGIN.search(seen.names[other])
        )
        begins = _follows(other, own, seen.rows) or bool(
            _BEGIN.search(seen.names[own]) and _END.search(seen.names[other])
        )
        if ends is begins:
            continue
        first, last = (other, own) if ends else (own, other)
        which = "end" if ends else "beginning"
        declared = [_as_declared(columns), *map(_as_declared, _with_its_date(other, columns, seen.rows))]
        return [
            f"each row has a time from '{seen.names[first]}' to '{seen.names[last]}': it stands at its {which}, "
            f"'{seen.names[own]}', and a mean would stand between them: {ASK} declare table: {{time: {{column: "
            f"{declared[0]}}}}}{''.join(f' or {d}' for d in declared[1:])}"
        ]
    return []


def _with_its_date(other: int, columns: Sequence[int], data: Sequence[Sequence[Cell]]) -> list[list[int]]:
    """The columns of the other time, with the date that stands before it or else that of the time that is taken, where
    one has its date in a column of its own; none where the other one lacks its date."""
    if _are_dates(other, data):
        return [[other]]
    if other and other - 1 not in columns and _are_dates(other - 1, data):
        return [[other - 1, other]]
    if len(columns) > 1:
        return [[*columns[:-1], other]]
    return [] if _are_dates(columns[0], data) else [[other]]


def _as_declared(columns: Sequence[int]) -> str:
    """Columns as they are declared, from 1."""
    return str([i + 1 for i in columns] if len(columns) > 1 else columns[0] + 1)


def _are_dates(column: int, data: Sequence[Sequence[Cell]]) -> bool:
    cells = [r[column] for r in data if not is_empty(r[column])]
    return bool(cells) and all(map(is_dated, cells))


def _are_stamps(column: int, data: Sequence[Sequence[Cell]]) -> bool:
    cells = [r[column] for r in data if not is_empty(r[column])]
    return len(cells) > 2 and len(set(cells)) > _MOST * len(cells) and all(map(is_stamp, cells))


def _follows(end: int, begin: int, data: Sequence[Sequence[Cell]]) -> bool:
    """Whether rows begin at the time at which the one before them ended."""
    pairs = list(zip((r[end] for r in data), (r[begin] for r in data[1:]), strict=False))
    return bool(pairs) and sum(a == b for a, b in pairs) >= _MOST * len(pairs)
