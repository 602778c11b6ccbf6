"""A sheet of a workbook, column by column: its times, numbers and words, in memory."""

from __future__ import annotations

import datetime as dt
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from thermodata.errors import FormatError
from thermodata.plugin import Array, Bool1D, Int1D, Loss, Source
from thermodata.reader.signals.by_place import BY_PLACE
from thermodata.reader.text.cells.cell import is_empty
from thermodata.reader.text.cells.time_forms.zone_words import stated_zone
from thermodata.reader.text.cells.values.quotes import clean
from thermodata.reader.text.names.before_values import behind_another, other_word
from thermodata.reader.text.page.layout import Layout
from thermodata.reader.text.page.timed.group import STREAM, Group, heads_of_blocks
from thermodata.reader.text.preamble.begin import declared_start
from thermodata.reader.text.preamble.titles import dated_titles
from thermodata.reader.text.rows.footer import is_footer
from thermodata.reader.text.tables.blocks.another_header import another_in_sheet, in_one_order, repeated_in_sheet
from thermodata.reader.text.tables.sample.zone_named import named_note
from thermodata.reader.text.times.in_memory import Stamps
from thermodata.reader.times.zone import NAT
from thermodata.schema.flag import Flag
from thermodata.schema.words.sentences import counted
from thermodata_reader_table.workbook.book import Sheet
from thermodata_reader_table.workbook.cells import seconds_of
from thermodata_reader_table.workbook.numbers import NumberCells
from thermodata_reader_table.workbook.start import Heads, begun, texts_of
from thermodata_reader_table.workbook.times import Times


@dataclass
class Stream:
    """Columns with one time, in memory. names: as the recording has them; at: the sheet's row of each, shape (n,);
    flags: of columns that have any, shape (n,): of cells that say overload; empty: cells that hold nothing, of columns
    that have any; sheet: where it stands; percent: columns that hold a fraction and show it in per cent; said:
    properties of each; held: columns whose values stand over empty cells; sheets: of a stream that goes
    on through several, each with the number of its rows."""

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
    sheets: tuple[tuple[str, int], ...] = ()

    def place(self, row: int) -> str:
        """The sheet and its row of a row of the stream, counted from 0."""
        ends = np.cumsum([rows for _, rows in self.sheets])
        home = self.sheets[int(np.searchsorted(ends, row, "right"))][0] if self.sheets else self.sheet
        return f"sheet '{home}', row {self.at[row]}"


class Table:
    """A sheet, column by column. start_above: whether a start that stands above the rows counts; begun: whether one
    did."""

    def __init__(self, sheet: Sheet, layout: Layout, where: str, source: Source, start_above: bool = True) -> None:
        self.start_above, self.begun = start_above, False
        self.sheet, self.layout, self.where, self.source = sheet, layout, where, source
        self.losses: list[Loss] = []
        self.head = sheet.rows[: layout.first]
        rows, named = in_one_order(layout, self.head, sheet.rows[layout.first :])
        if (other := another_in_sheet(layout, self.head, rows, named)) is not None:
            lost = 1 - other[0] / len(rows)
            self.losses.append(Loss(f"{where} row {layout.first + other[0] + 1}", None, None, lost, other[1]))
            rows = rows[: other[0]]
        self.repeats = repeated_in_sheet(self.head, rows) | {n for n in named if n < len(rows)}
        rows = [[None] * len(row) if n in self.repeats else row for n, row in enumerate(rows)] if self.repeats else rows
        self.columns = list(zip(*rows, strict=False))
        self._by_words()
        measured = [c for i, c in enumerate(self.columns) if i not in layout.time]
        self._numbers = NumberCells(measured, (source.table or {}).get("decimal"))
        self.notes = list(layout.notes)
        self._times = Times(layout, where, source, self._numbers, sheet.from_1904, self.notes.append)

    def streams(self, sheet: str | None) -> Iterator[Stream]:
        """sheet: its name where there are several."""
        for group, times in zip(self.layout.groups, self._dated_times(), strict=True):
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
            yield Stream(name, stamps, values, units, at, flags, empty, self.sheet.name, frozenset(percent), said)

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

    def _dated_times(self) -> list[Stamps]:
        """The times of each group, from the start that stands above the rows; that can't be one of some which count
        from a start and of others which tell times of day."""
        found = [self._times.of(group, self.columns) for group in self.layout.groups]
        if not self.start_above or len({s.of_day for s in found if not s.absolute}) > 1:
            return found
        zones = [stated_zone(self.layout.names[i] for i in g.time) or self.source.timezone for g in self.layout.groups]
        begin: list[Stamps] = []
        for was, zone, above in zip(found, zones, self._heads_above(found, zones), strict=True):
            times, further = begun(was, Heads(above, self.columns, self.repeats), self.source, zone, self.where)
            if further:  # such rows are empty, as those are that repeat the header
                self.repeats = gone = self.repeats | frozenset(further)
                self.columns = [tuple(None if n in gone else c for n, c in enumerate(col)) for col in self.columns]
            begin.append(times)
        self.begun = any(s.absolute and not was.absolute for s, was in zip(begin, found, strict=True))
        return begin

    def _heads_above(self, found: Sequence[Stamps], zones: Sequence[str | None]) -> list[Sequence[Sequence[Any]]]:
        """The head of each group: what stands above its own columns, where that dates every one of them, as the title
        of a block does beside others, and nobody declares which counts; else all of it."""
        whole: list[Sequence[Sequence[Any]]] = [self.head] * len(found)
        if len(found) < 2 or any(s.absolute for s in found):
            return whole
        declared, own = declared_start(self.source.table or {}), heads_of_blocks(self.layout.groups, self.head)
        titles = dated_titles([texts_of(h) for h in own], declared) if all(s.of_day for s in found) else None
        if declared is None:
            dated = (
                begun(was, Heads(above, self.columns, self.repeats), self.source, zone, self.where)[0].absolute
                for was, above, zone in zip(found, own, zones, strict=True)
            )
            if all(dated):
                return list(own)
        return whole if titles is None else list(titles)

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
        shown = self.sheet.percent.get(column, 0)
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

    def _values(self, name: str, cells: tuple[Any, ...]) -> tuple[Array, str | None, Bool1D]:
        """(values, unit that the cells themselves tell: seconds of durations, which say overload)."""
        filled = [c for c in cells if c not in ("", None)]
        unit = None
        if filled and sum(isinstance(c, dt.timedelta | dt.time) for c in filled) * 2 > len(filled):
            self.notes.append(f"column '{name}' holds durations or times of day: they are read as seconds")
            cells, unit = tuple(seconds_of(c) for c in cells), "s"
        found = self._numbers.of(cells)
        if found.odd and len(found.odd) * 2 > len(filled):
            texts = np.array([None if c is None else clean(str(c)) or None for c in cells], object)
            return texts, None, np.zeros(len(cells), bool)
        if found.odd:
            reason = f"{counted(len(found.odd), 'cell', 'is no number', 'are no numbers')}, such as '{found.odd[0]}'"
            lost = len(found.odd) / len(cells)
            self.losses.append(Loss(f"{self.where} column '{name}'", None, None, lost, reason, name))
        return found.values, unit, found.over
