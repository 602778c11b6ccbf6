"""When the rows of a table were measured, by the cells of their time or by their number."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from thermodata.plugin import Int1D
from thermodata.reader.text.cells.time_forms.time_pattern import DAY_NS
from thermodata.reader.text.cells.values.arrow import values
from thermodata.reader.text.cells.values.column import Values
from thermodata.reader.text.preamble.begin import Begin
from thermodata.reader.text.rows.grid import Rows
from thermodata.reader.text.tables.table import TimedGroup
from thermodata.reader.text.times.local_clock import DayCount, LocalClock
from thermodata.reader.text.times.several_cells.date_parts import column_times
from thermodata.reader.text.times.several_cells.days import Days, have_days
from thermodata.reader.times.time_units import EPOCHS, Epoch, to_ns
from thermodata.reader.times.wrapped_counter import Counter
from thermodata.reader.times.zone import NAT


class RowClock:
    """The times of a group's rows, chunk after chunk."""

    def __init__(self, timed: TimedGroup, timezone: str | None, begin: Begin | None = None) -> None:
        self.timed, self.begin, self.timezone = timed, begin, timezone
        epoch = EPOCHS.get(timed.group.epoch or "")
        local = epoch.local if epoch is not None else bool(timed.formats) and not timed.zoned and not timed.of_day
        local = local or (begin is not None and begin.of_day)
        self.epoch: Epoch | None = epoch
        self.clock = LocalClock(timezone if local else None)
        self.days = self._new_days()
        self.joined_days = Days()
        self.counted = 0
        self.counter = Counter()
        self._first: int | None = None
        self.anew: dict[
            int, Begin
        ] = {}  # of lines in the chunk that is read next, behind which rows count from another

    @property
    def zero_ns(self) -> int | None:
        """The time of day that its times count from; None before there is one, and where they are none."""
        first = self.days.first_ns
        return None if first is None else (first - self.timed.later_ns) % DAY_NS

    def times(self, rows: Rows, peek: bool = False) -> Int1D:
        """Shape (n,), NAT where a row has none. peek: only which rows have one; the clock does not go on."""
        ns = self._counted_times(rows, peek) if self.timed.group.counted else self._written_times(rows, peek)
        if peek:
            return ns
        parts, first = [], 0
        for line, begin in sorted(self.anew.items()):
            end = int(np.searchsorted(rows.line, line))
            parts.append(self._utc(ns[first:end]))
            first, self.begin = end, begin
            self.days, self._first = self._new_days(), None
        self.anew = {}
        parts.append(self._utc(ns[first:]))
        return np.concatenate(parts)

    def _new_days(self) -> DayCount:
        return DayCount(self.timed.formats[0].cycle_ns) if self.timed.of_day else DayCount()

    def _utc(self, ns: Int1D) -> Int1D:
        """UTC, or the time from the first row, of rows that count from one start [ns], shape (n,)."""
        if self.timed.of_day:
            ns = self._of_day(ns)
            if self.begin is None:
                return np.where(ns == NAT, NAT, ns + np.int64(self.timed.later_ns))
        if self.begin is not None and not self.begin.of_day:
            return self.begin.utc(ns, self.timezone)
        good = ns != NAT
        if good.all():
            return self.clock.utc(ns)
        result = np.full(ns.size, NAT, np.int64)
        result[good] = self.clock.utc(ns[good])
        return result

    def _of_day(self, ns: Int1D) -> Int1D:
        """Times of day or durations, shape (n,), counted from the first row; from their zero, and from the date above
        the rows, where the file says when it began."""
        good = ns != NAT
        if self._first is None and good.any():
            self._first = int(ns[good][0])
        since = self.days.relative(ns)
        if self.begin is None:
            return since
        zero = (self._first or 0) + (self.begin.ns if self.begin.of_day else 0)
        return np.where(since == NAT, NAT, since + np.int64(zero))

    def _joined_times(self, rows: Rows, peek: bool) -> Int1D:
        """Dates and times of day, shape (n,): of rows without a date too, where the table has such."""
        import pyarrow.compute as pc

        forms, (date, *others) = self.timed.formats, self.timed.group.time
        clock_ns = column_times([rows.times[i] for i in others], forms[1:])
        cells = rows.times[date]
        empty = np.zeros(rows.n, bool)
        if self.timed.once:
            empty = values(pc.equal(pc.utf8_trim_whitespace(cells.fill_null("")), ""), "bool")
        days = replace(self.joined_days) if peek else self.joined_days
        return days.join(column_times([cells], forms[:1]), clock_ns, empty)

    def _counted_times(self, rows: Rows, peek: bool) -> Int1D:
        """Times of rows that are counted. A line that is lost took its time too, a repeated header took none, nor did a
        row of another kind."""
        numbers = [
            i for i in self.timed.group.columns if i in rows.columns and rows.columns[i].values.dtype.kind != "O"
        ]
        odd = np.zeros(rows.n, np.int64)
        for i in numbers:
            odd[[row for row, _ in rows.columns[i].odd]] += 1
        words = odd == len(numbers) if numbers else np.zeros(rows.n, bool)
        lost = np.array([b.line for b in rows.bad if b.cells not in self.timed.group.others], np.int64)
        taken = np.cumsum(~words) - 1 + np.searchsorted(lost, rows.line)
        ns: Int1D = np.rint((self.counted + taken) * ((self.timed.group.seconds or 1.0) * 1e9)).astype(np.int64)
        if not peek:
            self.counted += int((~words).sum()) + lost.size
        return np.where(words, NAT, ns)

    def _since(self, cells: Values, peek: bool) -> Int1D:
        """Numbers of one unit as times from their zero."""
        counts, each = cells.values.astype(np.float64), self.timed.group.seconds or 1.0
        on = self.counter.gone_on(np.where(cells.empty, np.nan, counts), peek)
        return to_ns(on if self.counter.times else cells.values, each)

    def _written_times(self, rows: Rows, peek: bool) -> Int1D:
        group = self.timed.group
        if have_days(self.timed.formats):
            return self._joined_times(rows, peek)
        if not self.timed.formats:
            cells = rows.columns[group.time[0]]
            if self.epoch is None:
                return self._since(cells, peek)
            ns: Int1D = self.epoch.ns(cells.values)
            if cells.values.dtype.kind == "i":  # no NaN in them, and 0 is a date
                ns[cells.empty] = NAT
                ns[[row for row, _ in cells.odd]] = NAT
            return ns
        return column_times([rows.times[i] for i in group.time], self.timed.formats)
