"""A sheet of a workbook, column by column: its times, numbers and words, in memory."""

from __future__ import annotations

import datetime as dt
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import Any

import numpy as np

from thermodata.errors import FormatError
from thermodata.plugin import Array, Bool1D, Int1D, Loss, Source
from thermodata.reader.signals.by_place import BY_PLACE
from thermodata.reader.text.cells.cell import is_empty
from thermodata.reader.text.cells.number import decimal_mark, values_of
from thermodata.reader.text.cells.quotes import clean
from thermodata.reader.text.cells.zone_words import stated_zone
from thermodata.reader.text.names.before_values import behind_another, other_word
from thermodata.reader.text.page.group import STREAM, Group
from thermodata.reader.text.page.layout import Layout
from thermodata.reader.text.preamble.head_start import ORDERS
from thermodata.reader.text.rows.footer import is_footer
from thermodata.reader.text.tables.another_header import another_in_sheet, repeated_in_sheet
from thermodata.reader.text.tables.zone_named import named_note
from thermodata.reader.text.times.clock_numbers import clock_of_numbers, since_midnight_format
from thermodata.reader.text.times.date_parts import column_times, declared_parts
from thermodata.reader.text.times.days import NOTE, is_once
from thermodata.reader.text.times.in_memory import (
    Stamps,
    times_of_dates,
    times_of_day,
    times_of_numbers,
    times_of_texts,
)
from thermodata.reader.text.times.time_cells import belongs_to_time
from thermodata.reader.text.times.time_formats import find_formats
from thermodata.reader.times.time_units import EPOCHS, SECONDS, Epoch, to_ns
from thermodata.reader.times.zone import NAT
from thermodata.schema.flag import Flag
from thermodata.schema.words.sentences import counted
from thermodata_reader_table.workbook.cells import joined, joined_words, part_of_date, seconds_of
from thermodata_reader_table.workbook.days import local_times
from thermodata_reader_table.workbook.start import Heads, begun
from thermodata_reader_table.workbook.swapped import swapped_times


@dataclass
class Stream:
    """Columns with one time, in memory. names: as the recording has them; at: the sheet's row of each, shape (n,);
    flags: of columns that have any, shape (n,): of cells that say overload; empty: cells that hold nothing, of columns
    that have any; sheet: where it stands; percent: columns that hold a fraction and show it in per cent; said:
    properties of each; held: columns whose values stand over empty cells."""

    name: str
    times: Stamps
    values: dict[str, Array]
    units: dict[str, str | None]
    at: Int1D
    flags: dict[str, Array]
    empty: dict[str, Bool1D]
    sheet: str
    percent: frozenset[str]
    said: dict[str, dict[str, str]]
    held: frozenset[str] = frozenset()


class Table:
    """A sheet, column by column. decimal: of numbers that stand as text. percent: column -> numbers in per cent;
    start_above: whether a start that stands above the rows counts; begun: whether one did."""

    def __init__(
        self,
        sheet: str,
        rows: list[list[Any]],
        layout: Layout,
        where: str,
        source: Source,
        percent: Mapping[int, int] = MappingProxyType({}),
        start_above: bool = True,
        from_1904: bool = False,
    ) -> None:
        self.percent, self.from_1904 = percent, from_1904
        self.start_above, self.begun = start_above, False
        self.sheet, self.layout, self.where, self.source = sheet, layout, where, source
        self.notes = list(layout.notes)
        self.losses: list[Loss] = []
        self.head = rows[: layout.first]
        rows = rows[layout.first :]
        if (other := another_in_sheet(layout, self.head, rows)) is not None:
            lost = 1 - other[0] / len(rows)
            self.losses.append(Loss(f"{where} row {layout.first + other[0] + 1}", None, None, lost, other[1]))
            rows = rows[: other[0]]
        self.repeats = repeated_in_sheet(self.head, rows)
        rows = [[None] * len(row) if n in self.repeats else row for n, row in enumerate(rows)] if self.repeats else rows
        self.columns = list(zip(*rows, strict=False))
        self._by_words()
        said = (source.table or {}).get("decimal")
        self.decimal_declared = said is not None
        columns = [c for i, c in enumerate(self.columns) if i not in layout.time]
        self.decimal = said or decimal_mark(c for col in columns for c in col[:200] if c and isinstance(c, str)) or "."

    def streams(self, sheet: str | None) -> Iterator[Stream]:
        """sheet: its name where there are several."""
        for group, times in zip(self.layout.groups, self._dated(), strict=True):
            own = group.stream != STREAM
            name = group.stream if sheet is None else f"{sheet}/{group.stream}" if own else sheet
            before = "" if sheet is None else f"{sheet}/"
            self.notes += times.notes
            self._say_named_zone(group, times)
            keep = self._rows_of(group, times.t_ns)
            values, units, flags = dict[str, Array](), dict[str, str | None](), dict[str, Array]()
            empty = dict[str, Bool1D]()
            percent: set[str] = set()
            said: dict[str, dict[str, str]] = {}
            for i in group.columns:
                column, unit, beyond = self._values(self.layout.names[i], self.columns[i])
                values[before + self.layout.names[i]] = column[keep]
                units[before + self.layout.names[i]] = self.layout.units[i] or unit
                own_said = self.layout.said_of(i)
                places = {BY_PLACE: before + own_said[BY_PLACE]} if BY_PLACE in own_said else {}
                said[before + self.layout.names[i]] = {**own_said, **places}
                if self._in_percent(i):
                    units[before + self.layout.names[i]] = "%"
                    percent.add(before + self.layout.names[i])
                if beyond.any():
                    flags[before + self.layout.names[i]] = beyond[keep] * np.uint16(Flag.SATURATED)
                nothing = np.array([c in ("", None) for c in self.columns[i]], bool)[keep]
                if nothing.any():
                    empty[before + self.layout.names[i]] = nothing
            at = np.flatnonzero(keep).astype(np.int64) + self.layout.first + 1
            stamps = replace(times, t_ns=times.t_ns[keep], notes=())
            yield Stream(name, stamps, values, units, at, flags, empty, self.sheet, frozenset(percent), said)

    def _by_words(self) -> None:
        """Takes away the values behind other words than those that their columns are called by."""
        for i, word in enumerate(self.layout.worded if self.columns else ()):
            words, cells = self.columns[i - 1], self.columns[i]
            lost = behind_another(words, word) if word else np.zeros(0, bool)
            rows = [row for row in np.flatnonzero(lost).tolist() if not is_empty(cells[row])]
            if not rows:
                continue
            gone, name = set(rows), self.layout.names[i]
            self.columns[i] = tuple(None if row in gone else cell for row, cell in enumerate(cells))
            reason = f"{counted(len(rows), 'cell')}: {other_word(word, words[rows[0]])}"
            place = f"{self.where} column '{name}' from row {self.layout.first + rows[0] + 1}"
            self.losses.append(Loss(place, None, None, len(rows) / len(cells), reason, name))

    def _say_named_zone(self, group: Group, times: Stamps) -> None:
        """A note on a zone that a header names, where it leaves open what holds in summer or another is declared."""
        good = times.t_ns[times.t_ns != NAT]
        headers = [self.layout.names[i] for i in group.time]
        if times.absolute and good.size and stated_zone(headers) is None:
            note = named_note(headers, self.source.timezone, int(good.min()), int(good.max()))
            self.notes += [note] if note else []

    def _dated(self) -> list[Stamps]:
        """The times of each group, from the start that stands above the rows; that can't be one of some which count
        from a start and of others which tell times of day."""
        found = [self._times(group) for group in self.layout.groups]
        if not self.start_above or len({s.of_day for s in found if not s.absolute}) > 1:
            return found
        zones = [stated_zone(self.layout.names[i] for i in g.time) or self.source.timezone for g in self.layout.groups]
        begin: list[Stamps] = []
        for was, zone in zip(found, zones, strict=True):
            times, further = begun(was, Heads(self.head, self.columns, self.repeats), self.source, zone, self.where)
            if further:  # such rows are empty, as those are that repeat the header
                self.repeats = gone = self.repeats | frozenset(further)
                self.columns = [tuple(None if n in gone else c for n, c in enumerate(col)) for col in self.columns]
            begin.append(times)
        self.begun = any(s.absolute and not was.absolute for s, was in zip(begin, found, strict=True))
        return begin

    def _rows_of(self, group: Group, t_ns: Int1D) -> Bool1D:
        """Which rows are a group's, shape (n,): not those beside it when it has ended, empty ones (they take their time
        where rows are counted), what repeats the header, and statistics below the table."""
        keep = np.ones(t_ns.size, bool)
        keep[list(self.repeats)] = False
        if group.counted:
            return keep
        for row in np.flatnonzero(t_ns == NAT).tolist():
            cells = [self.columns[i][row] for i in sorted((*group.time, *group.columns))]
            keep[row] = not (all(map(is_empty, cells)) or is_footer(cells))
        return keep

    def _in_percent(self, column: int) -> bool:
        """Whether a column is shown in per cent, and its header does not say that it is a fraction. FormatError where
        some of its numbers are and others are not."""
        shown = self.percent.get(column, 0)
        if not shown or self.layout.units[column] not in (None, "%"):
            return False
        numbers = sum(isinstance(c, int | float) and not isinstance(c, bool) for c in self.columns[column])
        if shown < numbers:
            raise FormatError(
                f"column '{self.layout.names[column]}' mixes numbers in per cent with others",
                where=self.where,
                expected="one format of its cells",
                got=f"{shown} of {numbers} in per cent",
                hint="give all of its cells one format in the workbook",
            )
        return True

    def _times(self, group: Group) -> Stamps:
        if group.counted:
            rows = len(self.columns[0]) if self.columns else 0
            return Stamps(to_ns(np.arange(rows) * float(group.seconds or 1.0), 1.0), False, ())
        columns, names = [self.columns[i] for i in group.time], [self.layout.names[i] for i in group.time]
        zone = stated_zone(names) or self.source.timezone
        if not group.dated:
            unit = group.epoch or next(u for u, seconds in SECONDS.items() if seconds == group.seconds)
            if unit == "excel" and self.from_1904:
                unit = "excel1904"
                self.notes.append("days count from 1904, as the workbook says")
            if EPOCHS.get(unit) is not None and EPOCHS[unit].local:
                return times_of_dates(self._days(columns[0], EPOCHS[unit]).view("datetime64[ns]"), zone)
            return times_of_numbers(self._numbers(columns[0])[0], unit, zone, names[0])
        if since_midnight_format(group.form) is not None:
            counts = [[part_of_date(cell) for cell in cells] for cells in columns]
            return times_of_day(column_times(counts, find_formats(names, counts, group.form, self.where)))
        numbers = any(clock_of_numbers(n, cells) for n, cells in zip(names[1:], columns[1:], strict=True))
        if declared_parts(group.form, len(columns)) or numbers:
            parts = [[part_of_date(cell) for cell in cells] for cells in columns]
            forms = find_formats(names, parts, group.form, self.where)
            moment = column_times(parts, forms)
            zoned = any(form.zoned for form in forms)
            return Stamps(moment, True, ()) if zoned else times_of_dates(moment.view("datetime64[ns]"), zone)
        if len(columns) == 2 and is_once(columns[0]):
            self.notes.append(NOTE)
            order = group.form if group.form in ORDERS else None
            return times_of_dates(local_times(columns[0], columns[1], order, self.where).view("datetime64[ns]"), zone)
        worded = any(belongs_to_time(cells) for cells in columns[1:])
        moments = [joined_words(cells) if worded else joined(cells) for cells in zip(*columns, strict=True)]
        if (turned := swapped_times(moments, zone, group.form, self.where)) is not None:
            return turned
        if any(isinstance(j, str) and j for j in moments):
            texts = [j if isinstance(j, str) else str(j).replace(" 00:00:00", " 0:00:00") for j in moments]
            return self._of_texts(texts, zone, group.form)
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
        if len(self.layout.groups) < 2:
            return times_of_texts(texts, zone, form, self.where)
        filled = np.array([k for k, text in enumerate(texts) if not is_empty(text)], np.int64)
        found = times_of_texts([texts[k] for k in filled], zone, form, self.where)
        t_ns = np.full(len(texts), NAT, np.int64)
        t_ns[filled] = found.t_ns
        return replace(found, t_ns=t_ns)

    def _days(self, cells: tuple[Any, ...], epoch: Epoch) -> Int1D:
        """Local times of days that are counted from a date [ns], shape (n,), NAT where there is none; a cell that is
        formatted as a date holds such a count too, and is given as what it shows."""
        dated = [isinstance(c, dt.date) for c in cells]
        shown = [joined((c,)).isoformat() if is_date else "NaT" for c, is_date in zip(cells, dated, strict=True)]
        counts = tuple(None if is_date else c for c, is_date in zip(cells, dated, strict=True))
        counted = epoch.ns(self._numbers(counts)[0])
        return np.where(dated, np.array(shown, "datetime64[ns]").view(np.int64), counted)

    def _numbers(self, cells: tuple[Any, ...]) -> tuple[Array, list[str], Bool1D]:
        """(values, cells that are no numbers, which say overload): texts by the policy of all texts."""
        out, odd, over = np.full(len(cells), np.nan), list[str](), np.zeros(len(cells), bool)
        texts: list[int] = []
        for i, cell in enumerate(cells):
            if isinstance(cell, int | float):
                out[i] = cell
            elif isinstance(cell, str):
                if cell:
                    texts.append(i)
            elif cell is not None:
                odd.append(str(cell))
        if texts:
            found = values_of([cells[i] for i in texts], "float64", self.decimal, self.decimal_declared)
            out[texts], over[texts] = found.values, found.over
            odd += [cell for _, cell in found.odd]
        return out, odd, over

    def _values(self, name: str, cells: tuple[Any, ...]) -> tuple[Array, str | None, Bool1D]:
        """(values, unit that the cells themselves tell: seconds of durations, which say overload)."""
        filled = [c for c in cells if c not in ("", None)]
        unit = None
        if filled and sum(isinstance(c, dt.timedelta | dt.time) for c in filled) * 2 > len(filled):
            self.notes.append(f"column '{name}' holds durations or times of day: they are read as seconds")
            cells, unit = tuple(seconds_of(c) for c in cells), "s"
        numbers, odd, over = self._numbers(cells)
        if odd and len(odd) * 2 > len(filled):
            texts = np.array([None if c is None else clean(str(c)) or None for c in cells], object)
            return texts, None, np.zeros(len(cells), bool)
        if odd:
            reason = f"{counted(len(odd), 'cell', 'is no number', 'are no numbers')}, such as '{odd[0]}'"
            self.losses.append(Loss(f"{self.where} column '{name}'", None, None, len(odd) / len(cells), reason, name))
        return numbers, unit, over
