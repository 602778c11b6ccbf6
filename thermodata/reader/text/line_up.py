"""Which cells of a header name which columns, where these are not as many: told by a mark of comments in front of the
names, by the cells of the time, and by numbers of rows. Where none of them tells, nobody can: such a table is refused.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

from thermodata.errors import FormatError
from thermodata.reader.text.cell import Cell, is_clocked, is_dated, is_empty, is_number, is_stamp, mostly, number_of
from thermodata.reader.text.clock_pattern import says_the_hour
from thermodata.reader.text.header import split_unit
from thermodata.reader.text.header_rows import place_of_names, says_time, texts_of
from thermodata.reader.text.time_cells import belongs_to_time, names_part_of_time
from thermodata.reader.text.time_header import is_time_header

_MARK = re.compile(r"[#%;!*]{1,3}|//+|--+")  # of a comment, as a word of its own
NUMBERED = "the header names one column fewer than there are: the first holds the numbers of the rows"
_ENOUGH = 0.9  # of the rows, by whose cells a column is one of times


@dataclass(frozen=True)
class Fit:
    """cells: how many a row of the header has; of: for each column the cells that name it, none where nothing does."""

    cells: int
    of: tuple[tuple[int, ...], ...]
    note: str | None = None

    def over(self, row: Sequence[Cell]) -> list[Cell]:
        """A row of the header with its cells over their columns; another row as it is."""
        if len(row) != self.cells:
            return list(row)
        return [" ".join(t for i in at if (t := str(row[i] or "").strip())) for at in self.of]


def line_up(
    above: Sequence[Sequence[Cell]],
    rows: Sequence[Sequence[Cell]],
    width: int,
    units_row: int | None,
    blanks: bool = False,
) -> tuple[list[list[Cell]], Fit | None]:
    """The rows above the data with their cells over their columns, and how they were put there; None where they stand
    so, or nothing tells where they belong. rows: of data; width: their cells; blanks: part them, so that a sentence is
    no row of names."""
    marked = [len(r) == width + 1 and _MARK.fullmatch(str(r[0]).strip()) is not None for r in above]
    bare = [list(r[1:]) if mark else list(r) for r, mark in zip(above, marked, strict=True)]
    place = place_of_names(bare, width, units_row)
    whole = Fit(width + 1, tuple((i + 1,) for i in range(width))) if any(marked) else None
    names = [] if place is None else texts_of(bare[place])
    if place is None or not any(names):
        return bare, whole
    columns = width - _empty_at_the_end(rows, width)
    if marked[place] or _filled(names) in (width, columns) or not rows:
        return bare, whole
    fit = _fit(names[: _filled(names)], rows, columns, width)
    if fit is None and _MARK.fullmatch(names[0]):
        fit = _fit(names[1 : _filled(names)], rows, columns, width)
        fit = fit and Fit(fit.cells + 1, tuple(tuple(i + 1 for i in at) for at in fit.of), fit.note)
    if fit is None and blanks and _is_sentence(names, width):
        return line_up([[] if i == place else r for i, r in enumerate(bare)], rows, width, units_row, blanks)
    if fit is None:
        return bare, whole
    fit = Fit(len(names), fit.of, fit.note)
    return [fit.over(r) for r in bare], fit


def refuse_misfit(
    above: Sequence[Sequence[Cell]],
    rows: Sequence[Sequence[Cell]],
    width: int,
    units_row: int | None,
    skip: int,
    delimiter: str,
    where: str,
) -> str | None:
    """FormatError where the names are fewer or more than the columns; but a note where the last name alone is too many
    and the others stand over their columns by the cells of the time. above, rows: as `line_up` left them; skip: lines
    before them; delimiter: as messages show it."""
    place = place_of_names(above, width, units_row)
    if place is None or not rows:
        return None
    names = texts_of(above[place])
    said, columns = _filled(names), width - _empty_at_the_end(rows, width)
    if len(names) == width or said in (width, columns) or 2 * said <= width:
        return None
    if said > width and any(len(r) >= said for r in rows[:1]):
        return None  # groups of columns that ended
    if delimiter != "blanks" and said - 1 == width == columns and _stand_over_the_time(names, rows, columns):
        return (
            f"the last name of the header has no column, for rows have {columns} cells: '{names[said - 1]}'; "
            "the others are taken to stand over theirs"
        )
    few = said < width
    first = skip + len(above) + 1
    at = skip + place + 1
    last = "columns have no name" if few else "names have no column"
    lacking = f"declare table: {{header_rows: {at}}} if only the last {last}; else "
    blanks = "write names without blanks, or " if delimiter == "blanks" else ""
    commas = f"has {columns - said} column{'s' * (columns - said != 1)} a decimal comma? then export with ';' between "
    commas = f"{commas}cells; else " if few and delimiter == "','" else ""
    raise FormatError(
        f"the header has {'fewer' if few else 'more'} cells than the rows below it",
        where=f"{where} line {at}, rows from line {first}",
        expected=f"as many cells between {delimiter} in both",
        got=f"{said} in the header, {columns} in the rows: '{' '.join(texts_of(rows[0]))[:60]}' below "
        f"'{' '.join(names)[:60]}'",
        hint=f"{commas}{blanks}put cells that hold {delimiter} in quotes, or export with another delimiter; {lacking}"
        f"declare table: {{skip_rows: {first - 1}, header_rows: 0, names: [...]}} with a name for each column",
    )


def _fit(names: Sequence[str], rows: Sequence[Sequence[Cell]], columns: int, width: int) -> Fit | None:
    """How names stand over columns that are more or fewer, by the one time among both."""
    run = _names_of_time(names)
    if run is None:
        return None
    counted = 1 if _are_numbers_of_rows(rows) else 0
    for before in (0, counted)[: 1 + counted]:
        cells = _cells_of_time(rows, run[0] + before, columns)
        plain = not cells and bool(before) and _counts_from_zero(rows, run[0] + 1)
        many = 1 if plain else cells
        if not many or len(names) - len(run) != columns - before - many:
            continue
        last = [run[many - 1 :]] if len(run) > many else []
        over = [(i,) for i in run[: many - len(last)]]
        padded = [*over, *map(tuple, last), *[()] * (many - len(over) - len(last))]
        behind = [(i,) for i in range(run[-1] + 1, len(names))]
        of = [*[()] * before, *((i,) for i in range(run[0])), *padded, *behind, *[()] * (width - columns)]
        return Fit(len(names), tuple(of), NUMBERED if before else None)
    return None


def _stand_over_the_time(names: Sequence[str], rows: Sequence[Sequence[Cell]], columns: int) -> bool:
    """Whether the names for the time stand over its cells: dates and times of day, or numbers that rise."""
    run = _names_of_time(names)
    if run is None or run[-1] >= columns:
        return False
    cells = [[r[i] for r in rows if i < len(r) and not is_empty(r[i])] for i in range(columns)]
    stamped = [i for i, c in enumerate(cells) if c and mostly(c, is_stamp, _ENOUGH, len(c))]
    if stamped:
        return run[0] == stamped[0] and all(i in stamped or belongs_to_time(cells[i]) for i in run)
    values = [v for c in cells[run[0]] if is_number(c) and (v := number_of(c)) is not None]
    return len(values) == len(cells[run[0]]) > 1 and all(a < b for a, b in pairwise(values))


def _names_of_time(names: Sequence[str]) -> list[int] | None:
    """The places side by side that name the time: 'Date', 'Time', 'AM/PM'."""
    first = next((i for i, n in enumerate(names) if says_time(n) or is_time_header(n)), None)
    if first is None:
        return None
    run = [first]
    while run[-1] + 1 < len(names) and (is_time_header(names[run[-1] + 1]) or names_part_of_time(names[run[-1] + 1])):
        run.append(run[-1] + 1)
    return run


def _cells_of_time(rows: Sequence[Sequence[Cell]], first: int, columns: int) -> int:
    """How many columns from one on hold one time: a date, a time of day, and what belongs to that; 0 where the first
    is none."""
    columns_of = {i: [r[i] for r in rows if i < len(r) and not is_empty(r[i])] for i in range(first, columns)}

    def all_are(i: int, test: object) -> bool:
        cells = columns_of.get(i, [])
        return bool(cells) and mostly(cells, test, _ENOUGH, len(cells))  # type: ignore[arg-type]

    at = first
    dated = all_are(at, is_dated)
    at += dated
    if (not dated or not any(says_the_hour(str(c)) for c in columns_of[first][:1])) and all_are(at, is_clocked):
        at += 1
    if at == first:
        return 0
    while at in columns_of and belongs_to_time(columns_of[at], f"column {at + 1}"):
        at += 1
    return at - first


def _are_numbers_of_rows(rows: Sequence[Sequence[Cell]]) -> bool:
    """Whether the first cells count from row to row."""
    firsts = [str(r[0]).strip() for r in rows if r]
    return (
        len(firsts) > 1
        and all(f.isdecimal() for f in firsts)
        and all(int(b) - int(a) == 1 for a, b in pairwise(firsts))
    )


def _counts_from_zero(rows: Sequence[Sequence[Cell]], column: int) -> bool:
    """Whether numbers begin at 0 and go on in one step, as a time does beside numbers of rows that begin at 1."""
    cells = [r[column] for r in rows if column < len(r)]
    if len(cells) < 3 or str(rows[0][0]).strip() != "1" or not all(map(is_number, cells)):
        return False
    values = [number_of(c) or 0.0 for c in cells]
    step = values[1]
    return values[0] == 0 and step > 0 and all(abs(b - a - step) < 1e-6 * step for a, b in pairwise(values))


def _is_sentence(names: Sequence[str], width: int) -> bool:
    """Whether more words than there are columns name neither a time nor a unit."""
    return _filled(names) > width and not any(says_time(n) or is_time_header(n) or split_unit(n)[1] for n in names)


def _filled(names: Sequence[str]) -> int:
    """How many cells a row of names has, empty ones at its end left out."""
    return max((i + 1 for i, n in enumerate(names) if n), default=0)


def _empty_at_the_end(rows: Sequence[Sequence[Cell]], width: int) -> int:
    """The columns at the end that most rows leave empty: they end with a delimiter, or with a remark now and then."""
    whole = [r for r in rows if len(r) == width]
    many = 0
    while many < width and 2 * sum(not is_empty(r[width - 1 - many]) for r in whole) <= len(whole):
        many += 1
    return many if many < width else 0
