"""Rows of a delimited table that are of several series: found in the first look at the file, or refused."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from thermodata.plugin import Block, Int1D, Source
from thermodata.reader.signals.series import Declaration, FoundSeries, Series, find_series
from thermodata.reader.text.cells.lines.delimiter import fields
from thermodata.reader.text.cells.values.quotes import clean
from thermodata.reader.text.file.lines import Chunk
from thermodata.reader.text.tables.blocks.table_rows import RowReader
from thermodata.reader.text.tables.long_rows import refuse_long
from thermodata.reader.text.tables.table import Table

_HEAD, _REST = 2000, 8000  # lines that are looked at,
_MOST_CELLS, _FEWEST = 400_000, 100  # of fewer where they are long
_MOST_COLUMNS = 200  # a table of more has a column a signal


def with_series(table: Table, source: Source) -> Table:
    """The table with the series of its rows. FormatError for a long table that cannot be taken apart: relative times
    that begin anew for each name may be of one series or of tests that follow each other."""
    width = len(table.layout.names)
    declared = Declaration.of((source.table or {}).get("series"))
    if len(table.groups) > 1 or (width > _MOST_COLUMNS and not declared.columns):
        return table
    parts = list(_parts(table, max(_FEWEST, _MOST_CELLS // width)))
    # the zone moves all times alike
    reader = RowReader(table, Source(table=source.table), 1)
    blocks: list[Block] = []
    pieces: list[int] = []
    for number, (first, lines) in enumerate(parts):
        for item in reader.read(Chunk("\n".join((*lines, "")).encode(), first, 0, True)):
            if isinstance(item, Block):
                blocks.append(item)
                pieces += [number] * item.t_ns.size
    found = _series(blocks, np.array(pieces, np.int64), table.absolute, declared)
    if found.series is None and declared.columns is None:
        lines = [line for _, part in parts for line in part]
        rows = [[clean(c) for c in fields(line, table.delimiter, table.quoted)] for line in lines]
        refuse_long(table.layout.names, [r for r in rows if len(r) == width], table.name, table.layout.time)
    taken = found.series is not None and _takes_units(found.series)
    own = (note for note in table.notes if not taken or note != table.units_told)
    return replace(table, series=found.series, notes=(*own, *found.notes))


def _takes_units(series: Series) -> bool:
    """Whether a column of units is taken in each series that has it."""
    columns = {said.column for said in series.units.values()}
    return bool(columns) and all(one in series.units for one, held in series.held.items() if columns & held)


def _parts(table: Table, most: int) -> Iterator[tuple[int, Sequence[str]]]:
    """(number of the first, lines) of each part of the file that is looked at, which stand behind each other there."""
    first, sample = table.layout.first, table.sample
    head = sample.head[first : first + min(_HEAD, most)]
    yield first, head
    line = first + len(head)
    each = min(_REST, most) // max(1, len(sample.pieces))
    at = 0
    for size in sample.pieces:
        yield line, sample.rest[at : at + min(size, each)]
        at, line = at + size, line + size


def _series(blocks: list[Block], pieces: Int1D, absolute: bool, declared: Declaration) -> FoundSeries:
    if not blocks:
        return FoundSeries()
    one = blocks[0]
    values = {k: np.concatenate([b.values[k] for b in blocks]) for k in one.values}
    flags = {
        k: np.concatenate([(b.flags or {}).get(k, np.zeros(b.t_ns.size, np.uint16)) for b in blocks])
        for k in one.values
    }
    whole = Block(one.stream, np.concatenate([b.t_ns for b in blocks]), values, flags)
    return find_series(whole, absolute=absolute, declared=declared, pieces=pieces)
