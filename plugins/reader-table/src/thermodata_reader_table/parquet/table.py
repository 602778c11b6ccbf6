"""An open Parquet file: its columns, which of them is the time, and the times."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np

from thermodata.errors import FormatError, QuestionError
from thermodata.plugin import Source
from thermodata.reader.text import split_unit
from thermodata.reader.text.clocks.counts_of_seconds import ask_what_counts
from thermodata.reader.text.clocks.table_time import time_of
from thermodata.reader.text.clocks.time_columns import column as find_column
from thermodata.reader.text.clocks.time_columns import find_time
from thermodata.reader.text.clocks.time_groups import one_time
from thermodata.reader.text.names.header import unique
from thermodata.reader.text.names.time_header import is_time_header, unit_of_time
from thermodata.reader.text.page.counted_from import counted_from
from thermodata.reader.text.page.find_groups import period_s
from thermodata.reader.text.times import in_memory
from thermodata.reader.text.times.date_parts import find_parts
from thermodata.reader.text.times.in_memory import times_of_numbers
from thermodata.reader.times.open_questions import UNKNOWN, unanswered, unit_question
from thermodata.reader.times.time_units import EPOCHS, SECONDS, check_unit, found_epoch, known_unit, to_ns, with_step
from thermodata_reader_table.parquet.columns import nanoseconds, numbers
from thermodata_reader_table.parquet.day_and_clock import as_cells, clock_beside, joined, texts
from thermodata_reader_table.parquet.field_metadata import said_of_fields, said_of_file, units_of
from thermodata_reader_table.parquet.footer_check import check_footer
from thermodata_reader_table.parquet.schema import check_types, column_at, flat, left_out, value_type

_ROWS = 1_000_000  # whose times are read at once


@contextmanager
def damage_as_format_error(path: Path) -> Iterator[None]:
    """pyarrow raises several unrelated classes for a damaged file; all of them mean the same."""
    import pyarrow as pa

    try:
        yield
    except (pa.ArrowException, OSError, ValueError, OverflowError, MemoryError, KeyError, IndexError) as error:
        raise FormatError(
            "not a readable Parquet file", where=path.name, got=(str(error).splitlines() or ["?"])[0]
        ) from None


def _is_text(kind: Any) -> bool:
    import pyarrow.types as pt

    return bool(pt.is_string(value_type(kind)) or pt.is_large_string(value_type(kind)))


class Table:
    """An open file: its schema, and which columns hold the time."""

    def __init__(self, path: Path, source: Source) -> None:
        import pyarrow.parquet as pq

        self.path, self.source = path, source
        with damage_as_format_error(path):
            # of pages that have a checksum
            self.file = pq.ParquetFile(path, page_checksum_verification=True)
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
            raise FormatError("no column of numbers, text or times", where=path.name)
        period = one_time(source.table, path.name).get("period")
        self.period = None if period is None else period_s(period, path.name)
        self.time: int | None = None
        self.unit: str | None = None
        self.beside: tuple[int, ...] = ()  # columns that hold the rest of the time: its time of day, its parts
        self.form: str | None = one_time(source.table, path.name).get("format")
        if self.period is None:
            self.time, self.unit = self._find()

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

    def _find(self) -> tuple[int, str | None]:
        """The time column and its unit: None for timestamps, dates and text. QuestionError where nothing tells it."""
        import pyarrow.types as pt

        said = one_time(self.source.table, self.path.name)
        wanted, unit = said.get("column"), said.get("unit")
        others = list(wanted[1:]) if isinstance(wanted, list | tuple) else []
        if isinstance(wanted, list | tuple):
            wanted = wanted[0]
        self.beside = tuple(find_column(w, self.names, self.path.name) for w in others)
        if wanted == UNKNOWN and UNKNOWN not in self.names:
            raise unanswered("time.column", "the name of the column of times", self.path.name)
        if wanted is not None:
            column = find_column(wanted, self.names, self.path.name)
            if self.beside:
                return column, None
        else:
            stamped = [i for i, f in enumerate(self.schema) if pt.is_timestamp(f.type)]
            spans = [i for i, f in enumerate(self.schema) if pt.is_duration(f.type)]
            if stamped or spans:
                column = self._one_of(stamped or spans)
            elif "t_ns" in self.names:
                column, unit = self.names.index("t_ns"), "ns"
            else:
                column = self._of_cells(said, self.units)
            kind = self.schema.field(column).type
            if self.beside:
                return column, None
            if pt.is_timestamp(kind) or pt.is_date(kind) or _is_text(kind):
                clock = clock_beside(column, self.names, self._first_rows(), self.path.name)
                self.beside = () if clock is None else (clock,)
        kind = self.schema.field(column).type
        if pt.is_timestamp(kind) or pt.is_date(kind) or pt.is_time(kind) or _is_text(kind):
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
        found = next(self.batches(1000), None)
        cells = None if found is None else found.column(column)
        whole = cells is not None and pt.is_integer(kind)  # which may be longer than a float64 tells
        values = np.zeros(0) if cells is None else cells.drop_null().to_numpy() if whole else numbers(cells)
        name, text = self.names[column], with_step(unit)
        if unit is None:
            text = with_step(self._unit_said(column) or unit_of_time(name))
            of_file = said_of_file(self.file.schema_arrow.metadata, self.names)
            stated, notes = counted_from(name, values, text, (self.said[column], of_file), self.path.name)
            self.notes += notes
            text = stated or self._by_size(column, text, values)
            ask_what_counts(name, values, text, self.path.name)
        if text is None:
            text = found_epoch(values)
            if text is None:
                raise unit_question(name, values, self.path.name)
            self.notes.append(f"time column '{name}' has no unit: by its size it is {text}")
        return column, check_unit(str(text), self.path.name)

    def _unit_said(self, column: int) -> str | None:
        """The unit in a time's name, or in its metadata; what is no unit of time there is told."""
        said = self.units[column]
        if said is not None and split_unit(self.names[column])[1] is None and known_unit(said) is None:
            self.notes.append(f"'{self.names[column]}': its metadata say '{said}', which is no unit of time: not used")
            return None
        return said

    def _by_size(self, column: int, unit: str | None, values: Any) -> str | None:
        """What metadata say of counts from a date by their size is the step of that count: 's' of Unix times."""
        epoch = None if split_unit(self.names[column])[1] is not None else found_epoch(values)
        same = unit is not None and epoch is not None and SECONDS.get(known_unit(unit) or "") == EPOCHS[epoch].seconds
        return epoch if same else unit

    def _of_cells(self, said: Mapping[str, Any], units: list[str | None]) -> int:
        """The first column of a time that no type tells, found as in a table of text: with the others that a time of
        words or in parts takes, and how these are written. QuestionError, FormatError: as `time_of`."""
        import pyarrow.types as pt

        rows = self._first_rows()
        try:
            found = find_time(self.names, units, rows, self.path.name)[0]
        except FormatError:
            found = None
        kind = None if found is None else self.schema.field(found).type
        # numbers are told by more rows than these
        if found is not None and not (_is_text(kind) or pt.is_date(kind) or find_parts(self.names, rows)):
            return found
        time = time_of(said, self.names, units, rows, self.path.name)
        self.beside, self.form = time.columns[1:], self.form or time.form
        self.notes += time.notes
        return time.columns[0]

    def _first_rows(self) -> list[list[Any]]:
        """Cells of the first rows."""
        with damage_as_format_error(self.path):
            head = next(self.batches(100), None)
            return [list(r) for r in zip(*map(as_cells, head.columns), strict=True)] if head else []

    def _one_of(self, columns: list[int]) -> int:
        """The time among columns of times: the only one, or the one that is called so. FormatError for others."""
        called = [i for i in columns if is_time_header(self.names[i])]
        if len(columns) == 1 or len(called) == 1:
            return (called or columns)[0]
        names = [self.names[i] for i in called or columns]
        raise QuestionError(
            "several columns of times",
            where=self.path.name,
            got=", ".join(names),
            expected="one, or one of them that is called time",
            hint=f"declare table: {{time: {{column: {names[0]}}}}}",
            ask=f"which column is the time: {' or '.join(names)}?",
            declare={"time": {"column": UNKNOWN}},
            meanwhile={"time": {"column": names[0]}},
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
            values = column.to_numpy() if pt.is_integer(kind) and not column.null_count else numbers(column)
            return times_of_numbers(values, self.unit, self.source.timezone)
        if not (pt.is_timestamp(kind) or pt.is_date(kind)):
            return in_memory.times_of_texts(texts(column), self.source.timezone, self.form, self.path.name)
        zone = getattr(kind, "tz", None)
        naive = nanoseconds(column.cast(pa.timestamp("ns", zone)))
        if zone is not None:
            return in_memory.Stamps(naive, True, ())
        return in_memory.times_of_dates(naive.view("datetime64[ns]"), self.source.timezone)

    def dtype(self, column: int) -> str:
        """numpy's name; integers and bool of a column that has missing values are float64."""
        import pyarrow.types as pt

        kind = self.schema.field(column).type
        if pt.is_floating(kind):
            return {"float": "float32", "halffloat": "float16"}.get(str(kind), "float64")
        if pt.is_integer(kind) or pt.is_boolean(kind):
            with damage_as_format_error(self.path):
                complete = self._complete(column)
            if not complete:
                return "float64"
            return "bool" if pt.is_boolean(kind) else str(kind)
        if pt.is_decimal(kind):
            return "float64"
        return "str"

    def columns(self) -> list[tuple[int, str, str]]:
        """(number, name, dtype) of those beside the time."""
        return [(i, n, self.dtype(i)) for i, n in enumerate(self.names) if i not in (self.time, *self.beside)]

    def _complete(self, column: int) -> bool:
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
