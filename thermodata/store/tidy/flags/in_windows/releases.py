"""Where a channel that stands at the end of a window moves again: whether a reading was held shows in that step."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from thermodata.calibration.quality.column import ANALOG
from thermodata.plugin import Array
from thermodata.store.tidy.flags.in_windows import windows
from thermodata.store.tidy.flags.in_windows.cuts import cuts
from thermodata.store.tidy.plan.plan import Bound
from thermodata.store.tidy.values.chunk import Column
from thermodata.store.tidy.values.series import TestSeries


@dataclass(slots=True)
class Releases:
    """Looks ahead in the channels of a stream that ends at row `stop`."""

    series: TestSeries
    stop: int
    _moves: dict[str, tuple[int, float | None]] = field(default_factory=dict)

    def ahead_of(self, columns: Mapping[str, Column], own: int, stop: int) -> dict[str, Column]:
        """The channels of a window that ends at row `stop`; one that stands still from row `own` to there ends with
        the value that it takes when it moves again: whether a reading was held shows in that step."""
        seen = dict(columns)
        if own >= stop:
            return seen
        for name, column in columns.items():
            x = column.values
            if not _is_held_value(column, x[own - stop :]):
                continue
            value = self._release(column.bound, float(x[-1]), stop)
            if value is not None:
                x = x.copy()
                x[-1] = value
                seen[name] = replace(column, values=x)
        return seen

    def _release(self, bound: Bound, value: float, row: int) -> float | None:
        """The first value from `row` on that is another one; None where there is none."""
        known = self._moves.get(bound.name)
        if known is None or known[0] < row:
            known = (self.stop, None)
            for a, b in cuts(row, self.stop, windows.WINDOW_ROWS // 4, ()):
                x = self.series.values(bound, a, b)[0]
                other = np.flatnonzero(x != value)
                if other.size:
                    known = (a + int(other[0]), float(x[other[0]]))
                    break
            self._moves[bound.name] = known
        return known[1]


def _is_held_value(column: Column, values: Array) -> bool:
    """Whether measured values are all the same, and more than one."""
    analog = values.dtype.kind == "f" and column.bound.channel.quantity in ANALOG
    return analog and len(values) > 1 and values[0] == values[-1] and bool((values == values[0]).all())
