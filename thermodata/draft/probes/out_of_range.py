"""Where a probe is out of range: it has no reading, or stands at an end of its range again and again."""

from __future__ import annotations

import numpy as np

from thermodata.calibration.quality.ends.stays import BAND, stays_at_extreme
from thermodata.plugin import Bool1D, Float1D

LEAST = 0.02  # of the samples out of range, and in it
_FEWEST = 50


def out_of_range(x: Float1D) -> Bool1D | None:
    """Where a probe has no reading, or stands at an end of its range; None where it does so never, or nearly always."""
    none = ~np.isfinite(x)
    out = none.copy()
    fine = x[~none]
    if x.size < _FEWEST or not fine.size:
        return None
    span = float(np.ptp(fine))
    noisy = stays_at_extreme(fine)
    if noisy is not None:
        out |= ~none & (np.abs(x - noisy[0]) <= BAND * noisy[1])
    rails: list[tuple[float, Bool1D]] = []
    for end in (float(fine.min()), float(fine.max())):
        at_end = ~none & (np.abs(x - end) <= 1e-3 * span)
        rest = fine[np.abs(fine - end) > 1e-3 * span]
        # a rail is one reading again and again, and far from all others
        if rest.size and at_end.mean() > LEAST and np.abs(rest - end).min() > 0.2 * span:
            rails.append((np.unique(x[at_end]).size / at_end.sum(), at_end))
    # a machine at rest stays near one reading too, beside a rail: the rail is the end that repeats it more exactly
    rails.sort(key=lambda rail: rail[0])
    if len(rails) == 2 and rails[0][1].sum() + rails[1][1].sum() == fine.size and rails[0][0] < rails[1][0]:
        rails.pop()
    for _, at_end in rails:
        out |= at_end
    return out if LEAST < out.mean() < 1 - LEAST else None
