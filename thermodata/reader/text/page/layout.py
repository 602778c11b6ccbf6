"""How a table lies on its page: preamble, header rows, units, time columns. Declared, or found in its first rows."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from thermodata.errors import FormatError, QuestionError, UsageError
from thermodata.reader.signals.by_place import BY_PLACE
from thermodata.reader.text.cells.cell import Cell, is_dated, is_empty
from thermodata.reader.text.clocks.time_columns import column, time_of
from thermodata.reader.text.clocks.time_groups import Span, spans
from thermodata.reader.text.names.before_values import names_before_values
from thermodata.reader.text.names.declared_names import declared_names, unused_note
from thermodata.reader.text.names.described import descriptions
from thermodata.reader.text.names.header import split_unit, unique
from thermodata.reader.text.names.header_rows import are_numbers, names_and_units, texts_of
from thermodata.reader.text.page.first_data import first_data, width_of
from thermodata.reader.text.page.from_epoch import answer_of, from_epoch, stated_epoch
from thermodata.reader.text.page.from_start import with_start
from thermodata.reader.text.page.group import STREAM, Group
from thermodata.reader.text.page.line_up import Fit, line_up
from thermodata.reader.text.page.lines_between import lines_between
from thermodata.reader.text.page.misfit import refuse_misfit
from thermodata.reader.text.page.units_misfit import refuse_units_misfit
from thermodata.reader.text.preamble.head_interval import against_interval, with_interval
from thermodata.reader.times.open_questions import UNKNOWN, unanswered
from thermodata.reader.times.time_units import EPOCHS, SECONDS

_DATE = 8  # letters of a date by which it is known: "2026-03-", "02.03.20"


@dataclass(frozen=True)
class Layout:
    """first: rows before the data (preamble, header, units). names: header of each column as in the file, without
    blanks around it. groups: one, or several where columns have times of their own. over: the head that stands over
    several names, '' where there is none; described: what the file says of each column elsewhere, '' for nothing; fit:
    how the cells of the header were put over the columns, None where they stood there; worded: the word before the
    values of each column that is called by it, '' for none."""

    first: int
    names: tuple[str, ...]
    units: tuple[str | None, ...]
    groups: tuple[Group, ...]
    notes: tuple[str, ...] = ()
    over: tuple[str, ...] = ()
    described: tuple[str, ...] = ()
    fit: Fit | None = None
    worded: tuple[str, ...] = ()

    def said_of(self, column: int) -> dict[str, str]:
        """The properties of a signal: the head of the group that it stands in, what the file says of it, and its place
        where it is called by words in the rows."""
        said = {
            "group": self.over[column] if self.over else "",
            "description": self.described[column] if self.described else "",
            BY_PLACE: f"column {column + 1}" if self.worded and self.worded[column] else "",
        }
        return {key: text for key, text in said.items() if text}

    @property
    def time(self) -> tuple[int, ...]:
        """The time columns of all groups."""
        return tuple(i for g in self.groups for i in g.time)

    @property
    def dated(self) -> tuple[int, ...]:
        """Columns of dates and times that are read as text."""
        return tuple(i for g in self.groups if g.dated for i in g.time)

    def stream_of(self, column: int) -> str:
        return next(g.stream for g in self.groups if column in g.columns)


def find(
    rows: Sequence[Sequence[Cell]], declared: Mapping[str, Any] | None, where: str, between: str | None = None
) -> Layout:
    """The layout of a table from its first rows (some hundred suffice). declared: the campaign file's `table`; between:
    what parts the cells of a text, as messages show it, where a header of another number of cells is refused.

    FormatError where no data, or no time column, can be found.
    """
    said = {k: v for k, v in (declared or {}).items() if v is not None}
    skip = int(said.get("skip_rows", 0))
    width = width_of(rows[skip:])
    body = [r[:width] for r in rows[skip:]]
    header = said.get("header_rows")
    if header is None:
        first = first_data(body, width, where)
        date = next((str(c)[:_DATE] for c in body[first] if is_dated(c)), None)
        while first and _is_torn(body[first - 1], width, date):
            first -= 1
        first += skip
    else:
        first = skip + int(header)
    units_row = said.get("units_row")
    if units_row is not None and header is not None and int(units_row) > first:
        first = int(units_row)
    row_of_units = None if units_row is None else int(units_row) - 1 - skip
    below = rows[first : first + 200]
    above, fit = line_up(rows[skip:first], below, width, row_of_units, between == "blanks")
    lacking = None
    if between is not None and header is None:
        times = said.get("time") or {}
        told = not isinstance(times, Mapping) or times.get("column") is not None
        lacking = refuse_misfit(above, below, width, row_of_units, skip, between, where, told)
    if between is not None and said.get("names") is None:
        refuse_units_misfit(above, width, row_of_units, skip, between, where)
    heads, units, over = names_and_units([r[:width] for r in above], width, row_of_units)
    worded = names_before_values(heads, below) if said.get("names") is None and not any(units) else {}
    heads = [worded.get(i, head) for i, head in enumerate(heads)]
    units = [split_unit(worded[i])[1] if i in worded else unit for i, unit in enumerate(units)]
    unused = None
    if said.get("names") is not None and list(said["names"]) != heads:
        unused = unused_note(heads, below)
        if unused is None:
            heads = declared_names(said["names"], width, where)
            units = [split_unit(name)[1] for name in heads]
    names = unique(heads)
    described, listed = descriptions([texts_of(r) for r in above], heads)
    units = [u or v for u, v in zip(units, listed, strict=True)]
    data = _whole_rows(below, width)
    if not data:
        raise FormatError("a table without data rows", where=where, expected=f"data after row {first}")
    lost = lines_between(above, width, skip, names, units, where, between is not None) if header is None else []
    stated = stated_epoch(said.get("time"), map(texts_of, above))
    try:
        groups, notes = _groups(said.get("time") or {}, names, units, data, where)
        if stated is not None:
            groups, notes = from_epoch(stated, groups, notes, names, units, data, where)
    except QuestionError as question:
        answer = None if stated is None else answer_of(stated, names, units, data)
        if stated is None or answer is None:
            asked = with_interval(question, map(texts_of, above))
            raise with_start(asked, names, data, map(texts_of, above)) from None
        groups, notes = _groups(answer, names, units, data, where)
        notes = [*notes, stated.note(answer["unit"])]
    time = groups[0].time[:1] if not said.get("time") and len(groups) == 1 else ()
    against = [against_interval(names[i], [r[i] for r in data], groups[0].seconds, map(texts_of, above)) for i in time]
    by_words = [f"columns are called by the words before their values: {', '.join(worded.values())}"] if worded else []
    noted = (
        *notes,
        *lost,
        *by_words,
        *(note for note in (fit.note if fit else None, lacking, unused, *against) if note),
    )
    words = tuple(worded.get(i, "") for i in range(width)) if worded else ()
    return Layout(first, tuple(names), tuple(units), tuple(groups), noted, tuple(over), tuple(described), fit, words)


def _whole_rows(rows: Sequence[Sequence[Cell]], width: int) -> list[list[Cell]]:
    """The rows that say what columns hold: as wide as the table, or as many others (where a group has ended); a row of
    a width of its own is damaged, and says nothing. Short ones are filled with empty cells."""
    full = [r for r in rows if any(c not in ("", None) for c in r)]
    widths = Counter(len(r) for r in full)
    usual = {n for n, many in widths.items() if n == width or many > max(1, 0.05 * len(full))}
    return [[*r[:width], *[""] * (width - len(r))] for r in full if len(r) in usual or len(full) < 3]


def _is_torn(row: Sequence[Cell], width: int, date: str | None) -> bool:
    """Whether a row above the first good one is data all the same: with a date and something beside it, with a cell
    that begins with the date of the first good row, or of numbers only but for its destroyed time. Its loss is told;
    taken for a header, it would be gone without a word."""
    filled = [c for c in row if c not in ("", None)]
    if len(filled) < 2:
        return False
    if any(is_dated(c) for c in filled[:2]) or (date is not None and any(str(c)[:_DATE] == date for c in filled)):
        return True
    return len(row) == width and len(filled) > 2 and are_numbers(filled) and any("." in str(c) for c in filled)


def _groups(
    said: Mapping[str, Any] | Sequence[Mapping[str, Any]],
    names: list[str],
    units: list[str | None],
    data: list[list[Cell]],
    where: str,
) -> tuple[list[Group], list[str]]:
    """The times of a table, each with its columns: as declared (one, or a list), or as found."""
    width = len(names)
    if not isinstance(said, Mapping):
        if len(said) > 1:
            return declared_groups(said, names, units, data, where)
        said = said[0] if said else {}
    if said.get("period") is not None:
        return [_counted(said["period"], width, where)], []
    notes: list[str] = []
    found: list[Span] = []
    if said.get("column") is None:
        found, notes = spans(names, units, data, where)
    if not found:
        time, unit, form, more = time_of(said, names, units, data, where)
        rest = tuple(i for i in range(width) if i not in time)
        return [_group(STREAM, time, unit, form, rest)], [*more, *notes]
    groups = []
    for span in found:
        rows = [[r[i] for i in span.columns] for r in data if any(not is_empty(r[i]) for i in span.times)]
        time, unit, form, more = time_of(
            said,
            [names[i] for i in span.columns],
            [units[i] for i in span.columns],
            rows,
            where,
            tuple(span.columns.index(i) for i in span.times),
        )
        time = tuple(span.columns[i] for i in time)
        groups.append(_group(names[time[0]], time, unit, form, tuple(i for i in span.columns if i not in time)))
        notes += more
    which = "that share its name" if found[0].named else "behind it"
    streams = ", ".join(g.stream for g in groups)
    return groups, [f"{len(groups)} time columns, each with the columns {which}: streams {streams}", *notes]


def declared_groups(
    said: Sequence[Mapping[str, Any]], names: list[str], units: list[str | None], data: list[list[Cell]], where: str
) -> tuple[list[Group], list[str]]:
    """Groups of a declared list of times: each with its `signals`, or with the columns behind it up to the next."""
    width, notes, found = len(names), [], []
    for one in said:
        if one.get("column") is None:
            raise UsageError(
                "a time of several without its column",
                where=where,
                expected="table: {time: [{column: ...}, {column: ...}]}",
            )
        wanted = one["column"]
        columns = [column(w, names, where) for w in (wanted if isinstance(wanted, list | tuple) else [wanted])]
        rows = [r for r in data if not is_empty(r[columns[0]])]
        time, unit, form, more = time_of(one, names, units, rows, where)
        signals = one.get("signals")
        own = None if signals is None else tuple(column(w, names, where) for w in signals)
        found.append((time, unit, form, own))
        notes += more
    times = [i for time, *_ in found for i in time]
    taken = {i for *_, own in found for i in own or ()}
    twice = sorted({i for i in times if times.count(i) > 1 or i in taken})
    counts = [i for *_, own in found for i in own or ()]
    twice += sorted({i for i in counts if counts.count(i) > 1})
    if twice:
        raise UsageError(
            f"column '{names[twice[0]]}' is declared twice",
            where=where,
            expected="each column once, as a time or as a signal of one",
        )
    groups, left = [], set(range(width)) - set(times) - taken
    for time, unit, form, own in found:
        if own is None:
            end = min((i for i in times if i > max(time)), default=width)
            own = tuple(i for i in range(max(time) + 1, end) if i not in taken)
        left -= set(own)
        groups.append(_group(names[time[0]], time, unit, form, own))
    if left:
        first = groups[0]
        groups[0] = replace(first, columns=tuple(sorted((*first.columns, *left))))
        notes.append(
            f"columns of no declared time are read with '{first.stream}': " + ", ".join(names[i] for i in sorted(left))
        )
    return groups, notes


def _group(stream: str, time: tuple[int, ...], unit: str | None, form: str | None, columns: tuple[int, ...]) -> Group:
    return Group(
        stream, time, None if unit is None else SECONDS.get(unit), form, unit if unit in EPOCHS else None, columns
    )


def _counted(period: Any, width: int, where: str) -> Group:
    """All columns, in rows that follow each other at a declared period [s]."""
    return Group(STREAM, (), period_s(period, where), None, None, tuple(range(width)), True)


def period_s(period: Any, where: str) -> float:
    """A declared `time.period` [s]; FormatError where it is not answered yet."""
    if period == UNKNOWN:
        raise unanswered("time.period", "the time from row to row: 10 s, 1 min", where)
    if isinstance(period, str):
        from thermodata.schema.units.quantity import value_in

        period = value_in(period, "s")
    return float(period)
