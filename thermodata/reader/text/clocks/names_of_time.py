"""Where the time stands in a header and in the rows below it: its names side by side, and its cells."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

from thermodata.reader.text.cells.cell import Cell, is_clocked, is_dated, is_empty, is_number, mostly, number_of
from thermodata.reader.text.cells.time_forms.clock_pattern import says_the_hour
from thermodata.reader.text.names.time_header import is_time_header, says_time
from thermodata.reader.text.times.several_cells.time_cells import belongs_to_time, names_part_of_time

_WORDS = 3  # of one name of the time: 'Date and Time'
ENOUGH = 0.9  # of the rows, by whose cells a column is one of times


def names_of_time(names: Sequence[str], blanks: bool = False) -> list[int] | None:
    """The places side by side that name the time: 'Date', 'Time', 'AM/PM'. blanks: a name of several words stands in as
    many places, 'Date', 'and', 'Time'."""

    def words_from(i: int) -> int:
        """How many places one name of the time takes; 0 where none begins there, nor at the mark of a comment."""
        if i < len(names) and not any(map(str.isalnum, names[i])):
            return 0
        for many in range(min(_WORDS, len(names) - i) if blanks else 1, 1, -1):
            text = names[i : i + many]
            if is_time_header(" ".join(text)) or is_time_header("".join(text)):
                return many
        return int(i < len(names) and (is_time_header(names[i]) or names_part_of_time(names[i])))

    first = next((i for i, n in enumerate(names) if says_time(n) or is_time_header(n) or words_from(i) > 1), None)
    if first is None:
        return None
    run = list(range(first, first + max(1, words_from(first))))
    while more := words_from(run[-1] + 1):
        run += range(run[-1] + 1, run[-1] + 1 + more)
    return run


def cells_of_time(rows: Sequence[Sequence[Cell]], first: int, columns: int, names: Sequence[str] = ()) -> int:
    """How many columns from one on hold one time: a date, a time of day, and what belongs to that; 0 where the first
    is none. names: of the columns, where they stand over them."""
    columns_of = {i: [r[i] for r in rows if i < len(r) and not is_empty(r[i])] for i in range(first, columns)}

    def all_are(i: int, test: object) -> bool:
        cells = columns_of.get(i, [])
        return bool(cells) and mostly(cells, test, ENOUGH, len(cells))  # type: ignore[arg-type]

    at = first
    dated = all_are(at, is_dated)
    at += dated
    if (not dated or not any(says_the_hour(str(c)) for c in columns_of[first][:1])) and all_are(at, is_clocked):
        at += 1
    if at == first:
        return 0
    while at in columns_of and belongs_to_time(columns_of[at], names[at] if names else f"column {at + 1}"):
        at += 1
    return at - first


def rises(cells: Sequence[Cell]) -> bool:
    """Whether cells are numbers that rise from row to row."""
    values = [v for c in cells if is_number(c) and (v := number_of(c)) is not None]
    return len(values) == len(cells) > 1 and all(a < b for a, b in pairwise(values))


def filled(names: Sequence[str]) -> int:
    """How many cells a row of names has, empty ones at its end left out."""
    return max((i + 1 for i, n in enumerate(names) if n), default=0)


def empty_at_the_end(rows: Sequence[Sequence[Cell]], width: int) -> int:
    """The columns at the end that most rows leave empty: they end with a delimiter, or with a remark now and then."""
    whole = [r for r in rows if len(r) == width]
    many = 0
    while many < width and 2 * sum(not is_empty(r[width - 1 - many]) for r in whole) <= len(whole):
        many += 1
    return many if many < width else 0
