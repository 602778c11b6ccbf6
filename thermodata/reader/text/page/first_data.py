"""Where the rows of data begin below a preamble and a header, and how many cells they have."""

from __future__ import annotations

import re
from collections.abc import Sequence

from thermodata.errors import FormatError
from thermodata.reader.text.cells.cell import WORDS, Cell, is_dated, is_number, is_stamp, mostly
from thermodata.reader.text.names.unit_cells import refuse_units_in_cells
from thermodata.reader.text.preamble.head_words import said_by

# '31-Oct-26 10:00:00 PM', '2. března 2026 8:00'
_WORDED = re.compile(r"\s*\d{1,2}[-/. ] ?[^\W\d_]{3,10}\.?[-/., ] ?(?:\d{4}|\d{2})[,T ]? ?\d{1,2}:\d{2}")
_FEWEST_LABELS = 2  # rows of numbers behind a word


def is_data(row: Sequence[Cell], width: int) -> bool:
    """Numbers or dates in a third of the filled cells, and as many cells as the table has, or one fewer. A date with
    the name of its month is one, though its format is asked."""
    filled = [c for c in row if not (isinstance(c, str) and c.strip().lower() in WORDS) and c is not None]
    values = sum(is_number(c) or is_stamp(c) or _is_worded(c) for c in filled)
    return values >= 1 and values * 3 >= len(filled) and len(row) >= width - 1 and (len(filled) > 1 or width <= 2)


def _is_worded(cell: Cell) -> bool:
    return isinstance(cell, str) and _WORDED.match(cell) is not None


def second_half(body: Sequence[Sequence[Cell]]) -> list[Sequence[Cell]]:
    full = [r for r in body if any(c not in ("", None) for c in r)]
    return full[len(full) // 2 :]


def width_of(body: Sequence[Sequence[Cell]]) -> int:
    """Cells of most rows of the second half, where preamble is rare; the larger of two that are as frequent."""
    lengths = [len(r) for r in second_half(body)]
    return max(set(lengths), key=lambda n: (lengths.count(n), n), default=0)


def first_data(body: Sequence[Sequence[Cell]], width: int, where: str) -> int:
    """The index of the first row of data. width: cells of such a row. FormatError where there is none."""
    stamped, dates = _columns_of_times(body, width), _dates(body, width)
    # a word in the first cell is a label where rows hold none there
    firsts = [r[0] for r in second_half(body) if len(r) >= width - 1]
    labels = mostly(firsts, lambda c: is_number(c) or is_stamp(c), 0.9, len(firsts))
    unlabelled = _below_labels(body, firsts)
    for i, row in enumerate(body):
        if i < unlabelled:
            continue
        if stamped and not any(is_stamp(c) for k, c in enumerate(row) if k in stamped):
            continue  # a row of a list of channels with their ranges
        if labels and _is_labelled(row):
            continue  # 'Start date;2026-03-02' above 'Start time;07:00:00'
        following = [r for r in body[i + 1 : i + 11] if any(c not in ("", None) for c in r)]
        if not is_data(row, width) or sum(is_data(r, width) for r in following) * 2 < len(following):
            continue
        words = [c for c in row if isinstance(c, str) and c and not is_number(c) and not is_stamp(c)]
        dated = 2 * sum(c not in ("", None) for c in row) > width and any(
            is_dated(c) and (dates is None or k in dates) for k, c in enumerate(row)
        )
        alone = following and not is_data(following[0], width) and following[0] not in body[:i]
        if words and alone and not dated:
            continue  # "Serial;4711" above the header; a row above one that is repeated is data
        return i
    below = [r for r in second_half(body) if len(r) == width and any(map(is_stamp, r))]
    refuse_units_in_cells([c for r in below for c in r if not is_stamp(c)], where)
    raise FormatError(
        "no data rows found",
        where=where,
        expected="rows of numbers and times",
        hint="nothing was recorded, if it is a header alone; else declare table: {header_rows: ..., skip_rows: ...}",
    )


def _below_labels(body: Sequence[Sequence[Cell]], firsts: Sequence[Cell]) -> int:
    """The index of the first row without a label, below rows of settings behind words: 'Range;500;500' above
    ';0,12;0,08'. 0 where it is no such table: one word may mark its first row. firsts: the first
    cells of later rows."""
    if sum(c in ("", None) for c in firsts) < 0.9 * max(1, len(firsts)):
        return 0
    first = next((i for i, r in enumerate(body) if r and r[0] in ("", None) and any(map(is_number, r))), 0)
    width = width_of(body)
    return first if sum(is_data(r, width) for r in body[:first]) >= _FEWEST_LABELS else 0


def _is_labelled(row: Sequence[Cell]) -> bool:
    """Whether a row whose first cell is a number or a time elsewhere is one of a preamble: that names the date behind
    it, ends with a colon, or is a word beside a value and cells that are left out."""
    first = str(row[0] if row else "").strip()
    if said_by(first.strip(" :")) is not None:
        return True
    filled = [c for c in row if c not in ("", None)]
    return first[:1].isalpha() and not is_stamp(first) and (first.endswith(":") or len(filled) == 2 < len(row))


def _dates(body: Sequence[Sequence[Cell]], width: int) -> set[int] | None:
    """Columns that hold a date in nearly all rows of the second half; None where there are too few rows to say so. A
    preamble has a date too: 'Start: 05.02.2026' above a time in seconds."""
    late = [r for r in second_half(body) if len(r) >= width - 1]
    if len(late) < 5:
        return None
    return {k for k in range(width) if mostly((r[k] if k < len(r) else "" for r in late), is_dated, 0.9, len(late))}


def _columns_of_times(body: Sequence[Sequence[Cell]], width: int) -> set[int]:
    """Columns that hold dates or times in nearly all rows of the second half, where preamble is rare."""
    late = [r for r in second_half(body) if len(r) >= width - 1]
    if len(late) < 5:
        return set()
    return {k for k in range(width) if mostly((r[k] if k < len(r) else "" for r in late), is_stamp, 0.9, len(late))}
