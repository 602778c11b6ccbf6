"""A clock without a battery, which counts from its own epoch until somebody sets it: a step ahead that no pause is."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from thermodata.plugin import Int1D

LEAP_NS = 365 * 86_400 * 1_000_000_000  # no pause of a test is as long


@dataclass(slots=True)
class Leap:
    """Looks for the first leap of a stream while its blocks pass. row: behind it, from 0; by_ns: how far."""

    row: int | None = None
    by_ns: int = 0
    _rows: int = 0
    _before: int | None = None

    def add(self, t_ns: Int1D) -> None:
        """The times of the next rows, shape (n,), in file order."""
        if not t_ns.size:
            return
        if self.row is None:
            # a difference of int64 may overflow where a time is absurd: compare as floats
            steps = np.diff(t_ns.astype(np.float64), prepend=float(t_ns[0] if self._before is None else self._before))
            rows = np.flatnonzero(steps > LEAP_NS)
            if rows.size:
                self.row, self.by_ns = self._rows + int(rows[0]), int(steps[rows[0]])
        self._rows += t_ns.size
        self._before = int(t_ns[-1])

    def note(self) -> str | None:
        """What was found, in words; None where the clock never leapt."""
        if self.row is None:
            return None
        return (
            f"the clock leaps ahead by {self.by_ns / LEAP_NS:.3g} years at row {self.row + 1}: one that was set there? "
            "an ingest moves what came before up to it, for how long it paused is not known"
        )
