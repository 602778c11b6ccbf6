"""The times of a sheet's columns: dates, texts, counts, durations, and times of day beside a date that stands once."""

from __future__ import annotations

import datetime as dt
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from thermodata.plugin import Int1D, Source
from thermodata.reader.text.cells.cell import is_empty
from thermodata.reader.text.cells.time_forms.zone_words import stated_zone
from thermodata.reader.text.page.layout import Layout
from thermodata.reader.text.page.timed.group import Group
from thermodata.reader.text.preamble.head_start import ORDERS
from thermodata.reader.text.times.in_memory import (
    Stamps,
    times_of_dates,
    times_of_day,
    times_of_numbers,
    times_of_texts,
)
from thermodata.reader.text.times.several_cells.clock_numbers import clock_of_numbers, since_midnight_format
from thermodata.reader.text.times.several_cells.date_parts import column_times, declared_parts
from thermodata.reader.text.times.several_cells.days import NOTE, is_once
from thermodata.reader.text.times.several_cells.time_cells import belongs_to_time
from thermodata.reader.text.times.time_formats import find_formats
from thermodata.reader.times.time_units import EPOCHS, SECONDS, Epoch, to_ns
from thermodata.reader.times.zone import NAT
from thermodata_reader_table.workbook.cells import joined, joined_words, part_of_date
from thermodata_reader_table.workbook.days import local_times
from thermodata_reader_table.workbook.numbers import NumberCells
from thermodata_reader_table.workbook.swapped import swapped_times

Column = tuple[Any, ...]


class Times:
    """Of the groups of columns of one sheet."""

    def __init__(
        self,
        layout: Layout,
        where: str,
        source: Source,
        numbers: NumberCells,
        from_1904: bool,
        note: Callable[[str], None],
    ) -> None:
        """from_1904: whether days count from there; note: is told what was made of cells."""
        self._layout, self._where, self._source = layout, where, source
        self._numbers, self._from_1904, self._note = numbers, from_1904, note

    def of(self, group: Group, columns: Sequence[Column]) -> Stamps:
        """When the rows of a group were. columns: all of the sheet, n cells each. QuestionError where an order of day
        and month, or a format, is open."""
        if group.counted:
            rows = len(columns[0]) if columns else 0
            return Stamps(to_ns(np.arange(rows) * float(group.seconds or 1.0), 1.0), False, ())
        own, names = [columns[i] for i in group.time], [self._layout.names[i] for i in group.time]
        zone = stated_zone(names) or self._source.timezone
        if not group.dated:
            return self._of_counts(group, own[0], names[0], zone)
        if since_midnight_format(group.form) is not None:
            counts = [[part_of_date(cell) for cell in cells] for cells in own]
            return times_of_day(column_times(counts, find_formats(names, counts, group.form, self._where)))
        numbers = any(clock_of_numbers(n, cells) for n, cells in zip(names[1:], own[1:], strict=True))
        if declared_parts(group.form, len(own)) or numbers:
            return self._of_parts(own, names, group.form, zone)
        if len(own) == 2 and is_once(own[0]):
            self._note(NOTE)
            order = group.form if group.form in ORDERS else None
            return times_of_dates(local_times(own[0], own[1], order, self._where).view("datetime64[ns]"), zone)
        return self._of_moments(own, group.form, zone)

    def _of_counts(self, group: Group, cells: Column, name: str, zone: str | None) -> Stamps:
        """Of numbers in a unit, from a start or from a date."""
        unit = group.epoch or next(u for u, seconds in SECONDS.items() if seconds == group.seconds)
        if unit == "excel" and self._from_1904:
            unit = "excel1904"
            self._note("days count from 1904, as the workbook says")
        if EPOCHS.get(unit) is not None and EPOCHS[unit].local:
            return times_of_dates(self._days(cells, EPOCHS[unit]).view("datetime64[ns]"), zone)
        return times_of_numbers(self._numbers.of(cells).values, unit, zone, name)

    def _of_parts(self, columns: Sequence[Column], names: Sequence[str], form: str | None, zone: str | None) -> Stamps:
        """Of parts of a date in several columns."""
        parts = [[part_of_date(cell) for cell in cells] for cells in columns]
        forms = find_formats(names, parts, form, self._where)
        moment = column_times(parts, forms)
        zoned = any(one.zoned for one in forms)
        return Stamps(moment, True, ()) if zoned else times_of_dates(moment.view("datetime64[ns]"), zone)

    def _of_moments(self, columns: Sequence[Column], form: str | None, zone: str | None) -> Stamps:
        """Of cells that are a moment, or a duration, each row by itself."""
        worded = any(belongs_to_time(cells) for cells in columns[1:])
        moments = [joined_words(cells) if worded else joined(cells) for cells in zip(*columns, strict=True)]
        if (turned := swapped_times(moments, zone, form, self._where)) is not None:
            return turned
        if any(isinstance(j, str) and j for j in moments):
            texts = [j if isinstance(j, str) else str(j).replace(" 00:00:00", " 0:00:00") for j in moments]
            return self._of_texts(texts, zone, form)
        if any(isinstance(j, dt.timedelta) for j in moments):
            micro = dt.timedelta(microseconds=1)
            t = np.array([(j // micro) * 1000 if isinstance(j, dt.timedelta) else NAT for j in moments], np.int64)
            if any(isinstance(c, dt.time) for c in columns[0]):
                return times_of_day(t)
            return Stamps(t, False, ("durations: counted as the cells say",))
        naive = np.array([j.isoformat() if isinstance(j, dt.datetime) else "NaT" for j in moments], "datetime64[ns]")
        return times_of_dates(naive, zone)

    def _of_texts(self, texts: list[str], zone: str | None, form: str | None) -> Stamps:
        """Times that are written as texts; where groups have lengths of their own, by the rows that have one."""
        if len(self._layout.groups) < 2:
            return times_of_texts(texts, zone, form, self._where)
        filled = np.array([k for k, text in enumerate(texts) if not is_empty(text)], np.int64)
        found = times_of_texts([texts[k] for k in filled], zone, form, self._where)
        t_ns = np.full(len(texts), NAT, np.int64)
        t_ns[filled] = found.t_ns
        return replace(found, t_ns=t_ns)

    def _days(self, cells: Column, epoch: Epoch) -> Int1D:
        """Local times of days that are counted from a date [ns], shape (n,), NAT where there is none; a cell that is
        formatted as a date holds such a count too, and is given as what it shows."""
        dated = [isinstance(c, dt.date) for c in cells]
        shown = [joined((c,)).isoformat() if is_date else "NaT" for c, is_date in zip(cells, dated, strict=True)]
        counts = tuple(None if is_date else c for c, is_date in zip(cells, dated, strict=True))
        counted = epoch.ns(self._numbers.of(counts).values)
        return np.where(dated, np.array(shown, "datetime64[ns]").view(np.int64), counted)
