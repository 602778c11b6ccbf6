"""Workbooks (XLSX): refused where they would unpack to something absurd, then read by calamine.

A sheet is a table, or a note. Where several are tables and none is declared, each is a stream of its name, and its
signals are `sheet/name`.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Literal

import numpy as np

from thermodata.errors import FormatError
from thermodata.plugin import Block, Loss, Recording, Scaling, Signal, Source
from thermodata.reader.signals.series import Declaration
from thermodata.reader.text.cells.time_forms.time_pattern import DAY_NS
from thermodata.reader.text.page.layout import Layout
from thermodata.reader.text.page.timed.one_clock import one_clock
from thermodata.reader.text.preamble.begin import NOT_TAKEN, ROWS, FirstTimes
from thermodata.reader.text.preamble.together import begin_later_ns
from thermodata.reader.text.times.in_memory import Stamps
from thermodata.reader.times.zone import NAT
from thermodata.schema.words.sentences import counted
from thermodata_reader_table.workbook.book import Book, book_of
from thermodata_reader_table.workbook.follow_on import joined
from thermodata_reader_table.workbook.related import with_related
from thermodata_reader_table.workbook.series import taken_apart
from thermodata_reader_table.workbook.sheet import Stream, Table
from thermodata_reader_table.workbook.sheets import is_small, layouts_of, left_out, of_another_clock

_BLOCK_VALUES = 1_000_000


@dataclass
class Read:
    """All of a workbook that is read."""

    streams: list[Stream]
    notes: list[str]
    losses: list[Loss]
    clock: Literal["absolute", "relative"]
    start_ns: int | None
    of_day_ns: int | None = None


def read(path: Path, source: Source) -> Read:
    """FormatError where no sheet is a table (the reason of the first), or some have dates and others not."""
    book = book_of(path, source)
    tables, notes = layouts_of(book.sheets, source, path.name)
    several, first_note = len(tables) > 1, len(notes)
    read_sheets, found = _streams(path, source, book, tables, notes, start_above=True)
    begun = [sheet for sheet, table in read_sheets.items() if table.begun]
    if begun and len({s.times.absolute for streams in found.values() for s in streams}) > 1:
        notes.append(f"a start stands above the rows of sheet '{begun[0]}' and of no other, {NOT_TAKEN}")
        read_sheets, found = _streams(path, source, book, tables, notes, start_above=False)
    for sheet, table in read_sheets.items():
        notes += [f"sheet '{sheet}': {note}" for note in table.notes] if several else table.notes
    losses = [loss for table in read_sheets.values() for loss in table.losses]
    declared = Declaration.of((source.table or {}).get("series"))
    declared.check([name for streams in found.values() for stream in streams for name in stream.values])
    for sheet, table in read_sheets.items():
        apart = [taken_apart(stream, table.where, sheet if several else None, declared) for stream in found[sheet]]
        found[sheet] = [stream for streams, _, _ in apart for stream in streams]
        notes += [note for _, said, _ in apart for note in said]
        losses += [loss for _, _, lost in apart for loss in lost]
    names = {name for streams in found.values() for s in streams for name in s.values}
    for sheet, table in read_sheets.items():
        plain = len(table.layout.groups) == 1 and not table.layout.groups[0].counted
        for k, stream in enumerate(found[sheet]):
            found[sheet][k], told = with_related(stream, source.table, table.where, told_by_cells=plain, beyond=names)
            notes += told.notes
    for sheet in of_another_clock(found):
        notes.append(f"sheet '{sheet}' is not read: its times are of another kind than those of the other sheets")
        del found[sheet]
    streams = [s for made in found.values() for s in made]
    groups = [g for sheet in found for g in tables[sheet].groups]
    if several:
        whole = joined(found)
        streams, groups = ([whole], groups[:1]) if whole is not None else (streams, groups)
        notes.insert(first_note, _several(list(tables), whole is not None))
    for kind, count in book.odd.items():
        they = "it is" if count == 1 else "they are"
        if count and kind == "hidden":
            notes.append(f"{counted(count, 'hidden row')}: {they} read like the others")
        elif count:
            reason = f"{counted(count, 'cell')} of the workbook {kind}: {they} empty"
            losses.append(Loss(path.name, reason=reason))
    streams, of_day_ns = _on_one_clock(streams)
    clock, start_ns = one_clock([s.times for s in streams], groups, path.name)
    return Read(streams, list(dict.fromkeys(notes)), losses, clock, start_ns, of_day_ns)


def _several(sheets: Sequence[str], go_on: bool) -> str:
    """The note on several sheets that are tables."""
    each = "each a stream; signals are called SHEET/NAME"
    one = "which follow each other without a gap, and are read as one"
    alone = "for one alone declare table: {sheet: ...}: " + ", ".join(sheets)
    return f"{len(sheets)} sheets are tables, {one if go_on else each}; {alone}"


def _on_one_clock(streams: list[Stream]) -> tuple[list[Stream], int | None]:
    """(streams that tell times of day without a date on the clock of the earliest, the time of day of its zero). None
    where they have no one clock, or begin at their zero, as durations do."""
    firsts = [_first_of_day(s.times) for s in streams]
    moved = [replace(s, times=s.times.later(ns)) for s, ns in zip(streams, begin_later_ns(firsts), strict=True)]
    zeros = {s.times.zero_ns % DAY_NS for s in moved}
    told = len(zeros) == 1 and all(first is not None and not first.near_zero for first in firsts)
    return moved, zeros.pop() if told else None


def _first_of_day(times: Stamps) -> FirstTimes | None:
    good = times.t_ns[times.t_ns != NAT][:ROWS]
    return FirstTimes(tuple((good + times.zero_ns).tolist()), True) if times.of_day and good.size else None


def _streams(
    path: Path, source: Source, book: Book, layouts: Mapping[str, Layout], notes: list[str], start_above: bool
) -> tuple[dict[str, Table], dict[str, list[Stream]]]:
    """(the table, the streams) of each sheet, without summaries in which the declared time reads nothing. start_above:
    whether a start that stands above its rows counts; notes: take what is said of these."""
    tables: dict[str, Table] = {}
    found: dict[str, list[Stream]] = {}
    several = len(layouts) > 1
    for sheet, layout in layouts.items():
        where = f"{path.name} sheet '{sheet}'" if several else path.name
        table = Table(book.sheets[sheet], layout, where, source, start_above)
        try:
            found[sheet] = list(table.streams(sheet if several else None))
        except FormatError as error:
            if not (source.table or {}).get("time") or not is_small(sheet, layouts, book.sheets):
                raise
            notes.append(left_out(sheet, error))
        else:
            tables[sheet] = table
    return tables, found


def describe(path: Path, source: Source) -> Recording:
    found = read(path, source)
    signals = tuple(
        Signal(
            name,
            s.name,
            s.units[name],
            "str" if v.dtype == object else "float64",
            Scaling("linear", {"gain": 100.0, "offset": 0.0}) if name in s.percent else None,
            s.said[name],
            held=name in s.held,
        )
        for s in found.streams
        for name, v in s.values.items()
    )
    return Recording(signals, found.clock, found.start_ns, None, tuple(found.notes), found.of_day_ns)


def blocks(path: Path, source: Source) -> Iterator[Block | Loss]:
    found = read(path, source)
    if not any((s.times.t_ns != NAT).any() for s in found.streams):
        raise FormatError(
            "no row holds a time", where=path.name, hint="declare table: {time: {column: ..., unit: ...}}"
        )
    for stream in found.streams:
        t_ns = stream.times.t_ns
        good = t_ns != NAT
        size = max(1, int(source.options.get("block_rows", _BLOCK_VALUES // max(1, len(stream.values)))))
        for first in range(0, t_ns.size, size):
            rows = np.arange(first, min(first + size, t_ns.size))[good[first : first + size]]
            flags = {name: flag[rows] for name, flag in stream.flags.items()}
            values = {name: v[rows] for name, v in stream.values.items()}
            yield Block(stream.name, t_ns[rows], values, flags or None, stream.at[rows])
        if not good.all():
            bad = int((~good).sum())
            where = path.name if len(found.streams) == 1 else f"{path.name} {stream.name}"
            yield Loss(where, None, None, bad / t_ns.size, f"{counted(bad, 'row')} without a time")
    yield from found.losses


def locate(path: Path, source: Source, stream: str, row: int) -> str | None:
    """`sheet 'data', row 813` of a row (counted from 0) of a stream; None where there is no such row."""
    for held in read(path, source).streams:
        if held.name == stream:
            rows = np.flatnonzero(held.times.t_ns != NAT)
            return held.place(int(rows[row])) if row < rows.size else None
    return None
