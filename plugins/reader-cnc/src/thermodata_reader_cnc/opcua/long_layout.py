"""Where a long table holds its parts: the time, the tag, the value and its status, under the names that loggers and
historians give them. A tag may be parted into columns, of which those count that differ."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

from thermodata.reader.signals.unit_words import holds_units
from thermodata.reader.text import split_unit
from thermodata.reader.text.cells.lines.delimiter import fields
from thermodata.reader.text.cells.time_forms.time_pattern import TimeFormat
from thermodata.reader.text.cells.values.number import is_empty
from thermodata.reader.text.cells.values.quotes import clean
from thermodata.reader.text.cells.values.status import (
    are_faults,
    are_qualities,
    is_no_fault,
    is_severity,
    tells_quality,
    zero_is_good,
)
from thermodata.reader.text.rows.grid import Grid
from thermodata.reader.text.times.one_cell import timestamp
from thermodata_reader_cnc.opcua.long_series import Series, series_of, series_of_influx
from thermodata_reader_cnc.opcua.long_times import Times, time_columns, time_form
from thermodata_reader_cnc.opcua.long_words import TAGS, value_columns, value_pairs

_TYPE = "datatype"
_ROWS = 2000  # below the header, by which the times are known


@dataclass(frozen=True, slots=True)
class Layout:
    """Columns of the parts. header: its line; times: the first that a row has is its time; tags: columns that name what
    is measured, together; typed: further columns of the value, of which a row fills one; constant: (column, cell) of
    those that name the same in all that was looked at; status: None where there is none; zero_good: whether its code 0
    is, None where the codes do not tell; annotated: lines that begin with '#' are none of it; unread: names of columns
    of numbers that differ and are none of these; said: what their header says of the times; more: the same of further
    values of each row, `Kanal;Wert;Kanal;Wert`; faults: columns that say the faults of a row, of which 0 is none."""

    delimiter: str
    row: int
    header: str
    width: int
    times: tuple[int, ...]
    tags: tuple[int, ...]
    known: Mapping[tuple[str, ...], str]
    value: int
    typed: tuple[int, ...]
    status: int | None
    form: TimeFormat
    zero_good: bool | None
    unit: int | None
    annotated: bool
    said: Times
    unread: tuple[str, ...] = ()
    more: tuple[Layout, ...] = ()
    faults: tuple[int, ...] = ()

    @property
    def wanted(self) -> set[int]:
        """The columns that say something of an event."""
        maybe = {k for k in (self.status, self.unit) if k is not None}
        return {*self.times, *self.tags, self.value, *self.typed, *self.faults, *maybe}.union(
            *(each.wanted for each in self.more)
        )

    @property
    def status_name(self) -> str:
        """What the column of the status is called, bare."""
        return "" if self.status is None else bare(fields(self.header, self.delimiter)[self.status])

    @property
    def grid(self) -> Grid:
        """All wanted cells as text: what a value is, its tag decides."""
        kinds = tuple("str" if k in self.wanted else None for k in range(self.width))
        return Grid(self.delimiter, ".", kinds, quoted=True, exact=True)

    def valued(self, columns: dict[int, list[str | None]]) -> list[str | None]:
        """The value of each row: of typed columns the one that it fills."""
        if not self.typed:
            return columns[self.value]
        cells = (columns[k] for k in (self.value, *self.typed))
        return [next((c for c in each if c and not is_empty(c)), each[0]) for each in zip(*cells, strict=True)]

    def named(self, columns: dict[int, list[str | None]], n: int) -> list[str]:
        """The tag of each of n rows, by the cells of each wanted column."""
        if not self.tags:
            return ["Value"] * n
        tags = [[c or "" for c in columns[k]] for k in self.tags]
        if len(tags) == 1:
            return tags[0]
        known = self.known
        return [known[e] if e in known else "/".join(filter(None, e)) for e in zip(*tags, strict=True)]

    def faulty(self, columns: dict[int, list[str | None]], n: int) -> list[bool]:
        """Whether each of n rows says a fault, by the cells of each wanted column."""
        each = ([not is_no_fault(c or "") for c in columns[k]] for k in self.faults)
        return [any(row) for row in zip(*each, strict=True)] if self.faults else [False] * n

    def is_header(self, line: str) -> bool:
        """Whether a line repeats the header, or is an annotation: no loss."""
        return clean_line(line) == self.header or (self.annotated and line.startswith("#"))

    def is_other_header(self, line: str) -> bool:
        """Whether a line names columns anew, in another order or with others among them."""
        cells = [bare(c) for c in fields(line, self.delimiter)]
        named = [bare(c) for c in fields(self.header, self.delimiter)]
        return named[self.value] in cells and any(named[k] in cells for k in self.times) and not self.is_header(line)


def clean_line(line: str) -> str:
    return line.strip("\r\n \ufeff")


def bare(name: str) -> str:
    """A name without what names are written with: 'Tag Name', '_TAG_NAME'."""
    return re.sub(r"[\s_.#()-]", "", clean(name)).casefold()


def find_layout(
    lines: Sequence[str], where: str, declared: str | None = None, later: Sequence[str] = ()
) -> Layout | None:
    """The layout by a header row among the first ten lines, or None. declared: the format of the times; later: further
    lines, by which columns that differ are known. FormatError: no order of day and month."""
    for row in range(len(lines[:10])):
        for delimiter in (",", ";", "\t", "|"):
            found = _headed_by(row, delimiter, lines, where, declared, later)
            if found is not None:
                return found
    return None


@dataclass(frozen=True, slots=True)
class _Header:
    """Which columns a header names. raw, names: its cells, as they stand and `bare`; typed: further ones of the value,
    of other types; pairs: of tag and value, of a row that holds several; influx: it is one of InfluxDB."""

    raw: Sequence[str]
    names: Sequence[str]
    said: Times
    tag: int | None
    value: int
    typed: tuple[int, ...]
    status: int | None
    pairs: Sequence[tuple[int, int]]
    influx: bool

    @property
    def times(self) -> tuple[int, ...]:
        """The columns of the time."""
        return self.said.places

    def whole(self, rows: Iterable[Sequence[str]]) -> list[Sequence[str]]:
        """The rows with a cell for each name."""
        return [cells for cells in rows if len(cells) == len(self.names)]


def _header(raw: Sequence[str], below: Sequence[Sequence[str]]) -> _Header | None:
    """raw: the cells of a line; below: those of the lines below it. None where they name no time and value, or nothing
    tells what the value is of."""
    names = [bare(c) for c in raw]
    pairs = value_pairs(names, below)
    values = (pairs[0][1],) if pairs else value_columns(names)
    if not values:
        return None
    value, typed = values[0], values[1:]
    tag = pairs[0][0] if pairs else next((names.index(n) for n in TAGS if n in names), None)
    if {"_time", "_value"} <= set(raw):
        return _Header(raw, names, Times((raw.index("_time"),), "_time", None), tag, value, (), None, pairs, True)
    told = _qualities(names, below)
    status = min(told, key=lambda k: (told[k], k), default=None)
    if tag is None and ("sourcetimestamp" not in names or status is None):
        return None
    others = {k for k in (tag, *values, status, *(k for pair in pairs for k in pair)) if k is not None}
    said = time_columns(raw, names, below, others)
    return None if said is None else _Header(raw, names, said, tag, value, typed, status, pairs, False)


def _headed_by(
    row: int, delimiter: str, lines: Sequence[str], where: str, declared: str | None, later: Sequence[str]
) -> Layout | None:
    """The layout where this row is its header; None where it is none."""
    below = lines[row + 1 : row + _ROWS]
    header = _header([clean(c) for c in fields(lines[row], delimiter)], [fields(text, delimiter) for text in below])
    if header is None:
        return None
    body = header.whole(fields(text, delimiter) for text in below if not text.startswith("#"))
    form = time_form([text for cells in body if (text := _time(cells, header.times))], where, declared)
    if form is None:
        return None
    zero: bool | None = True
    if (status := header.status) is not None:
        codes = (cells[status] for cells in (*body, *header.whole(fields(text, delimiter) for text in later)))
        zero = zero_is_good(codes, header.names[status])
    taken = {
        *header.times,
        header.value,
        *header.typed,
        status,
        header.tag,
        *(k for pair in header.pairs for k in pair),
    }
    units = [
        k for k, c in enumerate(header.raw) if k not in taken and holds_units(c, (clean(cells[k]) for cells in body))
    ]
    statuses = list(_qualities(header.names, body))
    every = (fields(text, delimiter) for text in (*lines[row + 1 :], *later))
    faults = [k for k, n in enumerate(header.names) if k not in taken and are_faults((clean(c[k]) for c in body), n)]
    series = _series(header, every, form, {*units, *statuses, *faults})
    if _is_wide(header, series):
        return None
    found = Layout(
        delimiter=delimiter,
        row=row,
        header=clean_line(lines[row]),
        width=len(header.names),
        times=header.times,
        tags=series.tags,
        known=series.known,
        value=header.value,
        typed=header.typed,
        status=status,
        form=form,
        zero_good=zero,
        unit=next(iter(units), None),
        annotated=header.influx,
        said=header.said,
        unread=tuple(header.raw[k] for k in series.unread),
        faults=tuple(faults),
    )
    return replace(found, more=_further_values(found, header.pairs, units, statuses))


def _is_wide(header: _Header, series: Series) -> bool:
    """Whether the columns beside the value are measured as well, and the tag is a mere word on each row, as an
    operator's name is: its rows are of no several series."""
    beside = [header.raw[k] for k in series.measured]
    return not series.parted and bool(beside) and (not header.said.sure or any(split_unit(c)[1] for c in beside))


def _series(header: _Header, rows: Iterable[Sequence[str]], form: TimeFormat, others: Collection[int]) -> Series:
    """What names the series of a value. rows: the cells of all sampled lines; others: columns that say something else
    of a value."""
    if header.influx:
        return series_of_influx(header.raw, list(rows))
    if header.tag is None:
        return Series((), {})
    whole = header.whole(rows)
    of_type = [k for k, n in enumerate(header.names) if n == _TYPE]
    used = {
        *header.times,
        header.value,
        *header.typed,
        *(k for pair in header.pairs[1:] for k in pair),
        *others,
        *of_type,
    }
    t_ns = timestamp.parse([_time(cells, header.times) for cells in whole], form)
    return series_of(header.names, whole, t_ns, header.tag, used)


def _further_values(
    first: Layout, pairs: Sequence[tuple[int, int]], units: Sequence[int], statuses: Sequence[int]
) -> tuple[Layout, ...]:
    """The further values of a row: each with the unit and the status that stand in its own columns, or the row's."""
    return tuple(
        replace(
            first,
            tags=tuple(tag if k == pairs[0][0] else k for k in first.tags),
            value=value,
            unit=units[n] if len(units) == len(pairs) else first.unit,
            status=statuses[n] if len(statuses) == len(pairs) else first.status,
        )
        for n, (tag, value) in enumerate(pairs)
        if n
    )


def _qualities(names: Sequence[str], rows: Iterable[Sequence[str]]) -> dict[int, int]:
    """The columns that say how good a value is -> how surely, 0 and less the surest. names: bare; rows: their cells,
    by which a severity is one of EPICS, beside whose INVALID its status says why."""
    whole = [cells for cells in rows if len(cells) == len(names)]
    found: dict[int, int] = {}
    for k, name in enumerate(names):
        if is_severity(name) and are_qualities((clean(cells[k]) for cells in whole), name):
            found[k] = -1
        elif (sure := tells_quality(name)) is not None:
            found[k] = sure
    return found


def _time(cells: Sequence[str], times: Sequence[int]) -> str:
    return next((text for k in times if (text := clean(cells[k]))), "")
