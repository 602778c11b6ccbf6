"""Where things stand in a delimited text file: delimiter, header rows, time columns. Found from its own lines."""

from __future__ import annotations

import csv
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from thermodata.errors import FormatError
from thermodata.reader.text import clean
from thermodata.reader.text import timestamp as when
from thermodata.reader.zone import NAT
from thermodata_reader_cnc.header import Header, find_header
from thermodata_reader_cnc.timecolumns import (
    TimeColumns,
    absolute,
    declared_time,
    first_row,
    relative,
    with_milliseconds,
)

DELIMITERS = (";", "\t", ",", "|")


@dataclass(frozen=True, slots=True)
class Layout:
    """first_row: 0-based line of the first data row. time: (column, format) pairs that add up to one time."""

    delimiter: str
    quoted: bool
    first_row: int
    width: int
    header: Header
    time: TimeColumns

    @property
    def absolute(self) -> bool:
        return self.time[0][1].role != "relative"

    @property
    def time_columns(self) -> tuple[int, ...]:
        return tuple(column for column, _ in self.time)

    def row(self, line: str) -> list[str]:
        return fields(line, self.delimiter, self.quoted)

    def row_ns(self, cells: Sequence[str]) -> int:
        """The local (or, with an offset in the cell, UTC) time of a row; NAT where it has none."""
        total = 0
        for column, form in self.time:
            if column >= len(cells):
                return NAT
            ns = when.parse_one(cells[column], form) if form.role != "relative" else NAT
            if ns == NAT:
                return NAT
            total += ns
        return total


def fields(line: str, delimiter: str, quoted: bool) -> list[str]:
    """The cells of one line; a quote that is never closed is a character like any other."""
    if not quoted or '"' not in line or line.count('"') % 2:
        return line.split(delimiter)
    try:
        return next(csv.reader([line], delimiter=delimiter))
    except csv.Error:  # a cell of more than 128 KiB, a stray carriage return
        return line.split(delimiter)


def find_layout(lines: Sequence[str], rest: Sequence[str], declared: Mapping[str, Any] | None, where: str) -> Layout:
    """The layout by a file's head lines and lines of its rest. declared: the campaign's `table` keys.

    FormatError: no time column, an order of day and month that nothing decides, a declaration that does not fit.
    """
    table = dict(declared or {})
    skip = int(table.get("skip_rows") or 0)
    body = list(lines[skip:])
    delimiter = table.get("delimiter") or _delimiter(body)
    if delimiter is None:
        raise FormatError(
            "no columns found",
            where=where,
            expected="rows of cells between ';', tabs or commas",
            got=repr(body[0][:60]) if body else "no lines",
            hint="declare table: {delimiter: ...}",
        )
    delimiter = {"tab": "\t", "\\t": "\t", "semicolon": ";", "comma": ","}.get(delimiter, delimiter)
    quoted = any(f'{delimiter}"' in line or line.startswith('"') for line in body[:200])
    rows = [fields(line, delimiter, quoted) for line in body]
    width = _width(rows)
    others = [r for r in (fields(line, delimiter, quoted) for line in rest) if len(r) == width]
    tail = [r for r in rows[len(rows) // 2 :] if len(r) == width] or [r for r in rows if len(r) == width]
    time = declared_time(table, rows, tail + others, where) if table.get("time") else None
    time = time or absolute(tail, others, where) or relative(rows, tail)
    if time is None:
        raise FormatError(
            "no time column found",
            where=where,
            expected="a column of dates and times (01.03.2026 08:00:00, 2026-03-01T08:00:00Z), "
            "or one named Time/Zeit/Čas with a unit of time",
            got="; ".join(clean(c) for c in (tail[0] if tail else []))[:120],
            hint="declare table: {time: {column: ..., format: ...}}",
        )
    first = first_row(rows, width, time, table)
    header = find_header(rows[:first], body[:first], width, {column for column, _ in time}, table, skip)
    dated = [
        r
        for r in rows[first : first + 2000]
        if len(r) == width
        and any(form.role == "relative" or when.parse_one(r[column], form) != NAT for column, form in time[:1])
    ]
    time = with_milliseconds(time, header, dated)  # a header that is repeated between rows is none
    return Layout(delimiter, quoted, skip + first, width, header, time)


def _delimiter(lines: Sequence[str]) -> str | None:
    """The first of ';', tab, comma, '|' that cuts most of the last lines into equally many cells."""
    last = [line for line in lines[len(lines) // 2 :] if line.strip()][-500:]
    last = last[:-1] if len(last) > 1 else last  # which may be cut
    for delimiter in DELIMITERS:
        counts = Counter(line.count(delimiter) for line in last if delimiter in line)
        if counts and counts.most_common(1)[0][1] >= 0.5 * len(last):
            return delimiter
    return None


def _width(rows: Sequence[Sequence[str]]) -> int:
    counts = Counter(len(r) for r in rows[len(rows) // 2 :] if len(r) > 1)
    return counts.most_common(1)[0][0] if counts else 0
