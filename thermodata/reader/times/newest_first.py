"""Logs that stand newest first: the portal of a logger shows its last row on top, and saves what it shows."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from thermodata.plugin import Int1D

NOTE = "the rows stand newest first: they are taken from the last to the first"
_MOSTLY = 20  # steps back for one ahead: a stray time makes one of each
_LEAST = 3
_SELDOM = 0.2  # of the steps: a clock that is set, or a test that begins anew, makes one for many rows


@dataclass(slots=True)
class Steps:
    """Counts the steps of a stream's clock while its blocks pass."""

    ahead: int = 0
    back: int = 0
    _before: int | None = None

    def add(self, t_ns: Int1D) -> None:
        """The times of the next rows, shape (n,), in file order."""
        if not t_ns.size:
            return
        steps = np.diff(t_ns, prepend=t_ns[0] if self._before is None else self._before)
        self.ahead += int(np.count_nonzero(steps > 0))
        self.back += int(np.count_nonzero(steps < 0))
        self._before = int(t_ns[-1])

    @property
    def in_no_order(self) -> bool:
        """Whether steps back are so many that rows stand in no order of their times."""
        return self.back > _SELDOM * (self.ahead + self.back) and not self.newest_first

    @property
    def newest_first(self) -> bool:
        """Whether all steps but those of strays go back."""
        return self.back >= _LEAST and self.back > _MOSTLY * self.ahead
