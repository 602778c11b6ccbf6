"""Local time to UTC over chunks: the hour that repeats in autumn is told apart across the chunks' borders."""

from __future__ import annotations

from datetime import UTC, datetime

import numpy as np

from thermodata.plugin import Int1D
from thermodata.reader.zone import local_to_utc_ns

_NEAR = 3 * 3600 * 10**9


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
        if self._repeats(int(joined[-1])):
            far = np.flatnonzero(np.abs(joined - joined[-1]) > _NEAR)
            self._before = joined[far[-1] if far.size else 0 :]
        return result

    def _repeats(self, local_ns: int) -> bool:
        from zoneinfo import ZoneInfo

        assert self.timezone is not None
        when = datetime.fromtimestamp(local_ns // 10**9, UTC).replace(tzinfo=ZoneInfo(self.timezone))
        return when.replace(fold=0).utcoffset() != when.replace(fold=1).utcoffset()
