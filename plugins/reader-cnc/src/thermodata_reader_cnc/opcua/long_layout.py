"""Where a long table holds its parts: the time, the tag, the value and its status. A tag may be parted into columns, of
which those count that differ."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from thermodata.reader.text.cells.lines.delimiter import fields
from thermodata.reader.text.cells.time_forms.time_pattern import TimeFormat
from thermodata.reader.text.cells.values.number import is_empty
from thermodata.reader.text.cells.values.status import is_no_fault
from thermodata.reader.text.rows.grid import Grid
from thermodata_reader_cnc.opcua.long_times import Times
from thermodata_reader_cnc.opcua.long_words import bare


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
