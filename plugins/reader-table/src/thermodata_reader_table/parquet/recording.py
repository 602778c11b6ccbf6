"""Parquet: what describe() and blocks() say of a file, read by row group."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from thermodata.plugin import Block, Loss, Recording, Signal, Source
from thermodata.reader.series import TakenApart
from thermodata.reader.text import split_unit
from thermodata.reader.zone import NAT
from thermodata.schema.counted import counted
from thermodata_reader_table.parquet.columns import values_of
from thermodata_reader_table.parquet.table import Table, damage_as_format_error

STREAM = "table"
_ROWS = 250_000


def describe(path: Path, source: Source) -> Recording:
    """The one stream of a file, or that of each of its series. FormatError: damaged, no time, or a long table that
    can't be taken apart."""
    from thermodata_reader_table.parquet.row_series import series_of

    table = Table(path, source)
    apart = series_of(table)
    found = table.stamps(1000)
    good = found.t_ns[found.t_ns != NAT]
    signals = tuple(
        Signal(n, STREAM, split_unit(n)[1], table.dtype(i))
        for i, n in enumerate(table.names)
        if i not in (table.time, *table.beside)
    )
    signals = signals if apart.series is None else apart.series.signals(signals)
    start = (int(good[0]) if good.size else 0) if found.absolute else None
    return Recording(
        signals, "absolute" if found.absolute else "relative", start, True, (*table.notes, *found.notes, *apart.notes)
    )


def blocks(path: Path, source: Source) -> Iterator[Block | Loss]:
    """The values as stored, times in ns since 1970 UTC (or since the start), and rows that have no time as a loss."""
    from thermodata_reader_table.parquet.row_series import series_of

    table = Table(path, source)
    series = series_of(table).series
    if series is None:
        yield from _rows(table)
        return
    apart = TakenApart(series, path.name)
    for item in _rows(table):
        yield from apart.split(item)
    yield from apart.rest()


def _rows(table: Table) -> Iterator[Block | Loss]:
    source, path = table.source, table.path
    times = table.stamps().t_ns
    at = missing = 0
    columns = [(i, n, table.dtype(i)) for i, n in enumerate(table.names) if i not in (table.time, *table.beside)]
    size = max(1, int(source.options.get("block_rows", min(_ROWS, 1_000_000 // len(table.names)))))
    for batch in table.batches(size):
        t_ns = times[at : at + batch.num_rows]
        good = t_ns != NAT
        rows = at + np.flatnonzero(good)
        at += batch.num_rows
        missing += int((~good).sum())
        with damage_as_format_error(path):
            values = {name: values_of(batch.column(i), dtype)[good] for i, name, dtype in columns}
        yield Block(STREAM, t_ns[good], values, at=rows)
    if missing:
        yield Loss(path.name, None, None, missing / at, f"{counted(missing, 'row')} without a time")
