"""Times of rows over chunks: local time to UTC, with the hour that repeats in autumn told apart across the chunks'
borders; and times of day without a date, counted from the first."""

from __future__ import annotations

from datetime import UTC, datetime

import numpy as np

from thermodata.plugin import Int1D
from thermodata.reader.times.newest_first import Steps
from thermodata.reader.times.zone import NAT, local_to_utc_ns

_HOUR = 3600 * 10**9
_NEAR = 3 * _HOUR
_DAY = 24 * _HOUR


class LocalClock:
    """Turns the rows' local times into UTC in file order. timezone None: they are UTC (or carried an offset)."""

    def __init__(self, timezone: str | None) -> None:
        self.timezone = timezone
        self._before = np.empty(0, np.int64)

    def utc(self, local_ns: Int1D) -> Int1D:
        """UTC nanoseconds, shape (n,)."""
        if self.timezone is None or not local_ns.size:
            return local_ns
        joined = np.concatenate([self._before, local_ns])
        utc, _ = local_to_utc_ns(joined.view("datetime64[ns]"), self.timezone)
        result = utc[self._before.size :]
        self._before = joined[-1:]
        if any(self._in_repeated_hour(int(joined[-1]) - hours * _HOUR) for hours in range(3)):
            far = np.flatnonzero(np.abs(joined - joined[-1]) > _NEAR)
            self._before = joined[far[-1] if far.size else 0 :]
        return result

    def _in_repeated_hour(self, local_ns: int) -> bool:
        from zoneinfo import ZoneInfo

        assert self.timezone is not None
        when = datetime.fromtimestamp(local_ns // 10**9, UTC).replace(tzinfo=ZoneInfo(self.timezone))
        return when.replace(fold=0).utcoffset() != when.replace(fold=1).utcoffset()


class DayCount:
    """Times of day without a date, in file order: they count from the first, and each step back by half a day or more
    is the next midnight; in a file that stands newest first each step ahead by as much is the midnight before.
    cycle_ns: an hour in place of the day where they are minutes and seconds, more than a day where they never begin
    anew."""

    NOTE = "times of day without a date: counted from the first row"
    NOTE_SPANS = "spans of time: counted from the first row"
    NOTE_MINUTES = "times in minutes and seconds: counted from the first row"

    def __init__(self, cycle_ns: int = _DAY) -> None:
        self._cycle = cycle_ns
        self._first: int | None = None
        self._last = 0
        self._nights = 0
        self._clock = Steps()

    @classmethod
    def note(cls, cycle_ns: int) -> str:
        if cycle_ns > _DAY:
            return cls.NOTE_SPANS
        return cls.NOTE if cycle_ns == _DAY else cls.NOTE_MINUTES

    @property
    def first_ns(self) -> int | None:
        """The time of day that is counted from; None before there is one, and of minutes and seconds."""
        return self._first if self._cycle == _DAY else None

    def relative(self, of_day_ns: Int1D) -> Int1D:
        """Nanoseconds since the first of all, shape (n,); NAT stays."""
        good = of_day_ns != NAT
        values = of_day_ns[good]
        result = of_day_ns.copy()
        if values.size:
            if self._first is None:
                self._first = self._last = int(values[0])
            steps = np.diff(values, prepend=self._last)
            self._clock.add(values)
            ahead = -steps if self._clock.newest_first else steps
            # a step by more than all of it is no turn: 75:00 goes back to 00:00 where a recording begins anew; one by a
            # whole day is: 23:59:60 and 00:00:00
            whole = self._cycle + (self._cycle == _DAY)
            turned = ((ahead < -self._cycle // 2) & (ahead > -whole)).astype(np.int64)
            turned = -turned if self._clock.newest_first else turned
            nights = self._nights + np.cumsum(turned)
            result[good] = values + nights * self._cycle - self._first
            self._last, self._nights = int(values[-1]), int(nights[-1])
        return result
