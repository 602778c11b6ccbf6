"""Rows of a delimited text: whole chunks at once, and where one does not read, halves of it down to single lines."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from thermodata.plugin import Array, Block, Int1D, Loss
from thermodata.reader.text import clean, last_line_is_whole
from thermodata.reader.text import timestamp as when
from thermodata.reader.text.lines import ODD, Chunk
from thermodata.reader.text.local_clock import LocalClock
from thermodata.reader.text.losses import Losses
from thermodata.reader.zone import NAT
from thermodata_reader_cnc.arrowcolumns import MISSING, relative_ns, to_numpy
from thermodata_reader_cnc.cells import as_bool, as_float, as_int
from thermodata_reader_cnc.columns import FALSE, NOTHING, TRUE
from thermodata_reader_cnc.timecolumns import Counted

if TYPE_CHECKING:
    import pyarrow as pa

    from thermodata_reader_cnc.plain import Plan

_SMALL = 16 * 1024
_Part = tuple[Int1D, dict[str, Array], dict[str, Array]]


class _OddError(Exception):
    """A part of the file that cannot be read as a whole."""


def odd_lines(data: bytes, delimiter: str, width: int) -> bool:
    """Whether text holds so many cells that a line of it must be far too wide: a parser would make room for all."""
    return data.count(delimiter.encode()) > (width - 1) * (data.count(b"\n") + 1) + 10_000


class RowReader:
    """Turns chunks into blocks. A row without a time or with too few cells is lost; a cell that is no number is
    lost alone. Losses name the file's line, what was expected and what stood there."""

    def __init__(self, name: str, size: int, plan: Plan, timezone: str | None) -> None:
        self.plan, self.layout = plan, plan.layout
        self.losses = Losses(name, max(size, 1))
        self.decimal = plan.decimal or ("," if plan.layout.delimiter != "," else ".")
        self.sure = plan.decimal is not None
        self.clock = LocalClock(None if plan.utc or not plan.layout.absolute else timezone)
        self.stopped = False

    def read(self, chunk: Chunk) -> Iterator[Block | Loss]:
        """The blocks and losses of one chunk."""
        data, ends = chunk.data, chunk.data.endswith(b"\n")
        for line in chunk.odd:
            self.losses.add(line, ODD, 0, 0)
        tail = b""
        if chunk.last and data and not ends:
            cut = data.rfind(b"\n") + 1
            data, tail = data[:cut], data[cut:]
        yield from self._part(data, chunk.line)
        if tail and not self.stopped:
            yield from self._tail(tail, data, chunk.line + data.count(b"\n"))

    # ---- parts -----------------------------------------------------------------------------------

    def _part(self, data: bytes, line: int) -> Iterator[Block | Loss]:
        if not data or self.stopped:
            return
        try:
            part = self._fast(data)
        except _OddError:
            if len(data) > _SMALL:
                cut = data.find(b"\n", len(data) // 2) + 1
                if 0 < cut < len(data):
                    yield from self._part(data[:cut], line)
                    yield from self._part(data[cut:], line + data.count(b"\n", 0, cut))
                    return
            part = self._slow(data.decode("utf-8", "replace").split("\n"), line)
        yield from self._finish(part)

    def _finish(self, part: _Part) -> Iterator[Block | Loss]:
        local, values, flags = part
        t_ns = self.clock.utc(local) if self.layout.absolute else local
        if t_ns.size:
            yield Block("nc", t_ns, values, flags or None)
        yield from self.losses.dated(t_ns)

    def _fast(self, data: bytes) -> _Part:
        """A part that reads as a whole; _OddError where anything in it does not."""
        import pyarrow as pa
        import pyarrow.csv as pc

        layout = self.layout
        if data.count(b"\r") != data.count(b"\r\n"):
            raise _OddError  # a lone CR ends a row for Arrow, and none for _slow
        if b"\0" in data or (layout.quoted and data.count(b'"') % 2) or odd_lines(data, layout.delimiter, layout.width):
            raise _OddError
        names = [str(i) for i in range(layout.width)]
        kinds: dict[str, Any] = {str(i): pa.string() for i in layout.time_columns}
        if not layout.absolute:
            kinds = {str(layout.time_columns[0]): pa.float64()}
        text = pa.dictionary(pa.int32(), pa.string())
        for column in self.plan.columns:
            kinds[str(column.place)] = text if column.dtype == "str" else pa.type_for_alias(column.dtype)
        try:
            table = pc.read_csv(
                pa.BufferReader(data),
                pc.ReadOptions(column_names=names, block_size=1 << 20),
                pc.ParseOptions(delimiter=layout.delimiter, quote_char='"' if layout.quoted else False),
                pc.ConvertOptions(
                    column_types=kinds,
                    include_columns=list(kinds),
                    null_values=list(NOTHING),
                    true_values=list(TRUE),
                    false_values=list(FALSE),
                    decimal_point=self.decimal,
                    strings_can_be_null=False,
                    check_utf8=True,
                ),
            )
        except pa.ArrowInvalid as error:
            raise _OddError from error
        local = self._time(table)
        values: dict[str, Array] = {}
        flags: dict[str, Array] = {}
        for column in self.plan.columns:
            values[column.name], missing = to_numpy(table.column(str(column.place)), column.dtype)
            if missing is not None:
                flags[column.name] = missing
        return local, values, flags

    def _time(self, table: pa.Table) -> Int1D:
        if not self.layout.absolute:
            column, form = self.layout.time[0]
            seconds = table.column(str(column)).to_numpy()
            if not np.isfinite(seconds).all():
                raise _OddError
            assert isinstance(form, Counted)
            return relative_ns(seconds, form.unit_ns)
        total = np.zeros(table.num_rows, np.int64)
        for column, form in self.layout.time:
            part = when.parse(table.column(str(column)), form)
            if part.size and part.min() == NAT:
                raise _OddError
            total += part
        return total

    # ---- single lines ----------------------------------------------------------------------------

    def _slow(self, lines: list[str], line: int) -> _Part:
        times: list[int] = []
        columns: list[list[Any]] = [[] for _ in self.plan.columns]
        for k, text in enumerate(lines):
            if not text.strip(f"{self.layout.delimiter} \r\t\0"):
                if "\0" in text:
                    self.losses.add(
                        line + k, f"{len(text)} NUL bytes: what was written here is lost", len(text), len(times)
                    )
                continue
            row = self._row(text, line + k, len(times))
            if self.stopped:
                break
            if row is not None:
                times.append(row[0])
                for cell, into in zip(row[1], columns, strict=True):
                    into.append(cell)
        values: dict[str, Array] = {}
        flags: dict[str, Array] = {}
        for column, cells in zip(self.plan.columns, columns, strict=True):
            if column.dtype == "str":
                values[column.name] = np.array(cells, object) if cells else np.empty(0, object)
            elif column.dtype == "float64":
                values[column.name] = np.array([np.nan if c is None else c for c in cells], np.float64)
            else:
                missing = np.array([c is None for c in cells], bool)
                values[column.name] = np.array([0 if c is None else c for c in cells], np.dtype(column.dtype))
                if missing.any():
                    flags[column.name] = missing * MISSING
        return np.array(times, np.int64), values, flags

    def _row(self, text: str, line: int, row: int) -> tuple[int, list[Any]] | None:
        bare = text.replace("\0", "").rstrip("\r")
        if bare in self.layout.header.lines:
            return None  # the logger was restarted into the same file
        cells = self.layout.row(bare)
        if "\0" in text:
            nuls = text.count("\0")
            self.losses.add(line, f"{nuls} NUL bytes: what was written before this row is lost", nuls, row)
        if len(cells) != self.layout.width:
            self.losses.add(
                line, f"expected {self.layout.width} cells, got {len(cells)}: '{bare[:80]}'", len(text), row
            )
            return None
        if self._other_header(cells):
            self.stopped = True
            self.losses.add(
                line,
                f"another header begins here, nothing after it is read: '{bare[:120]}'; split the file there",
                len(text),
                row,
            )
            return None
        ns = self._row_ns(cells)
        if ns is None:
            forms = " and ".join(form.text for _, form in self.layout.time)
            got = "; ".join(cells[c] for c in self.layout.time_columns)
            self.losses.add(line, f"expected a time {forms}, got '{got[:80]}'", len(text), row)
            return None
        result: list[Any] = []
        for column in self.plan.columns:
            value = self._cell(clean(cells[column.place]), column.dtype)
            if value is None and column.dtype != "str" and clean(cells[column.place]) not in NOTHING:
                expected = "a number" if column.dtype != "bool" else "TRUE or FALSE"
                cell = cells[column.place]
                self.losses.add(line, f"expected {expected}, got '{cell[:40]}'", len(cell), row, column.name)
            result.append(value)
        return ns, result

    def _row_ns(self, cells: list[str]) -> int | None:
        if self.layout.absolute:
            ns = self.layout.row_ns(cells)
            return None if ns == NAT else ns
        value = as_float(clean(cells[self.layout.time_columns[0]]), self.decimal)
        if value is None or not np.isfinite(value):
            return None
        form = self.layout.time[0][1]
        assert isinstance(form, Counted)
        return int(relative_ns(np.array([value]), form.unit_ns)[0])

    def _cell(self, cell: str, dtype: str) -> Any:
        if dtype == "str":
            return cell or None
        if cell in NOTHING:
            return None
        if dtype == "bool":
            return as_bool(cell)
        if dtype == "int64":
            return as_int(cell)
        value = as_float(cell, self.decimal)
        if value is None and not self.sure:
            other = "." if self.decimal == "," else ","
            value = as_float(cell, other)
            if value is not None:  # the first number with a fraction tells the mark
                self.decimal, self.sure = other, True
        return value

    def _other_header(self, cells: list[str]) -> bool:
        names = self.layout.header.names
        same = [clean(cells[c]) == names[c] for c in self.layout.time_columns]
        return all(same) and bool(same)

    def _tail(self, tail: bytes, before: bytes, line: int) -> Iterator[Block | Loss]:
        """A last line without a line end: a row if it looks whole, else the cut end of one."""
        text = tail.decode("utf-8", "replace")
        end = before.rstrip(b"\n").rfind(b"\n") + 1
        previous = before[end:].decode("utf-8", "replace").rstrip("\r\n")
        if not previous or not last_line_is_whole(text, previous, self.layout.delimiter):
            self.losses.add(
                line, f"expected a whole row (the file ends without a line end), got '{text[:80]}'", len(tail), 0
            )
            yield from self.losses.dated(np.empty(0, np.int64))
            return
        yield from self._part(tail + b"\n", line)
