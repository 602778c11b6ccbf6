"""Days and times of day in columns of their own, where the days do not say all: a date that only the first row of a day
has, or one that stays as it was at the start while midnight passes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from thermodata.plugin import Bool1D, Int1D
from thermodata.reader.text.cells.cell import Cell, is_dated, is_empty
from thermodata.reader.text.cells.time_forms.time_pattern import DAY_NS, TimeFormat
from thermodata.reader.text.times.several_cells.date_parts import row_time
from thermodata.reader.times.zone import NAT

_SPARSE = 0.5  # of the rows: fewer have a date
_STEPS = 10  # of the rows, that the clock may miss over a midnight at which the date does not change
_SET_NS = 2 * 3600 * 10**9  # that a clock may be set back by within a day, as in autumn
NOTE = "the date stands in some rows only: it is that of the rows behind it, and midnights are counted"
STANDS = "the date does not change at midnight: midnights are counted"


def is_once(cells: Sequence[Cell]) -> bool:
    """Whether a column of dates has one in its first row and in few others, which are empty."""
    filled = [not is_empty(c) for c in cells]
    dated = all(is_dated(c) for c, full in zip(cells, filled, strict=True) if full)
    return len(cells) > 2 and filled[0] and sum(filled) < _SPARSE * len(cells) and dated


def filled(cells: Sequence[Cell]) -> list[Cell]:
    """The cells with the last one that holds anything in place of empty ones."""
    out: list[Cell] = []
    for cell in cells:
        out.append(out[-1] if out and is_empty(cell) else cell)
    return out


def have_days(forms: Sequence[TimeFormat]) -> bool:
    """Whether times are a date and a time of day."""
    return len(forms) > 1 and forms[0].role == "date" and forms[1].role == "time" and forms[1].cycle_ns == DAY_NS


def stands(rows: Sequence[Sequence[str]], time: Sequence[int], forms: Sequence[TimeFormat]) -> bool:
    """Whether sampled rows keep one date while their clock goes back as it does at midnight. time: their columns."""
    if not have_days(forms) or len({r[time[0]].strip() for r in rows}) != 1:
        return False
    clock = [ns for r in rows if (ns := row_time([r[i] for i in time[1:]], forms[1:])) != NAT]
    return any(b - a < -DAY_NS // 2 for a, b in pairwise(clock))


@dataclass(slots=True)
class Days:
    """Joins dates and times of day of rows in file order, part after part.

    A row without a date is of the day before it, or of the next one where the clock goes back by more than two hours.
    One with the same date as before is of the next day where the clock goes back so, and with a few steps of the rows
    passes midnight: a clock that is set does not hit that.
    """

    _day: int = NAT
    _clock: int = 0
    _nights: int = 0
    _step: int = 0
    _sound: bool = True

    def join(self, day_ns: Int1D, clock_ns: Int1D, empty: Bool1D) -> Int1D:
        """Local times [ns], shape (n,), NAT where a row has none. day_ns: of the dates, NAT where there is none; empty:
        where their cells are."""
        good = (clock_ns != NAT) & ((day_ns != NAT) | empty)
        out = np.full(day_ns.size, NAT, np.int64)
        if not good.any():
            return out
        clock = clock_ns[good]
        last = np.maximum.accumulate(np.where(empty[good], -1, np.arange(clock.size)))
        day = np.where(last >= 0, day_ns[good][np.maximum(last, 0)], self._day)
        steps = np.diff(clock, prepend=clock[0] if self._day == NAT else self._clock)
        ahead = steps[(steps > 0) & (steps < DAY_NS // 2)]
        self._step = int(np.median(ahead)) if ahead.size else self._step
        same = day == np.concatenate([[day[0] if self._day == NAT else self._day], day[:-1]])
        over = steps + DAY_NS <= _STEPS * self._step
        turned = same & np.where(empty[good], steps < -_SET_NS, (steps < -DAY_NS // 2) & over)
        paused = np.abs(steps) > _STEPS * self._step
        nights = self._midnights_since_date(same, turned, empty[good], (steps < -DAY_NS // 2) | paused)
        out[good] = np.where(day == NAT, NAT, day + nights * DAY_NS + clock)
        self._day, self._clock, self._nights = int(day[-1]), int(clock[-1]), int(nights[-1])
        return out

    def _midnights_since_date(self, same: Bool1D, turned: Bool1D, empty: Bool1D, away: Bool1D) -> Int1D:
        """Midnights since each row's date began, shape (n,). A date that was changed while no midnight passed is ahead
        of its clock: the midnight that follows is the one that it was changed for. away: where the clock went back
        over midnight, or the log stood still, and a date that changes is that of another session."""
        nights, count, first = np.zeros(same.size, np.int64), self._nights, 0
        for k in np.flatnonzero(~same | turned).tolist():
            nights[first:k], first = count, k
            if not same[k]:
                self._sound, count = bool(away[k]) or count > 0, 0
            elif self._sound or empty[k]:
                count += 1
        nights[first:] = count
        return nights
