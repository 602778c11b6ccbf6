"""Workbooks (XLSX): refused where they would unpack to something absurd, then read by calamine.

A sheet is a table, or a note. Where several are tables and none is declared, each is a stream of its name, and its
signals are `sheet/name`.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np

from thermodata.errors import FormatError, QuestionError, ThermodataError
from thermodata.plugin import Block, Loss, Recording, Scaling, Signal, Source
from thermodata.reader.signals.series import Declaration
from thermodata.reader.text.page.layout import Layout, find_layout
from thermodata.reader.text.page.on_its_side import refuse_sideways
from thermodata.reader.text.page.one_clock import one_clock
from thermodata.reader.text.preamble.begin import NOT_TAKEN
from thermodata.reader.times.zone import NAT
from thermodata.schema.words.sentences import counted
from thermodata_reader_table.workbook.book import Book, book_of
from thermodata_reader_table.workbook.related import with_related
from thermodata_reader_table.workbook.series import taken_apart
from thermodata_reader_table.workbook.sheet import Stream, Table

_BLOCK_VALUES = 1_000_000


@dataclass
class Read:
    """All of a workbook that is read."""

    streams: list[Stream]
    notes: list[str]
    losses: list[Loss]
    clock: Literal["absolute", "relative"]
    start_ns: int | None


def read(path: Path, source: Source) -> Read:
    """FormatError where no sheet is a table (the reason of the first), or some have dates and others not."""
    book = book_of(path, source)
    tables, notes = _layouts(path, source, book)
    several = len(tables) > 1
    if several:
        notes.append(
            f"{len(tables)} sheets are tables, each a stream; signals are called SHEET/NAME; for one alone "
            "declare table: {sheet: ...}: " + ", ".join(tables)
        )
    read_sheets, found = _streams(path, source, book, tables, start_above=True)
    begun = [sheet for sheet, table in read_sheets.items() if table.begun]
    if begun and len({s.times.absolute for streams in found.values() for s in streams}) > 1:
        notes.append(f"a start stands above the rows of sheet '{begun[0]}' and of no other, {NOT_TAKEN}")
        read_sheets, found = _streams(path, source, book, tables, start_above=False)
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
    for sheet in _of_another_clock(found):
        notes.append(f"sheet '{sheet}' is not read: its times are of another kind than those of the other sheets")
        del found[sheet]
    streams = [s for made in found.values() for s in made]
    groups = [g for sheet in found for g in tables[sheet].groups]
    for kind, count in book.odd.items():
        they = "it is" if count == 1 else "they are"
        if count and kind == "hidden":
            notes.append(f"{counted(count, 'hidden row')}: {they} read like the others")
        elif count:
            reason = f"{counted(count, 'cell')} of the workbook {kind}: {they} empty"
            losses.append(Loss(path.name, reason=reason))
    clock, start_ns = one_clock([s.times for s in streams], groups, path.name)
    return Read(streams, list(dict.fromkeys(notes)), losses, clock, start_ns)


def _layouts(path: Path, source: Source, book: Book) -> tuple[dict[str, Layout], list[str]]:
    """(how each sheet that is a table lies, notes on the others); the reason of the first where none is, and what one
    leaves open."""
    tables: dict[str, Layout] = {}
    refused: dict[str, ThermodataError] = {}
    for sheet, cells in book.sheets.items():
        where = f"{path.name} sheet '{sheet}'"
        try:
            if not (source.table or {}).get("time"):
                refuse_sideways(cells.rows, where)
            tables[sheet] = find_layout(cells.rows[:500], source.table, where)
        except ThermodataError as error:
            refused[sheet] = _naming(sheet, error) if len(book.sheets) > 1 else error
    # a list of numbers may be no recording; a time without its unit is one, but for a summary beside dates
    dated = max((len(book.sheets[s].rows) for s, t in tables.items() if t.of_dates), default=0)
    open_ = {s: e for s, e in refused.items() if isinstance(e, QuestionError) and 2 * len(book.sheets[s].rows) > dated}
    asked = [e for e in open_.values() if "period" not in e.declare.get("time", {})]
    if asked or not tables:
        raise next(iter(asked or refused.values()))
    return tables, [f"sheet '{s}' is not read as a table: {e.what}" for s, e in refused.items()]


def _streams(
    path: Path, source: Source, book: Book, layouts: Mapping[str, Layout], start_above: bool
) -> tuple[dict[str, Table], dict[str, list[Stream]]]:
    """(the table, the streams) of each sheet. start_above: whether a start that stands above its rows counts."""
    tables: dict[str, Table] = {}
    found: dict[str, list[Stream]] = {}
    several = len(layouts) > 1
    for sheet, layout in layouts.items():
        where = f"{path.name} sheet '{sheet}'" if several else path.name
        tables[sheet] = Table(book.sheets[sheet], layout, where, source, start_above)
        found[sheet] = list(tables[sheet].streams(sheet if several else None))
    return tables, found


def _naming(sheet: str, error: ThermodataError) -> ThermodataError:
    """A question of a sheet among several says which one leaves it."""
    if not isinstance(error, QuestionError):
        return error
    return QuestionError(
        error.what,
        where=error.where,
        expected=error.expected,
        got=error.got,
        hint=error.hint,
        ask=f"sheet '{sheet}': {error.ask}",
        declare=error.declare,
        meanwhile=error.meanwhile,
        times=error.times,
    )


def _of_another_clock(found: Mapping[str, Sequence[Stream]]) -> list[str]:
    """The few sheets with dates beside many that count from a start, or the other way: a list of tests with their days
    is no recording. None where they are no small minority: then nobody can tell which are meant."""
    kinds = {sheet: {s.times.absolute for s in streams if s.times.t_ns.size} for sheet, streams in found.items()}
    few, many = sorted(([s for s, kind in kinds.items() if kind == {dated}] for dated in (True, False)), key=len)
    return few if len(few) + len(many) == len(kinds) and len(many) >= max(3, 2 * len(few)) else []


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
    return Recording(signals, found.clock, found.start_ns, None, tuple(found.notes))


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
            at = held.at[held.times.t_ns != NAT]
            return f"sheet '{held.sheet}', row {at[row]}" if row < at.size else None
    return None
