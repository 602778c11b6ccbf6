"""A control's plain CSV export: what it holds, and its rows in blocks."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from thermodata.errors import FormatError
from thermodata.plugin import Block, Loss, Recording, Signal, Source
from thermodata.reader.text import last_line_is_whole
from thermodata.reader.text.lines import Chunk, Sample, chunks, sample
from thermodata.reader.text.locate import line_of
from thermodata.reader.text.timestamp import parse
from thermodata.reader.zone import NAT, local_to_utc_ns
from thermodata_reader_cnc import quality
from thermodata_reader_cnc.columns import Column, find_columns
from thermodata_reader_cnc.layout import Layout, find_layout

STREAM = "nc"
_NAMES = {";": "';'", "\t": "tabs"}
EXAMPLE = b"Datum;Zeit;T1 [degC]\n02.03.2026;08:00:00;20,5\n02.03.2026;08:00:01;20,6\n02.03.2026;08:00:02;20,7\n"


@dataclass(frozen=True, slots=True)
class Plan:
    """All that a file's first look found."""

    sample: Sample
    layout: Layout
    columns: tuple[Column, ...]
    decimal: str | None
    utc: bool  # the cells carry an offset from UTC
    quality: dict[str, tuple[str, bool]]


def claims(lines: Sequence[str]) -> str | None:
    """The reason for claiming lines of text, or None: absolute dates and times in the rows, and ';' or a tab between
    the cells. Comma-separated text, and text with relative or no time, is left to readers of general tables."""
    try:
        layout = find_layout([line for line in lines if line.strip()], [], None, "")
    except FormatError as error:
        # a file of ours whose day and month nothing tells apart is still ours: reading it asks for the order
        if error.what.startswith("day and month") and any(";" in line or "\t" in line for line in lines[-3:]):
            return "rows of a date and time between ';' or tabs"
        return None
    if layout.delimiter not in _NAMES or not layout.absolute:
        return None
    forms = " and ".join(form.text for _, form in layout.time)
    return f"rows between {_NAMES[layout.delimiter]} with a time {forms} in column {layout.time[0][0] + 1}"


def plan(path: Path, source: Source) -> Plan:
    """Layout and columns of a file by its head and pieces of the rest; FormatError where there is no table."""
    first = sample(path, source.encoding)
    # a last line without its end may be half a row: it decides nothing
    head = first.head[:-1] if first.whole and not first.ends_with_newline else first.head
    if not head:
        raise FormatError(
            "no whole line",
            where=path.name,
            expected="lines that end",
            got=repr(first.head[0][:60]) if first.head else "nothing",
        )
    layout = find_layout(head, first.rest, source.table, path.name)
    body = head[layout.first_row :] + first.rest
    rows = [r for r in map(layout.row, body) if len(r) == layout.width]
    if layout.absolute:
        good = [parse([r[place] for r in rows], form) != NAT for place, form in layout.time]
        rows = [r for r, *fine in zip(rows, *good, strict=True) if all(fine)]
    columns, decimal = find_columns(layout.header.names, layout.header.units, rows, layout.time_columns, first.whole)
    decimal = (source.table or {}).get("decimal") or decimal
    if not columns:
        raise FormatError("no column beside the time", where=path.name, expected="values", got=str(layout.width))
    told = quality.pairs(columns, rows[:2000])
    text = set(source.options.get("text") or ()) | quality.words(columns, rows, told)
    columns = tuple(Column(c.place, c.name, c.unit, "str") if c.name in text else c for c in columns)
    utc = (
        any(
            form.pattern is not None
            and (m := form.pattern.fullmatch(rows[0][place])) is not None
            and bool(m.groupdict().get("z"))
            for place, form in layout.time
        )
        if rows
        else False
    )
    return Plan(first, layout, columns, decimal, utc, told)


def describe(path: Path, source: Source) -> Recording:
    """Signals, clock and start of a file, by samples of it."""
    found = plan(path, source)
    layout, first = found.layout, found.sample
    notes = [first.note] if first.note else []
    start = end = None
    for line in first.head[layout.first_row :]:
        if layout.absolute and (start := _ns(layout, line)) is not None:
            break
    for line in reversed((first.rest or first.head)[-50:]):
        if layout.absolute and (end := _ns(layout, line)) is not None:
            break
    if start is not None and not found.utc:
        import numpy as np

        times = np.array([start, max(start, end or start)], "int64").view("datetime64[ns]")
        utc, decided = local_to_utc_ns(times, source.timezone)
        notes += decided
        shift = [int(t) - int(u) for t, u in zip(times.astype("int64"), utc, strict=True)]
        if shift[0] != shift[1]:
            notes.append(
                f"daylight saving of {source.timezone} changes in this file; rows of a repeated hour are told "
                "apart by their order"
            )
        start = int(utc[0])
    if layout.absolute and start is None:
        start = 0 if not first.head[layout.first_row :] else start
    if any(name.startswith("column ") for name in (c.name for c in found.columns)):
        notes.append("columns without a name are called by their place")
    if any("#" in c.name and c.name.rsplit("#", 1)[-1].isdigit() for c in found.columns):
        notes.append("names that repeat are numbered: #2, #3, ...")
    ordered = layout.time[0][1].text
    if "DD/MM" in ordered or "MM/DD" in ordered:
        notes.append(f"dates read as {ordered}")
    cut = not first.ends_with_newline and not _whole(first, layout.delimiter)
    return Recording(
        tuple(Signal(c.name, STREAM, c.unit, c.dtype) for c in found.columns),
        "absolute" if layout.absolute else "relative",
        start if layout.absolute else 0,
        False if cut else None,
        tuple(notes),
    )


def _ns(layout: Layout, line: str) -> int | None:
    ns = layout.row_ns(layout.row(line))
    return None if ns == NAT else ns


def _whole(first: Sample, delimiter: str) -> bool:
    lines = first.head if first.whole else first.rest
    return len(lines) < 2 or last_line_is_whole(lines[-1], lines[-2], delimiter)


def locate(path: Path, source: Source, stream: str, row: int) -> str | None:
    """The line of a row."""
    return line_of(blocks(path, source), stream, row)


def blocks(path: Path, source: Source) -> Iterator[Block | Loss]:
    """The rows in chunks of the file, and a loss for each part that does not read."""
    from thermodata_reader_cnc.rows import RowReader

    found = plan(path, source)
    reader = RowReader(path.name, path.stat().st_size, found, source.timezone)
    for chunk in chunks(path, found.sample.encoding):
        for item in reader.read(_without_header(chunk, found.layout.first_row)):
            yield quality.flagged(item, found.quality) if found.quality and isinstance(item, Block) else item
        if reader.stopped:
            break
    yield from reader.losses.rest()


def _without_header(chunk: Chunk, first_row: int) -> Chunk:
    if chunk.line >= first_row:
        return chunk
    at = 0
    for _ in range(first_row - chunk.line):
        at = chunk.data.find(b"\n", at) + 1
        if at == 0:
            return Chunk(b"", first_row, chunk.size, chunk.last)
    odd = tuple(line for line in chunk.odd if line >= first_row)
    return Chunk(chunk.data[at:], first_row, chunk.size, chunk.last, odd)
