"""What a function that was identified by its coefficients says of itself: its own gain is the factor 1, which says
nothing."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from thermodata.plugin import Effect, Float1D


@dataclass(frozen=True)
class Identified:
    """a over b: coefficients of rising powers of 1/z at step_s [s], b[0] = 1."""

    a: tuple[float, ...]
    b: tuple[float, ...]
    step_s: float

    @property
    def gain_at_rest(self) -> float:
        """In the response's unit per unit of the driver."""
        return sum(self.a) / sum(self.b)

    @property
    def taus_min(self) -> tuple[float, ...]:
        """Time constants [min] of the poles that have one, which are those between 0 and 1; the fastest first."""
        poles: Float1D = np.asarray([p.real for p in np.roots(self.b) if abs(p.imag) < 1e-12 and 0 < p.real < 1])
        return tuple(float(tau) for tau in np.sort(-self.step_s / 60.0 / np.log(poles)))


def identified(effect: Effect) -> Identified | None:
    """None of an effect whose parameters and gains are what was fitted."""
    found = getattr(effect, "identified", None)
    return found if isinstance(found, Identified) else None
