"""Headers that name other columns than the rows below them have: refused, for nobody can tell which names which."""

from __future__ import annotations

import re
from collections.abc import Sequence

from thermodata.errors import FormatError, QuestionError
from thermodata.reader.text.cells.cell import Cell, is_empty, is_stamp, mostly
from thermodata.reader.text.cells.time_forms.time_pattern import part_of_a_second
from thermodata.reader.text.clocks.names_of_time import (
    ENOUGH,
    cells_of_time,
    empty_at_the_end,
    filled,
    names_of_time,
    rises,
)
from thermodata.reader.text.names.header import split_unit
from thermodata.reader.text.names.header_rows import place_of_names, texts_of
from thermodata.reader.text.names.time_header import says_time
from thermodata.reader.text.page.header.head import Head
from thermodata.reader.text.times.several_cells.time_cells import belongs_to_time

_DAY_WORD = re.compile(
    r"(?i)dat[eu]m?|dato|dátum|data|fecha|дата|day|tag|dag|den|jour|giorno|d[ií]a|dzień|dzien|nap|日期|日付|날짜"
)
_CLOCK_WORD = re.compile(
    r"(?i)clock|tod|hours?|hrs?|hh|h|stunde|std|uhr|klok|klocka|hodina|godz|heures?|ore|uur|óra|min(utes?)?|local|lokal|"
    r"period|format|unnamed|column|dst|offset|zone"
)

_WHOLE, _THREE = re.compile(r":\d\d$"), re.compile(r"\d{3}")


def refuse_misfit(head: Head, *, told: bool) -> str | None:
    """FormatError where the names are fewer or more than the columns, or as many while the time takes columns more than
    names; but a note where the last name alone is too many and the others stand over their columns by the cells of the
    time. told: whether the columns of the time are declared."""
    rows, width = head.below, head.width
    place = place_of_names(head.above, width, head.row_of_units)
    if place is None or not rows:
        return None
    names = texts_of(head.above[place])
    said, columns = filled(names), width - empty_at_the_end(rows, width)
    if not told and said == columns and (own := _shifted(names, rows, columns)):
        raise _a_cell_more(head, place, names, own)
    if len(names) == width or said in (width, columns) or 2 * said <= width:
        return None
    if said > width and any(len(r) >= said for r in rows[:1]):
        return None  # groups of columns that ended
    if head.between != "blanks" and said - 1 == width == columns and _stand_over_the_time(names, rows, columns):
        return (
            f"the last name of the header has no column, for rows have {columns} cells: '{names[said - 1]}'; "
            "the others are taken to stand over theirs"
        )
    if said == columns - 1 and (behind := _milliseconds(names, rows, columns)):
        raise _parted_stamps(head, place, names[:said], behind)
    raise _other_cells(head, place, names, columns)


def _a_cell_more(head: Head, place: int, names: Sequence[str], own: Sequence[int]) -> FormatError:
    """place: of the names, in `above`. own: the columns of the time, to the first under a name of something else."""
    return FormatError(
        f"the time takes more cells in the rows than names in the header: '{names[own[-1]]}' stands over one",
        where=f"{head.where} line {head.line(place)}, rows from line {head.ends + 1}",
        expected=f"a name for each column between {head.between}, at the time too",
        got=f"'{' '.join(texts_of(head.below[0]))[:60]}' below '{' '.join(names)[:60]}'",
        hint=f"declare table: {{time: {{column: {[i + 1 for i in own]}}}}} if that names a part of the time; else "
        f"{head.named_anew}",
    )


def _other_cells(head: Head, place: int, names: Sequence[str], columns: int) -> FormatError:
    """place: of the names, in `above`. columns: those that hold anything."""
    said, between = filled(names), head.between
    few = said < head.width
    last = "columns have no name" if few else "names have no column"
    beside = names_of_time(names) is not None and not _stand_over_the_time(names, head.below, columns)
    lacking = "" if beside else f"declare table: {{header_rows: {head.line(place)}}} if only the last {last}; else "
    blanks = "write names without blanks, or " if between == "blanks" else ""
    commas = f"has {columns - said} column{'s' * (columns - said != 1)} a decimal comma? then export with ';' between "
    commas = f"{commas}cells; else " if few and between == "','" else ""
    return FormatError(
        f"the header has {'fewer' if few else 'more'} cells than the rows below it",
        where=f"{head.where} line {head.line(place)}, rows from line {head.ends + 1}",
        expected=f"as many cells between {between} in both",
        got=f"{said} in the header, {columns} in the rows: '{' '.join(texts_of(head.below[0]))[:60]}' below "
        f"'{' '.join(names)[:60]}'",
        hint=f"{commas}{blanks}put cells that hold {between} in quotes, or export with another delimiter; {lacking}"
        f"declare {head.named_anew}",
    )


def _milliseconds(names: Sequence[str], rows: Sequence[Sequence[Cell]], columns: int) -> int:
    """The column of three digits behind times to the second, which the mark before a fraction parts from these: Python
    logs '08:00:00,250'. 0 where there is none."""
    run = names_of_time(names)
    place = 0 if run is None else run[-1] + 1
    if run is None or not 0 < place < columns:
        return 0
    pairs = [(texts_of(r)[place - 1], texts_of(r)[place]) for r in rows if len(r) > place]
    if len(parts := {part for _, part in pairs}) == 1 and parts != {"000"}:
        return 0  # a speed that stands: milliseconds that never change are those of whole seconds
    good = [is_stamp(time) and _WHOLE.search(time) and _THREE.fullmatch(part) for time, part in pairs]
    return place if good and sum(map(bool, good)) >= ENOUGH * len(good) else 0


def _parted_stamps(head: Head, place: int, names: Sequence[str], behind: int) -> QuestionError:
    """Asks whether such a column holds milliseconds; meanwhile it does. place: of the names, in `above`; behind: of the
    column."""
    all_names = [*names[:behind], "ms", *names[behind:]]
    said = {"skip_rows": head.ends, "header_rows": 0, "names": all_names}
    shown = ",".join(texts_of(head.below[0])[behind - 1 : behind + 1])
    return QuestionError(
        "times whose milliseconds stand in a cell of their own, which the header does not name",
        where=f"{head.where} line {head.line(place)}",
        expected="a name for each column",
        got=shown,
        hint=f"declare table: {{skip_rows: {head.ends}, header_rows: 0, names: [{', '.join(all_names)}]}}",
        ask=f"names? the header names one column fewer than there are: is '{shown}' a time with its milliseconds?",
        declare=said,
        meanwhile=said,
    )


def _shifted(names: Sequence[str], rows: Sequence[Sequence[Cell]], columns: int) -> list[int]:
    """The columns of the time up to the first under a name of something else, where the names before it say date and
    time of day already: those behind it are a place off, too. Beside 'Datum' alone may well stand a word for the time
    of day that is not known. None where all is well."""
    run = names_of_time(names)
    if run is None or not all(names[:columns]):
        return []
    place, day = run[-1] + 1, len(run) == 1 and _DAY_WORD.fullmatch(split_unit(names[run[0]])[0].strip(" .:"))
    if day or place >= run[0] + cells_of_time(rows, run[0], columns, names):
        return []
    name = names[place]
    known = says_time(name) or _CLOCK_WORD.match(name) or part_of_a_second(name) is not None
    return [] if known else [*run, place]


def _stand_over_the_time(names: Sequence[str], rows: Sequence[Sequence[Cell]], columns: int) -> bool:
    """Whether the names for the time stand over its cells: dates and times of day, or numbers that rise."""
    run = names_of_time(names)
    if run is None or run[-1] >= columns:
        return False
    cells = [[r[i] for r in rows if i < len(r) and not is_empty(r[i])] for i in range(columns)]
    stamped = [i for i, c in enumerate(cells) if c and mostly(c, is_stamp, ENOUGH, len(c))]
    if stamped:
        return run[0] == stamped[0] and all(i in stamped or belongs_to_time(cells[i]) for i in run)
    return rises(cells[run[0]])
