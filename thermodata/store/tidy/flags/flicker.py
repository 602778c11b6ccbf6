"""Whether a channel that stands at all moments that are kept of it shows other readings between them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from thermodata.plugin import Float1D


@dataclass(slots=True)
class Flicker:
    """Whether samples of a channel differ: more than one from the first."""

    first: float | None = None
    others: int = 0

    @property
    def told(self) -> bool:
        return self.others > 1

    def take(self, x: Float1D) -> None:
        if self.told:
            return
        known = x[np.isfinite(x)]
        if self.first is None and known.size:
            self.first = float(known[0])
        self.others += int(np.count_nonzero(known != self.first))
