"""Plain text that LabVIEW writes ("Write To Spreadsheet File", "Write Delimited Spreadsheet", logs of a cRIO): rows of
numbers between tabs, with or without names, and a time in seconds since 1904, in seconds from a start, or none.

Text with dates and times of day belongs to the readers of controls and tables; see `ascii_layout` for what is claimed.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from thermodata.errors import FormatError
from thermodata.plugin import Array, Block, Bool1D, Int1D, Loss, Recording, Signal, Source
from thermodata.reader.text import last_line_is_whole
from thermodata.schema.flag import Flag
from thermodata.schema.quantity import value_in
from thermodata_reader_crio.ascii_layout import Layout, find_layout
from thermodata_reader_crio.comments import flags_of, texts
from thermodata_reader_crio.labtime import EPOCH_1904_NS, counted_ns, seconds_ns
from thermodata_reader_crio.labview_clock import step_ns
from thermodata_reader_crio.rows import Grid, Rows, number, parse
from thermodata_reader_crio.textparts import LineBlock, count_lines, decode, encoding_of, parts

STREAM = "data"
_HEAD_BYTES = 64 * 1024


def _layout(path: Path, source: Source) -> tuple[Layout, str, list[str]]:
    encoding, note = encoding_of(path, source.encoding)
    head = next(iter(parts(path, encoding, _HEAD_BYTES)), None)
    if head is None:
        raise FormatError("an empty file", where=path.name, expected="rows of numbers")
    text = decode(head.data, encoding)
    wanted = source.options.get("time")
    return find_layout(text, path.name, wanted), encoding, [note] if note else []


def describe(path: Path, source: Source) -> Recording:
    layout, _, notes = _layout(path, source)
    if not layout.header:
        notes.append("no line of names: columns are numbered")
    if layout.clock == "1904":
        notes.append(f"'{layout.names[layout.time]}' is taken as seconds since 1904 UTC, as LabVIEW counts")
    elif layout.clock == "seconds":
        notes.append(f"'{layout.names[layout.time]}' rises from row to row: taken as seconds from a start")
    elif source.options.get("increment") is None:
        notes.append("no time column: rows are counted as 1 s each; declare options: {increment: 0.1 s}, or {time: 1}")
    signals = [Signal(layout.names[i], STREAM, layout.units[i]) for i in layout.values]
    if layout.text:
        signals.append(Signal(layout.text, STREAM, None, "str"))
    start = None
    if layout.clock == "1904":
        first = next((int(b.t_ns[0]) for b in blocks(path, source) if isinstance(b, Block)), None)
        start = 0 if first is None else first
    return Recording(tuple(signals), "absolute" if layout.clock == "1904" else "relative", start, None, tuple(notes))


def blocks(path: Path, source: Source) -> Iterator[Block | Loss]:
    layout, encoding, _ = _layout(path, source)
    grid = Grid(
        layout.delimiter.encode(),
        layout.decimal.encode(),
        len(layout.names),
        layout.text is not None,
        len(layout.names),
    )
    size = int(source.options.get("block_rows", 0))
    step = source.options.get("increment")
    step_s = 1.0 if step is None else value_in(step, "s")
    done, last_ns = 0, None
    if layout.doubtful:
        yield Loss(
            f"{path.name} line {layout.doubtful[0]}",
            reason=f"{len(layout.doubtful)} lines before the first "
            "row that hold numbers: damaged rows, or a header of another kind",
        )
    for part in parts(path, encoding):
        data, line = part.data, part.line
        if not part.ended and not _whole(data, layout, encoding):
            data = data[: data.rfind(b"\n") + 1]
            yield Loss(
                f"{path.name} line {line + count_lines(data)}",
                last_ns,
                reason="the last line has no end: it may be cut",
            )
        data, line = _behind_header(data, line, layout)
        rows = parse(data, grid)
        block, good = _block(rows, layout, encoding, done, step_s, line)
        for a in range(0, block.t_ns.size, size or max(1, block.t_ns.size)):
            yield block.part(a, a + (size or block.t_ns.size))
        if block.t_ns.size:
            last_ns = int(block.t_ns[-1])
        yield from _losses(path, rows, good, data, line, layout, encoding)
        done += rows.n


def _behind_header(data: bytes, line: int, layout: Layout) -> tuple[bytes, int]:
    """What follows the file's header, for the part that begins with it."""
    if line > layout.first:
        return data, line
    at = 0
    for _ in range(layout.first - line + 1):
        at = data.find(b"\n", at) + 1 or len(data)
    return data[at:], layout.first + 1


def _whole(data: bytes, layout: Layout, encoding: str) -> bool:
    lines = data.rsplit(b"\n", 2)
    return len(lines) > 1 and last_line_is_whole(
        decode(lines[-1], encoding), decode(lines[-2].rstrip(b"\r"), encoding), layout.delimiter
    )


def _times(rows: Rows, layout: Layout, done: int, step_s: float) -> tuple[Int1D, Bool1D]:
    if layout.clock == "1904":
        return seconds_ns(rows.numbers[layout.time], EPOCH_1904_NS)
    if layout.clock == "seconds":
        return seconds_ns(rows.numbers[layout.time], 0)
    return counted_ns(done, rows.n, step_ns(step_s), 0)


def _block(rows: Rows, layout: Layout, encoding: str, done: int, step_s: float, line: int) -> tuple[LineBlock, Bool1D]:
    t_ns, good = _times(rows, layout, done, step_s)
    words = None if rows.text is None else texts(rows.text, encoding)
    said = None if words is None else flags_of(words)
    values: dict[str, Array] = {}
    flags: dict[str, Array] = {}
    for i in layout.values:
        column = rows.numbers[i]
        empty = np.isnan(column)
        values[layout.names[i]] = column[good]
        if empty.any() or said is not None:
            flag = empty * np.uint16(Flag.NOT_MEASURING) | (0 if said is None else said)
            flags[layout.names[i]] = flag.astype(np.uint16)[good]
    if layout.text:
        values[layout.text] = (np.full(rows.n, "", object) if words is None else words)[good]
    return LineBlock(STREAM, t_ns[good], values, flags or None, rows.line[good] + line), good


def _losses(
    path: Path, rows: Rows, good: Bool1D, data: bytes, line: int, layout: Layout, encoding: str
) -> Iterator[Loss]:
    lost = sorted({*rows.bad, *rows.line[~good].tolist()})
    if lost:
        # a session that was appended begins with the header again
        lines = data.split(b"\n")
        lost = [i for i in lost if decode(lines[i], encoding).strip() not in layout.header]
    if lost:
        yield Loss(
            f"{path.name} line {line + lost[0]}",
            reason=f"{len(lost)} lines that are no rows of {len(layout.names)} numbers with a time",
        )
    odd = (
        []
        if rows.text is None
        else [
            i
            for i, w in enumerate(rows.text.tolist())
            if w and (b"\0" in w or number(w.strip(), layout.decimal.encode()) is not None)
        ]
    )
    if odd:
        yield Loss(
            f"{path.name} line {line + int(rows.line[odd[0]])}",
            reason=f"{len(odd)} rows with a number, or bytes of no text, where the comment stands",
        )
    wrong = [r for r, _ in rows.wrong if good[r]]
    if wrong:
        yield Loss(
            f"{path.name} line {line + int(rows.line[wrong[0]])}",
            reason=f"{len(wrong)} cells that are no numbers: these values are flagged",
        )
