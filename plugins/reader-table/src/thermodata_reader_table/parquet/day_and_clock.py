"""Days and times of day in columns of their own, as DuckDB and Polars write dates (date32) and times (time64)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from thermodata.plugin import Bool1D
from thermodata.reader.text.cells.cell import Cell, is_clocked, is_dated, is_empty, mostly
from thermodata.reader.text.cells.first_rows import FirstRows
from thermodata.reader.text.cells.time_forms.clock_pattern import says_the_hour
from thermodata.reader.text.clocks.odd_clocks import clock_question
from thermodata.reader.text.times.in_memory import Stamps, times_of_dates, times_of_day
from thermodata.reader.text.times.several_cells.date_parts import column_times
from thermodata.reader.text.times.several_cells.days import Days, filled, have_days, is_once
from thermodata.reader.text.times.time_formats import find_formats


def as_cells(column: Any) -> list[Cell]:
    """The values of a column as cells of a table: days are texts without a time of day, and times of day texts."""
    import pyarrow.types as pt

    if pt.is_date(column.type) or pt.is_time(column.type):
        return texts(column)
    cells: list[Cell] = column.to_pylist()
    if pt.is_timestamp(column.type) and column.type.tz is None and _are_days(cells):
        return texts(column)
    return cells


def texts(column: Any) -> list[str]:
    """A column as texts, '' where a value is missing: days as 2026-03-16, times of day as 08:00:00."""
    import pyarrow as pa
    import pyarrow.compute as pc
    import pyarrow.types as pt

    if pt.is_timestamp(column.type):
        column = pc.floor_temporal(column, unit="day").cast(pa.date32())
    if pt.is_date(column.type) or pt.is_time(column.type):
        column = column.cast(pa.string())
    if pt.is_floating(column.type):  # a part of a date, of a column that has gaps
        return ["" if v is None or v != v else str(v).removesuffix(".0") for v in column.to_pylist()]
    return ["" if v is None else str(v) for v in column.to_pylist()]


def is_header(row: Sequence[Cell], names: Sequence[str]) -> bool:
    """Whether the filled cells of a row are the names of their columns, as where a text that goes on under a second
    header was written as Parquet."""
    filled = [(c, name) for c, name in zip(row, names, strict=True) if not is_empty(c)]
    return len(filled) > 1 and all(cell == name for cell, name in filled)


def clock_beside(day: int, seen: FirstRows) -> int | None:
    """The column of times of day beside a column of days; None where there is none. seen: of cells of `as_cells`.

    QuestionError where many rows share a day, and what tells their hour is not read.
    """
    cells = [r[day] for r in seen.rows if not is_empty(r[day])]
    if not cells or any(not is_dated(c) or not isinstance(c, str) or says_the_hour(c) for c in cells):
        return None
    for i in (i for i in range(len(seen.names)) if i != day):
        column = [r[i] for r in seen.rows if not is_empty(r[i])]
        # a duration of Arrow counts from a start, and is no time of day
        if column and mostly(column, lambda c: isinstance(c, str) and is_clocked(c), 0.8, len(column)):
            return i
    asked = clock_question((day,), seen)
    if asked is not None:
        raise asked
    return None


def joined(names: Sequence[str], columns: Sequence[Any], zone: str | None, form: str | None, where: str) -> Stamps:
    """The times of rows whose day and time of day, or whose parts, stand in several columns, in UTC.

    FormatError, QuestionError: as `find_formats`, for texts.
    """
    cells = [texts(c) for c in columns]
    for again in [n for n, row in enumerate(zip(*cells, strict=True)) if row == tuple(names)]:
        for column in cells:
            column[again] = ""
    once = is_once(cells[0])
    known = [[c for c in cells[0] if c], *cells[1:]] if once else cells
    forms = find_formats(list(names), known, form, where)
    if have_days(forms):
        empty: Bool1D = np.array([is_empty(c) for c in cells[0]])
        days, clocks = column_times(cells[:1], forms[:1]), column_times(cells[1:], forms[1:])
        local = Days().join(days, clocks, empty if once else np.zeros_like(empty))
    else:
        local = column_times([filled(cells[0]) if once else cells[0], *cells[1:]], forms)
    if forms[0].role == "time":
        return times_of_day(local, forms[0].cycle_ns)
    if any(f.zoned for f in forms):
        return Stamps(local, True, ())
    return times_of_dates(local.view("datetime64[ns]"), zone)


def _are_days(cells: Sequence[Any]) -> bool:
    some = [c for c in cells if c is not None]
    return bool(some) and not any(c.hour or c.minute or c.second or c.microsecond for c in some)
