"""A table in delimited text, described and read: the one way for every reader of such text.

A control's export, a logger's CSV, a spreadsheet saved as text: `table` looks at it, `table_rows` reads its rows.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from thermodata.errors import FormatError
from thermodata.plugin import Block, Int1D, Loss, Recording, Signal, Source
from thermodata.reader.signals.row_units import UNIT_OF
from thermodata.reader.signals.taken_apart import TakenApart
from thermodata.reader.text.cells.lines.delimiter import fields, parted_bytes
from thermodata.reader.text.cells.lines.named_values import all_in_columns
from thermodata.reader.text.cells.lines.stamped_lines import all_with_stamp
from thermodata.reader.text.cells.values.quotes import clean
from thermodata.reader.text.file.lines import Chunk, chunks
from thermodata.reader.text.names.described import names_at
from thermodata.reader.text.names.unit_column import in_one_unit
from thermodata.reader.text.preamble.begin import anew_note
from thermodata.reader.text.preamble.scales_said import SCALES_BELOW, lone_scales, scales_said
from thermodata.reader.text.preamble.units_said import HEAD, units_said
from thermodata.reader.text.preamble.ways_said import WAY, ways_said
from thermodata.reader.text.rows.event_line import event_notes
from thermodata.reader.text.rows.footer import footer_notes
from thermodata.reader.text.tables.blocks.table_rows import RowReader
from thermodata.reader.text.tables.find_table import open_table
from thermodata.reader.text.tables.table import Table
from thermodata.reader.text.times.local_clock import DayCount
from thermodata.reader.text.times.several_cells.days_without_year import yearless_note
from thermodata.reader.times.repeated_hour import repeated_hour
from thermodata.reader.times.time_units import EPOCHS
from thermodata.reader.times.zone import local_to_utc_ns, skipped_notes, skips_between, utc_offset_ns

__all__ = ["Table", "blocks", "describe", "open_table", "signals"]

_FIRST_ROWS, _LAST_LINES = 500, 20
_CUT = "the last line has no end and may be cut"


def signals(table: Table) -> tuple[Signal, ...]:
    """The signals of a table, in the order of its columns."""
    names, units = table.layout.names, table.layout.units
    stands = table.stands if table.series is None else frozenset[int]()
    heads = _stated_by_column(table)
    found = tuple(
        Signal(
            names[i],
            timed.stream,
            units[i],
            kind,
            properties=_said_of(table, i, heads),
            held=i in stands,
        )
        for timed in table.groups
        for i in timed.group.columns
        if (kind := table.kinds[i]) is not None
    )
    if table.series is not None:
        return table.series.signals(found)
    told = (*table.paired, *([table.unit] if table.unit else []))

    def with_unit(signal: Signal) -> Signal:
        for one in told:
            if signal.name == one.column:
                return replace(signal, properties={**signal.properties, UNIT_OF: one.of})
            if signal.name == one.of:
                return replace(signal, unit=one.unit)
        return signal

    return tuple(map(with_unit, found))


def _said_of(table: Table, column: int, heads: Mapping[str, Mapping[str, str]]) -> dict[str, str]:
    """heads: what lines above the names say of units and of scales."""
    name = table.layout.names[column]
    return {**table.layout.said_of(column), **table.qualities.properties(name), **heads.get(name, {})}


def _stated_by_column(table: Table) -> Mapping[str, Mapping[str, str]]:
    """Name of a column -> what lines above the names, and the first below them, state of its unit and scale."""
    names, first = table.layout.names, table.layout.first
    lines = table.sample.head[: first + SCALES_BELOW]
    rows = [[clean(c) for c in fields(line, table.delimiter, table.quoted)] for line in lines]
    above = rows[: names_at(rows[:first], names)]
    # a first row of channels names the columns, too, and scales stand between it and the last that does
    last = max((k for k in range(first) if names_at(rows[k : k + 1], names) == 0), default=0)
    found = {n: dict(said) for n, said in scales_said([*rows[:last], *rows[first:]], names).items()}
    for name, line in units_said(above, names).items():
        found.setdefault(name, {})[HEAD] = line
    for name, line in ways_said(rows[:first], names).items():
        found.setdefault(name, {})[WAY] = line
    return found


def describe(table: Table, source: Source) -> Recording:
    """Signals, clock and start; FormatError where some of its times are dates and others count from their start."""
    absolute = {timed.absolute for timed in table.groups}
    if len(absolute) > 1:
        raise FormatError(
            "some times are dates and others count from their start",
            where=table.name,
            got=", ".join(f"{g.stream}: {'dates' if g.absolute else 'relative'}" for g in table.groups),
            expected="one kind in a source",
            hint="declare one time: table: {time: {column: ...}}, and a second source for the others",
        )
    notes = list(table.notes)
    head = table.sample.head[: table.layout.first]
    above = [[clean(c) for c in fields(line, table.delimiter, table.quoted)] for line in head]
    notes += lone_scales(above, table.layout.names)
    start = of_day = None
    if table.absolute or any(timed.of_day for timed in table.groups):
        reader = RowReader(table, source, 1)
        first = table.layout.first
        data = "\n".join((*table.sample.head[first : first + _FIRST_ROWS], "")).encode()
        starts = [int(b.t_ns[0]) for b in reader.read(Chunk(data, first, 0, True)) if isinstance(b, Block)]
        if table.absolute:
            start = min(starts, default=0)
            notes += _zone_notes(table, source, start)
        elif len(zeros := {group.clock.zero_ns for group in reader.groups}) == 1:
            of_day = zeros.pop()
    if table.begin is not None:
        notes += [b.note() for b in (g.begin for g in table.groups) if b is not None] or [table.begin.note()]
    else:
        notes += _of_day_notes(table, source)
    if table.begin is not None or not table.absolute:
        notes += _notes_of_counts(table, source)
    ends = (table.sample.rest or table.sample.head)[-_LAST_LINES:]
    notes += footer_notes([clean(c) for c in fields(line, table.delimiter, table.quoted)] for line in ends)
    below = [
        [clean(c) for c in fields(x, table.delimiter, table.quoted)] for x in table.sample.head[table.layout.first :]
    ]
    texts = [kind == "str" for kind in table.kinds]
    notes += event_notes(below, texts, table.layout.first + 1, table.sample.whole)
    if table.cut:
        notes.append(_CUT)
    return Recording(
        signals(table),
        "absolute" if table.absolute else "relative",
        start,
        False if table.cut else None,
        tuple(dict.fromkeys(notes)),
        of_day,
    )


def _notes_of_counts(table: Table, source: Source) -> list[str]:
    """What is told of rows that count from a start, as far as the file was sampled: further heads with a start of their
    own, and a counter that begins anew."""
    reader = RowReader(table, source, 1)
    notes: dict[str, None] = {}
    for some in (table.sample.head[table.layout.first :], table.sample.rest):
        # what it met on the way stands in the reader
        deque(reader.read(Chunk("\n".join((*some, "")).encode(), 0, 0, True)), maxlen=0)
        notes.update(dict.fromkeys(map(anew_note, reader.anew)))
    timed = [(c.timed.group.time, c.counter) for c in (group.clock for group in reader.groups)]
    return [*notes] + [note for time, c in timed if time and (note := c.note(table.layout.names[time[0]])) is not None]


def _of_day_notes(table: Table, source: Source) -> list[str]:
    """What is told of times of day: from where they count, or that a day beside them lacks its year."""
    found = []
    for timed in (timed for timed in table.groups if timed.of_day):
        head = table.sample.head[table.layout.first : table.layout.first + _LAST_LINES]
        rows = [[clean(c) for c in fields(line, table.delimiter, table.quoted)] for line in head if line.strip()]
        declared = (source.table or {}).get("time")
        said = (table.layout.names, table.layout.units)
        yearless = None if declared else yearless_note(*said, rows, timed.group.time[0], table.name)
        found.append(yearless or DayCount.note(timed.formats[0].cycle_ns))
    return found


def _zone_notes(table: Table, source: Source, start: int) -> list[str]:
    """What the zone of local times had to decide; whether a line above the rows says another one than is declared, and
    whether daylight saving changes between first and last row."""
    timed = table.groups[0]
    epoch = EPOCHS.get(timed.group.epoch or "")
    utc = epoch is not None and not epoch.local
    if timed.zoned or utc or (table.begin is not None and not table.begin.local):
        return []
    if timed.stated is not None:
        said = [] if source.timezone in (None, timed.stated) else [f"the declared {source.timezone} is not used"]
        if timed.above:
            return [f"times in {timed.stated} by a line above the rows: '{timed.above[:60]}'"]
        names = "', '".join(table.layout.names[i] for i in timed.group.time)
        return ["; ".join([f"times in {timed.stated} by their header '{names}'", *said])]
    if source.timezone is None:
        return local_to_utc_ns(np.array([start], np.int64).view("datetime64[ns]"), None)[1]
    last = _local_times(table, source, (table.sample.rest or table.sample.head)[-50:])
    ends = [int(t_ns[-1]) for t_ns in last]
    before, after = (utc_offset_ns(source.timezone, ns // 10**9) for ns in (start, max([start, *ends])))
    hour = repeated_hour(source.timezone, start)
    if hour is not None and all(ns < hour.at_ns + hour.summer_ns for ns in ends):
        after = before  # all rows lie in one of its passes, and those at the end were read without their zone
    notes = []
    if table.zone is not None and {before, after} != {utc_offset_ns(table.zone[0], start // 10**9)}:
        notes.append(f"the line above the rows says '{table.zone[1][:60]}'; the declared {source.timezone} is used")
    if table.begin is not None and not table.begin.of_day:  # seconds from a start skip and repeat no hour
        return notes
    lines = [*table.sample.head[table.layout.first :], *table.sample.rest]
    near = skips_between(source.timezone, start, max([start, *ends]))
    local = _local_times(table, source, lines) if near else []
    skipped = skipped_notes(np.concatenate(local), source.timezone) if local else []
    notes += skipped
    if before != after and not skipped:
        how = (
            "rows of the repeated hour are told apart by their order" if after < before else "it skips an hour, no row"
        )
        notes.append(f"daylight saving of {source.timezone} changes in this file; {how}")
    return notes


def _local_times(table: Table, source: Source, lines: Sequence[str]) -> list[Int1D]:
    """The times of lines, block by block, as if they were UTC."""
    reader = RowReader(table, Source(table=source.table), 1)
    chunk = Chunk("\n".join((*lines, "")).encode(), 0, 0, True)
    return [b.t_ns for b in reader.read(chunk) if isinstance(b, Block) and b.t_ns.size]


def blocks(path: Path, table: Table, source: Source) -> Iterator[Block | Loss]:
    """The rows in chunks of the file, and a loss for each part that does not read."""
    rows = _rows(path, table, source)
    if table.series is None:
        for one in table.paired:
            rows = in_one_unit(rows, one, table.name, whole=True)
        yield from rows if table.unit is None else in_one_unit(rows, table.unit, table.name)
        return
    apart = TakenApart(table.series, table.name)
    for item in rows:
        yield from apart.split(item)
    yield from apart.rest()


def _rows(path: Path, table: Table, source: Source) -> Iterator[Block | Loss]:
    reader = RowReader(table, source, path.stat().st_size)
    for chunk in chunks(path, table.sample.encoding):
        if table.named:
            chunk = replace(chunk, data=all_in_columns(chunk.data, table.named))
        if table.schedules is not None:
            chunk = replace(chunk, data=table.schedules.all_parted(chunk.data))
        if table.stamped:
            chunk = replace(chunk, data=all_with_stamp(chunk.data, table.stamped))
        if table.blanks:
            parted = parted_bytes if table.columns is None else table.columns.parted_bytes
            chunk = replace(chunk, data=parted(chunk.data))
        yield from reader.read(_without_header(chunk, table.layout.first))
        if reader.stopped:
            break
    yield from reader.losses.rest()
    yield from reader.sixty.told(table.name)


def _without_header(chunk: Chunk, first: int) -> Chunk:
    if chunk.line >= first:
        return chunk
    at = 0
    for _ in range(first - chunk.line):
        at = chunk.data.find(b"\n", at) + 1
        if at == 0:
            return Chunk(b"", first, chunk.size, chunk.last)
    odd = tuple(line for line in chunk.odd if line >= first)
    return Chunk(chunk.data[at:], first, chunk.size, chunk.last, odd)
