"""Dates and times of day of a sheet's rows, where the date stands in some rows only."""

from __future__ import annotations

import datetime as dt
from collections.abc import Sequence
from typing import Any

import numpy as np

from thermodata.plugin import Int1D
from thermodata.reader.text.cells.cell import is_empty
from thermodata.reader.text.cells.time_forms.time_pattern import TIME_OF_DAY
from thermodata.reader.text.times.one_cell import timestamp
from thermodata.reader.text.times.several_cells.days import Days
from thermodata.reader.text.times.time_formats import find_format
from thermodata.reader.times.zone import NAT

_MICRO = dt.timedelta(microseconds=1)


def local_times(days: Sequence[Any], clocks: Sequence[Any], order: str | None, where: str) -> Int1D:
    """Local times [ns] since 1970, shape (n,), NAT where a row has none. order: the declared one of day and month.

    QuestionError where dates that are texts could be either way round.
    """
    texts = [d for d in days if isinstance(d, str) and not is_empty(d)]
    form = find_format(texts, where, order=order) if texts else None
    day_ns = [NAT if form is None else timestamp.parse_one(d, form) if d else NAT for d in _as_texts(days)]
    dated = [_ns(dt.datetime(d.year, d.month, d.day)) if isinstance(d, dt.date) else NAT for d in days]
    found = np.array([a if a != NAT else b for a, b in zip(dated, day_ns, strict=True)], np.int64)
    clock_ns = np.array([_of_day(c) for c in clocks], np.int64)
    return Days().join(found, clock_ns, np.array([is_empty(d) for d in days]))


def _as_texts(cells: Sequence[Any]) -> list[str]:
    return [c if isinstance(c, str) else "" for c in cells]


def _of_day(cell: Any) -> int:
    """Nanoseconds in the day of a time of day; NAT where a cell is none."""
    if isinstance(cell, dt.datetime):
        cell = cell.time()
    if isinstance(cell, dt.time):
        return _ns(dt.datetime.combine(dt.date(1970, 1, 1), cell))
    if isinstance(cell, dt.timedelta):
        return (cell // _MICRO) * 1000
    return timestamp.parse_one(cell.strip(), TIME_OF_DAY) if isinstance(cell, str) else NAT


def _ns(moment: dt.datetime) -> int:
    return ((moment - dt.datetime(1970, 1, 1)) // _MICRO) * 1000
