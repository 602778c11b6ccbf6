"""An open Parquet file: its columns, which of them is the time, and the times."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np

from thermodata.errors import FormatError
from thermodata.plugin import Array, Source
from thermodata.reader.text.clocks.time_groups import one_time
from thermodata.reader.text.names.header import unique
from thermodata.reader.text.page.timed.find_groups import period_s
from thermodata.reader.text.times import in_memory
from thermodata.reader.text.times.in_memory import times_of_numbers
from thermodata.reader.times.time_units import SECONDS, to_ns
from thermodata.reader.times.wrapped_counter import may_begin_anew
from thermodata_reader_table.parquet.columns import nanoseconds, numbers
from thermodata_reader_table.parquet.damage import damage_as_format_error
from thermodata_reader_table.parquet.day_and_clock import as_cells, is_header, joined, texts
from thermodata_reader_table.parquet.field_metadata import said_of_fields, units_of
from thermodata_reader_table.parquet.footer_check import check_footer
from thermodata_reader_table.parquet.schema import check_types, column_at, flat, left_out
from thermodata_reader_table.parquet.time_column import Columns, find_time_column

_ROWS = 1_000_000  # whose times are read at once


@contextmanager
def open_table(path: Path, source: Source) -> Iterator[Table]:
    """A file, closed at the end of the block. Left to Python it would be closed when nothing refers to it, and a thread
    of Arrow may do so for a while after a reading was given up. FormatError: damaged, or without a time."""
    import pyarrow.parquet as pq

    with damage_as_format_error(path):
        # of pages that have a checksum
        file = pq.ParquetFile(path, page_checksum_verification=True)
    with file:
        yield Table(path, source, file)


class Table:
    """An open file: its schema, and which columns hold the time."""

    def __init__(self, path: Path, source: Source, file: Any) -> None:
        self.path, self.source, self.file = path, source, file
        with damage_as_format_error(path):
            self.schema = self.file.schema_arrow
            self.schema, self.places = flat(self.schema)
            check_footer(path, self.file.schema)
            check_types(self.file)
        twice = [n for n, k in Counter(self.places).items() if k > 1]
        if twice:
            raise FormatError(
                "two columns of one name, which Parquet's own readers mix up",
                where=path.name,
                got="/".join(twice[0]),
                hint="write the file again with names of their own",
            )
        self.names = unique([str(n).strip() for n in self.schema.names])
        self.notes = left_out(self.file.schema_arrow)
        # what the metadata of each column say of it, and its unit by its name or by them
        self.said = said_of_fields(self.schema, self.file.schema_arrow.metadata)
        self.units, others = units_of(self.names, self.said)
        self.notes += others
        if not self.names:
            raise FormatError(
                "no column of numbers, text or times",
                where=path.name,
                hint="write lists and structures as columns of their own",
            )
        period = one_time(source.table, path.name).get("period")
        self.period = None if period is None else period_s(period, path.name)
        self.time: int | None = None
        self.unit: str | None = None
        self.beside: tuple[int, ...] = ()  # columns that hold the rest of the time: its time of day, its parts
        self.form: str | None = None
        if self.period is None:
            self._find_time(one_time(source.table, path.name))

    def _find_time(self, said: Mapping[str, Any]) -> None:
        metadata = self.file.schema_arrow.metadata
        columns = Columns(
            self.path.name, self.names, self.schema, self.units, self.said, metadata, self._head, self._first_rows
        )
        found = find_time_column(columns, said)
        self.time, self.unit, self.beside, self.form = found.column, found.unit, found.beside, found.form
        self.notes += found.notes

    def _head(self, rows: int) -> Any:
        """The first rows, one column a signal; None of a file without any."""
        return next(self.batches(rows), None)

    def _first_rows(self) -> list[list[Any]]:
        """Cells of the first rows."""
        with damage_as_format_error(self.path):
            head = self._head(100)
            rows = zip(*map(as_cells, head.columns), strict=True) if head else ()
            return [list(r) for r in rows if not is_header(r, self.names)]

    def batches(self, rows: int, columns: list[str] | None = None) -> Iterator[Any]:
        """Tables with one column a signal, structs taken apart; FormatError where a damaged part is met."""
        import pyarrow as pa

        wanted = list(dict.fromkeys(place[0] for place in self.places)) if columns is None else columns
        with damage_as_format_error(self.path):
            for batch in self.file.iter_batches(rows, columns=wanted):
                yield pa.table(
                    [column_at(batch, place) for place in self.places if place[0] in wanted],
                    names=[str(i) for i, place in enumerate(self.places) if place[0] in wanted],
                )

    def stamps(self, rows: int | None = None) -> in_memory.Stamps:
        """The times of all rows, or of the first some: by the time column, or counted at the declared period."""
        import pyarrow as pa

        wanted = (self.time or 0, *self.beside)
        tops = [self.places[i][0] for i in wanted]
        batches = self.batches(_ROWS, tops) if rows is None else islice(self.batches(rows, tops), 1)
        kept = [[b.column(str(i)) for i in wanted] for b in batches]
        if self.time is None:
            steps = np.arange(sum(len(k[0]) for k in kept))
            return in_memory.Stamps(to_ns(steps, self.period or 0.0), False, ())
        if not kept:
            return in_memory.Stamps(np.zeros(0, np.int64), False, ())
        with damage_as_format_error(self.path):
            columns = [
                pa.chunked_array([c for k in kept for c in k[n].chunks], self.schema.field(i).type)
                for n, i in enumerate(wanted)
            ]
            if self.beside:
                return joined([self.names[i] for i in wanted], columns, self.source.timezone, self.form, self.path.name)
            return self._times(columns[0])

    def _times(self, column: Any) -> in_memory.Stamps:
        """Times of the time column, or of a part of it. Local times want the whole column: the order of all its
        rows tells the hour that repeats."""
        import pyarrow as pa
        import pyarrow.types as pt

        kind = column.type
        if self.unit == "duration":
            return in_memory.Stamps(nanoseconds(column.cast(pa.duration("ns"))), False, ())
        if self.unit is not None:
            return times_of_numbers(_counts(column), self.unit, self.source.timezone, self.names[self.time or 0])
        if not (pt.is_timestamp(kind) or pt.is_date(kind)):
            return in_memory.times_of_texts(texts(column), self.source.timezone, self.form, self.path.name)
        zone = getattr(kind, "tz", None)
        naive = nanoseconds(column.cast(pa.timestamp("ns", zone)))
        if zone is not None:
            return in_memory.Stamps(naive, True, ())
        return in_memory.times_of_dates(naive.view("datetime64[ns]"), self.source.timezone)

    def notes_of_counts(self) -> tuple[str, ...]:
        """What is told of a time that counts from a start: a counter that begins anew where it is full."""
        if self.time is None or self.beside or self.unit not in SECONDS:
            return ()
        return self.stamps().notes if may_begin_anew(self._first_or_last, self.file.metadata.num_rows) else ()

    def _first_or_last(self, start: int, stop: int) -> Array:
        """Counts of the first rows, or of the last ones, which the last part of the file holds."""
        place = self.places[self.time or 0]
        with damage_as_format_error(self.path):
            if not start:
                return _counts(column_at(next(self.file.iter_batches(stop, columns=[place[0]])), place))
            last = self.file.read_row_group(self.file.num_row_groups - 1, columns=[place[0]])
            return _counts(column_at(last, place))[start - stop :]

    def dtype(self, column: int) -> str:
        """numpy's name; integers and bool of a column that has missing values are float64."""
        import pyarrow.types as pt

        kind = self.schema.field(column).type
        if pt.is_floating(kind):
            return {"float": "float32", "halffloat": "float16"}.get(str(kind), "float64")
        if pt.is_integer(kind) or pt.is_boolean(kind):
            with damage_as_format_error(self.path):
                complete = self._has_no_null(column)
            if not complete:
                return "float64"
            return "bool" if pt.is_boolean(kind) else str(kind)
        if pt.is_decimal(kind):
            return "float64"
        return "str"

    def columns(self) -> list[tuple[int, str, str]]:
        """(number, name, dtype) of those beside the time."""
        return [(i, n, self.dtype(i)) for i, n in enumerate(self.names) if i not in (self.time, *self.beside)]

    def _has_no_null(self, column: int) -> bool:
        meta, place = self.file.metadata, ".".join(self.places[column])
        for number in range(meta.num_row_groups):
            group = meta.row_group(number)
            leaf = next(
                (group.column(i) for i in range(group.num_columns) if group.column(i).path_in_schema == place), None
            )
            statistics = None if leaf is None else leaf.statistics
            if statistics is None or not statistics.has_null_count or statistics.null_count:
                return False
        return True


def _counts(column: Any) -> Array:
    import pyarrow.types as pt

    return column.to_numpy() if pt.is_integer(column.type) and not column.null_count else numbers(column)
