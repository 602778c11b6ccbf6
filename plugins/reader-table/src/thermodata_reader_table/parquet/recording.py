"""Parquet: what describe() and blocks() say of a file, read by row group."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from thermodata.plugin import Block, Loss, Recording, Signal, Source
from thermodata.reader.text import split_unit, time_formats
from thermodata.reader.zone import NAT
from thermodata_reader_table.parquet.columns import values_of
from thermodata_reader_table.parquet.table import Table, damage_as_format_error

STREAM = "table"
_ROWS = 250_000


def describe(path: Path, source: Source) -> Recording:
    """The one stream of a file, by its schema and first rows. FormatError: damaged, or no time."""
    table = Table(path, source)
    head = next(table.batches(1000), None)
    nothing = time_formats.Stamps(np.zeros(0, np.int64), False, ())
    with damage_as_format_error(path):
        found = nothing if head is None else table.times(head.column(table.time))
    good = found.t_ns[found.t_ns != NAT]
    signals = tuple(
        Signal(n, STREAM, split_unit(n)[1], table.dtype(i)) for i, n in enumerate(table.names) if i != table.time
    )
    start = (int(good[0]) if good.size else 0) if found.absolute else None
    return Recording(signals, "absolute" if found.absolute else "relative", start, True, (*table.notes, *found.notes))


def blocks(path: Path, source: Source) -> Iterator[Block | Loss]:
    """The values as stored, times in ns since 1970 UTC (or since the start), and rows that have no time as a loss."""
    table = Table(path, source)
    import pyarrow as pa

    top = table.places[table.time].split(".")[0]
    kept = [b.column(str(table.time)) for b in table.batches(_ROWS, [top])]
    with damage_as_format_error(path):
        column = pa.chunked_array([c for k in kept for c in k.chunks], table.schema.field(table.time).type)
        times = table.times(column).t_ns
    at = missing = 0
    columns = [(i, n, table.dtype(i)) for i, n in enumerate(table.names) if i != table.time]
    size = max(1, int(source.options.get("block_rows", min(_ROWS, 1_000_000 // len(table.names)))))
    for batch in table.batches(size):
        t_ns = times[at : at + batch.num_rows]
        good = t_ns != NAT
        at += batch.num_rows
        missing += int((~good).sum())
        with damage_as_format_error(path):
            values = {name: values_of(batch.column(i), dtype)[good] for i, name, dtype in columns}
        yield Block(STREAM, t_ns[good], values)
    if missing:
        yield Loss(path.name, None, None, missing / at, f"{missing} rows without a time")
