"""Rows of a delimited table that are of several series: found in the first look at the file, or refused."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from thermodata.plugin import Block, Source
from thermodata.reader.series import Series, find_series
from thermodata.reader.text.delimiter import fields
from thermodata.reader.text.lines import Chunk
from thermodata.reader.text.long_rows import refuse_long
from thermodata.reader.text.number import clean
from thermodata.reader.text.table import Table
from thermodata.reader.text.table_rows import RowReader

_HEAD, _REST = 2000, 8000  # lines that are looked at,
_MOST_CELLS, _FEWEST = 400_000, 100  # of fewer where they are long
_MOST_COLUMNS = 200  # a table of more has a column a signal


def with_series(table: Table, source: Source) -> Table:
    """The table with the series of its rows. FormatError for a long table that cannot be taken apart: relative times
    that begin anew for each name may be of one series or of tests that follow each other."""
    width = len(table.layout.names)
    if len(table.groups) > 1 or width > _MOST_COLUMNS:
        return table
    first, most = table.layout.first, max(_FEWEST, _MOST_CELLS // width)
    lines = (*table.sample.head[first : first + min(_HEAD, most)], *table.sample.rest[: min(_REST, most)])
    # the zone moves all times alike
    reader = RowReader(table, Source(table=source.table), 1)
    blocks = [b for b in reader.read(Chunk("\n".join((*lines, "")).encode(), first, 0, False)) if isinstance(b, Block)]
    series = _series(blocks, table.absolute)
    if series is None:
        rows = [[clean(c) for c in fields(line, table.delimiter, table.quoted)] for line in lines]
        refuse_long(table.layout.names, [r for r in rows if len(r) == width], table.name, table.layout.time)
        return table
    return replace(table, series=series, notes=(*table.notes, series.note()))


def _series(blocks: list[Block], absolute: bool) -> Series | None:
    if not blocks:
        return None
    one = blocks[0]
    values = {k: np.concatenate([b.values[k] for b in blocks]) for k in one.values}
    flags = {
        k: np.concatenate([(b.flags or {}).get(k, np.zeros(b.t_ns.size, np.uint16)) for b in blocks])
        for k in one.values
    }
    whole = Block(one.stream, np.concatenate([b.t_ns for b in blocks]), values, flags)
    return find_series(whole, absolute=absolute)
