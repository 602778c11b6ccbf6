"""Which cells of a header name which columns, where these are not as many: told by a mark of comments in front of the
names, by the cells of the time, and by numbers of rows. Where none of them tells, nobody can (`misfit`).
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

from thermodata.reader.text.cells.cell import Cell, is_empty, is_number, number_of
from thermodata.reader.text.clocks.names_of_time import cells_of_time, empty_at_the_end, filled, names_of_time, rises
from thermodata.reader.text.names.header import split_unit
from thermodata.reader.text.names.header_rows import place_of_names, texts_of
from thermodata.reader.text.names.time_header import is_time_header, says_time
from thermodata.reader.times.time_units import SECONDS

_MARK = re.compile(r"[#%;!*]{1,3}|//+|--+")  # of a comment, as a word of its own
_LONGEST_LABEL = 4  # words, and the mark, of what a row of names is called
_LABEL = re.compile(r"(?:[#%;!*/-]{1,3} ?)?[^\W\d][\w ]*:")
_OF_COLUMNS = re.compile(
    r"(?i)\b(?:columns?|names?|fields?|header|channels?|signals?|variables?|units?|einheit(?:en)?|spalten(?:namen)?|"
    r"kanäle|signale|colonnes?|colonne|columnas|colunas|unités?|unità|unidades|sloupce|jednotky|kolumny|jednostki|"
    r"kolommen|列|列名|单位|単位)\b"
)
# as instruments call a row, before the name or the unit of its time: "SIGNAL","TIME","ACH 1"
_KEYWORD = re.compile(r"(?i)(?:[a-z]+_)?(?:columns?|names?|fields?|channels?|signals?|variables?|units?)")
_UNITS = re.compile(r"(?i)(?:[a-z]+_)?units?")
NUMBERED = "the header names one column fewer than there are: the first holds the numbers of the rows"


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
    blanks: bool,
) -> tuple[list[list[Cell]], Fit | None]:
    """The rows above the data with their cells over their columns, and how they were put there; None where they stand
    so, or nothing tells where they belong. rows: of data; width: their cells; blanks: part them, so that a sentence is
    no row of names."""
    marked = [_before_names(r, width) for r in above]
    bare = [list(r[many:]) for r, many in zip(above, marked, strict=True)]
    place = place_of_names(bare, width, units_row)
    lead = max(marked, default=0)
    whole = Fit(width + lead, tuple((i + lead,) for i in range(width))) if lead else None
    names = [] if place is None else texts_of(bare[place])
    if place is None or not any(names):
        return bare, whole
    columns = width - empty_at_the_end(rows, width)
    if marked[place] or filled(names) in (width, columns) or not rows:
        return bare, whole
    fit = _fit(names[: filled(names)], rows, columns, width, blanks)
    if fit is None and _MARK.fullmatch(names[0]):
        fit = _fit(names[1 : filled(names)], rows, columns, width, blanks)
        fit = fit and Fit(fit.cells + 1, tuple(tuple(i + 1 for i in at) for at in fit.of), fit.note)
    if fit is None and blanks and _is_sentence(names, width):
        return line_up([[] if i == place else r for i, r in enumerate(bare)], rows, width, units_row, blanks)
    if fit is None:
        return bare, whole
    fit = Fit(len(names), fit.of, fit.note)
    return [fit.over(r) for r in bare], fit


def units_by_keyword(above: Sequence[Sequence[Cell]], width: int) -> int | None:
    """Which row above the data a keyword calls units: '"VERT_UNITS","s","um"'; None where none does."""
    called = (i for i, r in enumerate(above) if _before_names(r, width) and _UNITS.fullmatch(str(r[0]).strip()))
    return next(called, None)


def _before_names(row: Sequence[Cell], width: int) -> int:
    """How many cells stand before the first of as many names as there are columns: the mark of a comment, or what the
    row is called, '%% columns:'. 0 of another row."""
    many = len(row) - width
    if not 0 < many <= _LONGEST_LABEL:
        return 0
    said = " ".join(texts_of(row[:many])).strip()
    label = _LABEL.fullmatch(said)
    if many == 1 and _KEYWORD.fullmatch(said):
        first = str(row[1] or "").strip()
        return 1 if says_time(first) or is_time_header(first) or first in SECONDS else 0
    return many if (many == 1 and _MARK.fullmatch(said)) or (label and _OF_COLUMNS.search(said)) else 0


def _fit(names: Sequence[str], rows: Sequence[Sequence[Cell]], columns: int, width: int, blanks: bool) -> Fit | None:
    """How names stand over columns that are more or fewer, by the one time among both."""
    run = names_of_time(names, blanks)
    if run is None:
        return None
    counted = 1 if _are_numbers_of_rows(rows) else 0
    for before in (0, counted)[: 1 + counted]:
        cells = cells_of_time(rows, run[0] + before, columns)
        plain = not cells and (
            _counts_from_zero(rows, run[0] + 1) if before else len(run) > 1 and _alone_rises(rows, run[0], columns)
        )
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


def _alone_rises(rows: Sequence[Sequence[Cell]], column: int, columns: int) -> bool:
    """Whether numbers rise from row to row in one column, and in none beside it."""
    return [i for i in range(columns) if rises([r[i] for r in rows if i < len(r) and not is_empty(r[i])])] == [column]


def _is_sentence(names: Sequence[str], width: int) -> bool:
    """Whether more words than there are columns name neither a time nor a unit."""
    return filled(names) > width and not any(says_time(n) or is_time_header(n) or split_unit(n)[1] for n in names)
