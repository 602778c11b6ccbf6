"""Parquet: what describe() and blocks() say of a file, read by row group."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from thermodata.plugin import Block, Bool1D, Loss, Recording, Signal, Source
from thermodata.reader.signals.row_units import UNIT_OF, UnitColumn
from thermodata.reader.signals.taken_apart import TakenApart
from thermodata.reader.text.names.unit_column import in_one_unit
from thermodata.reader.times.zone import NAT
from thermodata.reader.typed_columns import Columns, Related, Relating, related, rows_looked_at, unit_in_rows
from thermodata.schema.words.sentences import counted
from thermodata_reader_table.parquet.columns import values_of
from thermodata_reader_table.parquet.damage import damage_as_format_error
from thermodata_reader_table.parquet.table import Table, open_table

STREAM = "table"
_ROWS = 250_000


def describe(path: Path, source: Source) -> Recording:
    """The one stream of a file, or that of each of its series. FormatError: damaged, no time, or a long table that
    can't be taken apart."""
    with open_table(path, source) as table:
        return _recording(table)


def blocks(path: Path, source: Source) -> Iterator[Block | Loss]:
    """The values as stored, times in ns since 1970 UTC (or since the start), and rows that have no time as a loss."""
    with open_table(path, source) as table:
        yield from _blocks(table)


def _recording(table: Table) -> Recording:
    from thermodata_reader_table.parquet.row_series import series_of

    apart = series_of(table)
    found = table.stamps(1000)
    good = found.t_ns[found.t_ns != NAT]
    told, (unit, unit_note) = (Related(), (None, None)) if apart.series else of_one_series(table)
    signals = tuple(
        Signal(
            n,
            STREAM,
            unit.unit if unit is not None and unit.of == n else table.units[i],
            "float64" if unit is not None and unit.of == n and unit.others else table.dtype(i),
            properties={
                **table.said[i],
                **told.qualities.properties(n),
                **({UNIT_OF: unit.of} if unit is not None and unit.column == n else {}),
            },
            held=n in told.stands,
        )
        for i, n in enumerate(table.names)
        if i not in (table.time, *table.beside)
    )
    signals = signals if apart.series is None else apart.series.signals(signals)
    start = (int(good[0]) if good.size else 0) if found.absolute else None
    return Recording(
        signals,
        "absolute" if found.absolute else "relative",
        start,
        True,
        (*table.notes, *found.notes, *table.notes_of_counts(), *apart.notes, *told.notes, *filter(None, [unit_note])),
    )


def _blocks(table: Table) -> Iterator[Block | Loss]:
    from thermodata_reader_table.parquet.row_series import series_of

    series = series_of(table).series
    if series is None:
        told, (unit, _) = of_one_series(table)
        rows = _rows(table, told, unit)
        yield from rows if unit is None else in_one_unit(rows, unit, table.path.name)
        return
    apart = TakenApart(series, table.path.name)
    for item in _rows(table, Related()):
        yield from apart.split(item)
    yield from apart.rest()


def of_one_series(table: Table) -> tuple[Related, tuple[UnitColumn | None, str | None]]:
    """What the columns of a table, which is of one series, say of each other in its first rows; and which of them says
    the unit of another, with a note."""
    columns = table.columns()
    rows = rows_looked_at(len(columns))
    head = next(table.batches(rows), None)
    if head is None:
        return Related(), (None, None)
    with damage_as_format_error(table.path):
        values = {name: values_of(head.column(i), dtype) for i, name, dtype in columns}
        empty = _empty(head, columns)
    seen = Columns(values, empty, table.stamps(rows).t_ns)
    told = related(table.source.table, seen, table.path.name, told_by_cells=table.time is not None)
    return told, unit_in_rows(values, {name: table.units[i] for i, name, _ in columns})


def _empty(batch: Any, columns: Sequence[tuple[int, str, str]]) -> dict[str, Bool1D]:
    """The cells that hold nothing, of columns that have any: a NaN that was written is none."""
    return {
        name: np.asarray(batch.column(i).is_null().to_numpy(zero_copy_only=False), bool)
        for i, name, _ in columns
        if batch.column(i).null_count
    }


def _rows(table: Table, told: Related, unit: UnitColumn | None = None) -> Iterator[Block | Loss]:
    source, path = table.source, table.path
    times = table.stamps().t_ns
    at = missing = 0
    columns = table.columns()
    relating = Relating(told)
    size = max(1, int(source.options.get("block_rows", min(_ROWS, 1_000_000 // len(table.names)))))
    for batch in table.batches(size):
        t_ns = times[at : at + batch.num_rows]
        good = t_ns != NAT
        rows = at + np.flatnonzero(good)
        at += batch.num_rows
        missing += int((~good).sum())
        with damage_as_format_error(path):
            values = {name: values_of(batch.column(i), dtype)[good] for i, name, dtype in columns}
            empty = {name: nothing[good] for name, nothing in _empty(batch, columns).items()}
        if unit is not None and unit.others:  # what is converted is whole no more
            values[unit.of] = values[unit.of].astype(np.float64)
        values, flags = relating.over(values, {}, empty)
        yield Block(STREAM, t_ns[good], values, flags or None, at=rows)
    if missing:
        yield Loss(path.name, None, None, missing / at, f"{counted(missing, 'row')} without a time")
