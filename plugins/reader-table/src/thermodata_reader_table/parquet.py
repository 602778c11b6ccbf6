"""Parquet: typed columns, read by row group."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from thermodata.errors import FormatError
from thermodata.plugin import Array, Block, Int1D, Loss, Recording, Signal, Source
from thermodata.reader.text import split_unit
from thermodata.reader.text.layout import unique
from thermodata.reader.text.time_columns import column as find_column
from thermodata.reader.text.time_columns import find_time
from thermodata.reader.text.time_formats import times_of_numbers
from thermodata.reader.text.time_groups import one_time
from thermodata.reader.time_units import check_unit, found_epoch
from thermodata.reader.zone import NAT
from thermodata_reader_table import stamps

STREAM = "table"
_ROWS = 250_000


@contextmanager
def _ours(path: Path) -> Iterator[None]:
    """pyarrow raises several unrelated classes for a damaged file; all of them mean the same."""
    import pyarrow as pa

    try:
        yield
    except (pa.ArrowException, OSError, ValueError, OverflowError, MemoryError, KeyError, IndexError) as error:
        raise FormatError(
            "not a readable Parquet file", where=path.name, got=(str(error).splitlines() or ["?"])[0]
        ) from None


def _check_types(file: Any) -> None:
    """ValueError where a column chunk is not of the type that the schema says: Arrow ends the process on it."""
    for group in range(file.metadata.num_row_groups):
        row_group = file.metadata.row_group(group)
        if row_group.num_columns != len(file.schema):
            raise ValueError(f"row group {group} has {row_group.num_columns} columns, the schema {len(file.schema)}")
        for column in range(row_group.num_columns):
            said, kind = file.schema.column(column).physical_type, row_group.column(column).physical_type
            if said != kind:
                raise ValueError(f"row group {group} column {column} is of {kind}, the schema says {said}")


class Table:
    """An open file: its schema, and which columns hold the time."""

    def __init__(self, path: Path, source: Source) -> None:
        import pyarrow.parquet as pq

        self.path, self.source = path, source
        with _ours(path):
            self.file = pq.ParquetFile(path)
            self.schema = self.file.schema_arrow
            self.schema, self.places = _flat(self.schema)
            _check_types(self.file)
        twice = [n for n, k in Counter(self.places).items() if k > 1]
        if twice:
            raise FormatError(
                "two columns of one name, which Parquet's own readers mix up",
                where=path.name,
                got=twice[0],
                hint="write the file again with names of their own",
            )
        self.names = unique([str(n).strip() for n in self.schema.names])
        self.notes = _left_out(self.file.schema_arrow)
        if not self.names:
            raise FormatError("no column of numbers, text or times", where=path.name)
        self.time, self.unit = self._find()

    def batches(self, rows: int, columns: list[str] | None = None) -> Iterator[Any]:
        """Tables with one column a signal, structs taken apart; FormatError where a damaged part is met."""
        import pyarrow as pa

        wanted = list(dict.fromkeys(place.split(".")[0] for place in self.places)) if columns is None else columns
        with _ours(self.path):
            for batch in self.file.iter_batches(rows, columns=wanted):
                yield pa.table(
                    [_at(batch, place) for place in self.places if place.split(".")[0] in wanted],
                    names=[str(i) for i, place in enumerate(self.places) if place.split(".")[0] in wanted],
                )

    def _find(self) -> tuple[int, str | None]:
        """The time column and its unit: None for timestamps, dates and text."""
        import pyarrow.types as pt

        said = one_time(self.source.table, self.path.name)
        wanted, unit = said.get("column"), said.get("unit")
        if isinstance(wanted, list):
            wanted = wanted[0]
        units = [split_unit(n)[1] for n in self.names]
        if wanted is not None:
            column = find_column(wanted, self.names, self.path.name)
        else:
            stamped = [i for i, f in enumerate(self.schema) if pt.is_timestamp(f.type)]
            spans = [i for i, f in enumerate(self.schema) if pt.is_duration(f.type)]
            if stamped or spans:
                column = [*stamped, *spans][0]
            elif "t_ns" in self.names:
                column, unit = self.names.index("t_ns"), "ns"
            else:
                with _ours(self.path):
                    head = next(self.batches(100), None)
                    rows = [list(r) for r in zip(*(c.to_pylist() for c in head.columns), strict=True)] if head else []
                column = find_time(self.names, units, rows, self.path.name)[0]
        if pt.is_timestamp(self.schema.field(column).type):
            return column, None
        kind = self.schema.field(column).type
        if pt.is_date(kind) or pt.is_string(_plain(kind)) or pt.is_large_string(_plain(kind)):
            return column, None
        if not (pt.is_integer(kind) or pt.is_floating(kind) or pt.is_decimal(kind) or pt.is_duration(kind)):
            raise FormatError(
                f"'{self.names[column]}' is no time",
                where=self.path.name,
                got=str(kind),
                expected="timestamps, dates, text or numbers",
            )
        if pt.is_duration(kind):
            return column, "duration"
        text = unit or units[column]
        if text is None:
            found = next(self.batches(1000), None)
            values = np.zeros(0) if found is None else _numbers(found.column(column))
            text = found_epoch(values) or "s"
            self.notes.append(
                f"time column '{self.names[column]}' has no unit: "
                + ("taken as seconds" if text == "s" else f"by its size it is {text}")
            )
        return column, check_unit(str(text), self.path.name)

    def times(self, column: Any) -> stamps.Stamps:
        """Times of the time column, or of a part of it. Local times want the whole column: the order of all its
        rows tells the hour that repeats."""
        import pyarrow as pa
        import pyarrow.types as pt

        kind = self.schema.field(self.time).type
        if self.unit == "duration":
            return stamps.Stamps(_ns(column.cast(pa.duration("ns"))), False, ())
        if self.unit is not None:
            values = column.to_numpy() if pt.is_integer(kind) and not column.null_count else _numbers(column)
            return times_of_numbers(values, self.unit, self.source.timezone)
        if not (pt.is_timestamp(kind) or pt.is_date(kind)):
            form = one_time(self.source.table, self.path.name).get("format")
            return stamps.parse([str(v or "") for v in column.to_pylist()], self.source.timezone, form, self.path.name)
        zone = getattr(kind, "tz", None)
        naive = _ns(column.cast(pa.timestamp("ns", zone)))
        if zone is not None:
            return stamps.Stamps(naive, True, ())
        return stamps.local_stamps(naive.view("datetime64[ns]"), self.source.timezone)

    def dtype(self, column: int) -> str:
        """numpy's name; integers and bool of a column that has missing values are float64."""
        import pyarrow.types as pt

        kind = self.schema.field(column).type
        if pt.is_floating(kind):
            return {"float": "float32", "halffloat": "float16"}.get(str(kind), "float64")
        if pt.is_integer(kind) or pt.is_boolean(kind):
            with _ours(self.path):
                complete = self._complete(column)
            if not complete:
                return "float64"
            return "bool" if pt.is_boolean(kind) else str(kind)
        if pt.is_decimal(kind):
            return "float64"
        return "str"

    def _complete(self, column: int) -> bool:
        meta, place = self.file.metadata, self.places[column]
        for number in range(meta.num_row_groups):
            group = meta.row_group(number)
            leaf = next(
                (group.column(i) for i in range(group.num_columns) if group.column(i).path_in_schema == place), None
            )
            statistics = None if leaf is None else leaf.statistics
            if statistics is None or not statistics.has_null_count or statistics.null_count:
                return False
        return True


def _plain(kind: Any) -> Any:
    """The type of a dictionary's values."""
    import pyarrow.types as pt

    return kind.value_type if pt.is_dictionary(kind) else kind


def _flat(schema: Any) -> tuple[Any, list[str]]:
    """The schema with structs taken apart, and the path of each column; lists and maps are left out."""
    import pyarrow as pa
    import pyarrow.types as pt

    fields: list[Any] = []
    places: list[str] = []

    def add(field: Any, place: str, name: str, depth: int) -> None:
        if pt.is_struct(field.type) and depth < 8:
            for inner in field.type:
                add(inner, f"{place}.{inner.name}", f"{name}/{inner.name}", depth + 1)
        elif not pt.is_nested(field.type):
            fields.append(pa.field(name, field.type))
            places.append(place)

    for field in schema:
        add(field, field.name, field.name, 0)
    return pa.schema(fields), places


def _left_out(schema: Any) -> list[str]:
    import pyarrow.types as pt

    names = [f.name for f in schema if pt.is_nested(f.type) and not pt.is_struct(f.type)]
    return [f"columns of lists are not read: {', '.join(names[:8])}"] if names else []


def _at(batch: Any, place: str) -> Any:
    """A column, or a part of a struct; a name may itself hold dots."""
    import pyarrow.compute as pc

    if place in batch.schema.names:
        return batch.column(batch.schema.names.index(place))
    first, *rest = place.split(".")
    column = batch.column(batch.schema.names.index(first))
    for name in rest:
        column = pc.struct_field(column, name)
    return column


def _numbers(column: Any) -> Array:
    import pyarrow as pa

    return np.asarray(column.cast(pa.float64()).to_numpy(), np.float64)


def _ns(column: Any) -> Int1D:
    """Nanoseconds of timestamps or durations; NAT where there is none."""
    import pyarrow as pa

    found: Int1D = column.cast(pa.int64()).fill_null(int(NAT)).to_numpy().astype(np.int64)
    return found


def describe(path: Path, source: Source) -> Recording:
    table = Table(path, source)
    head = next(table.batches(1000), None)
    nothing = stamps.Stamps(np.zeros(0, np.int64), False, ())
    with _ours(path):
        found = nothing if head is None else table.times(head.column(table.time))
    good = found.t_ns[found.t_ns != NAT]
    signals = tuple(
        Signal(n, STREAM, split_unit(n)[1], table.dtype(i)) for i, n in enumerate(table.names) if i != table.time
    )
    start = (int(good[0]) if good.size else 0) if found.absolute else None
    return Recording(signals, "absolute" if found.absolute else "relative", start, True, (*table.notes, *found.notes))


def blocks(path: Path, source: Source) -> Iterator[Block | Loss]:
    table = Table(path, source)
    import pyarrow as pa

    top = table.places[table.time].split(".")[0]
    kept = [b.column(str(table.time)) for b in table.batches(_ROWS, [top])]
    with _ours(path):
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
        with _ours(path):
            values = {name: _values(batch.column(i), dtype)[good] for i, name, dtype in columns}
        yield Block(STREAM, t_ns[good], values)
    if missing:
        yield Loss(path.name, None, None, missing / at, f"{missing} rows without a time")


def _values(column: Any, dtype: str) -> Array:
    if dtype == "float64":
        return _numbers(column)
    if dtype == "str":
        return np.array(["" if v is None else str(v) for v in column.to_pylist()], object)
    return np.asarray(column.to_numpy(zero_copy_only=False)).astype(dtype)
