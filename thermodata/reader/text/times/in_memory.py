"""The times of a whole column that is in memory, in UTC: texts, dates, numbers, times of day."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from thermodata.errors import FormatError, QuestionError
from thermodata.plugin import Array, Int1D
from thermodata.reader.text.cells.time_forms.time_pattern import DAY_NS
from thermodata.reader.text.times.local_clock import DayCount
from thermodata.reader.text.times.one_cell import timestamp
from thermodata.reader.text.times.one_cell.second_sixty import at_second_sixty, said_of_sixty
from thermodata.reader.text.times.several_cells.days import STANDS, Days, have_days, stands
from thermodata.reader.text.times.time_formats import find_formats
from thermodata.reader.times.time_units import EPOCHS, SECONDS, to_ns
from thermodata.reader.times.wrapped_counter import gone_on
from thermodata.reader.times.zone import NAT, local_to_utc_ns


@dataclass(frozen=True, slots=True)
class Stamps:
    """t_ns: shape (n,), `NAT` where a cell holds no time; absolute: False for times of day without a date, and for
    durations; zero_ns: what a relative time of 0 is in the cells; of_day: whether that is a time of day."""

    t_ns: Int1D
    absolute: bool
    notes: tuple[str, ...]
    zero_ns: int = 0
    of_day: bool = False

    def later(self, by_ns: int) -> Stamps:
        """The same on a clock that began so much earlier."""
        moved = np.where(self.t_ns == NAT, NAT, self.t_ns + np.int64(by_ns))
        return replace(self, t_ns=moved, zero_ns=self.zero_ns - by_ns) if by_ns else self


def times_of_texts(cells: Sequence[str], timezone: str | None, declared: str | None, where: str) -> Stamps:
    """Times of a column of texts, in UTC; times of day without a date count from the first.

    FormatError where day and month could be either way round in the whole column.
    """
    (form,) = find_formats([""], [list(cells)], declared, where)
    ns = timestamp.parse(list(cells), form)
    at_sixty = at_second_sixty(list(cells), form)
    told = (said_of_sixty(at_sixty.size, cells[at_sixty[0]]),) if at_sixty.size else ()
    if form.role == "time":
        found = times_of_day(ns, form.cycle_ns, form.of_day)
        return replace(found, notes=(*found.notes, *told))
    if form.zoned:
        return Stamps(ns, True, told)
    utc, notes = local_to_utc_ns(ns.view("datetime64[ns]"), timezone)
    return Stamps(utc, True, (*notes, *told))


def times_of_pairs(
    days: Sequence[str], clocks: Sequence[str], timezone: str | None, declared: str | None, where: str
) -> Stamps:
    """The same of a column of dates and one of times of day: midnights are counted where the date stands still."""
    try:
        forms = find_formats(["", ""], [list(days), list(clocks)], declared, where)
    except (FormatError, QuestionError):  # which both together may answer
        forms = ()
    if not have_days(forms):
        cells = [f"{day} {clock}" if day and clock else "" for day, clock in zip(days, clocks, strict=True)]
        return times_of_texts(cells, timezone, declared, where)
    at_sixty = at_second_sixty(list(clocks), forms[1])
    told = [said_of_sixty(at_sixty.size, clocks[at_sixty[0]])] if at_sixty.size else []
    if stands(list(zip(days, clocks, strict=True)), (0, 1), forms):
        told.append(STANDS)
    day_ns, clock_ns = (timestamp.parse(list(c), f) for c, f in zip((days, clocks), forms, strict=True))
    ns = Days().join(day_ns, clock_ns, np.zeros(len(days), np.bool_))
    utc, notes = local_to_utc_ns(ns.view("datetime64[ns]"), timezone)
    return Stamps(utc, True, (*notes, *told))


def times_of_dates(naive: npt.NDArray[np.datetime64], timezone: str | None) -> Stamps:
    """The same from cells that are dates already (a workbook's)."""
    utc, notes = local_to_utc_ns(naive, timezone)
    return Stamps(utc, True, tuple(notes))


def times_of_numbers(values: Array, unit: str, timezone: str | None, name: str | None = None) -> Stamps:
    """Times of a column of numbers. unit: of time_units.check_unit(); name: of a whole column, in which a counter that
    is full is counted on."""
    if unit in SECONDS:
        on, note = (values, None) if name is None else gone_on(values, name)
        return Stamps(to_ns(on, SECONDS[unit]), False, () if note is None else (note,))
    epoch = EPOCHS[unit]
    t_ns = epoch.ns(values)
    return times_of_dates(t_ns.view("datetime64[ns]"), timezone) if epoch.local else Stamps(t_ns, True, ())


def times_of_day(of_day_ns: Int1D, cycle_ns: int = DAY_NS, of_day: bool = True) -> Stamps:
    """Times of day without a date count from the first; each step back by half a day is the next midnight. of_day:
    False for durations that are written like them."""
    days = DayCount(cycle_ns)
    since = days.relative(of_day_ns)
    good = of_day_ns[of_day_ns != NAT]
    return Stamps(since, False, (DayCount.note(cycle_ns),), int(good[0]) if good.size else 0, of_day)
