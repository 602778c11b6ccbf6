"""Whether a channel that stands at all moments that are kept of it shows the next reading between them, often."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from thermodata.plugin import Float1D

_MOST_READINGS = 8  # different ones: what shows more moves, or is no sensor in treads
_FEWEST = 5  # times that it leaves its reading: a dead one drops out, and shows a wrong count, now and then
_SPREAD = 0.5  # of the test, from the first time to the last
_NEXT = 1.5  # of the distance of the nearest reading: rounding


@dataclass(slots=True)
class _Reading:
    """A reading. n: samples; runs: times that it comes; first, last: at which sample."""

    first: int
    last: int
    n: int = 0
    runs: int = 0


@dataclass(slots=True)
class Flicker:
    """How far the next readings lie from the one on which a channel stands."""

    readings: dict[float, _Reading] = field(default_factory=dict)
    n: int = 0
    before: float | None = None

    @property
    def tread(self) -> float | None:
        """The distance of the nearest readings, where it shows these often and all over the test; else None."""
        if not 1 < len(self.readings) <= _MOST_READINGS:
            return None
        stands = max(self.readings, key=lambda x: self.readings[x].n)
        apart = {x: abs(x - stands) for x in self.readings if x != stands}
        tread = min(apart.values())
        near = [self.readings[x] for x, d in apart.items() if d <= _NEXT * tread]
        spread = max(s.last for s in near) - min(s.first for s in near)
        often = sum(s.runs for s in near) >= _FEWEST and spread >= _SPREAD * self.n
        return tread if often else None

    def take(self, x: Float1D) -> None:
        """The next samples, NaN where they are none."""
        known = x[np.isfinite(x)]
        if len(self.readings) > _MOST_READINGS or not known.size:
            return
        starts = np.concatenate([[0], np.flatnonzero(np.diff(known)) + 1])
        lengths = np.diff(starts, append=known.size)
        for value in np.unique(known[starts])[: _MOST_READINGS + 1].tolist():
            mine = known[starts] == value
            rows = starts[mine] + self.n
            seen = self.readings.setdefault(value, _Reading(int(rows[0]), 0))
            seen.last = int(rows[-1])
            seen.n += int(lengths[mine].sum())
            seen.runs += len(rows) - int(value == self.before and bool(mine[0]))
        self.n += int(known.size)
        self.before = float(known[-1])
