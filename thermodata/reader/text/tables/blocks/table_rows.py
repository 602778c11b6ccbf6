"""The rows of a delimited table in blocks, with times, flags and places; and what of them does not read."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from thermodata.plugin import Block, Int1D, Loss, Source
from thermodata.reader.text.cells.values.number import to_float
from thermodata.reader.text.cells.values.quotes import clean
from thermodata.reader.text.file.lines import ODD, Chunk, last_line_is_whole
from thermodata.reader.text.file.losses import Losses
from thermodata.reader.text.names.before_values import behind_another, other_word
from thermodata.reader.text.preamble.begin import Begin, begun_anew
from thermodata.reader.text.rows.event_line import is_event_line
from thermodata.reader.text.rows.footer import is_footer
from thermodata.reader.text.rows.grid import Rows
from thermodata.reader.text.rows.quality_columns import values_of
from thermodata.reader.text.rows.typed import parse
from thermodata.reader.text.tables.blocks.another_header import another_header, cells_of, last_repeated, repeats_header
from thermodata.reader.text.tables.blocks.group_rows import Complaint, GroupRows, Parsed
from thermodata.reader.text.tables.blocks.read_on import Under, own_header
from thermodata.reader.text.tables.blocks.row_clock import RowClock
from thermodata.reader.text.tables.table import Table
from thermodata.reader.text.times.one_cell.second_sixty import SecondsSixty
from thermodata.reader.times.zone import NAT

_BLOCK_VALUES = 1_000_000
_HEAD_LINES = 40  # of a further head
MOST_HEADERS = 20  # of a file that name its columns in another order: each has all rows behind it parsed anew
_TOO_OFTEN = (
    f"the columns are named in another order here, as {MOST_HEADERS} times before, reading ends: split the file there"
)


@dataclass(frozen=True, slots=True)
class _Left:
    """Whole lines that are still to be read. line: the number of the first; told: what is known of them already."""

    data: bytes
    line: int
    told: list[Complaint]


class RowReader:
    """Turns chunks into blocks. A row without a time, or with another number of cells, is lost; a cell that is no
    number is lost alone. Losses name the file's line, what was expected and what stood there."""

    def __init__(self, table: Table, source: Source, size: int) -> None:
        self.table = table
        qualities = {quality: ", ".join(values) for quality, values in values_of(table.qualities.of_values).items()}
        self.losses = Losses(table.name, max(size, 1), qualities)
        self.sure = table.decimal is not None
        self.grid = table.grid(table.decimal or ("," if table.delimiter != "," else "."))
        self.sixty = SecondsSixty()
        self.groups = [
            GroupRows(table, RowClock(timed, timed.stated or source.timezone, timed.begin or table.begin))
            for timed in table.groups
        ]
        wide = len(table.layout.names) + 8
        self.rows_of_a_block = max(1, int(source.options.get("block_rows", _BLOCK_VALUES // wide)))
        self.stopped = False
        self.under = own_header(table)
        self._headers = 0  # that name the columns in another order
        self._read = 0  # bytes of the file up to the end of a chunk
        self._short: Int1D = np.empty(0, np.int64)
        self._repeated = -1  # the last line that repeats the header
        self._last_ns = NAT  # of the rows before a chunk, from their start
        self._anew: dict[int, Begin] = {}  # by the lines of further heads
        self._held = b""  # lines that are read with the next chunk

    def read(self, chunk: Chunk) -> Iterator[Block | Loss]:
        """The blocks and losses of one chunk."""
        data, line = self._held + chunk.data, chunk.line - self._held.count(b"\n")
        self._held = b"" if chunk.last else self._begins_at_the_end(data)
        data = data[: len(data) - len(self._held)]
        self._read = chunk.size - len(self._held)
        told = [Complaint(number, ODD, 0) for number in chunk.odd]
        if chunk.last and data and not data.endswith(b"\n"):
            cut = data.rfind(b"\n") + 1
            tail, data = data[cut:], data[:cut]
            if self._is_whole(tail, data):
                data += tail + b"\n"
            elif tail.strip(b"\0 \r\x1a"):
                shown = tail[:80].decode("utf-8", "replace")
                reason = f"expected a whole row (the file ends without a line end), got '{shown}'"
                told.append(Complaint(line + data.count(b"\n"), reason, len(tail)))
        left: _Left | None = _Left(data, line, told)
        while left is not None:
            parsed, lost, left = self._part(left)
            for number, group in enumerate(self.groups):
                yield from self._group(group, parsed, lost if number == 0 else [])

    def _part(self, lines: _Left) -> tuple[Parsed, list[Complaint], _Left | None]:
        """(the rows up to a further header, what is lost among them, what is left to be read under that)."""
        under = self.under
        rows, told, left = self._until_another_header(self._parse_chunk(lines.data, lines.line), lines)
        told += [Complaint(n, f"{count} NUL bytes: what was written here is lost", count) for n, count in rows.nul]
        for bad in rows.bad:
            if not (self._repeats_header(under, bad.text, bad.line) or self._is_no_row(bad.text, bad.line)):
                reason = f"expected {under.width} cells, got {bad.cells}: '{bad.text[:80]}'"
                told.append(Complaint(bad.line, reason, bad.size))
        told += self._torn(rows)
        rows, others = self._by_words(rows)
        return Parsed(rows, lines.data, lines.line, under), [*told, *others], left

    def _is_no_row(self, text: str, line: int) -> bool:
        """A line that says what happened is a loss beyond what the note on such lines has looked at."""
        if self._is_footer(text):
            return True
        texts = [kind == "str" for kind in self.table.kinds]
        return line <= len(self.table.sample.head) and is_event_line(self._cells(text), texts)

    @property
    def anew(self) -> Sequence[Begin]:
        """The starts of further heads, in the order of their lines."""
        return [self._anew[line] for line in sorted(self._anew)]

    def _repeats_header(self, under: Under, text: str, line: int) -> bool:
        """Whether a line is one of the header again, or says that the rows behind it count from another start."""
        return line in self._anew or repeats_header(self.table, text, under)

    def _is_head_or_footer(self, under: Under, text: str, line: int) -> bool:
        return self._repeats_header(under, text, line) or self._is_footer(text)

    def _is_footer(self, text: str) -> bool:
        return is_footer(self._cells(text))

    def _cells(self, text: str) -> list[str]:
        return cells_of(self.table, text)

    def _torn(self, rows: Rows) -> list[Complaint]:
        """Rows that end with the columns of a group, as if the others had ended, though longer lines follow."""
        if not rows.short.size and not self._short.size:
            return []
        waiting = np.concatenate([self._short, rows.short])
        last_whole = int(np.setdiff1d(rows.line, rows.short).max(initial=-1))
        self._short = waiting[waiting > last_whole]
        reason = "fewer cells than the lines behind it: what is missing is lost"
        return [Complaint(int(line), reason, 0) for line in waiting[waiting < last_whole]]

    def _by_words(self, rows: Rows) -> tuple[Rows, list[Complaint]]:
        """The rows without the values that stand behind other words than those that their columns are called by."""
        columns, told = dict(rows.columns), list[Complaint]()
        for i, word in enumerate(self.table.layout.worded):
            if not word or self.table.kinds[i - 1] != "str":
                continue
            words, held = columns[i - 1].values, columns[i]
            lost = behind_another(words.tolist(), word) & ~held.empty
            if not lost.any():
                continue
            values = held.values.copy()
            values[lost] = np.nan if values.dtype.kind == "f" else None if values.dtype == object else 0
            odd = tuple((row, cell) for row, cell in held.odd if not lost[row])
            columns[i] = replace(held, values=values, empty=held.empty | lost, odd=odd)
            name = self.table.layout.names[i]
            for row in np.flatnonzero(lost).tolist():
                size = len(str(held.values[row]))
                told.append(Complaint(int(rows.line[row]), other_word(word, words[row]), size, name))
        return replace(rows, columns=columns), told

    def _is_whole(self, tail: bytes, before: bytes) -> bool:
        """Whether a last line without a line end is a row all the same."""
        end = before.rstrip(b"\n").rfind(b"\n") + 1
        previous = before[end:].decode("utf-8", "replace").rstrip("\r\n")
        return bool(previous) and last_line_is_whole(tail.decode("utf-8", "replace"), previous, self.table.delimiter)

    def _parse_chunk(self, data: bytes, line: int) -> Rows:
        rows = parse(data, line, self.under.grid(self.grid))
        if self.sure:
            return self.under.columns_of(rows)
        other = "." if self.grid.decimal == "," else ","
        if any(to_float(clean(cell), other) is not None for v in rows.columns.values() for _, cell in v.odd):
            self.grid, self.sure = replace(self.grid, decimal=other), True  # the first fraction tells the mark
            rows = parse(data, line, self.under.grid(self.grid))
        return self.under.columns_of(rows)

    def _until_another_header(self, rows: Rows, chunk: _Left) -> tuple[Rows, list[Complaint], _Left | None]:
        """The rows before a line that names the columns anew, or their units, and what is told of them: what follows it
        is another table, or left to be read where its names tell which columns are which."""
        told = chunk.told
        since_ns = self.groups[0].clock.times(rows, peek=True)
        suspects = {*rows.line[since_ns == NAT].tolist(), *(b.line for b in rows.bad)}
        if not suspects:
            self._last_ns = int(since_ns[-1]) if since_ns.size else self._last_ns
            return rows, told, None
        lines = chunk.data.split(b"\n")
        texts = [(n, lines[n - chunk.line].decode("utf-8", "replace").strip("\r")) for n in sorted(suspects)]
        found = another_header(self.table, texts, self._repeated, self.under)
        above = texts if found is None else [(n, text) for n, text in texts if n < found.line]
        self._begin_anew(above, rows.line, since_ns)
        if found is None:
            self._repeated = last_repeated(self.table, texts, self.under)
            return rows, told, None
        before = lines[: found.line - chunk.line]
        size = self._bytes_left(chunk.data, before)
        rows, lost = rows.before(found.line), [t for t in told if t.line < found.line]
        if found.under is None or self._headers == MOST_HEADERS:
            self.stopped = True
            why = found.told if found.under is None else _TOO_OFTEN
            return rows, [*lost, Complaint(found.line, why, size)], None
        self._headers += 1
        self.under, self._repeated = found.under, found.line
        self._last_ns = int(since_ns[rows.n - 1]) if rows.n else self._last_ns
        at = sum(len(line) + 1 for line in lines[: len(before) + 1])
        behind = [t for t in told if t.line > found.line]
        if found.told:
            share = size * len(found.under.more) // found.under.width
            lost.append(Complaint(found.line, found.told, share))
        return rows, lost, _Left(chunk.data[at:], found.line + 1, behind)

    def _begins_at_the_end(self, data: bytes) -> bytes:
        """The last lines of a chunk from one on that may be a further head: only the rows behind it tell."""
        if self.table.begin is None or self.table.begin.of_day:
            return b""
        last = data.rsplit(b"\n", _HEAD_LINES + 1)[1:]
        for k, text in enumerate(last):
            if self._begun(text.decode("utf-8", "replace").strip("\r")) is not None:
                return b"\n".join(last[k:])
        return b""

    def _begun(self, text: str) -> Begin | None:
        """The start that a line says which is no row and no header."""
        above = [text.replace("\t", " ")] if self.table.blanks else self._cells(text)
        return None if self.table.repeats_header(text) else begun_anew([above], self.table.begin)

    def _begin_anew(self, texts: Sequence[tuple[int, str]], lines: Int1D, since_ns: Int1D) -> None:
        """Takes the starts that lines between the rows say, where the time of the rows begins anew behind them. texts:
        (number, text) of lines that are no rows; lines, since_ns: of the rows, shape (n,)."""
        good = since_ns != NAT
        at, ns = lines[good], since_ns[good]
        for number, text in texts:
            begin = self._begun(text)
            k = int(np.searchsorted(at, number))
            before = int(ns[k - 1]) if k else self._last_ns
            if begin is not None and before != NAT and k < ns.size and ns[k] < before:
                self._anew[number] = begin
                for group in self.groups:
                    group.clock.anew[number] = begin
        self._last_ns = int(ns[-1]) if ns.size else self._last_ns

    def _bytes_left(self, data: bytes, before: Sequence[bytes]) -> int:
        """The bytes of the file from a line of a chunk on. before: the lines of the chunk above it."""
        behind = len(data) - sum(len(line) + 1 for line in before)
        return max(1, self.losses.file_size - self._read + behind)

    def _group(self, group: GroupRows, parsed: Parsed, told: list[Complaint]) -> Iterator[Block | Loss]:
        rows, clock = parsed.rows, group.clock
        t_ns = clock.times(rows)
        good = t_ns != NAT
        told = [*told, *group.without_time(parsed, good, partial(self._is_head_or_footer, parsed.under))]
        if clock.timed.formats:
            self.sixty.add([rows.times[i] for i in clock.timed.group.time], clock.timed.formats, rows.line, t_ns)
        told += group.odd_cells(rows, good, self.grid.decimal)
        lines, t_ns = rows.line[good], t_ns[good]
        for each in sorted(told, key=lambda c: c.line):
            at = int(np.searchsorted(lines, each.line))
            self.losses.add(each.line, each.reason, each.size, at, each.column)
        if t_ns.size:
            block = group.block(rows, good, t_ns)
            for first in range(0, t_ns.size, self.rows_of_a_block):
                yield block.part(first, first + self.rows_of_a_block)
        yield from self.losses.dated(t_ns)
