"""Which column of a Parquet file is the time, and in what unit: declared, or by types, names, metadata and values."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from thermodata.errors import FormatError, QuestionError
from thermodata.reader.text import split_unit
from thermodata.reader.text.cells.first_rows import FirstRows
from thermodata.reader.text.clocks.counts_of_seconds import ask_what_counts
from thermodata.reader.text.clocks.table_time import time_of
from thermodata.reader.text.clocks.time_columns import column as find_column
from thermodata.reader.text.clocks.time_columns import find_time
from thermodata.reader.text.names.time_header import is_time_header, unit_of_time
from thermodata.reader.text.page.timed.counted_from import counted_from
from thermodata.reader.text.times.several_cells.date_parts import find_parts
from thermodata.reader.times.open_questions import UNKNOWN, unanswered, unit_question
from thermodata.reader.times.time_units import EPOCHS, SECONDS, check_unit, found_epoch, known_unit, with_step
from thermodata_reader_table.parquet.columns import numbers
from thermodata_reader_table.parquet.day_and_clock import clock_beside
from thermodata_reader_table.parquet.field_metadata import said_of_file
from thermodata_reader_table.parquet.schema import value_type


@dataclass(frozen=True)
class Columns:
    """What a file says of its columns. schema: pyarrow's, of as many fields; units: by names or metadata; said: what
    the metadata of each say; metadata: of the file; head: its first rows, so many, as a pyarrow Table whose columns
    stand in this order, None of a file without rows; cells: of the first rows."""

    where: str
    names: list[str]
    schema: Any
    units: list[str | None]
    said: Sequence[Mapping[str, str]]
    metadata: Mapping[bytes, bytes] | None
    head: Callable[[int], Any]
    cells: Callable[[], list[list[Any]]]

    def seen(self) -> FirstRows:
        """Its first rows, as those of a table of text."""
        return FirstRows(self.names, self.units, self.cells(), self.where)


@dataclass(slots=True)
class FoundTime:
    """column: that holds the time, from 0; unit: of numbers, 'duration' of spans, None of timestamps, dates and texts;
    beside: columns that hold the rest of the time: its time of day, its parts; form: how texts are written, None where
    they tell; notes: what a user is told of it."""

    column: int
    unit: str | None
    form: str | None
    beside: tuple[int, ...] = ()
    notes: list[str] = field(default_factory=list)


def find_time_column(columns: Columns, said: Mapping[str, Any]) -> FoundTime:
    """said: what is declared of the time. QuestionError where nothing tells it, or it can be read in two ways;
    FormatError for a declared column of another type."""
    found = _declared_time(columns, said) if said.get("column") is not None else _found_time(columns, said)
    kind = columns.schema.field(found.column).type
    if found.beside or _is_moment(kind):
        found.unit = None
    else:
        found.unit = _unit(columns, found, kind)
    return found


def _declared_time(columns: Columns, said: Mapping[str, Any]) -> FoundTime:
    wanted = said["column"]
    first, others = (wanted[0], wanted[1:]) if isinstance(wanted, list | tuple) else (wanted, ())
    beside = tuple(find_column(w, columns.names, columns.where) for w in others)
    if first == UNKNOWN and UNKNOWN not in columns.names:
        raise unanswered("time.column", "the name of the column of times", columns.where)
    return FoundTime(find_column(first, columns.names, columns.where), said.get("unit"), said.get("format"), beside)


def _found_time(columns: Columns, said: Mapping[str, Any]) -> FoundTime:
    """By the types of the columns, or else as in a table of text."""
    import pyarrow.types as pt

    stamped = [i for i, f in enumerate(columns.schema) if pt.is_timestamp(f.type)]
    spans = [i for i, f in enumerate(columns.schema) if pt.is_duration(f.type)]
    if stamped or spans:
        found = FoundTime(_one_of(columns, stamped or spans), said.get("unit"), said.get("format"))
    elif "t_ns" in columns.names:
        found = FoundTime(columns.names.index("t_ns"), "ns", said.get("format"))
    else:
        found = _of_cells(columns, said)
    kind = columns.schema.field(found.column).type
    if not found.beside and _is_moment(kind) and not pt.is_time(kind):
        clock = clock_beside(found.column, columns.seen())
        found.beside = () if clock is None else (clock,)
    return found


def _of_cells(columns: Columns, said: Mapping[str, Any]) -> FoundTime:
    """The first column of a time that no type tells, found as in a table of text: with the others that a time of
    words or in parts takes, and how these are written. QuestionError, FormatError: as `time_of`."""
    import pyarrow.types as pt

    seen = columns.seen()
    try:
        found = find_time(seen)[0]
    except FormatError:
        found = None
    kind = None if found is None else columns.schema.field(found).type
    # numbers are told by more rows than these
    if found is not None and not (_is_text(kind) or pt.is_date(kind) or find_parts(seen)):
        return FoundTime(found, said.get("unit"), said.get("format"))
    time = time_of(said, seen)
    form = said.get("format") or time.form
    return FoundTime(time.columns[0], said.get("unit"), form, time.columns[1:], [*time.notes])


def _one_of(columns: Columns, places: list[int]) -> int:
    """The time among columns of times: the only one, or the one that is called so. FormatError for others."""
    called = [i for i in places if is_time_header(columns.names[i])]
    if len(places) == 1 or len(called) == 1:
        return (called or places)[0]
    names = [columns.names[i] for i in called or places]
    raise QuestionError(
        "several columns of times",
        where=columns.where,
        got=", ".join(names),
        expected="one, or one of them that is called time",
        hint=f"declare table: {{time: {{column: {names[0]}}}}}",
        ask=f"which column is the time: {' or '.join(names)}?",
        declare={"time": {"column": UNKNOWN}},
        meanwhile={"time": {"column": names[0]}},
    )


def _unit(columns: Columns, found: FoundTime, kind: Any) -> str:
    """The unit of a time in numbers or spans. kind: its type."""
    import pyarrow.types as pt

    name, where = columns.names[found.column], columns.where
    if not (pt.is_integer(kind) or pt.is_floating(kind) or pt.is_decimal(kind) or pt.is_duration(kind)):
        raise FormatError(
            f"'{name}' is no time",
            where=where,
            got=str(kind),
            expected="timestamps, dates, text or numbers",
            hint="name another column: table: {time: {column: NAME}}",
        )
    if pt.is_duration(kind):
        return "duration"
    head = columns.head(1000)
    cells = None if head is None else head.column(found.column)
    whole = cells is not None and pt.is_integer(kind)  # which may be longer than a float64 tells
    values = np.zeros(0) if cells is None else cells.drop_null().to_numpy() if whole else numbers(cells)
    unit = with_step(found.unit)
    if found.unit is None:
        unit = with_step(_unit_said(columns, found) or unit_of_time(name))
        of_file = said_of_file(columns.metadata, columns.names)
        stated, notes = counted_from(name, values, unit, (columns.said[found.column], of_file), where)
        found.notes += notes
        unit = stated or _by_size(name, unit, values)
        ask_what_counts(name, values, unit, where)
    if unit is None:
        unit = found_epoch(values)
        if unit is None:
            raise unit_question(name, values, where)
        found.notes.append(f"time column '{name}' has no unit: by its size it is {unit}")
    return check_unit(str(unit), where)


def _unit_said(columns: Columns, found: FoundTime) -> str | None:
    """The unit in a time's name, or in its metadata; what is no unit of time there is told."""
    said, name = columns.units[found.column], columns.names[found.column]
    if said is not None and split_unit(name)[1] is None and known_unit(said) is None:
        found.notes.append(f"'{name}': its metadata say '{said}', which is no unit of time: not used")
        return None
    return said


def _by_size(name: str, unit: str | None, values: Any) -> str | None:
    """What metadata say of counts from a date by their size is the step of that count: 's' of Unix times."""
    epoch = None if split_unit(name)[1] is not None else found_epoch(values)
    same = unit is not None and epoch is not None and SECONDS.get(known_unit(unit) or "") == EPOCHS[epoch].seconds
    return epoch if same else unit


def _is_moment(kind: Any) -> bool:
    """Whether a type is one of timestamps, dates, times of day or texts: of none that counts in a unit."""
    import pyarrow.types as pt

    return bool(pt.is_timestamp(kind) or pt.is_date(kind) or pt.is_time(kind)) or _is_text(kind)


def _is_text(kind: Any) -> bool:
    import pyarrow.types as pt

    return bool(pt.is_string(value_type(kind)) or pt.is_large_string(value_type(kind)))
