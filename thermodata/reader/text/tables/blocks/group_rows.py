"""The rows of a group of columns that have one time: as blocks, and what of them does not read."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from thermodata.plugin import Array, Block, Bool1D, Int1D
from thermodata.reader.text.cells.lines.delimiter import fields
from thermodata.reader.text.cells.values.number import why_none
from thermodata.reader.text.cells.values.quotes import clean
from thermodata.reader.text.rows.changed_cells import Standing
from thermodata.reader.text.rows.grid import Rows
from thermodata.reader.text.tables.blocks.read_on import Under
from thermodata.reader.text.tables.blocks.row_clock import RowClock
from thermodata.reader.text.tables.table import Table
from thermodata.schema.flag import Flag

_NONE, _OVER = np.uint16(Flag.NOT_MEASURING), np.uint16(Flag.SATURATED)


@dataclass(frozen=True, slots=True)
class Complaint:
    """What is to be told of a line: a row or a cell that is lost."""

    line: int
    reason: str
    size: int
    column: str | None = None


@dataclass(frozen=True, slots=True)
class Parsed:
    """Rows with the bytes that they were parsed from. line: the number of the first line of these; under: how cells lie
    in them."""

    rows: Rows
    data: bytes
    line: int
    under: Under

    def texts(self, numbers: list[int]) -> Iterator[tuple[int, str]]:
        """(number, text) of some of the lines."""
        lines = self.data.split(b"\n") if numbers else []
        for number in numbers:
            yield number, lines[number - self.line].decode("utf-8", "replace").rstrip("\r")


class GroupRows:
    """Turns parsed rows into blocks of one group. clock: tells its times, chunk after chunk."""

    def __init__(self, table: Table, clock: RowClock) -> None:
        self.table, self.clock = table, clock
        own = clock.timed.group.columns
        self.columns = [i for i in own if table.kinds[i] is not None]
        # of rows that are of several sensors, each has values of its own
        stands = table.stands if table.series is None else ()
        self._standing = {i: Standing() for i in own if i in stands}

    def block(self, rows: Rows, good: Bool1D, t_ns: Int1D) -> Block:
        """good: which rows have a time, shape (n,); t_ns: of these."""
        values: dict[str, Array] = {}
        flags: dict[str, Array] = {}
        every = bool(good.all())
        for i in self.columns:
            name, kind, cells = self.table.layout.names[i], self.table.kinds[i], rows.columns[i]
            values[name] = cells.values if every else cells.values[good]
            flag = cells.over * _OVER if cells.over.any() else None
            if kind not in ("float64", "str") and cells.empty.any():  # no NaN in them: 0, and not valid
                none = (cells.empty & ~cells.over) * _NONE
                flag = none if flag is None else flag | none
            if flag is not None:
                flag = flag.astype(np.uint16)[good]
            if i in self._standing:
                written = np.array([v is not None for v in values[name]], bool) if kind == "str" else ~cells.empty[good]
                values[name], flag = self._standing[i].over(values[name], flag, written)
            if flag is not None and flag.any():
                flags[name] = flag
        flags = self.table.qualities.flagged(flags, values)
        return Block(self.clock.timed.stream, t_ns, values, flags or None, rows.line[good] + 1)

    def odd_cells(self, rows: Rows, good: Bool1D, decimal: str) -> Iterator[Complaint]:
        """The cells that are not what their column is, in rows that have a time."""
        for i in self.columns:
            kind = self.table.kinds[i] or ""
            for row, cell in rows.columns[i].odd:
                if good[row]:
                    reason = why_none(cell, kind, decimal)
                    yield Complaint(int(rows.line[row]), reason, len(cell), self.table.layout.names[i])

    def without_time(self, parsed: Parsed, good: Bool1D, is_no_row: Callable[[str, int], bool]) -> Iterator[Complaint]:
        """The rows that have no time, but for those beside a group that has ended. is_no_row: whether the text of a
        line, with its number, is none of a row."""
        time = self.clock.timed.group.time
        for number, text in parsed.texts(parsed.rows.line[~good].tolist()):
            if is_no_row(text, number):
                continue
            cells = parsed.under.in_order(fields(text.replace("\0", ""), self.table.delimiter, self.table.quoted))
            own = [clean(cells[i]) if i < len(cells) else "" for i in (*time, *self.columns)]
            if not any(own):
                continue
            got = "; ".join(own[: len(time)])
            yield Complaint(number, f"expected a time {self.clock.timed.said()}, got '{got[:80]}'", len(text))
