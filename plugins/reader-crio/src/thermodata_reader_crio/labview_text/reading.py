"""What plain LabVIEW text holds, and its rows in blocks."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from thermodata.errors import FormatError
from thermodata.plugin import Array, Block, Bool1D, Int1D, Loss, Recording, Signal, Source
from thermodata.reader.text.file.lines import ODD, Chunk, chunks, sample, without_cut_line
from thermodata.reader.text.rows.grid import Grid, Rows
from thermodata.reader.text.rows.typed import parse
from thermodata.schema.flag import Flag
from thermodata.schema.words.sentences import counted
from thermodata_reader_crio.comments import flags_of, is_odd, texts
from thermodata_reader_crio.labview_clock import EPOCH_1904_NS, step_ns
from thermodata_reader_crio.labview_text.layout import Layout, find_layout
from thermodata_reader_crio.labview_text.wanted import WantedTime, no_time, wanted_of
from thermodata_reader_crio.row_times import counted_ns, seconds_ns

STREAM = "data"


def describe(path: Path, source: Source) -> Recording:
    """Columns, clock and start of a file, by its first lines."""
    wanted = wanted_of(source, path.name)
    layout, _, notes = _layout(path, source, wanted)
    if not layout.header:
        notes.append("no line of names: columns are numbered")
    if layout.clock == "1904":
        notes.append(f"'{layout.names[layout.time]}' is taken as seconds since 1904 UTC, as LabVIEW counts")
    elif layout.clock == "seconds":
        how = "seconds" if layout.seconds == 1 else f"counts of {layout.seconds:g} s"
        if wanted.unit is None:
            notes.append(f"'{layout.names[layout.time]}' is taken as {how} from a start")
    elif wanted.period_s is None:
        raise no_time(layout.names, path.name)
    signals = [Signal(layout.names[i], STREAM, layout.units[i]) for i in layout.values]
    if layout.text:
        signals.append(Signal(layout.text, STREAM, None, "str"))
    start = None
    if layout.clock == "1904":
        first = next((int(b.t_ns[0]) for b in blocks(path, source) if isinstance(b, Block)), None)
        start = 0 if first is None else first
    return Recording(tuple(signals), "absolute" if layout.clock == "1904" else "relative", start, None, tuple(notes))


def _layout(path: Path, source: Source, wanted: WantedTime) -> tuple[Layout, str, list[str]]:
    first = sample(path, source.encoding)
    # a last line without its end may be half a row: it decides nothing
    head = first.head[:-1] if first.whole and not first.ends_with_newline else first.head
    if not head:
        raise FormatError(
            "no whole line",
            where=path.name,
            expected="rows of numbers",
            got="no line that ends",
            hint="copy it anew from where it was recorded",
        )
    return find_layout(head, path.name, wanted), first.encoding, [first.note] if first.note else []


def blocks(path: Path, source: Source) -> Iterator[Block | Loss]:
    """The rows, each with its line, and a loss for what does not read."""
    wanted = wanted_of(source, path.name)
    layout, encoding, _ = _layout(path, source, wanted)
    if layout.doubtful:
        yield Loss(
            f"{path.name} line {layout.doubtful[0]}",
            reason=f"{counted(len(layout.doubtful), 'line')} with numbers before the first row: "
            "damaged rows, or a header of another kind",
        )
    rows = _RowReader(path.name, layout, source, 1.0 if wanted.period_s is None else wanted.period_s)
    for chunk in chunks(path, encoding):
        yield from rows.items(chunk)


@dataclass
class _RowReader:
    """Chunk by chunk. step_s: from row to row, where they are counted; done: rows so far; last_ns: time of the last."""

    name: str
    layout: Layout
    source: Source
    step_s: float
    done: int = 0
    last_ns: int | None = None

    def __post_init__(self) -> None:
        layout = self.layout
        kinds = ("float64",) * len(layout.names) + ("str",) * (layout.text is not None)
        self.grid = Grid(layout.delimiter, layout.decimal, kinds, least=len(layout.names), blank_rows=True)
        self.block_rows = int(self.source.options.get("block_rows", 0))

    def items(self, chunk: Chunk) -> Iterator[Block | Loss]:
        """The blocks of a chunk, and its losses."""
        data, cut = without_cut_line(chunk.data, self.layout.delimiter) if chunk.last else (chunk.data, False)
        behind = chunk.line + data.count(b"\n") + 1 if cut else None
        if chunk.odd:
            more = f" ({len(chunk.odd)} such lines)" if len(chunk.odd) > 1 else ""
            yield Loss(f"{self.name} line {chunk.odd[0] + 1}", self.last_ns, reason=ODD + more)
        data, line = _behind_header(data, chunk.line, self.layout.first)
        rows = parse(data, line, self.grid)
        words = texts(rows.columns[len(self.layout.names)].values) if self.layout.text else None
        t_ns, good = self._times(rows)
        if rows.nul:
            good &= ~np.isin(rows.line, [n for n, _ in rows.nul])
        block = self._block(rows, words, t_ns, good)
        size = self.block_rows or max(1, block.t_ns.size)
        for a in range(0, block.t_ns.size, size):
            yield block.part(a, a + size)
        if block.t_ns.size:
            self.last_ns = int(block.t_ns[-1])
        self.done += rows.n
        yield from self._losses(rows, words, good, data, line)
        if behind is not None:
            yield Loss(f"{self.name} line {behind}", self.last_ns, reason="the last line has no end: it may be cut")

    def _times(self, rows: Rows) -> tuple[Int1D, Bool1D]:
        if self.layout.clock == "none":
            return counted_ns(self.done, rows.n, step_ns(self.step_s), 0)
        start = EPOCH_1904_NS if self.layout.clock == "1904" else 0
        return seconds_ns(rows.columns[self.layout.time].values * self.layout.seconds, start)

    def _block(self, rows: Rows, words: Array | None, t_ns: Int1D, good: Bool1D) -> Block:
        layout = self.layout
        said = None if words is None else flags_of(words)
        values: dict[str, Array] = {}
        flags: dict[str, Array] = {}
        for i in layout.values:
            column, over = rows.columns[i].values, rows.columns[i].over
            empty = np.isnan(column)
            values[layout.names[i]] = column[good]
            if empty.any() or said is not None:
                flag = np.where(over, Flag.SATURATED, empty * np.uint16(Flag.NOT_MEASURING))
                flags[layout.names[i]] = (flag | (0 if said is None else said)).astype(np.uint16)[good]
        if layout.text:
            values[layout.text] = (np.full(rows.n, "", object) if words is None else words)[good]
        return Block(STREAM, t_ns[good], values, flags or None, rows.line[good] + 1)

    def _losses(self, rows: Rows, words: Array | None, good: Bool1D, data: bytes, line: int) -> Iterator[Loss]:
        layout = self.layout
        lost = {b.line for b in rows.bad} | {n for n, _ in rows.nul} | set(rows.line[~good].tolist())
        if lost:
            # a session that was appended begins with the header again
            lines = data.split(b"\n")
            lost = {n for n in lost if lines[n - line].decode("utf-8", "replace").strip() not in layout.header}
        if lost:
            yield Loss(
                f"{self.name} line {min(lost) + 1}",
                reason=f"{counted(len(lost), 'line', 'that is no row', 'that are no rows')} of "
                f"{counted(len(layout.names), 'number')} with a time",
            )
        moved = [] if words is None else [r for r, w in enumerate(words.tolist()) if w and is_odd(w, layout.decimal)]
        if moved:
            yield Loss(
                f"{self.name} line {int(rows.line[moved[0]]) + 1}",
                reason=f"{counted(len(moved), 'row')} with a number, or bytes of no text, where the comment stands",
            )
        wrong = [int(rows.line[r]) for i in range(len(layout.names)) for r, _ in rows.columns[i].odd if good[r]]
        if wrong:
            yield Loss(
                f"{self.name} line {min(wrong) + 1}",
                reason=f"{counted(len(wrong), 'cell', 'that is no number', 'that are no numbers')}: these "
                "values are flagged",
            )


def _behind_header(data: bytes, line: int, first: int) -> tuple[bytes, int]:
    """(what follows the first lines of the file, the number of its first line, from 0)."""
    at = 0
    while line < first and at < len(data):
        at = data.find(b"\n", at) + 1 or len(data)
        line += 1
    return data[at:], line
