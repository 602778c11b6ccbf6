"""Parquet: typed columns, read by row group."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from thermodata.errors import FormatError
from thermodata.plugin import Array, Block, Loss, Recording, Signal, Source
from thermodata.reader.text import split_unit
from thermodata.reader.zone import NAT
from thermodata_reader_table import stamps
from thermodata_reader_table.clocks import SECONDS
from thermodata_reader_table.layout import _find_time
from thermodata_reader_table.layout import column as find_column

STREAM = "table"
_ROWS = 250_000
_PER_SECOND = {"s": 1, "ms": 10**3, "us": 10**6, "ns": 10**9}


@contextmanager
def _ours(path: Path) -> Iterator[None]:
    """pyarrow raises several unrelated classes for a damaged file; all of them mean the same."""
    import pyarrow as pa

    try:
        yield
    except (pa.ArrowException, OSError, ValueError, OverflowError) as error:
        raise FormatError("not a readable Parquet file", where=path.name,
                          got=(str(error).splitlines() or ["?"])[0]) from None


class Table:
    """An open file: its schema, and which columns hold the time."""

    def __init__(self, path: Path, source: Source) -> None:
        import pyarrow.parquet as pq

        self.path, self.source = path, source
        with _ours(path):
            self.file = pq.ParquetFile(path)
            self.schema = self.file.schema_arrow
        self.names = [str(n).strip() for n in self.schema.names]
        self.notes: list[str] = []
        self.time, self.seconds = self._find()

    def batches(self, rows: int) -> Iterator[Any]:
        """Record batches; FormatError where a damaged part is met."""
        with _ours(self.path):
            yield from self.file.iter_batches(rows)

    def _find(self) -> tuple[int, float | None]:
        import pyarrow.types as pt

        said = (self.source.table or {}).get("time") or {}
        wanted, unit = said.get("column"), said.get("unit")
        if isinstance(wanted, list):
            wanted = wanted[0]
        units = [split_unit(n)[1] for n in self.names]
        if wanted is not None:
            column = find_column(wanted, self.names, self.path.name)
        else:
            stamped = [i for i, f in enumerate(self.schema) if pt.is_timestamp(f.type)]
            if stamped:
                column = stamped[0]
            elif "t_ns" in self.names:
                column, unit = self.names.index("t_ns"), "ns"
            else:
                head = next(self.batches(100), None)
                rows = [list(r.values()) for r in head.to_pylist()] if head is not None else []
                column = _find_time(self.names, units, rows, self.path.name)[0]
        if pt.is_timestamp(self.schema.field(column).type):
            return column, None
        text = unit or units[column]
        if text is None:
            text = "s"
            self.notes.append(f"time column '{self.names[column]}' has no unit: taken as seconds")
        if text not in SECONDS:
            raise FormatError(f"unknown unit of time '{text}'", where=self.path.name, expected=", ".join(SECONDS))
        return column, SECONDS[text]

    def times(self, column: Any) -> stamps.Stamps:
        """Times of the time column, or of a part of it. Local times want the whole column: the order of all its
        rows tells the hour that repeats."""
        kind = self.schema.field(self.time).type
        if self.seconds is not None:
            if self.seconds == 1e-9 and str(kind) == "int64":
                return stamps.Stamps(column.to_numpy(zero_copy_only=False).astype(np.int64), False, ())
            seconds = np.asarray(column.to_numpy(zero_copy_only=False), np.float64) * self.seconds
            good = np.isfinite(seconds) & (np.abs(seconds) < 9e9)
            t_ns = np.full(seconds.size, NAT, np.int64)
            t_ns[good] = np.rint(seconds[good] * 1e9).astype(np.int64)
            return stamps.Stamps(t_ns, False, ())
        naive = column.to_numpy(zero_copy_only=False).astype("datetime64[ns]")
        if kind.tz is not None:
            return stamps.Stamps(naive.view(np.int64), True, ())
        return stamps.local_stamps(naive, self.source.timezone)

    def dtype(self, column: int) -> str:
        """numpy's name; integers and bool of a column that has missing values are float64."""
        import pyarrow.types as pt

        kind = self.schema.field(column).type
        if pt.is_floating(kind):
            return {"float": "float32", "halffloat": "float16"}.get(str(kind), "float64")
        if pt.is_integer(kind) or pt.is_boolean(kind):
            if not self._complete(column):
                return "float64"
            return "bool" if pt.is_boolean(kind) else str(kind)
        if pt.is_decimal(kind):
            return "float64"
        return "str"

    def _complete(self, column: int) -> bool:
        meta = self.file.metadata
        for group in range(meta.num_row_groups):
            statistics = meta.row_group(group).column(column).statistics
            if statistics is None or not statistics.has_null_count or statistics.null_count:
                return False
        return True


def describe(path: Path, source: Source) -> Recording:
    table = Table(path, source)
    head = next(table.batches(1000), None)
    nothing = stamps.Stamps(np.zeros(0, np.int64), table.seconds is None, ())
    found = nothing if head is None else table.times(head.column(table.time))
    good = found.t_ns[found.t_ns != NAT]
    signals = tuple(Signal(n, STREAM, split_unit(n)[1], table.dtype(i))
                    for i, n in enumerate(table.names) if i != table.time)
    start = (int(good[0]) if good.size else 0) if found.absolute else None
    return Recording(signals, "absolute" if found.absolute else "relative", start, True, (*table.notes, *found.notes))


def blocks(path: Path, source: Source) -> Iterator[Block | Loss]:
    table = Table(path, source)
    with _ours(path):
        column = table.file.read(columns=[table.schema.names[table.time]]).column(0)
    times = table.times(column).t_ns
    at = missing = 0
    columns = [(i, n, table.dtype(i)) for i, n in enumerate(table.names) if i != table.time]
    size = max(1, int(source.options.get("block_rows", min(_ROWS, 1_000_000 // len(table.names)))))
    for batch in table.batches(size):
        t_ns = times[at:at + batch.num_rows]
        good = t_ns != NAT
        at += batch.num_rows
        missing += int((~good).sum())
        values = {name: _values(batch.column(i), dtype)[good] for i, name, dtype in columns}
        yield Block(STREAM, t_ns[good], values)
    if missing:
        yield Loss(path.name, None, None, missing / at, f"{missing} rows without a time")


def _values(column: Any, dtype: str) -> Array:
    if dtype == "str":
        return np.array(["" if v is None else str(v) for v in column.to_pylist()], object)
    return np.asarray(column.to_numpy(zero_copy_only=False)).astype(dtype)
